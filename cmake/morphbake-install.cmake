# What `cmake --install` copies, and how find_package(morphbake) finds it.
include(CMakePackageConfigHelpers)

# The same compile command for static and shared: tests/install finds the objects in ccache.
set_target_properties(morphbake PROPERTIES DEFINE_SYMBOL "")

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/morphbake)
set(MORPHBAKE_DATA_DIR ${CMAKE_INSTALL_DATADIR}/morphbake)
file(RELATIVE_PATH lib_from_bin /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
set_target_properties(morphbake_cli PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")
install(TARGETS morphbake EXPORT morphbake FILE_SET HEADERS)
install(TARGETS morphbake_cli)
install(EXPORT morphbake FILE morphbake-targets.cmake NAMESPACE morphbake::
        DESTINATION ${package_dir})
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/morphbake-config.cmake.in
  ${PROJECT_BINARY_DIR}/morphbake-config.cmake
  INSTALL_DESTINATION ${package_dir}
  PATH_VARS MORPHBAKE_DATA_DIR CMAKE_INSTALL_BINDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/morphbake-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/morphbake-config.cmake
              ${PROJECT_BINARY_DIR}/morphbake-config-version.cmake
              ${PROJECT_SOURCE_DIR}/cmake/morphbake-import.cmake
              ${PROJECT_SOURCE_DIR}/cmake/morphbake-golden.cmake
        DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/schemas ${PROJECT_SOURCE_DIR}/config
        DESTINATION ${MORPHBAKE_DATA_DIR}
        FILES_MATCHING PATTERN "*.json")
