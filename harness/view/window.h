#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "harness/gl/context/context_glfw.h"

namespace shadowbench::view {

/// Dear ImGui in a window of GLFW: events in, frames out.
class Window {
 public:
  /// `context` must be current and outlive this object. `scale` enlarges text and widgets; 0: as the screen asks for.
  /// Throws Error(kContext) where ImGui cannot draw into it.
  Window(gl::GlfwContext& context, float scale);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  /// The size that a window may have on the first screen, with room for its frame.
  static glm::ivec2 find_room();

  void set_title(const std::string& title);

  bool is_closing() const;
  void close();

  /// Waits for events, at most so many seconds, and handles them.
  void wait(double seconds);

  glm::ivec2 size() const;                ///< of the framebuffer, pixels
  float scale() const { return scale_; }  ///< pixels for each of a usual screen's

  /// A key that went down.
  struct KeyPress {
    int key = 0;  ///< of GLFW
    bool control = false;
  };

  /// The keys that went down since the last call, also those that are up again: ImGui sees only what is down while a
  /// frame begins. None of those that were typed into a widget.
  std::vector<KeyPress> take_keys();

  /// Whether a key of GLFW is down.
  bool is_held(int key) const;

  void begin_frame();

  /// Draws the widgets over what the window's framebuffer holds, and shows it.
  void end_frame();

 private:
  GLFWwindow* window_;
  float scale_ = 1.0f;
  std::vector<KeyPress> keys_;
  std::string title_;

  static void note_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
};

}  // namespace shadowbench::view
