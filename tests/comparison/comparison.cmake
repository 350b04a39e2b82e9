# Newton against Gauss-Newton over random pairs of pose and sample; two million when called without a number.
add_executable(newton_comparison comparison/branch.cpp comparison/newton_comparison.cpp comparison/pairs.cpp)
find_package(Threads REQUIRED)
target_link_libraries(newton_comparison PRIVATE poesy_models poesy_random fmt::fmt Threads::Threads poesy_options)
add_test(NAME newton_comparison COMMAND newton_comparison 20000)
add_test(NAME newton_comparison_platform COMMAND newton_comparison 20000 1 2 platform)
set_tests_properties(newton_comparison newton_comparison_platform PROPERTIES LABELS statistical)
