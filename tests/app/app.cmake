# The parts of the program that need no terminal.
set(app_sources command_line.cpp mpi_ranks.cpp progress.cpp terminal.cpp)
list(TRANSFORM app_sources PREPEND ${PROJECT_SOURCE_DIR}/engine/app/)
poesy_test(app_test LABELS unit SOURCES app/command_line_test.cpp app/progress_test.cpp
           app/resumable_run_test.cpp ${app_sources}
           LINKS poesy_engine CLI11::CLI11 fmt::fmt)
