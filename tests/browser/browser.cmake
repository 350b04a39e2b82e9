# The scripts of others that stand in reports, made anew from their packages: the same bytes. Their packages for tests
# (axe-core) come with them.
set(web ${PROJECT_SOURCE_DIR}/engine/report/html/web)
set(remade ${CMAKE_CURRENT_BINARY_DIR}/web)
add_test(NAME browser.bundle COMMAND ${CMAKE_COMMAND} -D OUTPUT=${remade}/bundled -D WORK=${remade} -P ${web}/bundle.cmake)
set_tests_properties(browser.bundle PROPERTIES LABELS browser TIMEOUT 300 FIXTURES_SETUP web_packages)
foreach(script IN ITEMS d3 plot)
  add_test(NAME browser.bundled_${script}
           COMMAND ${CMAKE_COMMAND} -E compare_files ${web}/bundled/${script}.js ${remade}/bundled/${script}.js)
  set_tests_properties(browser.bundled_${script} PROPERTIES LABELS browser FIXTURES_REQUIRED web_packages)
endforeach()

# Reports in a browser: a page with figures of every type, and reports of studies.
foreach(pages IN ITEMS Figures Reports WhatIf)
  string(TOLOWER ${pages} name)
  set(script report_test.py)
  if(pages STREQUAL WhatIf)
    set(script what_if_test.py)
  endif()
  add_test(NAME browser.${name}
           COMMAND ${POESY_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/browser/${script} ${pages})
  set_tests_properties(browser.${name} PROPERTIES LABELS browser TIMEOUT 1200 SKIP_RETURN_CODE 77
                       FIXTURES_REQUIRED web_packages)
  set_property(TEST browser.${name} PROPERTY ENVIRONMENT POESY_PROGRAM=$<TARGET_FILE:poesy>
               POESY_WEB=${PROJECT_BINARY_DIR}/engine/report/web
               POESY_AXE=${remade}/node_modules/axe-core/axe.min.js)
endforeach()
