#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
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

/// Where the active camera sees a point, in parts of the picture from its upper left corner; may lie outside.
glm::vec2 find_place(const ViewState& state, const glm::vec3& point_ws);

/// Throws Error(kUsage) for settings that a run would refuse: a bias that a filter or the map cannot have.
void check(const ViewSettings& settings);

/// What the window shows beside the state: nothing of it changes an image.
struct Look {
  float divider = 0.5f;      ///< part of the picture's width; 0 or 1: all of one side
  std::size_t layer = 0;     ///< index into Layers::list()
  float error_scale = 0.2f;  ///< the error with the full colour
  bool panels = true;
  bool map = false;
  bool help = false;

  bool hides(std::size_t side) const { return divider == (side == 0 ? 0.0f : 1.0f); }
};

/// Where the picture lies in the window; pixels of the framebuffer from its upper left corner.
struct PicturePlace {
  glm::vec2 corner{0.0f};
  float magnified = 1.0f;  ///< the window's pixels for each of the picture's
  glm::ivec2 pixels{1};    ///< the picture's size

  glm::vec2 size() const { return magnified * glm::vec2(pixels); }

  /// The picture's place under one of the window, in pixels, rows top to bottom; may lie outside.
  glm::vec2 to_picture(const glm::vec2& place) const { return (place - corner) / magnified; }
  bool holds(const glm::vec2& place) const {
    const glm::vec2 at = to_picture(place);
    return at.x >= 0.0f && at.y >= 0.0f && at.x < static_cast<float>(pixels.x) && at.y < static_cast<float>(pixels.y);
  }

  /// The column at which the right side begins, in the picture's pixels.
  float divider_column(const Look& look) const { return look.divider * static_cast<float>(pixels.x); }
};

/// Brings the cameras and lights to what a scene file gives back, which takes directions as unit vectors. Of settings
/// that were settled, saved files show the very same, bit for bit; of others a direction may differ in the last digit.
/// Throws Error(kInput) for values that no scene file takes.
void settle(ViewSettings& settings);

/// Writes the scene that the state shows to a scene file: with its cameras and lights, and a bare model's floor. The
/// file appears whole or not at all. Throws Error(kUsage) for a file that is no .toml, that the scene was loaded from,
/// or that is a built-in scene's, Error(kInput) where the scene's own file can no longer be read, Error(kOutput).
void save_scene(const ViewState& state, const std::filesystem::path& file);

/// Where save_experiment() puts the scene: "a.scene.toml" beside "a.toml".
std::filesystem::path scene_beside(const std::filesystem::path& experiment);

/// Writes the experiment that is to lie at `file`, with its scene beside it: `shadowbench run` on it draws what the
/// state shows. The options are those of the state, but for how it is measured. The filters of both sides are its
/// cells, with every parameter; truth is traced in any case, so that a side that shows it adds none.
std::string write_experiment(const ViewState& state, options::RunOptions options, const std::filesystem::path& file);

/// Writes the experiment and its scene, which save_scene() does. Throws Error as save_scene().
void save_experiment(const ViewState& state, const std::filesystem::path& file);

/// What of the map is looked at.
struct MapReading {
  glm::vec3 place_ws{0.0f};  ///< of the receiver
  std::size_t side = 0;
  double zoom = 1.0;
  std::string content = "depth";  ///< or "channel 1" to "channel 4" of what the side's filter stores, or "variance"
};

/// The bias and the fit, which both sides share.
struct SharedSettings {
  std::vector<std::string> bias;  ///< as `--bias` takes it; none: the default
  std::string fit = "tight";      ///< as `--fit` takes it
};

/// A fault that a filter has, in a state that shows it.
struct Lesson {
  std::string name;  ///< as `view --lesson` takes it
  std::string title;
  std::vector<std::string> sentences;  ///< what is seen, why, and what helps
  std::string scene;
  std::optional<scene::Camera> camera;    ///< none: the scene's first
  std::array<std::string, kSides> sides;  ///< as make_side() takes them
  int map_size = 1024;
  SharedSettings settings;
  std::string instead_title;  ///< of what can be tried in place of these; empty: nothing
  SharedSettings instead;
  std::string layer;     ///< its id
  float divider = 0.5f;  ///< part of the picture that is the left side
  MapReading reading;
};

/// Reads the lessons of a file. Throws Error(kInput) with "file:line" for what is missing, unknown or out of range.
std::vector<Lesson> read_lessons(const std::filesystem::path& file);

/// Takes over the bias and the fit. Throws Error(kUsage) as parsing them does.
void set_shared(ViewSettings& settings, const SharedSettings& shared);

/// The state that a lesson asks for, whole: of `options` only the size of the picture and what does not decide what is
/// drawn are kept. Throws Error as make_view_state() and make_side() do.
ViewState make_lesson_state(const Lesson& lesson, const options::RunOptions& options,
                            const filters::Catalogue& catalogue);

}  // namespace shadowbench::view
