poesy_test(io_input_test LABELS unit SOURCES engine/io/study_file_test.cpp engine/io/study_fuzz_test.cpp
           engine/io/error_bound_test.cpp engine/io/held_errors_test.cpp engine/io/study_coupling_test.cpp engine/io/study_keys_test.cpp engine/io/study_fidelity_test.cpp
           engine/io/study_kinds_test.cpp engine/io/study_text_test.cpp engine/io/study_trajectory_test.cpp
           engine/io/table_file_test.cpp LINKS poesy_io tomlplusplus::tomlplusplus)
