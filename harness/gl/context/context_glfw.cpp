#include "harness/gl/context/context_glfw.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "base/error.h"
#include "harness/gl/gl_api.h"

// After the loader, see gl_api.h.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace shadowbench::gl {
namespace {

[[noreturn]] void refuse_glfw(std::string_view what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw Error(ErrorKind::kContext, fmt::format("{}: {}; it needs a display: log in to a desktop, or use xvfb-run", what,
                                               reason == nullptr ? "no reason given" : reason));
}

/// glfwInit does not count its callers.
int users = 0;

}  // namespace

GlfwLibrary::GlfwLibrary() {
#ifdef GLFW_PLATFORM
  // GLFW 3.4 asks Wayland first, whose library writes a line of its own where there is none.
  if (std::getenv("WAYLAND_DISPLAY") == nullptr) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (users == 0 && glfwInit() == GLFW_FALSE) refuse_glfw("GLFW does not start");
  ++users;
}

GlfwLibrary::~GlfwLibrary() {
  if (--users == 0) glfwTerminate();
}

GlfwContext::GlfwContext(const WindowShape& shape) {
  const auto start = std::chrono::steady_clock::now();
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_VISIBLE, shape.visible ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  window_.reset(glfwCreateWindow(shape.width, shape.height, shape.title.c_str(), nullptr, nullptr));
  if (!window_) refuse_glfw("GLFW opens no window with OpenGL 4.5 core");
  GlInfo info;
  info.backend = "glfw";
  info.device = glfwGetVersionString();
  initialise(std::move(info), start);
}

void GlfwContext::Destroy::operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }

void GlfwContext::bind() { glfwMakeContextCurrent(window_.get()); }

void GlfwContext::release() { glfwMakeContextCurrent(nullptr); }

GLADloadfunc GlfwContext::loader() const { return &glfwGetProcAddress; }

std::unique_ptr<Context> create_glfw_context() { return std::make_unique<GlfwContext>(WindowShape{}); }

}  // namespace shadowbench::gl
