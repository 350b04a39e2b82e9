poesy_test(base_test LABELS unit SOURCES engine/base/array_test.cpp engine/base/bytes_test.cpp engine/base/name_pattern_test.cpp engine/base/plain_file_test.cpp engine/base/ratio_test.cpp
           engine/base/text_test.cpp engine/base/units_test.cpp engine/base/value_limit_test.cpp
           LINKS poesy_base)
poesy_test(drawing_test LABELS unit SOURCES engine/drawing/share_inside_test.cpp engine/drawing/worst_case_test.cpp engine/drawing/zone_draws_test.cpp engine/drawing/zone_scatter_test.cpp
           LINKS poesy_drawing nlohmann_json::nlohmann_json DATA)
poesy_test(linalg_test LABELS property SOURCES engine/linalg/decompositions_test.cpp LINKS poesy_linalg)
poesy_test(fits_test LABELS unit SOURCES engine/fits/fit_test.cpp engine/fits/general_tolerance_test.cpp engine/fits/it_grade_test.cpp
                                         engine/fits/preferred_numbers_test.cpp LINKS poesy_fits)
