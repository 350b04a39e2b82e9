poesy_test(result_file_test LABELS unit
           SOURCES engine/files/result_file_test.cpp engine/kinds/result_kinds_test.cpp
                   engine/kinds/monte_carlo/fields_test.cpp engine/kinds/sobol/fields_test.cpp engine/kinds/coupling/fields_test.cpp engine/files/fields_test.cpp engine/files/export_test.cpp engine/files/file_writer_test.cpp engine/files/output_folder_test.cpp
                   engine/kinds/stored_study_test.cpp engine/kinds/sensitivity/tolerance_files_test.cpp
                   engine/kinds/sensitivity/fidelity_fields_test.cpp engine/kinds/sensitivity/separation_fields_test.cpp
           LINKS poesy_kinds)
poesy_test(content_hash_test LABELS unit SOURCES engine/files/content_hash_test.cpp engine/files/h5_disk_test.cpp LINKS poesy_kinds hdf5::hdf5)
poesy_test(result_robustness_test LABELS robustness SOURCES engine/files/result_robustness_test.cpp engine/files/trial_read_test.cpp
           LINKS poesy_kinds hdf5::hdf5)
poesy_test(checkpoint_test LABELS robustness SOURCES engine/files/checkpoint_test.cpp engine/files/second_name_test.cpp engine/files/shard_file_test.cpp engine/files/swapped_file_test.cpp LINKS poesy_kinds)
poesy_test(convergence_test LABELS unit
           SOURCES engine/study/study_samples_test.cpp engine/files/result_convergence_test.cpp
                   engine/report/convergence_table_test.cpp
           LINKS poesy_kinds)
