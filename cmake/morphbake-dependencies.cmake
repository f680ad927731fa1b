# Every third-party package in one place, with what Debian 12's packages get wrong.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(CGAL 5.5 REQUIRED)
find_package(embree 3 REQUIRED)
find_package(TBB REQUIRED)
find_package(CLI11 REQUIRED)

# SuiteSparse and valijson ship no CMake config; the config of OpenImageIO names an include folder
# of OpenCV that its package does not depend on, so all three are imported by hand.
function(morphbake_import name header libraries)
  find_path(${name}_INCLUDE_DIR ${header} PATH_SUFFIXES suitesparse
            HINTS ${CMAKE_SOURCE_DIR}/build/packages/usr/include REQUIRED)
  add_library(morphbake_${name} INTERFACE IMPORTED)
  target_include_directories(morphbake_${name} SYSTEM INTERFACE ${${name}_INCLUDE_DIR})
  foreach(library IN LISTS libraries)
    find_library(${name}_${library}_LIBRARY ${library} REQUIRED)
    target_link_libraries(morphbake_${name} INTERFACE ${${name}_${library}_LIBRARY})
  endforeach()
endfunction()

morphbake_import(cholmod cholmod.h "cholmod;openblas")
morphbake_import(valijson valijson/validator.hpp "")
morphbake_import(openimageio OpenImageIO/imageio.h "OpenImageIO;OpenImageIO_Util")
