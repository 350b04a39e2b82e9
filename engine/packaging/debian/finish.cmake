# Run by cpack when the files of the packages are in place, before they are packed: what Debian's policy asks for besides.
include(${CMAKE_CURRENT_LIST_DIR}/../notices.cmake)

function(poesy_compress file)
  execute_process(COMMAND gzip --best --no-name --force ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# poesy_document(ROOT PACKAGE): copyright and changelogs.
function(poesy_document root package)
  set(doc ${root}/${CPACK_POESY_DOC}/${package})
  file(MAKE_DIRECTORY ${doc})
  configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/copyright ${doc}/copyright COPYONLY)
  configure_file(${CPACK_POESY_SOURCE}/CHANGELOG.md ${doc}/changelog COPYONLY)
  string(TIMESTAMP now "%Y-%m-%d %H:%M:%S" UTC)
  execute_process(COMMAND awk -v version=${CPACK_PACKAGE_VERSION} -v release=${CPACK_DEBIAN_PACKAGE_RELEASE}
                          -v maintainer=${CPACK_PACKAGE_CONTACT} -v now=${now}
                          -f ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/changelog.awk ${CPACK_POESY_SOURCE}/CHANGELOG.md
                  OUTPUT_FILE ${doc}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  poesy_compress(${doc}/changelog)
  poesy_compress(${doc}/changelog.Debian)
endfunction()

set(program ${CPACK_TEMPORARY_DIRECTORY}/program/usr)
set(development ${CPACK_TEMPORARY_DIRECTORY}/development/usr)
poesy_document(${program} poesy)
poesy_document(${development} libpoesy-dev)
poesy_notices(${program}/${CPACK_POESY_DOC}/poesy/notices)
if(NOT EXISTS ${program}/${CPACK_POESY_MANDIR}/man1/poesy.1)
  message(FATAL_ERROR "no manual page is there: install help2man, configure and build poesy_completion_and_man again")
endif()
poesy_compress(${program}/${CPACK_POESY_MANDIR}/man1/poesy.1)
# Debian's zsh looks here.
file(MAKE_DIRECTORY ${program}/${CPACK_POESY_DATADIR}/zsh/vendor-completions)
file(RENAME ${program}/${CPACK_POESY_DATADIR}/zsh/site-functions/_poesy
     ${program}/${CPACK_POESY_DATADIR}/zsh/vendor-completions/_poesy)
file(REMOVE_RECURSE ${program}/${CPACK_POESY_DATADIR}/zsh/site-functions)
set(roots ${program} ${development})
if(CPACK_POESY_PYTHON_VERSION)
  set(python ${CPACK_TEMPORARY_DIRECTORY}/python/usr)
  poesy_document(${python} python3-poesy)
  foreach(file IN LISTS CPACK_POESY_COMPILED_IN_MODULE)
    poesy_notice(${file} ${python}/${CPACK_POESY_DOC}/python3-poesy/notices)
  endforeach()
  list(APPEND roots ${python})
endif()
# Whatever the umask is.
execute_process(COMMAND chmod --recursive u=rwX,go=rX ${roots} COMMAND_ERROR_IS_FATAL ANY)
