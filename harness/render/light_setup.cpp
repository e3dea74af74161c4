#include "harness/render/light_setup.h"

namespace shadowbench::render {
namespace {

glm::vec3 row(const glm::dmat4& m, int r) { return glm::vec3(glm::dvec3(m[0][r], m[1][r], m[2][r])); }

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

}  // namespace shadowbench::render
