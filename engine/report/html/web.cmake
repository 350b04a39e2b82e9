# The scripts and the style sheet of a report, as constants in poesy_report. Those in web/bundled are other people's;
# web/bundle.cmake makes them.
set(web_source ${CMAKE_CURRENT_LIST_DIR}/web)
set(bundled ${web_source}/bundled)
set(POESY_WEB ${CMAKE_CURRENT_BINARY_DIR}/report/web)

# In the order in which report.js joins them.
set(scripts data.js numbers.js names.js page.js drawing.js colours.js bars.js heatmap.js turning.js workspace.js lines.js
    scatter.js robot.js tables.js what_if.js main.js)
list(TRANSFORM scripts PREPEND ${web_source}/)
set(styles ${web_source}/report.css ${web_source}/robot.css ${web_source}/what_if.css)
set(assets_cpp ${POESY_WEB}/assets.cpp)
set(assets d3.js plot.js report.js report.css)  # as files, which tests/browser reads
list(TRANSFORM assets PREPEND ${POESY_WEB}/)
add_custom_command(OUTPUT ${assets_cpp}
                   BYPRODUCTS ${assets}
                   COMMAND ${CMAKE_COMMAND} "-DSCRIPTS=${scripts}" "-DSTYLES=${styles}"
                           -D BUNDLED=${bundled} -D OUTPUT=${assets_cpp} -P
                           ${CMAKE_CURRENT_LIST_DIR}/assets.cmake
                   DEPENDS ${bundled}/d3.js ${bundled}/plot.js ${scripts} ${styles}
                           ${CMAKE_CURRENT_LIST_DIR}/assets.cmake
                   COMMENT "Writing a report's scripts as constants" VERBATIM)
target_sources(poesy_report PRIVATE ${assets_cpp})
# Standard C++ asks for 65536 characters in a literal; GCC and Clang take any number.
set_source_files_properties(${assets_cpp} PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings)
