#include "harness/render/gbuffer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "harness/gl/program.h"

namespace shadowbench::render {
namespace {

glm::vec3 row(const glm::dmat4& m, int r) { return glm::vec3(glm::dvec3(m[0][r], m[1][r], m[2][r])); }

struct DepthRange {
  double near;
  double far;
};

DepthRange depth_range(const scene::Camera& camera, const scene::Bounds& bounds) {
  double nearest = std::numeric_limits<double>::max(), farthest = std::numeric_limits<double>::lowest();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p((corner & 1) ? bounds.max.x : bounds.min.x, (corner & 2) ? bounds.max.y : bounds.min.y,
                       (corner & 4) ? bounds.max.z : bounds.min.z);
    const double along = glm::dot(p - glm::dvec3(camera.position_ws), glm::dvec3(camera.forward_ws));
    nearest = std::min(nearest, along);
    farthest = std::max(farthest, along);
  }
  const double margin = 0.01 * std::max(farthest - nearest, 1e-6 * std::abs(farthest));
  const double far = std::max(farthest + margin, 1e-30);
  // A perspective near plane at or behind the camera does not exist. In a wide scene a share of it would cut off what
  // stands before the camera; in a small one a browser, whose depth cannot be reversed, still resolves that share.
  constexpr double kNearest_m = 0.05, kNearestShare = 1e-4;
  const bool perspective = camera.orthographic_height_m <= 0.0f;
  return {perspective ? std::max(nearest - margin, std::min(kNearest_m, kNearestShare * far)) : nearest - margin, far};
}

constexpr GLuint kPlacesUnit = 5, kPlanesUnit = 6, kSharesUnit = 16;  // of lib/receiver.glsl

void set_share(gl::Program& prepare, const scene::LayerShare& share) {
  if (const auto* slice = std::get_if<scene::ViewSlice>(&share)) {
    prepare.set("layer_slice",
                glm::vec4(slice->fade_in_begin, slice->fade_in_end, slice->fade_out_begin, slice->fade_out_end));
  }
  if (const auto* face = std::get_if<scene::CubeFace>(&share)) prepare.set("layer_face", face->index);
}

/// The receiver pass as it was read back: three RGBA texels per pixel.
struct ReceiverTexels {
  int width;
  std::vector<float> map;    // uv, depth, depth_unbiased
  std::vector<float> light;  // texel_size_ws, light_size, light_nearness, the layer's share
  std::vector<float> plane;  // depth_per_texel, n_dot_l, view_depth (0: no receiver, negative: beyond the map's reach)

