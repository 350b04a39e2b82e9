# doxygen and pandoc are looked up when the tests run: quickstart installs them for the tests, after the first configuring perhaps.
add_test(NAME docs.doxygen COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/docs/doxygen_test.py)
set_tests_properties(docs.doxygen PROPERTIES LABELS docs SKIP_RETURN_CODE 77)
add_test(NAME docs.site COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/docs/site_test.py)
set_tests_properties(docs.site PROPERTIES LABELS docs SKIP_RETURN_CODE 77 TIMEOUT 300)
# The numbers of the paper, against a new run of its studies.
add_test(NAME docs.paper COMMAND ${POESY_PYTHON} -B ${PROJECT_SOURCE_DIR}/results/paper/check_numbers.py $<TARGET_FILE:poesy>)
set_tests_properties(docs.paper PROPERTIES LABELS docs TIMEOUT 600)
# The kind of study of engine/docs/adding-a-kind.md in a program of its own: the registry with the two lines that the page
# adds. Files that are compiled in groups have the registry among others, so there it cannot be replaced.
if(NOT POESY_UNITY)
  file(READ ${PROJECT_SOURCE_DIR}/engine/kinds/registry.cpp registry)
  string(REPLACE "#include \"engine/kinds/sobol/kind.h\"\n"
                 "#include \"engine/kinds/sobol/kind.h\"\n#include \"tests/docs/extremes/extremes.h\"\n" registry "${registry}")
  string(REPLACE "&kCouplingKind}" "&kCouplingKind, &extremes::kKind}" registry "${registry}")
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/extremes_registry.cpp CONTENT "${registry}" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/engine/kinds/registry.cpp)
  add_executable(poesy_with_extremes $<TARGET_OBJECTS:poesy> docs/extremes/extremes.cpp
                 ${CMAKE_CURRENT_BINARY_DIR}/extremes_registry.cpp)
  target_link_libraries(poesy_with_extremes PRIVATE poesy_engine poesy_models CLI11::CLI11 fmt::fmt poesy_options)
  if(POESY_MPI)
    target_link_libraries(poesy_with_extremes PRIVATE MPI::MPI_C)
  endif()
  add_test(NAME docs.adding_a_kind COMMAND ${POESY_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/docs/adding_a_kind_test.py)
  set_tests_properties(docs.adding_a_kind PROPERTIES LABELS docs TIMEOUT ${program_test_timeout} ENVIRONMENT
    "POESY_PROGRAM=$<TARGET_FILE:poesy_with_extremes>;PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/program")
endif()
