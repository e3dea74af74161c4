#pragma once

#include <filesystem>
#include <string>
#include <vector>

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
