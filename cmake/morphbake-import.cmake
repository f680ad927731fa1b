# Packages without a usable CMake config, imported by hand; also installed, for the users of the static
# library. SuiteSparse and valijson ship none; the config of Debian's OpenImageIO names an include
# folder of OpenCV that its package does not depend on.
function(morphbake_import name header libraries)
  if(TARGET morphbake_${name})
    return()
  endif()
  find_path(MORPHBAKE_${name}_INCLUDE_DIR ${header} PATH_SUFFIXES suitesparse REQUIRED
            HINTS ${MORPHBAKE_UNPACKED_PACKAGES}/usr/include)
  mark_as_advanced(MORPHBAKE_${name}_INCLUDE_DIR)
  add_library(morphbake_${name} INTERFACE IMPORTED GLOBAL)
  target_include_directories(morphbake_${name} SYSTEM
                             INTERFACE ${MORPHBAKE_${name}_INCLUDE_DIR})
  foreach(library IN LISTS libraries)
    find_library(MORPHBAKE_${name}_${library}_LIBRARY ${library} REQUIRED)
    mark_as_advanced(MORPHBAKE_${name}_${library}_LIBRARY)
    target_link_libraries(morphbake_${name}
                          INTERFACE ${MORPHBAKE_${name}_${library}_LIBRARY})
  endforeach()
endfunction()

macro(morphbake_import_linked)
  morphbake_import(cholmod cholmod.h "cholmod;openblas")
  morphbake_import(openimageio OpenImageIO/imageio.h "OpenImageIO;OpenImageIO_Util")
endmacro()
