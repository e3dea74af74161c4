#include <dlfcn.h>
#include <fmt/format.h>

#include <chrono>

#include "base/error.h"
#include "harness/gl/context/context.h"
#include "harness/gl/gl_api.h"

// After the loader, see gl_api.h. The header of Mesa 25 takes these words from <GL/gl.h>, whose place the loader has.
#ifndef GLAPI
#define GLAPI extern
#endif
#ifndef APIENTRY
#define APIENTRY
#endif
#include <GL/osmesa.h>

namespace shadowbench::gl {
namespace {

/// A function of a library, of whatever type it is.
struct Symbol {
  void* address;
  template <class Function>
  operator Function*() const {
    return reinterpret_cast<Function*>(address);
  }
};

Symbol find_function(const char* name) {
  static void* const library = dlopen("libOSMesa.so.8", RTLD_NOW);
  void* const address = library != nullptr ? dlsym(library, name) : nullptr;
  if (address == nullptr) throw Error(ErrorKind::kContext, fmt::format("OSMesa cannot be loaded ({})", dlerror()));
  return {address};
}

/// OSMesa is opened by the first context: it brings LLVM, which takes longer to load than all else that starts the
/// program.
struct Osmesa {
  decltype(&OSMesaCreateContextAttribs) create_context = find_function("OSMesaCreateContextAttribs");
  decltype(&OSMesaDestroyContext) destroy_context = find_function("OSMesaDestroyContext");
  decltype(&OSMesaGetCurrentContext) get_current_context = find_function("OSMesaGetCurrentContext");
  decltype(&OSMesaMakeCurrent) make_current = find_function("OSMesaMakeCurrent");
  decltype(&OSMesaGetProcAddress) get_function = find_function("OSMesaGetProcAddress");
};

const Osmesa& osmesa() {
  static const Osmesa functions;
  return functions;
}

class OsmesaContext : public Context {
 public:
  OsmesaContext() {
    const auto start = std::chrono::steady_clock::now();
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              0,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              4,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              5,
                              0};
    context_ = Owned(osmesa().create_context(attributes, nullptr));
    if (!context_) throw Error(ErrorKind::kContext, "OSMesa gives no OpenGL 4.5 core context");
    GlInfo info;
    info.backend = "osmesa";
    info.software = true;
    initialise(std::move(info), start);
  }

 private:
  struct Destroy {
    void operator()(OSMesaContext context) const {
      if (osmesa().get_current_context() == context) osmesa().make_current(nullptr, nullptr, 0, 0, 0);
      osmesa().destroy_context(context);
    }
  };
  using Owned = std::unique_ptr<std::remove_pointer_t<OSMesaContext>, Destroy>;

  void bind() override {
    if (osmesa().make_current(context_.get(), window_, GL_UNSIGNED_BYTE, kSide, kSide) == 0)
      throw Error(ErrorKind::kContext, "OSMesa cannot make its context current");
  }

  void release() override { osmesa().make_current(nullptr, nullptr, 0, 0, 0); }

  GLADloadfunc loader() const override {
    return [](const char* name) { return reinterpret_cast<GLADapiproc>(osmesa().get_function(name)); };
  }

  // OSMesa wants a window to draw into; everything here draws into framebuffer objects.
  static constexpr int kSide = 4;
  unsigned char window_[kSide * kSide * 4] = {};
  Owned context_;
};

}  // namespace

std::unique_ptr<Context> create_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace shadowbench::gl
