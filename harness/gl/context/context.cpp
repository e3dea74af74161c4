#include "harness/gl/context/context.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/statvfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "harness/gl/objects.h"

namespace shadowbench::gl {

// One function for each way to get a context, null where this build leaves it out. Each returns a context that is
// current, or throws Error(kContext) with the reason.
#ifdef SHADOWBENCH_HAS_OSMESA
std::unique_ptr<Context> create_osmesa_context();
#else
inline constexpr std::nullptr_t create_osmesa_context = nullptr;
#endif

#ifdef SHADOWBENCH_HAS_EGL
std::unique_ptr<Context> create_egl_context();
/// Like create_egl_context, but refuses software rasterisers.
std::unique_ptr<Context> create_egl_gpu_context();
/// Like create_egl_context, but refuses GPUs.
std::unique_ptr<Context> create_egl_software_context();
#else
inline constexpr std::nullptr_t create_egl_context = nullptr, create_egl_gpu_context = nullptr,
                                create_egl_software_context = nullptr;
#endif

#ifdef SHADOWBENCH_HAS_WINDOW
std::unique_ptr<Context> create_glfw_context();
#else
inline constexpr std::nullptr_t create_glfw_context = nullptr;
#endif

namespace {

constexpr std::uintmax_t kLeastFree = std::uintmax_t{16} << 20;  // ten times Mesa's index

std::filesystem::path find_cache_folder() {
  for (const char* name : {"MESA_SHADER_CACHE_DIR", "XDG_CACHE_HOME"})
    if (const char* folder = std::getenv(name); folder && *folder) return folder;
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home ? home : "/") / ".cache";
}

/// Free bytes where the folder is, or will be.
std::optional<std::uintmax_t> count_free(std::filesystem::path folder) {
  struct statvfs disk {};
  while (statvfs(folder.c_str(), &disk) != 0) {
    if (!folder.has_parent_path() || folder == folder.parent_path()) return std::nullopt;
    folder = folder.parent_path();
  }
  return std::uintmax_t{disk.f_bavail} * disk.f_frsize;
}

/// Switches Mesa's cache of shaders off where its disk is nearly full: Mesa maps its index into memory, and a page that
/// the disk cannot hold ends the program with SIGBUS. Returns why, or an empty text where the cache stays on. To be
/// called before the first context.
std::string disable_shader_cache_on_full_disk() {
  constexpr const char* kSwitch = "MESA_SHADER_CACHE_DISABLE";
  if (std::getenv(kSwitch)) return {};
  const std::filesystem::path folder = find_cache_folder();
  const std::optional<std::uintmax_t> free = count_free(folder);
  if (!free || *free >= kLeastFree) return {};
  setenv(kSwitch, "true", 1);
  return fmt::format("the driver's cache of shaders in {}, where {} KB are free", folder.string(), *free >> 10);
}

/// The context that is current; one is at a time in the whole process.
Context* current = nullptr;

std::string get_gl_string(GLenum name) {
  const auto* text = glGetString(name);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

// This is for display and for the order in which `auto` tries back ends. Nothing that can be measured may depend on it.
bool looks_like_software(const std::string& renderer) {
  for (const std::string_view name :
       {"llvmpipe", "softpipe", "swrast", "Software Rasterizer", "SwiftShader", "lavapipe"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

struct Attempt {
  std::string_view name;
  std::unique_ptr<Context> (*create)();
};

/// What to try, without what this build leaves out.
std::vector<Attempt> list_attempts(Backend backend) {
  const Attempt osmesa = {"osmesa", create_osmesa_context};
  const Attempt egl_gpu = {"egl on a GPU", create_egl_gpu_context};
  const Attempt egl_software = {"egl in software", create_egl_software_context};
  const Attempt egl = {"egl", create_egl_context};
  const Attempt glfw = {"glfw", create_glfw_context};
  std::vector<Attempt> attempts;
  switch (backend) {
    case Backend::kAuto: attempts = {egl_gpu, osmesa, egl, glfw}; break;
    case Backend::kSoftware: attempts = {osmesa, egl_software}; break;
    case Backend::kOsmesa: attempts = {osmesa}; break;
    case Backend::kEgl: attempts = {egl}; break;
    case Backend::kGlfw: attempts = {glfw}; break;
  }
  std::erase_if(attempts, [](const Attempt& attempt) { return attempt.create == nullptr; });
  return attempts;
}

/// Mesa crashes where $GALLIUM_DRIVER names a driver that it was built without: such a context is made in a process of
/// its own first.
void require_driver(const Attempt& attempt) {
  const char* driver = std::getenv("GALLIUM_DRIVER");
  if (driver == nullptr || driver == std::string_view("llvmpipe") || *driver == '\0') return;
  const pid_t child = fork();
  if (child == 0) {
    try {
      attempt.create();
    } catch (const std::exception&) {
      // Why there is none is found again, where it can be told.
    }
    _exit(0);
  }
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0)
    throw Error(ErrorKind::kContext,
                fmt::format("Mesa crashes with GALLIUM_DRIVER={}: unset it, or name a driver that Mesa has, such as "
                            "llvmpipe",
                            driver));
}

}  // namespace

bool has_backend(Backend backend) { return !list_attempts(backend).empty(); }

ContextChoice create_context(Backend backend) {
  if (!has_backend(backend)) {
    throw Error(ErrorKind::kContext,
                fmt::format("this build has no --gl {}; take another, or build with the library that it needs",
                            name_of(backend)));
  }
  ContextChoice choice;
  if (std::string full = disable_shader_cache_on_full_disk(); !full.empty()) choice.refused.push_back(std::move(full));
  for (const Attempt& attempt : list_attempts(backend)) {
    try {
      require_driver(attempt);
      choice.context = attempt.create();
      return choice;
    } catch (const Error& error) {
      choice.refused.push_back(fmt::format("{}: {}", attempt.name, error.message()));
    }
  }
  throw Error(
      ErrorKind::kContext,
      fmt::format("no OpenGL 4.5 core context: {}; install libosmesa6 or libegl-mesa0, or choose another with --gl",
                  fmt::join(choice.refused, "; ")));
}

Context::~Context() {
  if (current == this) current = nullptr;
}

void Context::make_current() {
  // EGL refuses a thread that has a context of another library.
  if (current != nullptr && current != this) std::exchange(current, nullptr)->release();
  bind();
  current = this;
  if (gladLoadGL(loader()) == 0) throw Error(ErrorKind::kContext, "the GL functions cannot be loaded");
}

void Context::initialise(GlInfo info, std::chrono::steady_clock::time_point start) {
  make_current();
  if (!GLAD_GL_VERSION_4_5)
    throw Error(ErrorKind::kContext, fmt::format("OpenGL 4.5 is needed, this is {}", get_gl_string(GL_VERSION)));
  info_ = std::move(info);
  info_.vendor = get_gl_string(GL_VENDOR);
  info_.renderer = get_gl_string(GL_RENDERER);
  info_.version = get_gl_string(GL_VERSION);
  info_.software = info_.software || looks_like_software(info_.renderer);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &info_.max_texture_size);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(&Context::record_message, this);
  info_.creation_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void GLAPIENTRY Context::record_message(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                                        const GLchar* message, const void* context) {
  if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
  if (severity != GL_DEBUG_SEVERITY_HIGH && severity != GL_DEBUG_SEVERITY_MEDIUM) return;
  // The pointer is the `this` of initialise(); GL hands it back as const.
  auto* self = const_cast<Context*>(static_cast<const Context*>(context));
  std::string text = length < 0 ? std::string(message) : std::string(message, static_cast<std::size_t>(length));
  if (std::ranges::find(self->errors_, text) == self->errors_.end()) self->errors_.push_back(std::move(text));
}

std::vector<std::string> Context::take_gl_errors() {
  // A context without the debug flag need not send messages: what is pending without one counts as well.
  const auto pending = drain_gl_errors();
  if (errors_.empty())
    for (const GLenum error : pending) errors_.push_back(gl_error_name(error));
  return std::exchange(errors_, {});
}

void Context::require_no_gl_errors() {
  const auto errors = take_gl_errors();
  if (!errors.empty()) throw std::logic_error(fmt::format("GL errors: {}", fmt::join(errors, "; ")));
}

}  // namespace shadowbench::gl
