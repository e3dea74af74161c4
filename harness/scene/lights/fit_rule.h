#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace shadowbench::scene {

/// Chooses what the light's frustum encloses.
enum class FitMode {
  kSphere,    ///< a sphere around the scene: its size does not change when the light turns
  kTight,     ///< casters and receivers, as the light sees them
  kView,      ///< what the camera sees of the scene, with the casters between that and the light
  kCascades,  ///< slices of that, each with a layer of the map for itself
  kFocused,   ///< what the camera sees, its width and its length by themselves; see fit_warped() for this and the next
              ///< four
  kLispsm,
  kPsm,
  kTsm,
  kLogpsm,
  kParaboloid,  ///< of a point light: two halves in place of a cube's six faces
};

/// Whether the sun's map goes through a projection that follows the camera.
constexpr bool is_warped(FitMode mode) { return mode >= FitMode::kFocused && mode <= FitMode::kLogpsm; }

/// How cascades share what the camera sees.
struct CascadeRule {
  int count = 4;       ///< 2 .. 4
  double split = 0.5;  ///< 0: slices of equal depth, 1: of equal ratios of depth; between them: a mean of both
  std::vector<double> splits = {};  ///< metres, ascending: where all slices but the last end, in place of `split`
  double blend = 0.1;               ///< the last share of a slice, over which it fades into the next
  bool seen = false;                ///< split the depths that pixels show, and not those of all geometry in view
  double near_m = 0.0;              ///< where the first slice begins; 0: with what is in view
  double far_m = 0.0;               ///< where the last slice ends; 0: with what is in view

  bool operator==(const CascadeRule&) const = default;
};

/// `--fit` as it was asked for.
struct FitRule {
  FitMode mode = FitMode::kTight;
  CascadeRule cascades;  ///< FitMode::kCascades only

  /// Whether each camera has a map of its own.
  bool follows_view() const { return mode == FitMode::kView || mode == FitMode::kCascades || is_warped(mode); }
};

/// Every fit's name, as FitMode has them.
std::vector<std::string> list_fit_names();

/// The fit's name on the command line and in records.
std::string_view name_of(FitMode mode);

/// The rule as parse_fit_rule() reads it: "tight", "cascades:count=4,split=0.5,blend=0.1,depths=all",
/// "cascades:count=3,splits=5/20,blend=0.1,depths=all,far=80".
std::string describe_fit(const FitRule& rule);

/// All of these, as describe_fit() has each.
std::set<std::string> describe_fits(const std::vector<FitRule>& rules);

/// Reads a rule. Throws kUsage for a name that is no fit, or a key or value that cascades have not, with those there
/// are.
FitRule parse_fit_rule(std::string_view text);

}  // namespace shadowbench::scene
