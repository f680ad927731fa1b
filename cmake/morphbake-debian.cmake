# Run by cpack on what it is about to pack: Debian's change log and a compressed manual page. The date is
# SOURCE_DATE_EPOCH's where that is set.
set(root ${CPACK_TEMPORARY_DIRECTORY}/program/usr/share)
if(NOT EXISTS ${root}/doc/morphbake)
  message(FATAL_ERROR "there is no ${root}/doc/morphbake")
endif()
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(changes ${root}/doc/morphbake/changelog.Debian)
file(WRITE ${changes}
     "morphbake (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) bookworm; urgency=medium\n\n"
     "  * Made by cpack; what is new stands in CHANGELOG.md.\n\n"
     " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
execute_process(COMMAND gzip -9nf ${changes} ${root}/man/man1/morphbake.1 COMMAND_ERROR_IS_FATAL ANY)
file(CHMOD ${changes}.gz ${root}/man/man1/morphbake.1.gz
     PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
