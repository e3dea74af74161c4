#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/error.h"
#include "filters/glsl_words.h"
#include "harness/gl/context/context.h"

// Without this EGL's headers bring in Xlib's macros.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace shadowbench::gl {
namespace {

/// Names one display that EGL could open.
struct Candidate {
  std::string name;
  EGLenum platform = 0;
  void* native = nullptr;
  bool software = false;
};

struct Display {
  EGLDisplay display = EGL_NO_DISPLAY;
  std::string extensions;
};

std::string own_text(const char* text) { return text == nullptr ? std::string() : std::string(text); }

template <typename Function>
Function load(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

[[noreturn]] void refuse_egl(std::string_view what) {
  throw Error(ErrorKind::kContext, fmt::format("{} (EGL error 0x{:04x})", what, eglGetError()));
}

Candidate describe_device(EGLDeviceEXT device, int index) {
  const auto query = load<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  const std::string extensions = query == nullptr ? "" : own_text(query(device, EGL_EXTENSIONS));
  std::string node;
  if (filters::has_word(extensions, "EGL_EXT_device_drm")) node = own_text(query(device, EGL_DRM_DEVICE_FILE_EXT));
  Candidate candidate;
  candidate.software = filters::has_word(extensions, "EGL_MESA_device_software");
  candidate.name = fmt::format("device {}{}{}", index, node.empty() ? "" : " ", node);
  if (candidate.software) candidate.name += " (software)";
  candidate.platform = EGL_PLATFORM_DEVICE_EXT;
  candidate.native = device;
  return candidate;
}

std::vector<Candidate> list_devices() {
  const auto query = load<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  EGLint count = 0;
  if (query == nullptr || query(0, nullptr, &count) == EGL_FALSE || count < 1) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (query(count, devices.data(), &count) == EGL_FALSE) return {};
  std::vector<Candidate> candidates;
  for (int i = 0; i < count; ++i) candidates.push_back(describe_device(devices[static_cast<std::size_t>(i)], i));
  return candidates;
}

/// Lists what to try: devices with a GPU, then other devices, then Mesa's surfaceless platform.
std::vector<Candidate> list_candidates() {
  const std::string client = own_text(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS));
  std::vector<Candidate> candidates;
  if (filters::has_word(client, "EGL_EXT_platform_device")) candidates = list_devices();
  std::ranges::stable_partition(candidates, [](const Candidate& candidate) { return !candidate.software; });
  if (filters::has_word(client, "EGL_MESA_platform_surfaceless"))
    candidates.push_back({"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, nullptr, false});
  return candidates;
}

// Displays stay open for the life of the process: closing one would take every other context on it along.
Display open_display(const Candidate& candidate) {
  const auto get_display = load<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get_display == nullptr) refuse_egl("no eglGetPlatformDisplayEXT");
  Display opened;
  opened.display = get_display(candidate.platform, candidate.native, nullptr);
  if (opened.display == EGL_NO_DISPLAY) refuse_egl("no display");
  if (eglInitialize(opened.display, nullptr, nullptr) == EGL_FALSE) refuse_egl("the display does not initialise");
  opened.extensions = own_text(eglQueryString(opened.display, EGL_EXTENSIONS));
  if (!filters::has_word(opened.extensions, "EGL_KHR_surfaceless_context"))
    refuse_egl("no EGL_KHR_surfaceless_context");
  return opened;
}

EGLConfig choose_config(const Display& opened) {
  if (filters::has_word(opened.extensions, "EGL_KHR_no_config_context")) return EGL_NO_CONFIG_KHR;
  const EGLint attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(opened.display, attributes, &config, 1, &count) == EGL_FALSE || count < 1)
    refuse_egl("no configuration renders OpenGL");
  return config;
}

class EglContext : public Context {
 public:
  explicit EglContext(const Candidate& candidate) {
    const auto start = std::chrono::steady_clock::now();
    const Display opened = open_display(candidate);
    owned_.display = opened.display;
    if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) refuse_egl("no OpenGL, only OpenGL ES");
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    owned_.context = eglCreateContext(opened.display, choose_config(opened), EGL_NO_CONTEXT, attributes);
    if (owned_.context == EGL_NO_CONTEXT) refuse_egl("no OpenGL 4.5 core context");
    GlInfo info;
    info.backend = "egl";
    info.device = candidate.name;
    info.software = candidate.software;
    initialise(std::move(info), start);
  }

 private:
  struct Owned {
    Owned() = default;
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;
    ~Owned() {
      if (context == EGL_NO_CONTEXT) return;
      if (eglGetCurrentContext() == context) eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      eglDestroyContext(display, context);
    }
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
  };

  void bind() override {
    // The API in force belongs to the thread, and GLFW may have changed it.
    eglBindAPI(EGL_OPENGL_API);
    if (eglMakeCurrent(owned_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, owned_.context) == EGL_FALSE)
      refuse_egl("the context cannot be made current");
  }

  void release() override {
    eglBindAPI(EGL_OPENGL_API);
    eglMakeCurrent(owned_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }

  GLADloadfunc loader() const override { return &eglGetProcAddress; }

  Owned owned_;
};

/// Which devices will do.
enum class Wanted { kAny, kGpu, kSoftware };

std::unique_ptr<Context> create_first(Wanted wanted) {
  std::vector<std::string> reasons;
  for (const Candidate& candidate : list_candidates()) {
    try {
      // What draws in software says so only once it has a context; what says so before needs none.
      const bool is_known = candidate.software && wanted == Wanted::kGpu;
      std::unique_ptr<Context> context = is_known ? nullptr : std::make_unique<EglContext>(candidate);
      const bool is_software = is_known || context->info().software;
      if (wanted == Wanted::kAny || is_software == (wanted == Wanted::kSoftware)) return context;
      reasons.push_back(candidate.name + (is_software ? ": a software rasteriser" : ": a GPU"));
    } catch (const Error& error) {
      reasons.push_back(fmt::format("{}: {}", candidate.name, error.message()));
    }
  }
  if (reasons.empty()) reasons.emplace_back("no device and no surfaceless platform");
  throw Error(ErrorKind::kContext, fmt::format("{}", fmt::join(reasons, ", ")));
}

}  // namespace

std::unique_ptr<Context> create_egl_context() { return create_first(Wanted::kAny); }
std::unique_ptr<Context> create_egl_gpu_context() { return create_first(Wanted::kGpu); }
std::unique_ptr<Context> create_egl_software_context() { return create_first(Wanted::kSoftware); }

}  // namespace shadowbench::gl
