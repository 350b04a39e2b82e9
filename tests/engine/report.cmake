poesy_test(report_test LABELS unit SOURCES engine/report/monte_carlo_table_test.cpp LINKS poesy_report)
