#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/view/look.h"
#include "harness/view/panels/widgets.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

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
