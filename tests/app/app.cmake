# The parts of the program that need no terminal.
set(app_sources duration.cpp progress_line.cpp recent_rate.cpp whole_number.cpp)
list(TRANSFORM app_sources PREPEND ${PROJECT_SOURCE_DIR}/engine/app/)
poesy_test(app_test LABELS unit SOURCES app/duration_test.cpp app/progress_line_test.cpp app/recent_rate_test.cpp
           app/whole_number_test.cpp ${app_sources} LINKS poesy_engine CLI11::CLI11 fmt::fmt)
