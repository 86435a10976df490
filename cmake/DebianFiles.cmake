# Run by cpack between installing and packing: copyright and changelog of each package, manual pages
# packed, and the usual rights whatever the umask.
file(READ ${CPACK_TEMPORARY_DIRECTORY}/runtime/usr/share/doc/knotwave/LICENSE license)
string(REGEX MATCH "Copyright \\(c\\) ([^\n]+)\n+(.*)$" _ "${license}")
set(owner "${CMAKE_MATCH_1}")
string(STRIP "${CMAKE_MATCH_2}" text)
string(REPLACE "\n\n" "\n.\n" text "${text}")
string(REPLACE "\n" "\n " text "${text}")
set(components runtime development plugins)
set(packages knotwave knotwave-dev knotwave-plugins)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, if set

foreach(component package IN ZIP_LISTS components packages)
  if(NOT EXISTS ${CPACK_TEMPORARY_DIRECTORY}/${component})
    continue()
  endif()
  set(share ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr/share)
  set(doc ${share}/doc/${package})
  file(MAKE_DIRECTORY ${doc})
  file(WRITE ${doc}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Knotwave

Files: *
Copyright: ${owner}
License: Expat
 ${text}
")
  file(WRITE ${doc}/changelog "knotwave (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * What changed is told in CHANGELOG.md of the package knotwave.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
  file(GLOB pages ${share}/man/man1/*.1)
  execute_process(COMMAND gzip -9n ${doc}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND chmod -R u=rwX,go=rX ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(REMOVE ${CPACK_TEMPORARY_DIRECTORY}/runtime/usr/share/doc/knotwave/LICENSE)
file(CREATE_LINK copyright ${CPACK_TEMPORARY_DIRECTORY}/runtime/usr/share/doc/knotwave/LICENSE SYMBOLIC)
