#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/view/view_state.h"

namespace shadowbench::view {

/// What of the map is looked at.
struct MapReading {
  glm::vec3 place_ws{0.0f};  ///< of the receiver
  std::size_t side = 0;
  double zoom = 1.0;
  std::size_t content = 0;  ///< 0: depth; else a channel of what the side's filter stores, from 1 on
};

/// The bias and the fit, which both sides share.
struct SharedSettings {
  std::vector<std::string> bias;  ///< as `--bias` takes it; none: the default
  std::string fit = "tight";      ///< as `--fit` takes it
};

/// A fault that a filter has, in a state that shows it.
struct Lesson {
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
