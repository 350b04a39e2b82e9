# The package poesy, installed beside the compiled module (component python): its sources, and the metadata by which Python
# knows it (importlib.metadata, pip list). As for pip, setuptools makes them of pyproject.toml, README.md and the version in
# poesy/__init__.py.
set(python_package ${PROJECT_SOURCE_DIR}/engine/python)
set(python_metadata ${CMAKE_BINARY_DIR}/python_metadata)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${python_package}/pyproject.toml ${python_package}/README.md
             ${python_package}/poesy/__init__.py)

file(REMOVE_RECURSE ${python_metadata})
file(MAKE_DIRECTORY ${python_metadata})
execute_process(COMMAND ${Python_EXECUTABLE} -B -c
                        "from setuptools import build_meta as b; b.prepare_metadata_for_build_wheel('${python_metadata}')"
                WORKING_DIRECTORY ${python_package} RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE problem)
set(python_metadata ${python_metadata}/poesy-${PROJECT_VERSION}.dist-info)
if(NOT code EQUAL 0 OR NOT EXISTS ${python_metadata}/METADATA)
  message(FATAL_ERROR "${Python_EXECUTABLE} cannot make the metadata of engine/python for version ${PROJECT_VERSION}. "
                      "It needs setuptools and wheel (python3-setuptools, python3-wheel).\n${problem}")
endif()
file(WRITE ${python_metadata}/INSTALLER "cmake\n")  # which pip names when it is asked to remove the package

install(DIRECTORY ${python_package}/poesy DESTINATION ${POESY_PYTHON_DIR} COMPONENT python
        FILES_MATCHING PATTERN "*.py" PATTERN py.typed PATTERN __pycache__ EXCLUDE)
install(DIRECTORY ${python_metadata} DESTINATION ${POESY_PYTHON_DIR} COMPONENT python)
