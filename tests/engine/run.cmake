poesy_test(run_test LABELS determinism SOURCES engine/run/runner_test.cpp LINKS poesy_run)
