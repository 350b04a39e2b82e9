poesy_test(study_test LABELS unit SOURCES engine/study/plan_test.cpp engine/study/study_test.cpp
           LINKS poesy_study)
