#pragma once

#include <string>
#include <vector>

#include "harness/view/lessons.h"
#include "harness/view/panels/widgets.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

/// Chooses what is looked at: a scene, or a lesson with its text.
class ScenePanel {
 public:
  /// Throws Error(kInput) where scenes or lessons cannot be read.
  ScenePanel(Workbench& bench, Widgets widgets);

  /// Lays out the widgets in the current ImGui window. The lesson whose state is shown from now on; null: as before.
  const Lesson* lay_out();

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

}  // namespace shadowbench::view
