poesy_test(result_file_test LABELS unit
           SOURCES engine/result/result_file_test.cpp engine/kinds/result_kinds_test.cpp
                   engine/kinds/monte_carlo/fields_test.cpp engine/kinds/sobol/fields_test.cpp engine/kinds/coupling/fields_test.cpp engine/result/fields_test.cpp engine/result/export_test.cpp engine/storage/file_writer_test.cpp engine/storage/output_folder_test.cpp
                   engine/kinds/stored_study_test.cpp engine/kinds/sensitivity/tolerance_files_test.cpp
                   engine/kinds/sensitivity/fidelity_fields_test.cpp engine/kinds/sensitivity/separation_fields_test.cpp
           LINKS poesy_kinds)
poesy_test(content_hash_test LABELS unit SOURCES engine/storage/content_hash_test.cpp engine/storage/h5_disk_test.cpp LINKS poesy_kinds hdf5::hdf5)
poesy_test(result_robustness_test LABELS robustness SOURCES engine/result/result_robustness_test.cpp engine/storage/trial_read_test.cpp
           LINKS poesy_kinds hdf5::hdf5)
poesy_test(checkpoint_test LABELS robustness SOURCES engine/storage/checkpoint_test.cpp engine/storage/second_name_test.cpp engine/result/shard_file_test.cpp LINKS poesy_kinds)
poesy_test(convergence_test LABELS unit
           SOURCES engine/study/study_samples_test.cpp engine/result/result_convergence_test.cpp
                   engine/report/convergence_table_test.cpp
                   engine/report/merits_test.cpp
           LINKS poesy_kinds)
