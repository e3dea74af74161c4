#include "harness/tune/tuning.h"

#include <algorithm>
#include <cassert>
#include <exception>
#include <nlopt.hpp>

namespace shadowbench::tune {
namespace {

constexpr double kGlobalShare = 0.6;    // of the budget
constexpr double kFirstStep = 0.1;      // of Subplex, on the scaled range
constexpr double kSmallestStep = 1e-3;  // likewise
constexpr int kRepeatsPerSetting = 50;  // places that round to known settings cost nothing, but must not go on for ever
constexpr int kRangeRounds = 3;
constexpr double kWorthAnotherRound = 0.01;  // relative

std::vector<double> list_defaults(const std::vector<ParamScale>& params) {
  std::vector<double> defaults;
  for (const ParamScale& scale : params) defaults.push_back(scale.param().default_value);
  return defaults;
}

/// One search. NLopt calls it back.
class Search {
 public:
  Search(const std::vector<ParamScale>& params, const SearchSettings& settings, SettingsDrawn& drawn)
      : params_(params), settings_(settings), drawn_(drawn) {}

  void run() {
    drawn_.error(list_defaults(params_), "default");
    run_stage(nlopt::GN_DIRECT_L, "global", std::max(1, static_cast<int>(kGlobalShare * settings_.budget)));
    run_stage(nlopt::LN_SBPLX, "local", settings_.budget);
  }

 private:
  const std::vector<ParamScale>& params_;
  const SearchSettings& settings_;
  SettingsDrawn& drawn_;
  const char* stage_ = "";
  int limit_ = 0;  ///< settings drawn at the end of the stage
  std::exception_ptr failure_;

  std::vector<double> to_values(const std::vector<double>& units) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < units.size(); ++i) values.push_back(params_[i].to_value(units[i]));
    return values;
  }

  std::vector<double> to_units(const std::vector<double>& values) const {
    std::vector<double> units;
    for (std::size_t i = 0; i < values.size(); ++i)
      units.push_back(std::clamp(params_[i].to_unit(values[i]), 0.0, 1.0));
    return units;
  }

  double evaluate(const std::vector<double>& units) {
    const std::vector<double> values = to_values(units);
    if (!drawn_.knows(values) && drawn_.count() >= limit_) throw nlopt::forced_stop();
    try {
      return drawn_.error(values, stage_);
    } catch (...) {
      failure_ = std::current_exception();  // NLopt passes on none but its own
      throw nlopt::forced_stop();
    }
  }

  static double call(const std::vector<double>& units, std::vector<double>&, void* search) {
    return static_cast<Search*>(search)->evaluate(units);
  }

  void run_stage(nlopt::algorithm algorithm, const char* stage, int limit) {
    if (drawn_.count() >= limit) return;
    stage_ = stage;
    limit_ = limit;
    nlopt::opt optimiser(algorithm, static_cast<unsigned>(params_.size()));
    optimiser.set_lower_bounds(0.0);
    optimiser.set_upper_bounds(1.0);
    optimiser.set_min_objective(&Search::call, this);
    optimiser.set_maxeval(kRepeatsPerSetting * settings_.budget);
    optimiser.set_xtol_abs(kSmallestStep);
    optimiser.set_initial_step(kFirstStep);
    std::vector<double> units = to_units(drawn_.best());
    double error = 0.0;
    try {
      optimiser.optimize(units, error);
    } catch (const nlopt::forced_stop&) {
    } catch (const nlopt::roundoff_limited&) {
      // As near as rounding allows.
    }
    if (failure_) std::rethrow_exception(failure_);
  }
};

}  // namespace

double SettingsDrawn::error(const std::vector<double>& values, const char* stage) {
  const auto found = errors_.find(values);
  if (found != errors_.end()) return found->second;
  const double error = objective_(values);
  errors_.emplace(values, error);
  if (best_.empty() || error < best_error_) {
    best_ = values;
    best_error_ = error;
  }
  if (on_evaluation_) on_evaluation_({count(), stage, values, error});
  return error;
}

SearchResult search_parameters(const std::vector<ParamScale>& params, const SearchSettings& settings,
                               const Objective& objective) {
  assert(!params.empty() && settings.budget >= 1);
  SearchResult result;
  SettingsDrawn drawn(objective, settings.on_evaluation);
  Search(params, settings, drawn).run();
  result.search_evaluations = drawn.count();
  const auto found_better = [&] { return drawn.best_error() < result.best_error * (1.0 - kWorthAnotherRound); };
  for (int round = 0; round == 0 || (round < kRangeRounds && found_better()); ++round) {
    result.best = drawn.best();
    result.best_error = drawn.best_error();
    result.ranges.clear();
    for (std::size_t i = 0; i < params.size(); ++i)
      result.ranges.push_back(find_good_range(params, i, result.best, settings.tolerance, drawn));
  }
  result.default_error = drawn.error(list_defaults(params), "range");
  result.evaluations = drawn.count();
  return result;
}

}  // namespace shadowbench::tune
