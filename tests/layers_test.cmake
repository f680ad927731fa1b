# Tests the test: layers.cmake must report each breach of a broken tree and exit with 1, and pass a right one.
# cmake -DROOT=<source folder> -DSCRATCH=<folder> -P tests/layers_test.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${SCRATCH})
file(WRITE ${SCRATCH}/src/morphbake/CMakeLists.txt
     "set(MORPHBAKE_MODULES\n    mesh\n    json\n    gltf\n    solve)\n"
     "set(MORPHBAKE_INTERNAL_HEADERS json/.* gltf/document.h)\n")

function(run_layers result output)
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${SCRATCH} -P ${ROOT}/tests/layers.cmake
                  RESULT_VARIABLE code ERROR_VARIABLE text OUTPUT_QUIET)
  string(REGEX REPLACE "[ \n]+" " " text "${text}")
  set(${result} ${code} PARENT_SCOPE)
  set(${output} "${text}" PARENT_SCOPE)
endfunction()

function(expect_breach file content expected)
  file(WRITE ${SCRATCH}/src/${file} "${content}\n")
  run_layers(code output)
  file(REMOVE ${SCRATCH}/src/${file})
  string(FIND "${output}" "src/${file}: ${expected}" found)
  if(NOT code EQUAL 1 OR found EQUAL -1)
    message(SEND_ERROR "not reported (rc ${code}): ${file}: ${content}\n${output}")
  endif()
endfunction()

file(WRITE ${SCRATCH}/src/morphbake/solve/right.cpp
     "#include \"morphbake/mesh/a.h\"\n#include <vector>\n#include <fmt/core.h>\n")
file(WRITE ${SCRATCH}/src/morphbake/mesh/right.cpp "#  include <CGAL/Surface_mesh.h>\n")
file(WRITE ${SCRATCH}/src/morphbake/json/json.h "#include <nlohmann/json.hpp>\n")
run_layers(code output)
if(NOT code EQUAL 0)
  message(SEND_ERROR "a right tree was refused: ${output}")
endif()

expect_breach(morphbake/mesh/up.cpp "#include \"morphbake/solve/b.h\"" "includes morphbake/solve/b.h: solve comes after")
expect_breach(morphbake/mesh/up.h "# include <morphbake/solve/b.h>" "includes morphbake/solve/b.h: solve comes after")
expect_breach(morphbake/mesh/none.cpp "#include \"morphbake/nowhere/b.h\"" "includes morphbake/nowhere/b.h: no such")
expect_breach(morphbake/solve/far.cpp "#include <CGAL/Surface_mesh.h>" "includes CGAL/Surface_mesh.h: only for")
expect_breach(morphbake/mesh/near.h "#include <CGAL/Surface_mesh.h>" "a public header includes CGAL")
expect_breach(morphbake/gltf/document.h "#include <CGAL/Surface_mesh.h>" "includes CGAL/Surface_mesh.h in a header")
expect_breach(morphbake/gltf/json.cpp "#include <nlohmann/json.hpp>" "includes nlohmann/json.hpp: only for")
expect_breach(morphbake/solve/json.h "#include \"morphbake/json/json.h\"" "a public header includes the internal")
expect_breach(morphbake/solve/odd.cpp "#include <zlib.h>" "includes zlib.h: no owner")
expect_breach(morphbake/mesh/deep/a.cpp "" "its folder is not in MORPHBAKE_MODULES")
expect_breach(morphbake/helper/a.h "" "its folder is not in MORPHBAKE_MODULES")
expect_breach(cli/a.cpp "#include <CGAL/Surface_mesh.h>" "includes CGAL/Surface_mesh.h: only for")
