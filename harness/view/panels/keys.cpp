#include "harness/view/panels/keys.h"

#include "harness/gl/gl_api.h"

// After the loader, see gl_api.h.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace shadowbench::view {

const std::vector<Key>& list_keys() {
  static const std::vector<Key> keys = {
      {Command::kHelp, GLFW_KEY_F1, false, "F1", "show or hide this list"},
      {Command::kShare, GLFW_KEY_T, false, "T", "divider between the sides, or one side at a time"},
      {Command::kFlip, GLFW_KEY_SPACE, false, "Space", "one side at a time: flip to the other"},
      {Command::kSwapSides, GLFW_KEY_X, false, "X", "exchange left and right"},
      {Command::kNextLayer, GLFW_KEY_PAGE_DOWN, false, "Page Down", "next layer: picture, visibility, error, ..."},
      {Command::kPreviousLayer, GLFW_KEY_PAGE_UP, false, "Page Up", "previous layer"},
      {Command::kMagnifier, GLFW_KEY_M, false, "M", "magnifier with the values under the pointer"},
      {Command::kMap, GLFW_KEY_N, false, "N", "the depth map and the stored map"},
      {Command::kPanels, GLFW_KEY_H, false, "H", "show or hide the panels"},
      {Command::kNextCamera, GLFW_KEY_C, false, "C", "next camera of the scene"},
      {Command::kNextLight, GLFW_KEY_L, false, "L", "next light of the scene"},
      {Command::kResetView, GLFW_KEY_R, false, "R", "camera and light as the scene has them"},
      {Command::kSavePicture, GLFW_KEY_P, true, "Ctrl+P", "save the picture, and the float images of both sides"},
      {Command::kSaveScene, GLFW_KEY_S, true, "Ctrl+S", "save the scene with this camera and light"},
      {Command::kSaveExperiment, GLFW_KEY_E, true, "Ctrl+E", "save both sides as an experiment of 'shadowbench run'"},
      {Command::kQuit, GLFW_KEY_Q, true, "Ctrl+Q", "close the window"}};
  return keys;
}

const std::vector<std::pair<std::string, std::string>>& list_gestures() {
  static const std::vector<std::pair<std::string, std::string>> gestures = {
      {"left drag", "orbit around what is under the pointer"},
      {"right drag", "look around"},
      {"middle drag", "move sideways"},
      {"wheel", "approach what is under the pointer"},
      {"Shift + left drag", "move the light across the sky"},
      {"drag the divider", "share the picture otherwise"},
      {"W A S D, E, Q", "fly ahead, left, back, right, up, down; Shift: faster"},
      {"Ctrl + click on a slider", "type a number"}};
  return gestures;
}

std::vector<Command> find_commands(const std::vector<Window::KeyPress>& presses) {
  std::vector<Command> commands;
  for (const Window::KeyPress& press : presses)
    for (const Key& each : list_keys())
      if (each.key == press.key && each.control == press.control) commands.push_back(each.command);
  return commands;
}

}  // namespace shadowbench::view
