#include <glm/glm.hpp>

#include "harness/gl/embedded_shaders.h"
#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "harness/gl/survey/survey_parts.h"

namespace shadowbench::gl {
namespace {

constexpr int kSide = 64;

struct Plane {
  float depth = 0.0f;
  glm::vec2 rise{0.0f};  ///< across the width and the height of the viewport
};

struct Offset {
  float factor = 0.0f;
  float units = 0.0f;
};

/// Draws planes into a depth texture and says what depth they get.
class PlaneDrawer {
 public:
  explicit PlaneDrawer(GLenum depth_format)
      : program_("survey plane", embedded_source("survey_plane.vert"), embedded_source("survey_plane.frag")),
        depth_("survey plane", depth_format, kSide, kSide),
        framebuffer_("survey plane"),
        empty_("survey plane") {
    framebuffer_.attach_depth(depth_);
  }

  /// Returns by how much `offset` moves the middle of the plane.
  double measure(const Plane& plane, const Offset& offset) { return draw(plane, offset) - draw(plane, {}); }

 private:
  double draw(const Plane& plane, const Offset& offset) {
    for (const GLenum capability : {GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_CULL_FACE, GL_RASTERIZER_DISCARD})
      glDisable(capability);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(offset.factor, offset.units);
    framebuffer_.bind();
    program_.set("u_depth", plane.depth);
    program_.set("u_rise", plane.rise);
    program_.use();
    empty_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return static_cast<double>(depth_.read_floats(1)[kSide * (kSide / 2) + kSide / 2]);
  }

  Program program_;
  Texture depth_;
  Framebuffer framebuffer_;
  VertexArray empty_;
};

}  // namespace

double measure_offset_unit(GLenum depth_format, float depth) {
  constexpr float kUnits = 4096.0f;  // many, so that the format's own steps do not show
  return PlaneDrawer(depth_format).measure({depth, {}}, {0.0f, kUnits}) / static_cast<double>(kUnits);
}

double measure_slope_ratio() {
  constexpr float kFactor = 16.0f;
  constexpr glm::vec2 kRise = {0.09f, 0.12f};
  const double moved = PlaneDrawer(GL_DEPTH_COMPONENT32F).measure({0.1f, kRise}, {kFactor, 0.0f});
  return moved / static_cast<double>(kFactor * kRise.y / static_cast<float>(kSide));
}

}  // namespace shadowbench::gl
