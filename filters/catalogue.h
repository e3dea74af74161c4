#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "filters/filter_spec.h"

namespace shadowbench::filters {

/// What an engine's shadows are as they ship, as a filter of ours.
struct Preset {
  std::string name;                       ///< "unity-hdrp-high"
  std::string title;                      ///< for people: engine and setting
  std::string filter;                     ///< one filter with parameters, as the command line writes it
  std::string bias;                       ///< the engine's depth bias, in its own units
  std::vector<std::string> bias_options;  ///< texts of --bias that say exactly that; none where no mode can
  std::string differs;                    ///< what of the engine the filter does not do
  std::vector<std::string> sources;       ///< addresses of what was read
  std::string version;                    ///< of the engine, that was read
  std::string where;                      ///< "file:line"
};

/// A filter and the parameter values it is to run with.
struct FilterRequest {
  FilterSpec spec;
  ParamValues values;                 ///< complete: every parameter has a value
  std::set<std::string> set_by_user;  ///< names of the parameters that were asked for
  std::string width;          ///< asked for in place of a radius, as in solve_radius(), or kLightWidth; empty: was not
  bool is_run_width = false;  ///< that width is the run's, and goes without saying
  std::optional<double> light_sigma_texels;  ///< the kernel's width that the scene's light asks for, once it is known
  bool user_file = false;                    ///< given by its path; it runs in a process of its own
  std::vector<Preset> presets;               ///< that were asked for, and are this

  /// The id, with the asked-for parameters in parentheses; what tables and grids print.
  std::string label() const;

  /// The parameter that the light's width sets; null where none does.
  const std::string* param_by_light() const;

  /// Gives that parameter its value. Requires the light's width in texels.
  void take_light_width(double sigma_texels);
};

/// Gives filters a width, as solve_radius() takes it or kLightWidth, but for those that were told a radius or a width,
/// and presets. With kLightWidth, filters that have no width to choose, and presets, count as of that width as they
/// are. Throws Error(kUsage) as solve_radius().
void set_widths(std::vector<FilterRequest>& requests, const std::string& width);

/// Throws Error(kUsage) where one of them is to have the light's width: `run` alone asks a light.
void refuse_light_widths(const std::vector<FilterRequest>& requests);

/// Whether both are one filter with the same values: whether they make one cell.
bool is_same(const FilterRequest& a, const FilterRequest& b);

/// Knows the filters of one folder, one `<id>.glsl` each; comparison filters first, narrow before wide.
class Catalogue {
 public:
  /// Loads every filter in `folder`.
  /// Throws Error(kFilter) as load_filter, or when the folder holds none.
  explicit Catalogue(const std::filesystem::path& folder);

  const std::vector<FilterSpec>& filters() const { return filters_; }

  /// Reads the presets that stand beside the filters. Throws as load_presets().
  std::vector<Preset> presets() const;

  /// Throws Error(kUsage), with the nearest id, when there is no such filter.
  const FilterSpec& find(const std::string& id) const;

  /// Adds a user's file.
  /// Throws as load_filter, and Error(kUsage) when its id is taken.
  void add_user_file(const std::filesystem::path& path);

  /// Adds many. Throws FilterErrors with what is wrong in any of them, and likewise where an id is taken.
  void add_user_files(const std::vector<std::string>& paths);

  /// Parses `a,b:param=value,param=value,c`. In place of a radius a filter takes `width=`, as solve_radius() does, or
  /// kLightWidth, which is left to take_light_width().
  /// `all` stands for every filter but those for teaching, at its defaults, and `teaching` for these; an empty text is
  /// `all`. `@name` stands for presets, as choose_presets() finds them; what is asked for as a preset and otherwise,
  /// too, is one request. Throws Error(kUsage) for an unknown filter, preset or parameter (with the nearest name) and
  /// for a value out of range, and Error(kInput) with the line of a preset that is no filter of this catalogue.
  std::vector<FilterRequest> parse_requests(const std::string& text) const;

 private:
  std::filesystem::path folder_;
  std::vector<FilterSpec> filters_;
  std::vector<std::string> user_ids_;

  FilterRequest make_request(const std::string& id) const;
  FilterRequest make_request(const Preset& preset) const;
  void add_requests(std::vector<FilterRequest>& requests, std::optional<std::vector<Preset>>& known,
                    const std::string& item) const;
};

/// Every parameter its default.
ParamValues default_values(const FilterSpec& spec);

/// Whether a name asks for the kernel's width in place of a radius, and is no parameter of the filter's own.
bool asks_for_width(const FilterSpec& spec, const std::string& name);

/// Parses and checks one value for one parameter.
/// Throws Error(kUsage) when the parameter is unknown (with the nearest name) or the value is not allowed.
ParamValue parse_value(const FilterSpec& spec, const std::string& name, const std::string& text);

/// Reads a file of presets, in its order. Throws Error(kInput) with file and line: an unknown key, a missing or empty
/// one, a name that is taken or cannot stand on a command line.
std::vector<Preset> load_presets(const std::filesystem::path& file);

/// Finds the preset of that name, or all whose names go on with "-" after it: "unity-hdrp" is every quality of it.
/// Throws Error(kUsage), with the nearest name, where there is none.
std::vector<Preset> choose_presets(const std::vector<Preset>& all, const std::string& name);

/// The --bias options that give the engine's bias; empty where there are none.
std::string write_bias_options(const Preset& preset);

/// What a user of it must know: its filter, what that does not do, and the engine's bias, which no preset sets.
std::string describe_preset(const Preset& preset);

}  // namespace shadowbench::filters
