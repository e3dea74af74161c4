#include <utility>

#include "harness/view/gui.h"
#include "harness/view/save.h"

// After the loader, see gl_api.h.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace shadowbench::view {

const std::vector<Gui::Key>& Gui::list_keys() {
  static const std::vector<Key> keys = {
      {GLFW_KEY_F1, false, "F1", "show or hide this list", [](Gui& gui) { gui.look_.help = !gui.look_.help; }},
      {GLFW_KEY_T, false, "T", "divider between the sides, or one side at a time",
       [](Gui& gui) {
         gui.look_.sharing = gui.look_.sharing == Sharing::kDivider ? Sharing::kFlip : Sharing::kDivider;
       }},
      {GLFW_KEY_SPACE, false, "Space", "one side at a time: flip to the other",
       [](Gui& gui) {
         gui.look_.sharing = Sharing::kFlip;
         gui.look_.flipped_to = 1 - gui.look_.flipped_to;
       }},
      {GLFW_KEY_X, false, "X", "exchange left and right",
       [](Gui& gui) { gui.bench_.change(Changes::all(), [](ViewSettings& s) { std::swap(s.sides[0], s.sides[1]); }); }},
      {GLFW_KEY_PAGE_DOWN, false, "Page Down", "next layer: picture, visibility, error, ...",
       [](Gui& gui) { gui.look_.layer = (gui.look_.layer + 1) % Layers::list().size(); }},
      {GLFW_KEY_PAGE_UP, false, "Page Up", "previous layer",
       [](Gui& gui) { gui.look_.layer = (gui.look_.layer + Layers::list().size() - 1) % Layers::list().size(); }},
      {GLFW_KEY_M, false, "M", "magnifier with the values under the pointer",
       [](Gui& gui) { gui.look_.magnifier = !gui.look_.magnifier; }},
      {GLFW_KEY_N, false, "N", "the depth map and the stored map", [](Gui& gui) { gui.look_.map = !gui.look_.map; }},
      {GLFW_KEY_H, false, "H", "show or hide the panels", [](Gui& gui) { gui.look_.panels = !gui.look_.panels; }},
      {GLFW_KEY_C, false, "C", "next camera of the scene",
       [](Gui& gui) {
         gui.bench_.change(Changes::all(), [](ViewSettings& s) { s.camera = (s.camera + 1) % s.cameras.size(); });
       }},
      {GLFW_KEY_L, false, "L", "next light of the scene",
       [](Gui& gui) {
         gui.bench_.change(Changes::all(), [](ViewSettings& s) { s.light = (s.light + 1) % s.lights.size(); });
       }},
      {GLFW_KEY_R, false, "R", "camera and light as the scene has them",
       [](Gui& gui) {
         gui.bench_.change(Changes::all(), [&](ViewSettings& s) {
           s.cameras = gui.bench_.first().cameras;
           s.lights = gui.bench_.first().lights;
         });
       }},
      {GLFW_KEY_P, true, "Ctrl+P", "save the picture with captions, and the float images of both sides",
       [](Gui& gui) { gui.save("picture", [&](const auto& stem) { gui.save_picture(stem); }); }},
      {GLFW_KEY_S, true, "Ctrl+S", "save the scene with this camera and light",
       [](Gui& gui) { gui.save_state("scene", save_scene); }},
      {GLFW_KEY_E, true, "Ctrl+E", "save both sides as an experiment of 'shadowbench run'",
       [](Gui& gui) { gui.save_state("experiment", save_experiment); }},
      {GLFW_KEY_Q, true, "Ctrl+Q", "close the window", [](Gui& gui) { gui.window_.close(); }}};
  return keys;
}

}  // namespace shadowbench::view
