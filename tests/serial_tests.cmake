# Read by ctest once all tests are known.
set_tests_properties("harness/run.Timing.TwiceTheTaps_TakeLonger" PROPERTIES RUN_SERIAL TRUE)
