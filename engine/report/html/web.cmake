# The scripts and the style sheet of a report, as constants in poesy_report. Packages of others come from npm, in the
# versions and with the checksums of web/package-lock.json; nothing of them runs while they are installed.
find_program(POESY_NPM npm DOC "npm, which gets what reports draw with")
if(NOT POESY_NPM)
  message(FATAL_ERROR "npm is not installed, and reports need it to be built: on Debian, apt-get install nodejs npm")
endif()

set(web_source ${CMAKE_CURRENT_LIST_DIR}/web)
set(POESY_WEB ${CMAKE_CURRENT_BINARY_DIR}/report/web)
set(packages ${POESY_WEB}/packages.stamp)
set(omit --omit=dev)
if(POESY_TESTS)
  set(omit)  # axe-core, for the test in a browser
endif()
add_custom_command(OUTPUT ${packages}
                   COMMAND ${CMAKE_COMMAND} -E make_directory ${POESY_WEB}
                   COMMAND ${CMAKE_COMMAND} -E copy ${web_source}/package.json ${web_source}/package-lock.json
                           ${POESY_WEB}
                   COMMAND ${CMAKE_COMMAND} -E chdir ${POESY_WEB} ${POESY_NPM} ci ${omit} --ignore-scripts --no-audit
                           --no-fund --prefer-offline --loglevel=error
                   COMMAND ${CMAKE_COMMAND} -E touch ${packages}
                   DEPENDS ${web_source}/package.json ${web_source}/package-lock.json
                   COMMENT "Getting the packages that reports draw with (npm ci)" VERBATIM)

# In the order in which report.js joins them.
set(scripts data.js numbers.js page.js drawing.js colours.js bars.js heatmap.js workspace.js lines.js scatter.js
    main.js)
list(TRANSFORM scripts PREPEND ${web_source}/)
set(assets_cpp ${POESY_WEB}/assets.cpp)
set(assets d3.js plot.js report.js report.css)  # as files, which tests/browser reads
list(TRANSFORM assets PREPEND ${POESY_WEB}/)
add_custom_command(OUTPUT ${assets_cpp}
                   BYPRODUCTS ${assets}
                   COMMAND ${CMAKE_COMMAND} "-DSCRIPTS=${scripts}" -D STYLE=${web_source}/report.css
                           -D PACKAGES=${POESY_WEB}/node_modules -D OUTPUT=${assets_cpp} -P
                           ${CMAKE_CURRENT_LIST_DIR}/assets.cmake
                   DEPENDS ${packages} ${scripts} ${web_source}/report.css ${CMAKE_CURRENT_LIST_DIR}/assets.cmake
                   COMMENT "Writing a report's scripts as constants" VERBATIM)
target_sources(poesy_report PRIVATE ${assets_cpp})
# Standard C++ asks for 65536 characters in a literal; GCC and Clang take any number.
set_source_files_properties(${assets_cpp} PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings)
