poesy_test(calibration_test LABELS unit
           SOURCES engine/calibration/drive_correction_test.cpp engine/calibration/rank_test.cpp
           LINKS poesy_calibration poesy_models DATA)
poesy_test(calibration_statistical_test LABELS statistical
           SOURCES engine/calibration/coverage_statistical_test.cpp
           LINKS poesy_calibration poesy_models poesy_random DATA)
