#pragma once

#include <array>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/options/options.h"
#include "harness/scene/scene.h"

namespace shadowbench::view {

/// The two sides of the divider.
inline constexpr std::size_t kSides = 2;
inline constexpr std::array<const char*, kSides> kSideNames = {"left", "right"};

/// What a side is called that shows the truth.
inline constexpr const char* kTruthName = "truth";

/// What one side shows.
struct Side {
  filters::FilterRequest filter;
  bool truth = false;  ///< ray-traced visibility, in place of the filter's

  /// For titles: "truth", or the filter with the parameters that were asked for.
  std::string label() const { return truth ? kTruthName : filter.label(); }
};

/// The side that a text asks for: a filter with parameters, or "truth". A side that shows the truth keeps a filter, for
/// when it shows one. Throws Error(kUsage) as Catalogue::parse_requests(), and where the text names several filters.
Side make_side(const filters::Catalogue& catalogue, const std::string& text);

/// What can be changed in the window.
struct ViewSettings {
  options::RunOptions options;         ///< of one picture size, one map size and one fit; `filters` are of both sides
  std::vector<scene::Camera> cameras;  ///< the scene's, as they were moved
  std::vector<scene::Light> lights;    ///< likewise
  std::size_t camera = 0;              ///< index of the one that is looked through
  std::size_t light = 0;               ///< index of the one that shines
  std::array<Side, kSides> sides;      ///< left, right

  int map_size() const { return options.map_sizes.front(); }
  const scene::Camera& active_camera() const { return cameras[camera]; }
};

/// All that decides what is drawn: a run with the same settings measures the same images.
struct ViewState : ViewSettings {
  std::string scene_argument;  ///< the name or path that the scene was loaded by
  scene::Scene scene;          ///< `light` is the one that shines, as it was moved; `other_lights` is empty
};

/// Loads a scene and looks at it as a run would: through its first camera, under its first light. Throws Error as
/// scene::load().
ViewState make_view_state(options::RunOptions options, const std::string& scene_argument,
                          std::array<Side, kSides> sides);

/// Lets the light of that name shine, seen from its first view. Throws Error(kUsage) where the scene has none.
void choose_light(ViewState& state, const std::string& name);

/// Takes over other settings: the scene gets its light, and the options the filters of both sides, each once: their
/// kernels pad the map as a run's do.
void apply(ViewState& state, ViewSettings settings);

/// Take over what `--fit` and `--bias` take. Throw Error(kUsage) as parsing these does.
void set_fit(ViewSettings& settings, const std::string& text);
void set_bias(ViewSettings& settings, const std::vector<std::string>& texts);

/// Halves the picture's sides, and with `map` those of the map, with the widths of kernels that parameters set: shadows
/// stay about as wide.
void halve(ViewSettings& settings, bool map);

/// Where the active camera sees a point, in parts of the picture from its upper left corner; may lie outside.
glm::vec2 find_place(const ViewState& state, const glm::vec3& point_ws);

/// Throws Error(kUsage) for settings that a run would refuse: a bias that a filter or the map cannot have.
void check(const ViewSettings& settings);

}  // namespace shadowbench::view
