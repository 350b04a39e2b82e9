poesy_test(run_test LABELS determinism SOURCES engine/run/pose_unit_test.cpp engine/run/runner_test.cpp LINKS poesy_kinds)
poesy_test(analysis_test LABELS unit SOURCES engine/kinds/evaluate/cases_test.cpp engine/kinds/coupling/rows_test.cpp
           engine/kinds/coupling/coupling_test.cpp engine/kinds/coupling/corners_test.cpp engine/kinds/sensitivity/fidelity_test.cpp engine/kinds/identification/identification_test.cpp
           engine/kinds/sensitivity/points_radius_test.cpp engine/kinds/sensitivity/separation_test.cpp engine/run/verdict_test.cpp LINKS poesy_kinds)
# It counts by an operator new of its own, where a sanitizer has one.
if(NOT POESY_SANITIZE)
  poesy_test(allocation_test LABELS property SOURCES engine/run/allocation_test.cpp LINKS poesy_kinds poesy_models)
endif()
poesy_test(monte_carlo_sort_test LABELS regression SOURCES engine/kinds/monte_carlo/sort_test.cpp
           LINKS poesy_kinds poesy_models)
poesy_test(machines_test LABELS unit SOURCES engine/kinds/monte_carlo/machines_test.cpp engine/kinds/monte_carlo/stated_errors_test.cpp LINKS poesy_kinds Boost::headers)
poesy_test(sweep_settings_test LABELS unit SOURCES engine/kinds/sweep/settings_test.cpp LINKS poesy_kinds)
poesy_test(part_groups_test LABELS unit SOURCES engine/kinds/monte_carlo/part_groups_test.cpp LINKS poesy_kinds)
poesy_test(part_sums_statistical_test LABELS statistical
           SOURCES engine/kinds/monte_carlo/part_sums_statistical_test.cpp LINKS poesy_kinds Boost::headers)
poesy_test(tolerance_confirmation_test LABELS statistical SOURCES engine/kinds/sensitivity/tolerance_confirmation_test.cpp
           LINKS poesy_kinds)
poesy_test(fidelity_statistical_test LABELS statistical SOURCES engine/kinds/sensitivity/fidelity_statistical_test.cpp
           LINKS poesy_kinds)
poesy_test(index_history_test LABELS property SOURCES engine/kinds/sensitivity/index_history_test.cpp LINKS poesy_kinds poesy_models)
poesy_test(cell_stats_test LABELS determinism SOURCES engine/kinds/sensitivity/cell_stats_test.cpp LINKS poesy_kinds)
poesy_test(linearity_test LABELS determinism SOURCES engine/kinds/sensitivity/linearity_test.cpp LINKS poesy_kinds)
poesy_test(series_model_test LABELS property SOURCES engine/run/series_model_test.cpp LINKS poesy_kinds poesy_models)
poesy_test(unit_order_test LABELS determinism SOURCES engine/run/unit_order_test.cpp LINKS poesy_kinds poesy_models)
poesy_test(failures_test LABELS determinism SOURCES engine/run/failures_test.cpp LINKS poesy_kinds)
poesy_test(continuation_test LABELS robustness SOURCES engine/run/checkpoints_test.cpp engine/run/continuation_test.cpp
           engine/run/hostile_states_test.cpp LINKS poesy_kinds)
poesy_test(adaptive_test LABELS determinism SOURCES engine/run/adaptive_test.cpp LINKS poesy_kinds)
poesy_test(adaptive_statistical_test LABELS statistical SOURCES engine/run/adaptive_statistical_test.cpp
           LINKS poesy_kinds Boost::headers)
poesy_test(ranks_test LABELS robustness SOURCES engine/run/ranks_test.cpp LINKS poesy_kinds)
poesy_test(study_run_test LABELS unit SOURCES engine/kinds/outlook_test.cpp engine/kinds/study_run_test.cpp LINKS poesy_kinds)
poesy_test(tolerance_search_test LABELS statistical
           SOURCES engine/kinds/allocation/near_limit_test.cpp engine/kinds/allocation/search_stages_test.cpp
                   engine/kinds/allocation/search_test.cpp engine/kinds/allocation/variations_test.cpp
           LINKS poesy_kinds)
poesy_test(calibrated_allocation_test LABELS unit DATA SOURCES engine/kinds/allocation/calibrated_test.cpp
           LINKS poesy_kinds poesy_models)
poesy_test(zone_parts_test LABELS unit DATA SOURCES engine/kinds/allocation/zones_test.cpp
           LINKS poesy_kinds poesy_models nlohmann_json::nlohmann_json)
poesy_test(sobol_test LABELS unit SOURCES engine/kinds/sobol/groups_test.cpp engine/kinds/sobol/constant_test.cpp
           LINKS poesy_kinds)
poesy_test(sobol_statistical_test LABELS statistical
           SOURCES engine/kinds/sobol/reference_test.cpp engine/kinds/sobol/shapley_statistical_test.cpp
           LINKS poesy_kinds)
