# Programs of other people read our files: h5dump, Python (h5py, xarray), Octave.
# The system's Python comes first: it is the one that Debian's h5py and xarray belong to.
find_program(POESY_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(POESY_PYTHON python3)
find_program(POESY_OCTAVE octave-cli)
find_program(POESY_H5DUMP h5dump)
foreach(tool POESY_PYTHON POESY_OCTAVE POESY_H5DUMP)
  if(NOT ${tool})
    message(FATAL_ERROR "The tests need python3, octave-cli and h5dump; not found: ${tool}. Install Debian's python3-h5py "
                        "python3-h5netcdf python3-xarray python3-matplotlib octave gnuplot-nox fonts-freefont-otf "
                        "hdf5-tools, or configure with -DPOESY_TESTS=OFF.")
  endif()
endforeach()

add_executable(write_examples interop/write_examples.cpp)
target_link_libraries(write_examples PRIVATE poesy_kinds poesy_options)

set(examples ${CMAKE_CURRENT_BINARY_DIR}/interop)
file(MAKE_DIRECTORY ${examples})
add_test(NAME interop.write_examples COMMAND write_examples ${examples})
set_tests_properties(interop.write_examples PROPERTIES FIXTURES_SETUP interop_examples LABELS interop)

function(poesy_interop_test name)
  add_test(NAME interop.${name} COMMAND ${ARGN})
  set_tests_properties(interop.${name} PROPERTIES FIXTURES_REQUIRED interop_examples LABELS interop TIMEOUT 300)
endfunction()

set(scripts ${CMAKE_CURRENT_SOURCE_DIR}/interop)
set(octave ${scripts}/octave ${POESY_OCTAVE} --no-init-file --quiet)
foreach(kind sensitivity evaluate paired monte_carlo machines sobol allocation coupling cases identification)
  poesy_interop_test(h5dump_${kind} ${POESY_H5DUMP} ${examples}/${kind}.h5)
  poesy_interop_test(python_structure_${kind} ${POESY_PYTHON} ${scripts}/check_structure.py ${examples}/${kind}.h5)
  poesy_interop_test(python_tables_${kind} ${POESY_PYTHON} ${scripts}/check_tables.py ${examples}/${kind})
  poesy_interop_test(octave_tables_${kind} ${octave} ${scripts}/check_tables.m ${examples}/${kind})
endforeach()
# What users take to read results: results/read_results.py and results/read_results.m. Files that are none come first.
add_test(NAME interop.make_strangers COMMAND ${POESY_PYTHON} -B ${scripts}/make_strangers.py ${examples})
set_tests_properties(interop.make_strangers PROPERTIES FIXTURES_SETUP interop_strangers DEPENDS interop.write_examples
                     FIXTURES_REQUIRED interop_examples LABELS interop)
poesy_interop_test(python_read_results ${POESY_PYTHON} -B ${scripts}/read_results_test.py $<TARGET_FILE:poesy> ${examples})
poesy_interop_test(octave_read_results ${octave} ${scripts}/check_read_results.m ${PROJECT_SOURCE_DIR} ${examples})
# The package +poesy runs studies of every kind; it finds the program as users tell it where it is.
add_test(NAME interop.octave_poesy COMMAND ${octave} ${scripts}/check_poesy.m ${PROJECT_SOURCE_DIR})
set_tests_properties(interop.octave_poesy PROPERTIES LABELS interop TIMEOUT 300 ENVIRONMENT "POESY=$<TARGET_FILE:poesy>")
set_tests_properties(interop.python_read_results interop.octave_read_results PROPERTIES
                     TIMEOUT 300 FIXTURES_REQUIRED "interop_examples;interop_strangers" ENVIRONMENT "POESY_PYTHON=${POESY_PYTHON}")
add_test(NAME interop.reading_guide COMMAND ${POESY_PYTHON} -B ${scripts}/reading_guide_test.py $<TARGET_FILE:poesy>
                                            ${POESY_OCTAVE})
set_tests_properties(interop.reading_guide PROPERTIES LABELS interop TIMEOUT 300)
poesy_interop_test(python_values ${POESY_PYTHON} ${scripts}/check_values.py ${examples}/sensitivity.h5
                   ${examples}/evaluate.h5 ${examples}/paired.h5)
# engine/docs/result-datasets.md is what the results say of themselves.
poesy_interop_test(dataset_page ${POESY_PYTHON} -B ${scripts}/dataset_page.py
                   ${PROJECT_SOURCE_DIR}/engine/docs/result-datasets.md ${examples} $<TARGET_FILE:poesy>)
# The tests of allocation compare with costs that scipy found. Where there is a scipy it finds some of them again.
add_test(NAME interop.allocation_costs COMMAND ${POESY_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/engine/optimise/reference_costs.py
                                               check ${CMAKE_CURRENT_SOURCE_DIR}/data/allocation_costs.csv)
set_tests_properties(interop.allocation_costs PROPERTIES LABELS interop SKIP_RETURN_CODE 77 TIMEOUT 300)
