# cmake [-D OUTPUT=folder] [-D WORK=folder] -P engine/report/html/web/bundle.cmake
# Makes bundled/d3.js and bundled/plot.js: what reports draw with, as others publish it, behind their licences. Packages
# come from npm, in the versions and with the checksums of package-lock.json; nothing of them runs. To change a version:
# npm install --package-lock-only in this folder, then this script. A test makes the files again and compares them.
if(NOT OUTPUT)
  set(OUTPUT ${CMAKE_CURRENT_LIST_DIR}/bundled)
endif()
if(NOT WORK)
  cmake_path(SET WORK NORMALIZE ${CMAKE_CURRENT_LIST_DIR}/../../../../build/report-packages)
endif()
find_program(POESY_NPM npm)
if(NOT POESY_NPM)
  message(FATAL_ERROR "npm is not installed: on Debian, apt-get install nodejs npm")
endif()

file(MAKE_DIRECTORY ${WORK} ${OUTPUT})
file(COPY ${CMAKE_CURRENT_LIST_DIR}/package.json ${CMAKE_CURRENT_LIST_DIR}/package-lock.json DESTINATION ${WORK})
execute_process(COMMAND ${POESY_NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error
                WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)

# bundle(NAME FILE PACKAGES...): a file of the first package, behind the licences of all that are bundled in it.
function(bundle name file)
  set(notice "")
  foreach(package IN LISTS ARGN)
    file(READ ${WORK}/node_modules/${package}/LICENSE licence)
    string(STRIP "${licence}" licence)
    string(APPEND notice "${package}:\n\n${licence}\n\n")
  endforeach()
  list(GET ARGN 0 first)
  file(READ ${WORK}/node_modules/${first}/${file} script)
  file(WRITE ${OUTPUT}/${name} "/*!\n${notice}*/\n${script}")
endfunction()

# All of d3's own packages have one licence, but for those that are named here.
bundle(d3.js dist/d3.min.js d3 d3-ease d3-geo d3-scale-chromatic d3-delaunay delaunator robust-predicates)
bundle(plot.js dist/plot.umd.min.js @observablehq/plot interval-tree-1d binary-search-bounds isoformat)
