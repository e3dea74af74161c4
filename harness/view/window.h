#pragma once

#include <functional>
#include <glm/glm.hpp>

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

  bool is_closing() const;
  void close();

  /// Waits for events, at most so many seconds, and handles them.
  void wait(double seconds);

  glm::ivec2 size() const;                ///< of the framebuffer, pixels
  float scale() const { return scale_; }  ///< pixels for each of a usual screen's

  void begin_frame();

  /// Draws the widgets over what the window's framebuffer holds, and shows it.
  void end_frame();

 private:
  GLFWwindow* window_;
  float scale_ = 1.0f;
};

}  // namespace shadowbench::view
