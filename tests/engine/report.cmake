poesy_test(report_test LABELS unit SOURCES engine/kinds/coupling/tables_test.cpp
           engine/kinds/sensitivity/fidelity_table_test.cpp engine/kinds/sensitivity/index_change_test.cpp engine/report/json_tables_test.cpp
           engine/kinds/monte_carlo/tables_test.cpp engine/kinds/sensitivity/ranked_table_test.cpp engine/report/latex_columns_test.cpp
           engine/kinds/sensitivity/separation_table_test.cpp engine/report/mechanism_picture_test.cpp engine/report/signs_test.cpp engine/report/sketch_words_test.cpp engine/report/text_table_test.cpp engine/kinds/sensitivity/tolerance_table_test.cpp
           engine/kinds/sensitivity/two_rankings_test.cpp
           LINKS poesy_kinds nlohmann_json::nlohmann_json)
poesy_test(html_report_test LABELS unit SOURCES engine/report/html_parts_test.cpp engine/report/printed_number_test.cpp
           engine/kinds/report_test.cpp
           LINKS poesy_kinds nlohmann_json::nlohmann_json)
poesy_test(allocation_report_test LABELS unit
           SOURCES engine/kinds/allocation/fields_test.cpp engine/kinds/allocation/report_test.cpp
           LINKS poesy_kinds nlohmann_json::nlohmann_json hdf5::hdf5)
