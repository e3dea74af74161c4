# Read by ctest once all tests are known.
set_tests_properties("harness/run.Timing.TwiceTheTaps_TakeLonger" "harness/run.LightTiming.MoreLights_TakeLonger_StillAndMoving" PROPERTIES RUN_SERIAL TRUE)
