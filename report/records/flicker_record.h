#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::records {

inline constexpr int kFlickerSchemaVersion = 2;

/// How one filter's image changes while something moves; see metrics::FlickerStats.
struct FlickerFilter {
  std::string filter;  ///< with the parameters that were asked for
  double change = 0.0;
  double flicker = 0.0;
  double returning = 0.0;  ///< share
  std::int64_t not_finite = 0;
  std::vector<double> step_change;  ///< of each step, root mean square over receivers
};

/// One motion, with the map's texel grid free or fixed in the world.
struct FlickerVariant {
  bool snap = false;
  double texel_m = 0.0;      ///< width of a texel in the first frame
  double grid_texels = 0.0;  ///< median motion of a receiver against the texel grid in a step, without whole texels
  int resizes = 0;           ///< steps in which the texel's size changes by more than a millionth
  std::vector<FlickerFilter> filters;
};

/// How the truth changes while the light or the camera moves.
struct FlickerTruth {
  bool moves = false;  ///< false: the truth cannot change, and is not traced
  double change = 0.0;
  double returning = 0.0;
  double noise =
      0.0;  ///< standard error of a change, root mean square, if frames were traced with random numbers of their own
  std::vector<double> step_change;  ///< of each step, root mean square over receivers
};

/// What was found while one thing moved.
struct FlickerMotion {
  std::string id;     ///< "light"
  std::string title;  ///< for people
  std::string how;    ///< a sentence that says what moves
  double step = 0.0;
  std::string step_unit;  ///< "degrees", "m"
  std::string fit;        ///< fit of the light's frustum, as --fit names it
  std::int64_t receivers = 0;
  FlickerTruth truth;
  std::vector<FlickerVariant> variants;  ///< without snapping, then with it; both have the filters in one order
  std::string picture;                   ///< path of the picture of the flicker, pixel by pixel
};

/// Everything that `shadowbench flicker` found.
struct FlickerRecord : Provenance {
  std::string scene, view;
  int width = 0, height = 0;  ///< of the pictures, pixels
  int map_size = 0;           ///< texels along a side
  int frames = 0;
  float return_above = 0.0f;  ///< going back by more counts
  std::vector<FlickerMotion> motions;
};

/// Makes the text of a flicker.json: `gl` and `machine` as in results.json.
std::string make_flicker_json(const FlickerRecord& record);

/// Makes flicker.csv (RFC 4180): one row per motion, snapping and filter.
std::string make_flicker_csv(const FlickerRecord& record);

}  // namespace shadowbench::records
