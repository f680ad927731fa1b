# What `cmake --install` copies, and how find_package(morphbake) finds it. Two components: `program` is what the
# Debian package holds (cmake/morphbake-package.cmake), `development` the library.
include(CMakePackageConfigHelpers)

# The same compile command for static and shared: tests/install finds the objects in ccache.
set_target_properties(morphbake PROPERTIES DEFINE_SYMBOL "")

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/morphbake)
set(MORPHBAKE_DATA_DIR ${CMAKE_INSTALL_DATADIR}/morphbake)
if(BUILD_SHARED_LIBS)
  file(RELATIVE_PATH lib_from_bin /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
  set_target_properties(morphbake_cli PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")
endif()
install(TARGETS morphbake_cli COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/schemas ${PROJECT_SOURCE_DIR}/config
        DESTINATION ${MORPHBAKE_DATA_DIR} COMPONENT program
        FILES_MATCHING PATTERN "*.json")

install(TARGETS morphbake EXPORT morphbake FILE_SET HEADERS COMPONENT development
        ARCHIVE COMPONENT development LIBRARY COMPONENT program NAMELINK_COMPONENT development)
install(EXPORT morphbake FILE morphbake-targets.cmake NAMESPACE morphbake::
        DESTINATION ${package_dir} COMPONENT development)
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
        DESTINATION ${package_dir} COMPONENT development)

# What the program prints about itself: where bash-completion, fish and man look.
set(pages ${PROJECT_BINARY_DIR}/pages)
file(MAKE_DIRECTORY ${pages})
function(install_printed file folder)
  add_custom_command(
    OUTPUT ${pages}/${file}
    COMMAND ${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0 $<TARGET_FILE:morphbake_cli> ${ARGN} > ${pages}/${file}
    DEPENDS morphbake_cli VERBATIM)
  set_property(TARGET morphbake_pages APPEND PROPERTY SOURCES ${pages}/${file})
  install(FILES ${pages}/${file} DESTINATION ${folder} COMPONENT program)
endfunction()
add_custom_target(morphbake_pages ALL)
install_printed(morphbake ${CMAKE_INSTALL_DATADIR}/bash-completion/completions completion bash)
install_printed(morphbake.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d completion fish)
install_printed(morphbake.1 ${CMAKE_INSTALL_MANDIR}/man1 manual)

# Documents and examples, laid out as in the source, since they link to one another.
foreach(folder IN ITEMS docs examples)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
          FILES_MATCHING PATTERN "*.md" PATTERN "*.json" PATTERN "*.png" PATTERN "*.gif" PATTERN "*.glb"
          PATTERN "out" EXCLUDE)
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
file(RELATIVE_PATH schemas /${CMAKE_INSTALL_DOCDIR} /${MORPHBAKE_DATA_DIR}/schemas)
file(CREATE_LINK ${schemas} ${PROJECT_BINARY_DIR}/pages/schemas SYMBOLIC)
install(FILES ${PROJECT_BINARY_DIR}/pages/schemas DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

# `copyright` in Debian's form, which names what docs/licences.md lists; and the notices of those libraries
# whose code is compiled into the program, as their licences ask for.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/licences.md)
file(STRINGS ${PROJECT_SOURCE_DIR}/docs/licences.md rows REGEX "^\\| `")
set(MORPHBAKE_LIBRARIES "")
foreach(row IN LISTS rows)
  string(REGEX MATCH "^\\| `([^`]+)` \\| ([^|]*) \\| ([^|]*) \\| ([^|]*) \\| ([^|]*) \\|$" matched "${row}")
  if(NOT matched)
    message(FATAL_ERROR "docs/licences.md: this row has not five columns: ${row}")
  endif()
  set(package ${CMAKE_MATCH_1})
  string(APPEND MORPHBAKE_LIBRARIES " ${CMAKE_MATCH_2} ${CMAKE_MATCH_3} (${package}): ${CMAKE_MATCH_4}\n")
  foreach(prefix IN ITEMS "" ${MORPHBAKE_UNPACKED_PACKAGES})
    install(FILES ${prefix}/usr/share/doc/${package}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR}/licences
            RENAME ${package} OPTIONAL COMPONENT program)
  endforeach()
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/cmake/copyright.in ${PROJECT_BINARY_DIR}/copyright @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
