poesy_test(calibration_test LABELS unit
           SOURCES engine/calibration/drive_correction_test.cpp engine/calibration/rank_test.cpp
                   engine/calibration/studied_machines_test.cpp
           LINKS poesy_calibration poesy_models nlohmann_json::nlohmann_json DATA)
poesy_test(calibration_statistical_test LABELS statistical
           SOURCES engine/calibration/coverage_statistical_test.cpp
                   engine/calibration/prediction_statistical_test.cpp
           LINKS poesy_calibration poesy_models poesy_random DATA)
