# Read by ctest once all tests are known.
# A timing is compared there: nothing else may run beside it.
set_tests_properties("harness/run.Timing.TwiceTheTaps_TakeLonger" "harness/run.LightTiming.MoreLights_TakeLonger_StillAndMoving"
                     "harness/run.OwnTime.OfAConstantIsNothing" "harness/run.OwnTime.OfAComparisonIsMoreThanNothing"
                     "harness/run.OwnTime.EmptyLookupsReadWhatTheirFiltersRead" PROPERTIES RUN_SERIAL TRUE)
# Some twenty runs of the program, which sanitizers slow down.
set_tests_properties("harness/cli.FaultSignal.ManyTimesAtRandomMoments_NothingIsLost" PROPERTIES TIMEOUT 900)
