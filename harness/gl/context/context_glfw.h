#pragma once

#include <memory>
#include <string>

#include "harness/gl/context/context.h"

struct GLFWwindow;

namespace shadowbench::gl {

/// A window as it is asked for; by default one that nobody sees.
struct WindowShape {
  int width = 16;  ///< in the window system's units
  int height = 16;
  std::string title = "shadowbench";
  bool visible = false;
};

/// Keeps GLFW initialised while any of these lives.
class GlfwLibrary {
 public:
  /// Throws Error(kContext) where GLFW does not start, for want of a display for instance.
  GlfwLibrary();
  GlfwLibrary(const GlfwLibrary&) = delete;
  GlfwLibrary& operator=(const GlfwLibrary&) = delete;
  ~GlfwLibrary();
};

/// The context of a window.
class GlfwContext : public Context {
 public:
  /// Throws Error(kContext).
  explicit GlfwContext(const WindowShape& shape);

  GLFWwindow* window() const { return window_.get(); }

 private:
  void bind() override;
  void release() override;
  GLADloadfunc loader() const override;

  GlfwLibrary library_;
  struct Destroy {
    void operator()(GLFWwindow* window) const;
  };
  std::unique_ptr<GLFWwindow, Destroy> window_;
};

}  // namespace shadowbench::gl
