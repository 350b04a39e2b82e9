poesy_test(io_input_test LABELS unit SOURCES engine/study/study_file_test.cpp engine/study/study_fuzz_test.cpp
           engine/study/error_bound_test.cpp engine/study/response_units_test.cpp engine/study/held_errors_test.cpp engine/kinds/coupling/keys_test.cpp engine/study/study_keys_test.cpp engine/study/study_fidelity_test.cpp
           engine/kinds/study_kinds_test.cpp engine/study/study_text_test.cpp engine/study/study_trajectory_test.cpp
           engine/study/calibrated_key_test.cpp engine/study/limit_keys_test.cpp engine/study/correlated_errors_test.cpp engine/study/shift_key_test.cpp engine/study/mean_key_test.cpp engine/study/given_machines_test.cpp engine/study/table_file_test.cpp engine/study/bare_numbers_test.cpp engine/study/patterns_test.cpp engine/study/zone_keys_test.cpp LINKS poesy_kinds tomlplusplus::tomlplusplus)
poesy_test(allocation_keys_test LABELS unit
           SOURCES engine/kinds/allocation/drawn_part_test.cpp
                   engine/kinds/allocation/keys_test.cpp
           LINKS poesy_kinds poesy_models DATA)
poesy_test(own_responses_test LABELS unit SOURCES engine/study/own_responses_test.cpp LINKS poesy_kinds poesy_models)
