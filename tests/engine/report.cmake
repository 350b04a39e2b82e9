poesy_test(report_test LABELS unit SOURCES engine/report/coupling_table_test.cpp
           engine/report/fidelity_table_test.cpp engine/report/index_change_test.cpp engine/report/json_tables_test.cpp
           engine/report/monte_carlo_table_test.cpp engine/report/ranked_table_test.cpp
           engine/report/separation_table_test.cpp engine/report/text_table_test.cpp engine/report/tolerance_table_test.cpp
           engine/report/two_rankings_test.cpp
           LINKS poesy_report nlohmann_json::nlohmann_json)
poesy_test(html_report_test LABELS unit SOURCES engine/report/html_parts_test.cpp engine/report/html_report_test.cpp
           LINKS poesy_report nlohmann_json::nlohmann_json)
