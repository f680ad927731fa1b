# Checks who includes whom: cmake -DROOT=<source folder> -P tests/layers.cmake
#
# A module includes itself and modules above it in MORPHBAKE_MODULES (src/morphbake/CMakeLists.txt); each
# third-party library has owners; public headers show the standard library and Eigen only. Exits with 1
# and one line a breach.
cmake_minimum_required(VERSION 3.25)  # also for IN_LIST, which silently fails in scripts without it

# regular expression of the header = modules that may include it ("any": every .cpp file)
set(OWNERS
    "^(Eigen|unsupported/Eigen)/=any header"
    "^fmt/=any"
    "^(tbb|oneapi/tbb)/=any"
    "^nlohmann/=json"
    "^valijson/=json"
    "^tiny_gltf\\.h$=gltf"
    "^stb_image.*\\.h$=gltf"
    "^(CGAL|boost)/=mesh sources correspondence connectivity atlas transition"
    "^(cholmod|umfpack|SuiteSparse.*|cblas|metis)\\.h$=linear"
    "^(suitesparse|Spectra)/=linear"
    "^OpenImageIO/=images"
    "^embree[34]/=preview"
    "^muParser\\.h$=transition"
    "^meshoptimizer\\.h$=gltf export"
    "^draco/=gltf"
    "^CLI/=cli"
    "^xxhash\\.h$=cache"
    "^sys/mman\\.h$=linear"
    "^(fcntl|fnmatch|link|poll|unistd|signal|sys/.*)(\\.h)?$=files cache batch cli")

set(breaches "")
function(breach file text)
  set(breaches "${breaches}${file}: ${text}\n" PARENT_SCOPE)
endfunction()

function(list_in file name result)
  file(READ ${file} text)
  if(NOT text MATCHES "set\\(${name}[ \n]+([^)]*)\\)")
    message(FATAL_ERROR "${file}: no set(${name} ...)")
  endif()
  string(REGEX REPLACE "[ \n]+" ";" items "${CMAKE_MATCH_1}")
  set(${result} ${items} PARENT_SCOPE)
endfunction()

list_in(${ROOT}/src/morphbake/CMakeLists.txt MORPHBAKE_MODULES modules)
list_in(${ROOT}/src/morphbake/CMakeLists.txt MORPHBAKE_INTERNAL_HEADERS internal)
list(JOIN internal "|" internal)
set(internal "^(${internal})$")

macro(check_own_include file module include is_header)
  string(REGEX MATCH "^morphbake/([^/]*)/(.*)$" matched ${include})
  set(other "${CMAKE_MATCH_1}")
  set(own_file "${CMAKE_MATCH_2}")
  list(FIND modules "${other}" other_rank)
  if(other_rank EQUAL -1)
    breach(${file} "includes ${include}: no such module")
  elseif(NOT "${module}" STREQUAL "cli" AND other_rank GREATER rank)
    breach(${file} "includes ${include}: ${other} comes after ${module}")
  elseif(${is_header} AND "${other}/${own_file}" MATCHES "${internal}")
    breach(${file} "a public header includes the internal ${include}")
  endif()
endmacro()

macro(check_foreign_include file module include is_header)
  set(owners "")
  foreach(rule IN LISTS OWNERS)
    string(REGEX MATCH "^(.*)=([^=]*)$" matched "${rule}")
    set(allowed ${CMAKE_MATCH_2})
    if(${include} MATCHES "${CMAKE_MATCH_1}")
      string(REPLACE " " ";" owners "${allowed}")
      break()
    endif()
  endforeach()
  if(NOT owners AND ${include} MATCHES "[./]")
    breach(${file} "includes ${include}: no owner in tests/layers.cmake")
  elseif(owners AND NOT "any" IN_LIST owners AND NOT "${module}" IN_LIST owners)
    breach(${file} "includes ${include}: only for ${owners}")
  elseif(owners AND ${is_header} AND NOT "header" IN_LIST owners)
    breach(${file} "a public header includes ${include}: move it to a .cpp file")
  endif()
endmacro()

function(check_file file module)
  list(FIND modules "${module}" rank)
  file(RELATIVE_PATH path ${ROOT}/src/morphbake ${ROOT}/${file})
  set(is_header FALSE)
  if(file MATCHES "\\.h$" AND NOT path MATCHES "${internal}" AND NOT "${module}" STREQUAL "cli")
    set(is_header TRUE)
  endif()
  file(STRINGS ${ROOT}/${file} lines REGEX "^[ \t]*#[ \t]*include")
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "include[ \t]*[<\"]([^>\"]+)[>\"]")
      breach(${file} "unreadable include: ${line}")
      continue()
    endif()
    set(include ${CMAKE_MATCH_1})
    if(path MATCHES "${internal}" AND include MATCHES "^(CGAL|boost)/")
      breach(${file} "includes ${include} in a header")
    elseif(include STREQUAL "morphbake/version.h")
      continue()  # below all modules
    elseif(include MATCHES "^morphbake/")
      check_own_include(${file} ${module} ${include} ${is_header})
    elseif(NOT ("${module}" STREQUAL "cli" AND EXISTS ${ROOT}/src/${include}))
      check_foreign_include(${file} ${module} ${include} ${is_header})
    endif()
  endforeach()
  set(breaches "${breaches}" PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/src/*.cpp ${ROOT}/src/*.h)
list(REMOVE_ITEM files src/morphbake/version.h)
foreach(file IN LISTS files)
  if(file MATCHES "^src/cli/[^/]*$")
    check_file(${file} cli)
  elseif(file MATCHES "^src/morphbake/([^/]+)/[^/]+$" AND CMAKE_MATCH_1 IN_LIST modules)
    check_file(${file} ${CMAKE_MATCH_1})
  else()
    breach(${file} "its folder is not in MORPHBAKE_MODULES")
  endif()
endforeach()
if(breaches)
  message(FATAL_ERROR "${breaches}")
endif()
list(LENGTH files count)
message(STATUS "layers: ${count} files are right")
