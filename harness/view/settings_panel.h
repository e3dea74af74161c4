#pragma once

#include <functional>
#include <string>
#include <vector>

#include "filters/filter_spec.h"
#include "harness/gl/objects.h"
#include "harness/view/view_state.h"
#include "harness/view/window.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

/// Dear ImGui's widgets as this window has them: each with a name that tests know it by, and help under the pointer.
/// All return whether the user has changed the value.
class Widgets {
 public:
  explicit Widgets(ViewLog& log) : log_(log) {}

  /// One of several.
  bool choose(const std::string& name, const std::string& label, const std::vector<std::string>& choices,
              std::size_t& chosen, const std::string& help = {});

  struct SliderLimits {
    double min = 0.0;
    double max = 1.0;
    bool logarithmic = false;
    bool integer = false;
    std::string unit = {};
  };

  /// A number within limits; one typed in (Ctrl and a click) stays within them.
  bool slide(const std::string& name, const std::string& label, const SliderLimits& limits, double& value,
             const std::string& help = {});

  /// Any number.
  bool drag(const std::string& name, const std::string& label, const std::string& unit, float& value, float speed);

  bool tick(const std::string& name, const std::string& label, bool& value, const std::string& help = {});

  /// A button.
  bool press(const std::string& name, const std::string& label, const std::string& help = {});

  /// A filter's parameter, by what its front matter says of it.
  bool parameter(const std::string& name, const filters::ParamSpec& spec, filters::ParamValue& value);

  /// A texture, pixel by pixel, its row 0 at the bottom.
  void show(const std::string& name, const gl::Texture& texture);

  /// To be called after a widget of another kind.
  void note(const std::string& name);

 private:
  ViewLog& log_;

  void finish(const std::string& name, const std::string& help);
};

/// Shows a text beside the pointer where the last widget is under it.
void show_help(const std::string& text);

/// Chooses what is looked at: a scene, or a lesson with its text.
class ScenePanel {
 public:
  /// Throws Error(kInput) where scenes or lessons cannot be read.
  ScenePanel(Workbench& bench, Widgets widgets);

  /// Lays out the widgets in the current ImGui window. The lesson whose state is shown from now on; null: as before.
  const Lesson* lay_out();

  /// Begins the lesson of that name. The lesson whose state is shown; null: it cannot be, and the bench says why.
  const Lesson* start(const std::string& name);

  /// The title of the lesson that is shown; empty: none.
  std::string lesson() const { return lesson_ == 0 ? "" : lessons_[lesson_ - 1].title; }

 private:
  Workbench& bench_;
  Widgets widgets_;
  std::vector<std::string> scenes_;
  std::vector<Lesson> lessons_;
  std::size_t lesson_ = 0;  ///< 0: none; else the number of the one that is shown
  bool is_instead_ = false;

  void choose_scene();
  const Lesson* start_lesson();
  const Lesson* show_lesson();
};

/// The widgets that change the state: filters with their parameters, light, map, camera; and what is seen of it.
class SettingsPanel {
 public:
  /// `save_scene` saves the scene with the light as it is.
  SettingsPanel(Workbench& bench, Widgets widgets, std::function<void()> save_scene);

  /// Lays out the widgets in the current ImGui window.
  void lay_out(Look& look);

 private:
  Workbench& bench_;
  Widgets widgets_;
  std::function<void()> save_scene_;
  std::vector<std::string> choices_;  ///< of a side: the truth, and the filters by id
  double bias_amount_ = 0.0;

  void show_look(Look& look);
  void show_side(std::size_t side);
  void show_light();
  void show_map();
  void show_fit();
  void show_bias();
  void show_camera();
  void choose_side(std::size_t side, const std::string& choice);
};

}  // namespace shadowbench::view
