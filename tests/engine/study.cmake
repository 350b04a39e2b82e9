poesy_test(study_test LABELS unit SOURCES engine/run/history_points_test.cpp engine/study/milestones_test.cpp engine/study/plan_test.cpp engine/study/study_test.cpp
           LINKS poesy_kinds)
poesy_test(pose_selection_test LABELS property SOURCES engine/study/pose_selection_test.cpp
           engine/study/boundary_test.cpp engine/study/trajectory_test.cpp
           engine/study/unusual_workspace_test.cpp LINKS poesy_kinds)
poesy_test(boundary_statistical_test LABELS statistical SOURCES engine/study/boundary_statistical_test.cpp
           LINKS poesy_kinds Boost::headers)
