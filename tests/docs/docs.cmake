# doxygen is looked up when the test runs: quickstart installs it for the tests, after the first configuring perhaps.
add_test(NAME docs.doxygen COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/docs/doxygen_test.py)
set_tests_properties(docs.doxygen PROPERTIES LABELS docs SKIP_RETURN_CODE 77)
