# The commit that a program is built from, looked up by each build.
#
#   include(morphbake-commit)
#   morphbake_commit(morphbake version.cpp.in)
#
# compiles the file, with its @MORPHBAKE_COMMIT@ set: 9 digits of the commit's hash, "-dirty" behind them where a
# file that the program is made of differs from it. Sources without git have the hash in cmake/commit.txt, if
# `git archive` made them, else none. Run as a script (-DROOT= -DVERSION= -DINPUT= -DOUTPUT=) it writes the file,
# and touches it only where it changes: then alone something is compiled and linked anew.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(MORPHBAKE_COMMIT_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
  function(morphbake_commit target input)
    cmake_path(ABSOLUTE_PATH input BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    set(output ${CMAKE_CURRENT_BINARY_DIR}/version.cpp)
    add_custom_target(
      ${target}_commit
      COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
              -DINPUT=${input} -DOUTPUT=${output} -P ${MORPHBAKE_COMMIT_SCRIPT}
      BYPRODUCTS ${output}
      COMMENT "Looking up the commit"
      VERBATIM)
    target_sources(${target} PRIVATE ${output})
    add_dependencies(${target} ${target}_commit)
  endfunction()
  return()
endif()

cmake_minimum_required(VERSION 3.25)
find_program(GIT git)

function(ask_git result)
  execute_process(COMMAND ${GIT} --no-optional-locks -C ${ROOT} ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output
                  ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT code STREQUAL "0")
    set(output "none")
  endif()
  set(${result} "${output}" PARENT_SCOPE)
endfunction()

set(prefix "none")
if(GIT)
  ask_git(prefix rev-parse --show-prefix)
endif()
set(MORPHBAKE_COMMIT "")
if(prefix STREQUAL "")  # not "none", nor a folder of the repository of somebody else
  ask_git(hash rev-parse HEAD)
  ask_git(changes status --porcelain -- CMakeLists.txt cmake config schemas src)
  if(NOT changes STREQUAL "")
    set(dirty "-dirty")
  endif()
elseif(EXISTS ${ROOT}/cmake/commit.txt)
  file(STRINGS ${ROOT}/cmake/commit.txt hash LIMIT_COUNT 1)
endif()
if(hash MATCHES "^[0-9a-f]+$")
  string(SUBSTRING ${hash} 0 9 hash)
  set(MORPHBAKE_COMMIT "${hash}${dirty}")
endif()
set(PROJECT_VERSION ${VERSION})
configure_file(${INPUT} ${OUTPUT} @ONLY)
