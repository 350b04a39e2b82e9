# The Python package engine/python, with the program of this build. POESY_PYTHON is the system's Python (interop.cmake).

# python_test(NAME [ARGUMENT...])
function(python_test name)
  add_test(NAME python.${name} COMMAND ${POESY_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/python/${name}_test.py ${ARGN})
  set_tests_properties(python.${name} PROPERTIES LABELS interop TIMEOUT 600 SKIP_RETURN_CODE 77
                       ENVIRONMENT POESY_PROGRAM=$<TARGET_FILE:poesy>)
endfunction()

python_test(toml)
python_test(numbers)
python_test(run)
python_test(sweep)
python_test(figure)
python_test(evaluate)
python_test(calibrate)
python_test(plots)
python_test(source)
python_test(untrusted)
python_test(tutorial)
python_test(results ${CMAKE_CURRENT_BINARY_DIR}/interop)
set_tests_properties(python.results PROPERTIES FIXTURES_REQUIRED "interop_examples;interop_strangers")
