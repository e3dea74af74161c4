#include <fmt/format.h>

#include <chrono>

#include "filters/base/error.h"
#include "harness/gl/context/context_backends.h"
#include "harness/gl/gl_api.h"

// After the loader, see gl_api.h.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace shadowbench::gl {
namespace {

[[noreturn]] void refuse_glfw(std::string_view what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw Error(ErrorKind::kContext, fmt::format("{}: {}", what, reason == nullptr ? "no reason given" : reason));
}

/// Keeps GLFW initialised while any context lives; glfwInit itself does not count.
class Library {
 public:
  Library() {
    if (users == 0 && glfwInit() == GLFW_FALSE) refuse_glfw("GLFW does not start");
    ++users;
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() {
    if (--users == 0) glfwTerminate();
  }

 private:
  static inline int users = 0;
};

class GlfwContext : public Context {
 public:
  GlfwContext() {
    const auto start = std::chrono::steady_clock::now();
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    constexpr int kSide = 16;
    window_.reset(glfwCreateWindow(kSide, kSide, "shadowbench", nullptr, nullptr));
    if (!window_) refuse_glfw("GLFW opens no window with OpenGL 4.5 core");
    GlInfo info;
    info.backend = "glfw";
    info.device = glfwGetVersionString();
    initialise(std::move(info), start);
  }

 private:
  struct Destroy {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
  };

  void bind() override { glfwMakeContextCurrent(window_.get()); }
  GLADloadfunc loader() const override { return &glfwGetProcAddress; }

  Library library_;
  std::unique_ptr<GLFWwindow, Destroy> window_;
};

}  // namespace

std::unique_ptr<Context> create_glfw_context() { return std::make_unique<GlfwContext>(); }

}  // namespace shadowbench::gl
