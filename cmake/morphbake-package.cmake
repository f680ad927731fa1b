# The Debian package of the program: `cpack -G DEB` in a build folder; pipeline/package does that. Its libraries
# are found by dpkg-shlibdeps. morphbake-debian.cmake adds what only a package has.
set(MORPHBAKE_MAINTAINER "morphbake maintainers <maintainers@users.noreply.h-seed-5a11aa8f.example>"
    CACHE STRING "Who answers for a package: NAME <MAIL>")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME morphbake)
set(CPACK_PACKAGE_CONTACT "${MORPHBAKE_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/morphbake-debian.cmake)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME morphbake)
set(CPACK_DEBIAN_PROGRAM_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "bakes local shape morphs into glTF")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "A JSON recipe says which part of which mesh turns into which other mesh, and
when. morphbake gives the meshes one connectivity, blends them region by
region and writes a .glb with morph targets and a weights animation, which
plays in web browsers, engines and modelling programs, with turntable
previews as GIF and PNG. Other commands compare, check and show any glTF file
with morph targets.")
if(PROJECT_IS_TOP_LEVEL AND NOT BUILD_SHARED_LIBS) # a program that is whole by itself
  include(CPack)
endif()
