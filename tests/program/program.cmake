# The program, driven as a user drives it. The system's python3 has h5py from Debian's packages.
find_program(POESY_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)

# program_test(NAME LABEL)
function(program_test name label)
  add_test(NAME program.${name}
           COMMAND ${POESY_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/program/${name}_test.py)
  set_tests_properties(program.${name} PROPERTIES LABELS ${label} TIMEOUT 600 ENVIRONMENT
    "POESY_PROGRAM=$<TARGET_FILE:poesy>;POESY_ORACLE=${CMAKE_CURRENT_SOURCE_DIR}/data/deformation_2upr_rpu.json")
endfunction()

program_test(bad_input unit)
program_test(oracle regression)
program_test(determinism determinism)
program_test(adaptive determinism)
program_test(fidelity unit)
program_test(interruption robustness)
program_test(kill robustness)
program_test(replay unit)
program_test(report unit)
program_test(limits unit)
program_test(same_numbers unit)
program_test(resume robustness)
program_test(shard robustness)
program_test(full_disk robustness)
program_test(slurm cluster)
foreach(look IN ITEMS terminal completion_bash completion_zsh man_page)
  program_test(${look} unit)
  set_tests_properties(program.${look} PROPERTIES SKIP_RETURN_CODE 77)
endforeach()
set_property(TEST program.terminal APPEND PROPERTY ENVIRONMENT POESY_SCREENS=${CMAKE_CURRENT_BINARY_DIR}/screens)
set_tests_properties(program.full_disk program.slurm PROPERTIES SKIP_RETURN_CODE 77)
set_tests_properties(program.slurm PROPERTIES TIMEOUT 1200)
# Sanitizers find fault with memory and threads of Open MPI's own; ranks_test runs ranks as threads under them.
if(NOT POESY_SANITIZE)
  program_test(mpi robustness)
  set_property(TEST program.mpi APPEND PROPERTY ENVIRONMENT POESY_HAS_MPI=$<IF:$<BOOL:${POESY_MPI}>,ON,OFF>)
  set_tests_properties(program.mpi PROPERTIES PROCESSORS 2)
endif()
if(POESY_SANITIZE)
  # Runs take ten times as long there.
  set_property(TEST program.kill APPEND PROPERTY ENVIRONMENT POESY_KILLS=6)
  set_tests_properties(program.kill program.resume program.full_disk PROPERTIES TIMEOUT 1800)
endif()
program_test(tolerances unit)
program_test(trajectory unit)
program_test(coupling unit)
program_test(show unit)
program_test(command_line unit)
program_test(reference unit)
program_test(tutorial unit)

add_test(NAME regression.golden
         COMMAND ${POESY_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/regression/regression_test.py $<TARGET_FILE:poesy>)
set_tests_properties(regression.golden PROPERTIES LABELS regression TIMEOUT 600)

# Four million solves, three times over: too slow under the sanitizers, which see every part of it in other tests.
if(NOT POESY_SANITIZE)
  foreach(paper IN ITEMS paper three_prs_paper)
    add_test(NAME regression.${paper}
             COMMAND ${POESY_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/regression/${paper}_test.py $<TARGET_FILE:poesy>)
    set_tests_properties(regression.${paper} PROPERTIES LABELS regression TIMEOUT 600)
  endforeach()
endif()
