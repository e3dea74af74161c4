#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::records {

/// The faults of one filter under one amount of bias.
struct BiasCell {
  std::string scene;  ///< as cells of a run name it: with the name of one of several lights
  std::string light;  ///< its name, or what it is where it has none
  std::string view;
  int map_size = 0;
  std::string fit;     ///< of the light's map
  std::string filter;  ///< label: id and the parameters that were asked for
  std::string id;      ///< of the filter
  ParamMap params;     ///< complete
  std::string mode;    ///< "constant"
  std::string key;     ///< "depth"; empty where the mode takes no amount, nor has what depends on one
  std::string bias;    ///< as --bias takes it; of a recommendation empty where no mode frees the filter of acne
  std::optional<double> factor = {};   ///< multiple of the theoretical amount
  std::optional<double> setting = {};  ///< value of the mode's key
  std::optional<double> lift_depth =
      {};  ///< how far that moves the steepest receiver towards the light, depth in [0,1]
  std::optional<double> lift_texels = {};  ///< the same, in widths of a texel there
  std::optional<double> lift_m = {};       ///< the same, in metres
  std::optional<double> acne = {};         ///< share of wholly lit receivers that are dark
  std::optional<double> contact_gap = {};  ///< share of receivers blocked by what touches them that bias lights

  /// Whether a run's cell was measured in the same way, but for the bias.
  bool is_of(const CellRecord& cell) const {
    return scene == cell.scene && map_size == cell.map_size && fit == cell.fit && id == cell.filter &&
           params == cell.params;
  }
};

/// One mode of bias.
struct BiasModeRecord {
  std::string mode;                        ///< "constant"
  std::string meaning;                     ///< one sentence
  std::vector<std::string> left_out = {};  ///< filters that cannot use it, with the reason
  std::string picture = {};                ///< path of its pictures, relative to the page
  std::string picture_caption = {};
};

/// One light of a scene: all modes of bias.
struct BiasSweepRecord {
  std::string light;                                            ///< as its cells name it
  std::string refused = {};                                     ///< why the light has no answer; empty: it has one
  std::vector<std::pair<std::string, std::string>> facts = {};  ///< scene, view, map and program
  std::vector<std::string> filters = {};                        ///< labels; their place gives them their colour
  double angle_deg = 0.0;  ///< between normal and light, of the lit receiver that the theoretical amount is for
  Interval texel_m = {};   ///< at lit receivers: under a lamp it grows with the distance
  std::vector<BiasModeRecord> modes = {};
  std::vector<BiasCell> cells = {};  ///< by mode, filter and ascending amount
};

/// Makes bias.csv (RFC 4180): a row per cell; what is absent is empty.
std::string make_bias_csv(const std::vector<BiasSweepRecord>& sweeps);

/// Makes bias.json of what a sweep recommends.
std::string make_bias_json(const std::vector<BiasCell>& recommended);

/// Reads the bias.json that lies in the folder `bias` of a report; nothing where there is none. What cannot be read is
/// left out, and `warnings` say why.
std::vector<BiasCell> read_recommended_biases(const std::filesystem::path& report, std::vector<std::string>& warnings);

}  // namespace shadowbench::records
