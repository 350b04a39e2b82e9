# Reports in a browser. Screenshots are left in the build tree, to be looked at.
add_test(NAME browser.report
         COMMAND ${POESY_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/browser/report_test.py)
set_tests_properties(browser.report PROPERTIES LABELS browser TIMEOUT 900 SKIP_RETURN_CODE 77 ENVIRONMENT
  "POESY_PROGRAM=$<TARGET_FILE:poesy>;POESY_WEB=${PROJECT_BINARY_DIR}/engine/report/web;POESY_SCREENSHOTS=${PROJECT_BINARY_DIR}/screenshots")
