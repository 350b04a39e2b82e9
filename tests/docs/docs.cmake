# doxygen and pandoc are looked up when the tests run: quickstart installs them for the tests, after the first configuring perhaps.
add_test(NAME docs.doxygen COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/docs/doxygen_test.py)
set_tests_properties(docs.doxygen PROPERTIES LABELS docs SKIP_RETURN_CODE 77)
add_test(NAME docs.site COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/docs/site_test.py)
set_tests_properties(docs.site PROPERTIES LABELS docs SKIP_RETURN_CODE 77 TIMEOUT 300)
# The numbers of the paper, against a new run of its studies.
add_test(NAME docs.paper COMMAND ${POESY_PYTHON} -B ${PROJECT_SOURCE_DIR}/results/paper/check_numbers.py $<TARGET_FILE:poesy>)
set_tests_properties(docs.paper PROPERTIES LABELS docs TIMEOUT 600)
