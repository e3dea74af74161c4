#include "harness/render/shadow_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "base/text.h"
#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "harness/render/gbuffer.h"
#include "harness/render/geometry.h"

namespace shadowbench::render {
namespace {

/// What a light's map holds: a perspective one the depth of its projection.
filters::DepthCurve fit_curve(filters::DepthCurve wanted, const scene::LightFrustum& frustum) {
  if (!frustum.perspective || is_curved(frustum.shape)) return wanted;
  if (!wanted.is_linear()) {
    throw Error(ErrorKind::kUsage,
                "--perspective-depth: this light stands in the scene, and its map holds the depth of its own "
                "projection; leave the option out");
  }
  return {wanted.reversed, frustum.perspective->far_over_near()};
}

Defines stipple_defines(BlendCasters casters, const scene::LightFrustum& frustum) {
  if (casters == BlendCasters::kOpaque) return {};
  if (casters == BlendCasters::kDither) return {{"STIPPLED_CASTERS", "1"}};
  if (frustum.shape == scene::MapShape::kLogarithmic) {
    throw Error(
        ErrorKind::kUsage,
        "--blend-casters hashed cannot be drawn into a logarithmic map, whose fragments do not know their place "
        "on the surface; use dither, or another --fit");
  }
  return {{"STIPPLED_CASTERS", "1"}, {"HASHED_CASTERS", "1"}};
}

void set_curve(gl::Program& program, const filters::DepthCurve& curve) {
  program.set("far_over_near", static_cast<float>(curve.far_over_near));
}

}  // namespace

std::string describe_map(const MapSettings& settings) {
  std::string text(gl::pixel_format(settings.format).name);
  if (!settings.curve.is_linear()) text += fmt::format(" perspective {:.6g}", settings.curve.far_over_near);
  if (settings.curve.reversed) text += " reversed";
  if (settings.blend_casters == BlendCasters::kOpaque) return text;
  return text + " " + name_of(settings.blend_casters);
}

double find_coarsest_step(const MapSettings& settings, double farthest) {
  const bool is_float = settings.format == GL_DEPTH_COMPONENT32F;
  const filters::DepthFormat format{is_float ? 32 : settings.format == GL_DEPTH_COMPONENT24 ? 24 : 16, is_float};
  constexpr int kSamples = 256;
  double coarsest = 0.0;
  for (int i = 0; i <= kSamples; ++i)
    coarsest = std::max(coarsest, filters::depth_step(farthest * i / kSamples, settings.curve, format));
  return coarsest;
}

Defines curve_defines(const filters::DepthCurve& curve) {
  Defines defines;
  if (!curve.is_linear()) defines.emplace_back("PERSPECTIVE_DEPTH", "1");
  if (curve.reversed) defines.emplace_back("REVERSED_DEPTH", "1");
  return defines;
}

GLenum wrap_mode(filters::Border border) {
  switch (border) {
    case filters::Border::kBorder: return GL_CLAMP_TO_BORDER;
    case filters::Border::kEdge: return GL_CLAMP_TO_EDGE;
    case filters::Border::kRepeat: return GL_REPEAT;
  }
  return GL_CLAMP_TO_BORDER;
}

void require_depth_bits(GLenum format, int bits) {
  const int wanted = format == GL_DEPTH_COMPONENT16 ? 16 : format == GL_DEPTH_COMPONENT24 ? 24 : 32;
  if (bits == wanted) return;
  throw Error(ErrorKind::kUsage, fmt::format("this GL stores {} in {} bits; choose another --map-format or --gl",
                                             gl::pixel_format(format).name, bits));
}

ShadowMap::ShadowMap(int size, const MapSettings& settings, int layers)
    : wanted_(settings.curve), settings_(settings), drawn_(static_cast<std::size_t>(layers)) {
  for (int layer = 0; layer < layers; ++layer) layers_.emplace_back("shadow map", settings.format, size, size);
  require_depth_bits(settings.format, texture().depth_bits());
  const GLenum compare = settings.curve.reversed ? GL_GEQUAL : GL_LEQUAL;
  for (gl::Sampler* sampler : {&plain_, &compare_linear_, &compare_nearest_}) {
    sampler->set_filter(GL_NEAREST, GL_NEAREST);
    sampler->set_wrap(wrap_mode(border_));
    sampler->set_border(glm::vec4(settings.curve.far_plane()));  // nothing in the way
  }
  compare_linear_.set_filter(GL_LINEAR, GL_LINEAR);
  compare_linear_.set_compare(compare);
  compare_nearest_.set_compare(compare);
}

void ShadowMap::set_border(filters::Border border) {
  border_ = border;
  for (gl::Sampler* sampler : {&plain_, &compare_linear_, &compare_nearest_}) sampler->set_wrap(wrap_mode(border));
}

void ShadowMap::draw_casters(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum,
                             const MapBias& bias, ImageTarget& target, Defines defines) const {
  target.bind();
  set_geometry_state();
  target.clear_depth(settings_.curve.far_plane());
  const filters::DepthCurve& curve = settings_.curve;
  for (auto& define : curve_defines(curve)) defines.push_back(std::move(define));
  const bool is_plane = !is_curved(frustum.shape), bends = !curve.is_linear() && !frustum.perspective;
  if (is_plane && bends) defines.emplace_back("BEND_DEPTH", "1");
  for (auto& define : shape_defines(frustum)) defines.push_back(std::move(define));
  if (frustum.shape == scene::MapShape::kLogarithmic) defines.push_back(kExactEdges);
  for (auto& define : stipple_defines(settings_.blend_casters, frustum)) defines.push_back(std::move(define));
  const float away = curve.reversed ? -1.0f : 1.0f;
  if (curve.reversed) glDepthFunc(GL_GREATER);
  if (bias.polygon_factor != 0.0 || bias.polygon_units != 0.0) {
    if (!is_plane) {
      throw Error(ErrorKind::kUsage,
                  "--bias polygon-offset cannot be drawn into a warped map or a paraboloid: the GL would add it before "
                  "the shader writes the depth; use another bias, or another --fit");
    }
    assert(curve.is_linear() || frustum.perspective);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(away * static_cast<float>(bias.polygon_factor), away * static_cast<float>(bias.polygon_units));
  }
  const glm::mat4 clip_from_world = curve.reversed && is_plane && !bends
                                        ? glm::mat4(reverse_depth(frustum.clip_from_light) * frustum.light_from_world)
                                        : frustum.clip_from_world;
  const auto prepare = [&](gl::Program& program) {
    program.set("clip_from_world", clip_from_world);
    set_curve(program, curve);
    if (!is_plane) set_shape(program, frustum);
  };
  if (frustum.shape == scene::MapShape::kParaboloid) glEnable(GL_CLIP_DISTANCE0);
  if (bias.cull_front) {
    geometry.draw(shaders, "depth", DrawSet::kUncullableCasters, prepare, defines);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    geometry.draw(shaders, "depth", DrawSet::kCullableCasters, prepare, defines);
  } else {
    geometry.draw(shaders, "depth", DrawSet::kCasters, prepare, defines);
  }
  glDisable(GL_CLIP_DISTANCE0);
  set_geometry_state();
}

void ShadowMap::draw(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum,
                     const MapBias& bias) {
  const auto layer = static_cast<std::size_t>(frustum.layer);
  drawn_[layer].emplace(geometry, frustum, bias);
  settings_.curve = fit_curve(wanted_, frustum);
  if (bias.midpoint)
    draw_midpoint(shaders, geometry, frustum, bias);
  else
    draw_casters(shaders, geometry, frustum, bias, layers_[layer], {});
}

/// Woo 1992, The Shadow Depth Map Revisited, Graphics Gems III: the map lies between the first and the second surface,
/// so that neither shadows itself. Where there is no second surface, the far plane takes its place.
void ShadowMap::draw_midpoint(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum,
                              const MapBias& bias) {
  if (surfaces_.empty()) {
    surfaces_.emplace_back("first surface", settings_.format, size(), size());
    surfaces_.emplace_back("second surface", settings_.format, size(), size());
  }
  draw_casters(shaders, geometry, frustum, bias, surfaces_[0], {});
  surfaces_[0].texture().bind(0);
  draw_casters(shaders, geometry, frustum, bias, surfaces_[1], {{"BEHIND_FIRST", "1"}});
  surfaces_[1].texture().bind(1);
  draw_mean(shaders, layers_[static_cast<std::size_t>(frustum.layer)]);
}

void ShadowMap::draw_mean(ShaderLibrary& shaders, ImageTarget& target) const {
  gl::Program& program = shaders.fullscreen("midpoint.frag", curve_defines(settings_.curve));
  set_curve(program, settings_.curve);
  target.bind();
  program.use();
  gl::FullscreenTriangle().draw_depth();
}

void ShadowMap::draw_samples(ShaderLibrary& shaders, ImageTarget& target, int layer) const {
  const std::optional<Drawn>& drawn = drawn_[static_cast<std::size_t>(layer)];
  if (drawn && !drawn->bias.midpoint) {
    glEnable(GL_SAMPLE_SHADING);  // each sample has a depth and a hole of its own
    glMinSampleShading(1.0f);
    draw_casters(shaders, drawn->geometry, drawn->frustum, drawn->bias, target, {});
    glDisable(GL_SAMPLE_SHADING);
    return;
  }
  for (const GLuint unit : {0u, 1u}) texture(layer).bind(unit);
  draw_mean(shaders, target);
}

void ShadowMap::upload(std::span<const float> stored) {
  layers_.front().texture().upload_floats(stored, 1);
  drawn_.front().reset();
}

void ShadowMap::bind(gl::Program& reader, int layer) const {
  set_curve(reader, settings_.curve);
  const gl::Sampler* samplers[] = {&plain_, &compare_linear_, &compare_nearest_};
  for (GLuint unit = 0; unit < 3; ++unit) {
    texture(layer).bind(unit);
    samplers[unit]->bind(unit);
  }
}

filters::DepthMap ShadowMap::read(int layer) const {
  return {.size = size(),
          .stored = texture(layer).read_floats(1),
          .curve = settings_.curve,
          .clamps_reference = settings_.format != GL_DEPTH_COMPONENT32F,
          .border = border_,
          .texel_bytes = gl::pixel_format(settings_.format).bytes_per_texel};
}

images::Image ShadowMap::read_picture() const {
  if (layers() == 1) return read_image(texture(), 1);
  images::Image picture(layers() * size(), size(), 1);
  for (int layer = 0; layer < layers(); ++layer) {
    const images::Image own = read_image(texture(layer), 1);
    for (int y = 0; y < size(); ++y) std::copy_n(own.at(0, y), size(), picture.at(layer * size(), y));
  }
  return picture;
}

}  // namespace shadowbench::render
