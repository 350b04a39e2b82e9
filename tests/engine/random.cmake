poesy_test(random_test LABELS unit
           SOURCES engine/random/stream_test.cpp engine/random/distribution_test.cpp
                   engine/random/low_discrepancy_test.cpp engine/random/scrambled_sobol_test.cpp
                   engine/random/latin_hypercube_test.cpp engine/random/normal_copula_test.cpp
                   engine/random/weighted_points_test.cpp engine/random/smoothed_values_test.cpp
           LINKS poesy_random Boost::headers)
poesy_test(random_property_test LABELS property
           SOURCES engine/random/distribution_property_test.cpp engine/random/shifted_distribution_test.cpp engine/random/centred_distribution_test.cpp
                   engine/random/stream_property_test.cpp
           LINKS poesy_random Boost::headers)
poesy_test(random_statistical_test LABELS statistical
           SOURCES engine/random/designs_statistical_test.cpp engine/random/distribution_statistical_test.cpp
                   engine/random/normal_copula_statistical_test.cpp
                   engine/random/stream_statistical_test.cpp
           LINKS poesy_random poesy_stats Boost::headers)
target_include_directories(random_test SYSTEM PRIVATE ${RANDOM123_INCLUDE_DIR})
