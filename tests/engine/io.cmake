poesy_test(result_file_test LABELS unit
           SOURCES engine/io/result_file_test.cpp engine/io/result_kinds_test.cpp
                   engine/io/result_monte_carlo_test.cpp engine/io/result_coupling_test.cpp engine/io/fields_test.cpp engine/io/export_test.cpp engine/io/file_writer_test.cpp engine/io/output_folder_test.cpp
                   engine/io/stored_study_test.cpp engine/io/tolerance_files_test.cpp
                   engine/io/result_fidelity_test.cpp engine/io/result_separation_test.cpp
           LINKS poesy_io DATA)
poesy_test(content_hash_test LABELS unit SOURCES engine/io/content_hash_test.cpp LINKS poesy_io hdf5::hdf5)
poesy_test(result_robustness_test LABELS robustness SOURCES engine/io/result_robustness_test.cpp engine/io/trial_read_test.cpp
           LINKS poesy_io hdf5::hdf5)
poesy_test(checkpoint_test LABELS robustness SOURCES engine/io/checkpoint_test.cpp engine/io/second_name_test.cpp LINKS poesy_io)
poesy_test(convergence_test LABELS unit
           SOURCES engine/io/study_samples_test.cpp engine/io/result_convergence_test.cpp
                   engine/report/convergence_table_test.cpp
           LINKS poesy_report)
