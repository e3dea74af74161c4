#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::records {

/// The faults of one filter's image under one amount of bias.
struct BiasPoint {
  std::optional<double> factor;       ///< multiple of the theoretical amount; empty: the mode takes no amount
  double setting = 0.0;               ///< value of the mode's key; 0 where it has none
  std::optional<double> acne;         ///< share of wholly lit receivers that are dark
  std::optional<double> contact_gap;  ///< share of receivers blocked by what touches them that bias lights
};

/// One filter under one mode of bias, over its amount.
struct BiasCurve {
  std::string filter;             ///< label: id and the parameters that were asked for
  double theory_setting = 0.0;    ///< value that theory gives the mode's key
  double lift_depth = 0.0;        ///< how far that moves the receiver towards the light, depth in [0,1]
  double lift_texels = 0.0;       ///< the same, in widths of a texel at the receiver that theory is taken from
  double lift_m = 0.0;            ///< the same, in metres
  std::vector<BiasPoint> points;  ///< by ascending factor
  std::string id = {};            ///< of the filter
  ParamMap params = {};           ///< complete
};

/// One mode of bias.
struct BiasModeRecord {
  std::string mode;     ///< "constant"
  std::string key;      ///< "depth"; empty where the mode takes no amount
  std::string meaning;  ///< one sentence
  std::vector<BiasCurve> curves;
  std::vector<std::string> left_out;  ///< filters that cannot use it, with the reason
  std::string picture;                ///< path of its pictures, relative to the page
  std::string picture_caption;
};

/// One light of a scene: all modes of bias.
struct BiasSweepRecord {
  struct Span {
    double least = 0.0, most = 0.0;
  };
  std::string scene;  ///< as cells of a run name it: with the name of one of several lights
  std::string title;
  std::string light;    ///< its name, or what it is where it has none
  std::string refused;  ///< why the light has no answer; empty: it has one
  std::string view;
  int map_size = 0;
  std::string fit;  ///< of the light's map
  int width = 0;    ///< pixels
  int height = 0;   ///< pixels
  std::string renderer;
  std::vector<std::string> filters;  ///< labels; their place gives them their colour
  double percentile = 0.0;           ///< [0,1]: the theoretical amount is enough for this share of the lit receivers
  double slope_depth = 0.0;  ///< |dz/du| + |dz/dv| of the lit receiver at that percentile of slope, depth per texel
  double angle_deg = 0.0;    ///< between that receiver's normal and the light
  Span texel_m;              ///< at lit receivers: under a lamp it grows with the distance
  double depth_range_m = 0.0;
  double gap_above = 0.0;      ///< what bias adds to the visibility of a lit contact, at least
  double acne_below = 0.0;     ///< visibility below which a lit receiver is dark
  long acne_receivers = 0;     ///< receivers of the mask
  long contact_receivers = 0;  ///< receivers of the mask
  int fewest_receivers = 0;    ///< a rate over fewer receivers is absent
  std::vector<BiasModeRecord> modes;
};

/// The bias that a sweep recommends for a filter under a light.
struct BiasToShip {
  std::string scene;  ///< as cells of a run name it
  std::string light;  ///< as its sweep names it
  int map_size = 0;
  std::string fit;        ///< of the light's map
  std::string filter;     ///< label
  std::string id = {};    ///< of the filter
  ParamMap params = {};   ///< complete
  std::string bias = {};  ///< as --bias takes it; empty: under no mode the filter is free of acne
  std::optional<double> contact_gap = {};

  /// Whether it was measured as this cell was, but for the bias.
  bool is_of(const CellRecord& cell) const {
    return scene == cell.scene && map_size == cell.map_size && fit == cell.fit && id == cell.filter &&
           params == cell.params;
  }
};

/// Makes the text of a bias.json.
std::string make_bias_json(const std::vector<BiasToShip>& ships);

/// Reads the bias.json that lies in the folder `bias` of a report; nothing where there is none. What cannot be read is
/// left out, and `warnings` say why.
std::vector<BiasToShip> list_bias_to_ship(const std::filesystem::path& report, std::vector<std::string>& warnings);

}  // namespace shadowbench::records
