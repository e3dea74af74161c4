#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::records {

/// A metric with the parameters a filter has by default, and with those that were found.
struct TunedScore {
  double at_default = 0.0;
  double tuned = 0.0;
  double gain() const { return at_default - tuned; }  ///< positive: the found ones are better
};

/// The scores of one view.
struct TunedViewRecord {
  std::string scene;
  std::string view;
  bool training = false;
  TunedScore score;
  double truth_se = 0.0;  ///< standard error of the truth, root mean square over the view's receivers
};

/// One parameter that was searched, and how wide its good range is.
struct TunedParamRecord {
  std::string name;
  std::string unit;
  std::string scale;  ///< scale of the search: "linear", "log"
  double min = 0.0;
  double max = 0.0;
  double default_value = 0.0;
  double found = 0.0;
  std::vector<Interval>
      good;                 ///< where the training error stays near the best, with the other parameters at their best
  double good_share = 0.0;  ///< share of the scaled range that they take, [0,1]
  bool no_effect = false;   ///< the training error is the same all over the range
};

/// The verdict of the unseen views on the parameters that were found.
enum class TuneVerdict {
  kBetter,      ///< better by more than the truth's standard error
  kNoGain,      ///< not better by more than that, in training or on unseen views
  kOverfitted,  ///< better in training, but not on unseen views
};
constexpr auto names_of(TuneVerdict) { return std::array{"better", "no gain", "overfitted"}; }

/// What was found for one filter.
struct TunedFilterRecord {
  std::string id;
  std::string label;  ///< with the parameters that the request fixed
  ParamMap defaults;  ///< complete: the starting point, fixed parameters included
  ParamMap params;    ///< complete: what to run with; the defaults, unless the verdict is kBetter
  std::string fit;    ///< of the light's map: what to run with, likewise
  std::vector<TunedParamRecord> searched;
  std::vector<TunedViewRecord> views;
  TunedScore training;  ///< mean over the training views
  TunedScore unseen;    ///< mean over the unseen views
  std::optional<double>
      unseen_truth_se;  ///< mean over the unseen views; empty: the metric is not in units of visibility
  TuneVerdict verdict = TuneVerdict::kNoGain;
  int search_evaluations = 0;  ///< settings that the search drew
  int evaluations = 0;         ///< settings drawn in all, with those for the good ranges
};

/// Names the schema that tuned.json follows.
inline constexpr int kTunedSchemaVersion = 2;

/// A whole tuning.
struct TunedRecord {
  std::string commit;
  std::string renderer;
  std::string metric;
  int map_size = 0;
  std::string fit;             ///< of the light's map, as asked for
  int width = 0;               ///< pixels
  int height = 0;              ///< pixels
  double pad_texels = 0.0;     ///< texels around the scene in the map
  double widest_kernel = 0.0;  ///< half-width in texels of the widest kernel that was searched
  int budget = 0;
  double tolerance = 0.0;  ///< by which share the error of the good range may exceed the best
  std::uint32_t seed = 0;
  std::string light;              ///< "AZIMUTH,ELEVATION"; empty: each scene's own
  std::vector<std::string> bias;  ///< as asked for; empty: the default
  std::string training_views;     ///< in words
  std::string unseen_views;       ///< in words
  std::vector<std::string> scenes;
  std::vector<std::string> notes;  ///< views left out, and why
  std::vector<TunedFilterRecord> filters;
};

/// Fills in a filter's means, verdict and the parameters to run with, from its views and `found`, its complete
/// parameters as found. `metric_in_visibility`: the truth's standard error is in the metric's unit; else any gain
/// counts.
void judge_tuning(TunedFilterRecord& filter, const ParamMap& found, bool metric_in_visibility);

/// Makes the text of a tuned.json: settings, and for every filter its parameters, their good ranges and all scores.
std::string make_tuned_json(const TunedRecord& record);

/// What a run takes from a tuned.json.
struct TunedSettings {
  struct Filter {
    std::string id;
    ParamMap params;  ///< not checked against the filter
    std::string fit;
  };
  std::string metric;
  int map_size = 0;
  std::vector<Filter> filters;  ///< each id once
};

/// Reads a tuned.json.
/// Throws Error(kInput), with file and field, where it is missing, malformed or of another schema version.
TunedSettings read_tuned_settings(const std::filesystem::path& file);

}  // namespace shadowbench::records
