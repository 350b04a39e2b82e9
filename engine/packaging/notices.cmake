# Notices of other people's software that is in the program, for the folder of its documents.
include(${CMAKE_CURRENT_LIST_DIR}/debian/dependencies.cmake)

# poesy_notice(FILE FOLDER): writes the notice of the library that a file is of, as its Debian package holds it.
function(poesy_notice file folder)
  poesy_package_of(package ${file})
  configure_file(/usr/share/doc/${package}/copyright ${folder}/${package}.txt COPYONLY)
endfunction()

# poesy_notices(FOLDER): writes the notice of each library that is in the program, and of the scripts in reports.
function(poesy_notices folder)
  foreach(file IN LISTS CPACK_POESY_COMPILED_IN)
    poesy_notice(${file} ${folder})
  endforeach()
  foreach(script IN ITEMS d3 plot)
    file(READ ${CPACK_POESY_SOURCE}/engine/report/html/web/bundled/${script}.js text)
    string(FIND "${text}" "*/" end)
    string(SUBSTRING "${text}" 0 ${end} notice)
    string(REGEX REPLACE "^/\\*!\n" "" notice "${notice}")
    file(WRITE ${folder}/${script}.txt "${notice}")
  endforeach()
endfunction()
