#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "harness/gl/gl_api.h"

namespace shadowbench::gl {

/// Names a way to get an OpenGL context; `kAuto` tries them in turn, `kSoftware` those that need no GPU and no display.
enum class Backend { kAuto, kSoftware, kOsmesa, kEgl, kGlfw };
constexpr auto names_of(Backend) { return std::array{"auto", "software", "osmesa", "egl", "glfw"}; }

/// Whether this build has a way to make such a context; the machine may still refuse it.
bool has_backend(Backend backend);

/// What a context runs on.
struct GlInfo {
  std::string backend;       ///< "osmesa", "egl" or "glfw"
  std::string device;        ///< what the back end says it opened, e.g. "device 0 (/dev/dri/card0)"; may be empty
  std::string vendor;        ///< GL_VENDOR
  std::string renderer;      ///< GL_RENDERER
  std::string version;       ///< GL_VERSION
  bool software = false;     ///< a CPU rasteriser; for display and for the order of `auto`: limits are measured
  int max_texture_size = 0;  ///< texels per side
  double creation_ms = 0.0;  ///< wall time that making this context took
};

/// Owns one OpenGL 4.5 core context, with clip control lower-left, zero-to-one, and KHR_debug errors recorded.
/// Requires: objects made in it are destroyed before it. One context is current at a time in the whole process.
class Context {
 public:
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  virtual ~Context();

  /// Makes this context current on the calling thread, in place of the one before, and points the loader at its
  /// functions.
  /// Throws Error(kContext).
  void make_current();

  /// Returns what this context runs on; valid as long as the context.
  const GlInfo& info() const { return info_; }

  /// Returns and forgets the errors of high and medium severity since the last call, KHR_debug's and glGetError's.
  /// Requires: this context is current. Shader compiler errors are not among them: `Program` throws those.
  std::vector<std::string> take_gl_errors();

  /// Throws std::logic_error with all recorded GL errors, if there are any: a GL error is a bug of ours.
  void require_no_gl_errors();

 protected:
  Context() = default;

  /// Makes the context current, loads the functions, reads `info` and sets the state that every pass relies on.
  /// Requires: called once, by the code that made the derived object; `start` is when it began. Throws Error(kContext).
  void initialise(GlInfo info, std::chrono::steady_clock::time_point start);

 private:
  virtual void bind() = 0;
  virtual void release() = 0;  ///< leaves the calling thread without a context; requires that this one is current
  virtual GLADloadfunc loader() const = 0;
  static void GLAPIENTRY record_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                        const GLchar* message, const void* context);

  GlInfo info_;
  std::vector<std::string> errors_;
};

/// The context that was made, and the reasons why those tried before it were not taken.
struct ContextChoice {
  std::unique_ptr<Context> context;  ///< never null; current on the calling thread
  std::vector<std::string> refused;  ///< "egl: why", in the order tried; what else is not used, and why, comes first
};

/// Makes a context with `backend`, or for `kAuto` the first that works of: EGL on a GPU, OSMesa, EGL in software, GLFW;
/// for `kSoftware` of OSMesa and EGL in software.
/// Throws Error(kContext) with every reason when none works.
/// Cost: 3 to 30 ms in software (a second one 2 ms), more on a GPU.
ContextChoice create_context(Backend backend);

}  // namespace shadowbench::gl
