#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/options/options.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/tune/tuning.h"

namespace shadowbench::tune {

/// The options of `shadowbench tune`.
struct TuneOptions {
  options::RunOptions
      run;  ///< scenes, filters with the parameters that stay fixed, one map size, picture size, light, bias, folders
  bool skip_scenes =
      false;  ///< leave out scenes that have no training view to measure the metric in: nobody asked for them by name
  std::string metric = "rmse";
  int budget = 80;  ///< settings that the search draws of each filter; half as many of its cascades
  std::set<std::string> fixed_keys = {};  ///< of --fit, which are not searched
};

/// Lists the parameters of a request that are searched: numbers with a range that the request does not set, and that
/// are not `const`, which would have to be compiled anew for every value.
std::vector<SearchedParam> list_searched_params(const filters::FilterRequest& request);

/// Lists what is searched of cascades: how they are split, unless their splits are in metres, and how wide they blend,
/// but for `fixed`. Nothing of other fits.
std::vector<SearchedParam> list_searched_params(const scene::FitRule& fit, const std::set<std::string>& fixed);

/// The half-width in texels of the widest kernel that a search of these filters draws.
double find_widest_kernel(const std::vector<filters::FilterRequest>& requests);

/// How many texels the maps of a search are padded by, the same for every setting: what the widest kernel needs,
/// but at most a 64th of the map, at least 4. A kernel that reaches beyond reads depth 1, as it would in a larger map
/// without casters.
double choose_tune_padding(double widest_kernel_texels, int map_size);

/// Finds the split and blend of cascades that make the metric's mean over the training views (tune_views()) of all
/// scenes least for each filter, then the parameters of the filter that do so with these, and scores all of it, and the
/// defaults, on views that were not trained on. Of blends whose errors differ by less than the truth's standard error
/// the widest is taken, which hides seams best. Writes tuned.json, tune.html, .md and evaluations.csv into the output
/// folder. Returns the page as Markdown. Throws Error(kUsage) for an unknown metric, a filter named twice or without
/// parameters to search, Error(kInput) where a scene that is not to be skipped, or every scene, has no view to measure
/// the metric in, and as run_experiment. Cost: one prefilter per scene and one lookup per view for each setting, and a
/// map per view for each setting of cascades; the truth of each view, once. Memory is that of the training views,
/// whatever the number of settings.
std::string tune_filters(const TuneOptions& options, options::Progress& progress);

/// Every request the parameters that a tuned.json holds for its filter, but for those that the request sets
/// itself. Returns what the user should know: filters that the file does not name, which keep their defaults, and maps
/// and fits that differ from those it was tuned on. Throws Error(kInput), with file and field, where the file is
/// malformed or names an unknown filter or parameter, or a value that is not allowed; also for filters that are not
/// requested.
std::vector<std::string> apply_tuned(std::vector<filters::FilterRequest>& requests, const filters::Catalogue& catalogue,
                                     const std::filesystem::path& file, const std::vector<int>& map_sizes,
                                     const std::vector<scene::FitRule>& fits);

}  // namespace shadowbench::tune
