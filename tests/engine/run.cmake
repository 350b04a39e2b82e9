poesy_test(run_test LABELS determinism SOURCES engine/run/monte_carlo_test.cpp engine/run/runner_test.cpp LINKS poesy_run)
poesy_test(analysis_test LABELS unit SOURCES engine/run/cases_test.cpp engine/run/coupling_rows_test.cpp
           engine/run/coupling_test.cpp engine/run/fidelity_test.cpp engine/run/identification_test.cpp
           engine/run/points_radius_test.cpp engine/run/separation_test.cpp engine/run/verdict_test.cpp LINKS poesy_run)
poesy_test(allocation_test LABELS property SOURCES engine/run/allocation_test.cpp LINKS poesy_run poesy_models)
poesy_test(monte_carlo_sort_test LABELS regression SOURCES engine/run/monte_carlo_sort_test.cpp
           LINKS poesy_run poesy_models)
poesy_test(tolerance_confirmation_test LABELS statistical SOURCES engine/run/tolerance_confirmation_test.cpp
           LINKS poesy_run)
poesy_test(fidelity_statistical_test LABELS statistical SOURCES engine/run/fidelity_statistical_test.cpp
           LINKS poesy_run)
poesy_test(index_history_test LABELS property SOURCES engine/run/index_history_test.cpp LINKS poesy_run poesy_models)
poesy_test(linearity_test LABELS determinism SOURCES engine/run/linearity_test.cpp LINKS poesy_run)
poesy_test(unit_order_test LABELS determinism SOURCES engine/run/unit_order_test.cpp LINKS poesy_io poesy_models)
poesy_test(failures_test LABELS determinism SOURCES engine/run/failures_test.cpp LINKS poesy_run)
poesy_test(continuation_test LABELS robustness SOURCES engine/run/continuation_test.cpp LINKS poesy_run)
poesy_test(adaptive_test LABELS determinism SOURCES engine/run/adaptive_test.cpp LINKS poesy_run)
poesy_test(adaptive_statistical_test LABELS statistical SOURCES engine/run/adaptive_statistical_test.cpp
           LINKS poesy_run Boost::headers)
poesy_test(ranks_test LABELS robustness SOURCES engine/run/ranks_test.cpp LINKS poesy_run)
poesy_test(study_run_test LABELS unit SOURCES engine/run/outlook_test.cpp engine/run/study_run_test.cpp LINKS poesy_run)
