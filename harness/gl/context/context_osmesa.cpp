#include <chrono>

#include "base/error.h"
#include "harness/gl/context/context_backends.h"
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
    context_ = Owned(OSMesaCreateContextAttribs(attributes, nullptr));
    if (!context_) throw Error(ErrorKind::kContext, "OSMesa gives no OpenGL 4.5 core context");
    GlInfo info;
    info.backend = "osmesa";
    info.software = true;
    initialise(std::move(info), start);
  }

 private:
  struct Destroy {
    void operator()(OSMesaContext context) const {
      if (OSMesaGetCurrentContext() == context) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
      OSMesaDestroyContext(context);
    }
  };
  using Owned = std::unique_ptr<std::remove_pointer_t<OSMesaContext>, Destroy>;

  void bind() override {
    if (OSMesaMakeCurrent(context_.get(), window_, GL_UNSIGNED_BYTE, kSide, kSide) == 0)
      throw Error(ErrorKind::kContext, "OSMesa cannot make its context current");
  }

  void release() override { OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0); }

  GLADloadfunc loader() const override {
    return [](const char* name) { return reinterpret_cast<GLADapiproc>(OSMesaGetProcAddress(name)); };
  }

  // OSMesa wants a window to draw into; everything here draws into framebuffer objects.
  static constexpr int kSide = 4;
  unsigned char window_[kSide * kSide * 4] = {};
  Owned context_;
};

}  // namespace

std::unique_ptr<Context> create_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace shadowbench::gl
