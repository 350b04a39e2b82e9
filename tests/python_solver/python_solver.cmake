# The module for Python, where it is built, by the Python that it was built for, with that one's NumPy and SciPy.
if(POESY_PYTHON_MODULE AND NOT POESY_SANITIZE)
  add_test(NAME python.solver
           COMMAND ${Python_EXECUTABLE} -B ${CMAKE_CURRENT_SOURCE_DIR}/python_solver/solver_test.py)
  set_tests_properties(python.solver PROPERTIES LABELS interop TIMEOUT 300 ENVIRONMENT
    "POESY_PROGRAM=$<TARGET_FILE:poesy>;PYTHONPATH=$<TARGET_FILE_DIR:poesy_solver>")
endif()
