// The entries of the module that the command line loads when there is work to do: the image libraries behind it take
// 0.2 s to load, which `list` and `--help` should not pay.

#include "harness/flicker/run_flicker.h"
#include "harness/run/bias_sweep.h"
#include "harness/run/compare_pictures.h"
#include "harness/run/run_experiment.h"
#include "harness/run/tune_filters.h"
#include "harness/stress/run_stress.h"
#include "report/merge.h"
#include "report/regress/regress.h"

extern "C" void shadowbench_run_experiment(const shadowbench::run::RunOptions& options,
                                           shadowbench::run::Progress& progress) {
  shadowbench::run::run_experiment(options, progress);
}

extern "C" void shadowbench_compare_pictures(const shadowbench::run::ComparisonOptions& options,
                                             shadowbench::run::Comparison& result) {
  result = shadowbench::run::compare_pictures(options);
}

extern "C" void shadowbench_run_bias_sweep(const shadowbench::run::RunOptions& options,
                                           shadowbench::run::Progress& progress) {
  shadowbench::run::run_bias_sweep(options, progress);
}

extern "C" void shadowbench_merge_runs(const std::vector<std::filesystem::path>& folders,
                                       const std::filesystem::path& out) {
  shadowbench::report::merge_runs(folders, out);
}

extern "C" void shadowbench_tune_filters(const shadowbench::run::TuneOptions& options,
                                         shadowbench::run::Progress& progress, std::string& text) {
  text = shadowbench::run::tune_filters(options, progress);
}

extern "C" void shadowbench_run_stress(const shadowbench::stress::StressOptions& options,
                                       shadowbench::run::Progress& progress,
                                       shadowbench::stress::StressOutcome& outcome) {
  outcome = shadowbench::stress::run_stress(options, progress);
}

extern "C" void shadowbench_describe_stress_axes(const std::vector<shadowbench::filters::FilterRequest>& filters,
                                                 std::string& text) {
  text = shadowbench::stress::describe_axes(filters);
}

extern "C" void shadowbench_run_flicker(const shadowbench::flicker::FlickerOptions& options,
                                        shadowbench::run::Progress& progress) {
  shadowbench::flicker::run_flicker(options, progress);
}

extern "C" void shadowbench_run_regress(const shadowbench::regress::RegressOptions& options,
                                        shadowbench::regress::RegressOutcome& outcome) {
  outcome = shadowbench::regress::run_regress(options);
}
