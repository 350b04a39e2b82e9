poesy_test(stats_test LABELS unit
           SOURCES engine/stats/chebyshev_series_test.cpp engine/stats/histogram_test.cpp engine/stats/mean_interval_test.cpp engine/stats/merge_tree_test.cpp engine/stats/moments_test.cpp
                   engine/stats/quantile_interval_test.cpp engine/stats/quantile_sketch_test.cpp engine/stats/rank_correlation_test.cpp
                   engine/stats/rounding_test.cpp engine/stats/indices_test.cpp engine/stats/sketch_offset_test.cpp
                   engine/stats/stored_stats_test.cpp engine/stats/tolerance_test.cpp engine/stats/proportion_test.cpp
                   engine/stats/machines_test.cpp engine/stats/error_scores_test.cpp engine/stats/yield_gradient_test.cpp
                   engine/stats/main_effects_test.cpp engine/stats/first_order_test.cpp engine/stats/squared_differences_test.cpp
                   engine/stats/linear_fit_test.cpp engine/stats/linear_limits_test.cpp engine/stats/mean_square_shares_test.cpp
                   engine/stats/mapped_gradient_test.cpp engine/stats/told_together_test.cpp
           LINKS poesy_stats poesy_random Boost::headers)
poesy_test(stats_property_test LABELS property
           SOURCES engine/stats/moments_property_test.cpp engine/stats/quantile_sketch_property_test.cpp
                   engine/stats/indices_property_test.cpp
           LINKS poesy_stats)
poesy_test(stats_statistical_test LABELS statistical
           SOURCES engine/stats/coverage_statistical_test.cpp engine/stats/quantile_coverage_statistical_test.cpp
                   engine/stats/effect_coverage_statistical_test.cpp
                   engine/stats/squared_differences_statistical_test.cpp
           LINKS poesy_stats poesy_random Boost::headers)
poesy_test(least_cost_test LABELS unit
           SOURCES engine/optimise/branch_and_bound_test.cpp engine/optimise/cost_law_test.cpp
                   engine/optimise/least_cost_test.cpp engine/optimise/max_tolerances_test.cpp
                   engine/optimise/tolerance_limits_test.cpp
           LINKS poesy_optimise)
poesy_test(least_cost_property_test LABELS property DATA
           SOURCES engine/optimise/least_cost_property_test.cpp engine/optimise/pairs_test.cpp
           LINKS poesy_optimise)
