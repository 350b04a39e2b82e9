# Reports in a browser: a page with figures of every type, and reports of studies. Screenshots stay in the build tree.
foreach(pages IN ITEMS Figures Reports)
  string(TOLOWER ${pages} name)
  add_test(NAME browser.${name}
           COMMAND ${POESY_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/browser/report_test.py ${pages})
  set_tests_properties(browser.${name} PROPERTIES LABELS browser TIMEOUT 1200 SKIP_RETURN_CODE 77)
  set_property(TEST browser.${name} PROPERTY ENVIRONMENT POESY_PROGRAM=$<TARGET_FILE:poesy>
               POESY_WEB=${PROJECT_BINARY_DIR}/engine/report/web POESY_SCREENSHOTS=${PROJECT_BINARY_DIR}/screenshots)
endforeach()