  std::size_t pixels() const { return map.size() / 4; }
  bool counts(std::size_t i) const { return plane[4 * i + 3] != 0.0f && plane[4 * i + 2] > filters::kFacesLight; }
  bool is_asked_about(std::size_t i) const { return counts(i) && plane[4 * i + 3] > 0.0f && light[4 * i + 3] > 0.0f; }
};

ReceiverTexels draw_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light) {
  const gl::Texture map("receivers in the map", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  const gl::Texture plane("receiver planes", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  const gl::Texture size("receivers and the light", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  gl::Framebuffer framebuffer("receivers");
  framebuffer.attach_color(0, map);
  framebuffer.attach_color(1, plane);
  framebuffer.attach_color(2, size);
  gl::Program& program = shaders.fullscreen("receiver.frag", receiver_defines(light));
  const ReceiverBuffer& receivers = gbuffer.receivers(shaders, light);
  set_light(program, light);
  framebuffer.bind();
  gbuffer.bind();
  receivers.bind();
  program.use();
  gl::FullscreenTriangle().draw();
  return {gbuffer.width(), map.read_floats(4), size.read_floats(4), plane.read_floats(4)};
}

/// As shaders/lib/receiver.glsl computes it.
glm::vec2 bias_per_texel(const glm::vec2& depth_per_texel, float texel_size_ws, const LightSetup& light) {
  const float steepest =
      static_cast<float>(light.bias.max_tangent) * texel_size_ws / static_cast<float>(light.frustum.depth_range_ws);
  return static_cast<float>(light.bias.plane_kernels) * glm::min(glm::abs(depth_per_texel), glm::vec2(steepest));
}

filters::Receiver make_receiver(const ReceiverTexels& texels, std::size_t i, const LightSetup& light) {
  const float* map = &texels.map[4 * i];
  const float* plane = &texels.plane[4 * i];
  filters::Receiver r;
  r.uv = {map[0], map[1]};
  r.depth = map[2];
  r.depth_unbiased = map[3];
  r.depth_per_texel = {plane[0], plane[1]};
  r.texel_size_ws = texels.light[4 * i];
  r.light_size = texels.light[4 * i + 1];
  r.light_nearness = texels.light[4 * i + 2];
  r.layer = light.frustum.layer;
  r.layer_share = texels.light[4 * i + 3];
  r.bias_per_texel = bias_per_texel(r.depth_per_texel, r.texel_size_ws, light);
  r.n_dot_l = plane[2];
  r.view_depth = plane[3];
  r.depth_range_ws = static_cast<float>(light.frustum.depth_range_ws);
  r.pixel = {static_cast<int>(i) % texels.width, static_cast<int>(i) / texels.width};
  r.frame = light.frame;
  return r;
}

}  // namespace

LightSetup make_light_setup(const scene::LightFrustum& frustum, const scene::Light& light, const Bias& bias,
                            std::uint32_t seed, const filters::RangeRule& range) {
  return {.frustum = frustum, .light_size = scene::light_size(light), .bias = bias, .seed = seed, .range = range};
}

void set_beam(gl::Program& program, const scene::Beam& beam) {
  program.set("light_direction_ws", glm::vec3(beam.axis_ws));
  program.set("light_position_ws", glm::vec3(beam.position_ws));
  program.set("light_cone", glm::vec2(beam.cos_inner, beam.cos_outer));
  program.set("light_reference_m", static_cast<float>(beam.reference_m));
}

void set_shape(gl::Program& program, const scene::LightFrustum& frustum) {
  program.set("uv_depth_from_world", frustum.uv_depth_from_world);
  program.set("light_direction_ws", frustum.direction_ws);
  program.set("light_right_ws", row(frustum.light_from_world, 0));
  program.set("light_up_ws", row(frustum.light_from_world, 1));
  program.set("depth_range_ws", static_cast<float>(frustum.depth_range_ws));
  if (frustum.perspective) set_beam(program, frustum.perspective->beam);
  if (!is_curved(frustum.shape)) return;
  program.set("map_texels", static_cast<float>(frustum.map_texels()));
  if (frustum.shape == scene::MapShape::kLogarithmic) {
    program.set("log_scale", static_cast<float>(frustum.log_curve.scale));
    program.set("log_offset", static_cast<float>(frustum.log_curve.offset));
  }
  if (frustum.shape != scene::MapShape::kParaboloid) return;
  program.set("paraboloid_radius", static_cast<float>(frustum.paraboloid.radius));
  program.set("paraboloid_center", glm::vec2(frustum.paraboloid.center));
  program.set("light_near_m", static_cast<float>(frustum.perspective->near_m));
}

void set_light(gl::Program& program, const LightSetup& light) {
  const scene::LightFrustum& frustum = light.frustum;
  set_shape(program, frustum);
  program.set("texel_size_ws", static_cast<float>(frustum.texel_size_ws));
  program.set("light_size", static_cast<float>(light.light_size));
  program.set("bias_constant", static_cast<float>(light.bias.constant_depth));
  program.set("bias_slope", static_cast<float>(light.bias.slope_depth));
  program.set("bias_plane_texels", static_cast<float>(light.bias.plane_texels));
  program.set("bias_plane_kernels", static_cast<float>(light.bias.plane_kernels));
  program.set("bias_normal_texels", static_cast<float>(light.bias.normal_offset_texels));
  program.set("bias_max_tangent", static_cast<float>(light.bias.max_tangent));
  program.set("light_layer", frustum.layer);
}

Defines shape_defines(const scene::LightFrustum& frustum) {
  Defines defines;
  if (frustum.projective) defines.emplace_back("PROJECTIVE_MAP", "1");
  if (frustum.perspective) defines.push_back(kPerspectiveLight);
  switch (frustum.shape) {
    case scene::MapShape::kPlane: break;
    case scene::MapShape::kLogarithmic: defines.emplace_back("LOG_MAP", "1"); [[fallthrough]];
    case scene::MapShape::kWarped: defines.emplace_back("WARPED_MAP", "1"); break;
    case scene::MapShape::kParaboloid: defines.emplace_back("PARABOLOID_MAP", "1"); break;
  }
  return defines;
}

Defines range_defines(const LightSetup& light) {
  Defines defines = shape_defines(light.frustum);
  if (!light.range.far_test) defines.emplace_back("NO_FAR_TEST", "1");
  if (light.frustum.projective && !light.range.behind_test) defines.emplace_back("NO_BEHIND_TEST", "1");
  if (light.frustum.is_layered()) defines.emplace_back("LAYERED", "1");
  if (std::holds_alternative<scene::ViewSlice>(light.frustum.share)) defines.emplace_back("VIEW_SLICE", "1");
  if (std::holds_alternative<scene::CubeFace>(light.frustum.share)) defines.emplace_back("CUBE_FACE", "1");
  if (std::holds_alternative<scene::HalfSphere>(light.frustum.share)) defines.emplace_back("HALF_SPHERE", "1");
  return defines;
}

Defines receiver_defines(const LightSetup& light) {
  Defines defines = shape_defines(light.frustum);
  if (light.bias.slope_depth > 0.0) defines.emplace_back("BIAS_BY_SLOPE", "1");
  if (light.frustum.is_layered()) defines.emplace_back("LAYERED", "1");
  return defines;
}

glm::dmat4 reverse_depth(glm::dmat4 clip) {
  for (int column = 0; column < 4; ++column) clip[column][2] = clip[column][3] - clip[column][2];
  return clip;
}

glm::mat4 clip_from_world(const scene::Camera& camera, const scene::Bounds& bounds, double aspect,
                          const glm::dvec2& shift) {
  const DepthRange range = depth_range(camera, bounds);
  const glm::dvec3 eye(camera.position_ws);
  const glm::dmat4 view = glm::lookAtRH(eye, eye + glm::dvec3(camera.forward_ws), glm::dvec3(camera.up_ws));
  const double half = 0.5 * static_cast<double>(camera.orthographic_height_m);
  const glm::dmat4 projection = reverse_depth(
      half > 0.0 ? glm::orthoRH_ZO(-half * aspect, half * aspect, -half, half, range.near, range.far)
                 : glm::perspectiveRH_ZO(static_cast<double>(camera.vertical_fov_rad), aspect, range.near, range.far));
  if (shift == glm::dvec2(0.0)) return glm::mat4(projection * view);
  return glm::mat4(glm::translate(glm::dmat4(1.0), glm::dvec3(2.0 * shift, 0.0)) * projection * view);
}

void set_geometry_state() {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

GBuffer::GBuffer(int width, int height)
    : position_("g-buffer position", GL_RGBA32F, width, height),
      normal_("g-buffer normal", GL_RGBA32F, width, height),
      shading_normal_("g-buffer shading normal", GL_RGBA16F, width, height),
      albedo_("g-buffer albedo", GL_RGBA16F, width, height),
      depth_("g-buffer depth", GL_DEPTH_COMPONENT32F, width, height) {
  framebuffer_.attach_color(0, position_);
  framebuffer_.attach_color(1, normal_);
  framebuffer_.attach_color(2, shading_normal_);
  framebuffer_.attach_color(3, albedo_);
  framebuffer_.attach_depth(depth_);
}

void GBuffer::draw(ShaderLibrary& shaders, const Geometry& geometry, const scene::Scene& scene,
                   const scene::Camera& camera, const glm::dvec2& jitter, const std::optional<PictureWindow>& window) {
  receivers_.clear();
  framebuffer_.bind();
  set_geometry_state();
  glDepthFunc(GL_GREATER);
  for (int i = 0; i < 4; ++i) framebuffer_.clear_color(i, glm::vec4(0.0f));
  framebuffer_.clear_depth(0.0f);
  const auto [corner, whole] = window.value_or(PictureWindow{{0, 0}, {width(), height()}});
  glViewport(-corner.x, -corner.y, whole.x, whole.y);
  const double aspect = static_cast<double>(whole.x) / whole.y;
  const glm::mat4 matrix = clip_from_world(camera, scene.bounds(), aspect, jitter / glm::dvec2(whole));
  geometry.draw(shaders, "gbuffer", DrawSet::kAll, [&](gl::Program& program) {
    program.set("clip_from_world", matrix);
    program.set("camera_position_ws", camera.position_ws);
    program.set("camera_forward_ws", camera.forward_ws);
    program.set("orthographic", camera.orthographic_height_m > 0.0f ? 1 : 0);
  });
}

const ReceiverBuffer& GBuffer::receivers(ShaderLibrary& shaders, const LightSetup& light) const {
  const auto found = std::ranges::find_if(receivers_, [&](const ReceiverBuffer& each) { return each.is_of(light); });
  if (found != receivers_.end()) return *found;
  if (receivers_.size() == kKeptReceiverMaps) receivers_.pop_front();
  return receivers_.emplace_back(shaders.fullscreen("prepare_receivers.frag", range_defines(light)), *this, light);
}

void GBuffer::bind() const {
  GLuint unit = 8;
  for (const gl::Texture* texture : {&position_, &normal_, &shading_normal_, &albedo_}) texture->bind(unit++);
}

ReceiverBuffer::ReceiverBuffer(gl::Program& prepare, const GBuffer& gbuffer, const LightSetup& light)
    : light_(light),
      places_("receivers in the map", GL_RGBA32F, gbuffer.width(), gbuffer.height()),
      planes_("receiver planes", GL_RGBA32F, gbuffer.width(), gbuffer.height()) {
  gl::Framebuffer framebuffer("receivers");
  framebuffer.attach_color(0, places_);
  framebuffer.attach_color(1, planes_);
  if (light.frustum.is_layered()) {
    layer_.emplace(Layer{{"receivers' shares", GL_R32F, gbuffer.width(), gbuffer.height()},
                         {"receivers of a layer", GL_DEPTH_COMPONENT32F, gbuffer.width(), gbuffer.height()}});
    framebuffer.attach_color(2, layer_->shares);
    framebuffer.attach_depth(layer_->mask);
  }
  set_light(prepare, light);
  set_share(prepare, light.frustum.share);
  framebuffer.bind();
  gbuffer.bind();
  prepare.use();
  if (layer_)
    gl::FullscreenTriangle().draw_depth();
  else
    gl::FullscreenTriangle().draw();
}

bool ReceiverBuffer::is_of(const LightSetup& light) const {
  const scene::LightFrustum &own = light_.frustum, &other = light.frustum;
  return own.uv_depth_from_world == other.uv_depth_from_world && own.light_from_world == other.light_from_world &&
         own.direction_ws == other.direction_ws && own.texel_size_ws == other.texel_size_ws &&
         own.depth_range_ws == other.depth_range_ws && own.projective == other.projective && own.shape == other.shape &&
         own.log_curve == other.log_curve && own.paraboloid == other.paraboloid &&
         own.perspective.has_value() == other.perspective.has_value() && own.layer == other.layer &&
         own.share == other.share && light_.bias.normal_offset_texels == light.bias.normal_offset_texels &&
         light_.bias.max_tangent == light.bias.max_tangent && light_.range.far_test == light.range.far_test &&
         light_.range.behind_test == light.range.behind_test;
}

void ReceiverBuffer::bind() const {
  places_.bind(kPlacesUnit);
  planes_.bind(kPlanesUnit);
  if (layer_) layer_->shares.bind(kSharesUnit);
}

std::int64_t count_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightLayers& light) {
  const ReceiverTexels texels = draw_receivers(shaders, gbuffer, light.front());
  std::int64_t count = 0;
  for (std::size_t i = 0; i < texels.pixels(); ++i) count += texels.counts(i) ? 1 : 0;
  return count;
}

std::vector<float> read_layer_shares(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& layer) {
  const ReceiverTexels texels = draw_receivers(shaders, gbuffer, layer);
  const auto width = static_cast<std::size_t>(gbuffer.width()), height = static_cast<std::size_t>(gbuffer.height());
  std::vector<float> shares;
  for (std::size_t y = height; y-- > 0;)
    for (std::size_t x = 0; x < width; ++x) shares.push_back(texels.light[4 * (y * width + x) + 3]);
  return shares;
}

std::vector<filters::Receiver> read_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light) {
  const ReceiverTexels texels = draw_receivers(shaders, gbuffer, light);
  const std::vector<float> positions = gbuffer.position().read_floats(4), normals = gbuffer.normal().read_floats(4);
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < texels.pixels(); ++i)
    if (texels.is_asked_about(i)) asked.push_back(i);
  std::vector<filters::Receiver> receivers(asked.size());
  tbb::parallel_for(std::size_t{0}, asked.size(), [&](std::size_t k) {
    const std::size_t i = asked[k];
    receivers[k] = make_receiver(texels, i, light);
    receivers[k].position_ws = {positions[4 * i], positions[4 * i + 1], positions[4 * i + 2]};
    receivers[k].normal_ws = {normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]};
  });
  return receivers;
}

}  // namespace shadowbench::render
