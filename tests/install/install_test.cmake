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
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${SCRATCH}/consumer)
run(${SCRATCH}/consumer/consumer ${ROOT}/tests/cli/good_recipe/recipe.json ${SCRATCH}/consumer/out)
if(NOT EXISTS ${SCRATCH}/consumer/out/tetrahedra.glb)
  message(SEND_ERROR "the consumer has baked nothing")
endif()
run(${prefix}/bin/morphbake --version)
foreach(file IN ITEMS share/morphbake/schemas/recipe.schema.json share/morphbake/config/bake.json
                        share/morphbake/config/profiles/web-three.json)
  if(EXISTS ${ROOT}/schemas AND NOT EXISTS ${prefix}/${file})
    message(SEND_ERROR "not installed: ${file}")
  endif()
endforeach()
