# Installs morphbake into SCRATCH/prefix, then configures, builds and runs the consumer against it.
cmake_minimum_required(VERSION 3.25)
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "failed with ${code}: ${ARGN}")
  endif()
endfunction()

set(prefix ${SCRATCH}/prefix)
file(REMOVE_RECURSE ${prefix} ${SCRATCH}/consumer)
if(KIND STREQUAL "shared")
  set(BUILT ${BUILT_SHARED})
  run(${CMAKE_COMMAND} -S ${ROOT} -B ${BUILT} -G Ninja -DBUILD_SHARED_LIBS=ON -DMORPHBAKE_TESTS=OFF
      -DCMAKE_BUILD_TYPE=RelWithDebInfo -DMORPHBAKE_WARNINGS_AS_ERRORS=ON
      -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=${FLAGS})
  run(${CMAKE_COMMAND} --build ${BUILT})
endif()
run(${CMAKE_COMMAND} --install ${BUILT} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${SCRATCH}/consumer -G Ninja
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=Release
    -DRECIPE=${ROOT}/tests/cli/good_recipe/recipe.json)
run(${CMAKE_COMMAND} --build ${SCRATCH}/consumer)
run(${SCRATCH}/consumer/consumer ${ROOT}/tests/cli/good_recipe/recipe.json ${SCRATCH}/consumer/out)
if(NOT EXISTS ${SCRATCH}/consumer/out/tetrahedra.glb)
  message(SEND_ERROR "the consumer has baked nothing")
endif()
run(${prefix}/bin/morphbake --version)

# morphbake_add_golden: a test that fails as long as nothing is stored, and passes from then on.
function(golden_test_is expected)
  execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${SCRATCH}/consumer -R golden.consumer
                          --no-tests=error OUTPUT_VARIABLE output ERROR_VARIABLE output
                  RESULT_VARIABLE code)
  if((code EQUAL 0 AND expected) OR (NOT code EQUAL 0 AND NOT expected))
    return()
  endif()
  message(SEND_ERROR "golden.consumer: ${code}, but passing is to be ${expected}: ${output}")
endfunction()
golden_test_is(FALSE)
if(NOT EXISTS ${SCRATCH}/consumer/golden-differences/consumer/junit.xml)
  message(SEND_ERROR "golden.consumer has written no JUnit file")
endif()
if(EXISTS ${SCRATCH}/consumer/golden)
  message(SEND_ERROR "golden.consumer has stored something")
endif()
run(${prefix}/bin/morphbake golden ${ROOT}/tests/cli/good_recipe/recipe.json --golden-dir
    ${SCRATCH}/consumer/golden --accept)
golden_test_is(TRUE)
foreach(file IN ITEMS share/morphbake/schemas/recipe.schema.json share/morphbake/config/bake.json
                        share/morphbake/config/profiles/web-three.json share/man/man1/morphbake.1
                        share/bash-completion/completions/morphbake share/fish/vendor_completions.d/morphbake.fish
                        share/doc/morphbake/copyright share/doc/morphbake/docs/recipe.md
                        share/doc/morphbake/schemas/recipe.schema.json share/doc/morphbake/examples/01_nose/recipe.json
                        share/doc/morphbake/licences/libcgal-dev)
  if(EXISTS ${ROOT}/schemas AND NOT EXISTS ${prefix}/${file})
    message(SEND_ERROR "not installed: ${file}")
  endif()
endforeach()
