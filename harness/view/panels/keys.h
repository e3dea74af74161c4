#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/view/window.h"

namespace shadowbench::view {

/// What the keys do, beside those that fly the camera.
enum class Command {
  kHelp,
  kFlip,
  kShare,
  kNextLayer,
  kPreviousLayer,
  kSwapSides,
  kMagnifier,
  kMap,
  kPanels,
  kNextCamera,
  kNextLight,
  kResetView,
  kSavePicture,
  kSaveScene,
  kSaveExperiment,
  kQuit,
};

/// One key with what it does; F1 lists them all.
struct Key {
  Command command;
  int key = 0;           ///< of GLFW
  bool control = false;  ///< with Ctrl
  std::string name;      ///< as it is written on the keyboard
  std::string text;      ///< what it does
};

/// All keys, in the order of the help; one table.
const std::vector<Key>& list_keys();

/// What the mouse does, for the help: gesture and effect.
const std::vector<std::pair<std::string, std::string>>& list_gestures();

/// What these keys ask for.
std::vector<Command> find_commands(const std::vector<Window::KeyPress>& presses);

}  // namespace shadowbench::view
