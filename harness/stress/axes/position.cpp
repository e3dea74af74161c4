#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "harness/render/bias/bias_rule.h"
#include "harness/scene/validate.h"
#include "harness/stress/drawn_scene.h"
#include "harness/stress/slab_scene.h"

namespace shadowbench::stress {
namespace position {

constexpr double kBound = 0.01;              // of the pixels
constexpr glm::dvec3 kWay{0.8, 0.36, 0.48};  // the scene is moved along it; unit length
constexpr double kSingleStep = 0x1p-23;      // ulp of a coordinate, relative
constexpr double kDoubleStep = 0x1p-52;
constexpr const char* kSource = "derived: step of a float coordinate (IEEE 754)";

/// The origin that positions are relative to when they become floats.
enum class Origin {
  kWorld,         ///< the world's: where the scene stands
  kSceneLate,     ///< the scene's, subtracted after positions became floats
  kSceneInDouble  ///< the scene's, subtracted before, in double
};

struct Setting {
  std::string name;
  Origin origin = Origin::kWorld;
};

const char* describe(Origin origin) {
  switch (origin) {
    case Origin::kWorld: return "as it is";
    case Origin::kSceneLate: return "relative too late";
    case Origin::kSceneInDouble: return "relative in double";
  }
  return "";
}

/// The sums are doubles in the order that is written: the compiler may not simplify (p + way) - way to p.
glm::vec3 move(const glm::vec3& p, const glm::dvec3& way, Origin origin) {
  const glm::dvec3 moved = glm::dvec3(p) + way;
  switch (origin) {
    case Origin::kWorld: break;
    case Origin::kSceneLate: return glm::vec3(glm::dvec3(glm::vec3(moved)) - way);
    case Origin::kSceneInDouble: return glm::vec3(moved - way);
  }
  return glm::vec3(moved);
}

scene::Scene move(scene::Scene scene, const glm::dvec3& way, Origin origin) {
  for (scene::Mesh& mesh : scene.meshes)
    for (scene::Vertex& vertex : mesh.vertices) vertex.position_ws = move(vertex.position_ws, way, origin);
  for (scene::Camera& camera : scene.cameras) camera.position_ws = move(camera.position_ws, way, origin);
  return scene::validate(std::move(scene), "moved scene");
}

double find_size(const scene::Scene& scene) {
  const scene::Bounds bounds = scene.bounds();
  return glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
}

/// How far a receiver may be off along the light before its own surface in the map shadows it: by the constant bias,
/// and by what the plane's bias has left over the half texel that the sampling grid needs.
double find_slack(const scene::Scene& scene, const scene::LightFrustum& frustum,
                  const filters::FilterRequest& request) {
  const glm::dvec3 normal(scene.meshes.front().vertices.front().normal_ws), light(frustum.direction_ws);
  const double facing = std::abs(glm::dot(normal, light)),
               tangent = std::sqrt(std::max(1.0 - facing * facing, 0.0)) / facing;
  const render::Bias bias = render::resolve_bias({}, frustum, request.spec, request.values);
  return bias.constant_depth * frustum.depth_range_ws + 0.5 * frustum.texel_size_ws * tangent;
}

/// Shadows move by whole texels where the step of a coordinate reaches half a texel.
Theory make_theory(const scene::Scene& scene, const scene::LightFrustum& frustum, const filters::FilterRequest& request,
                   Origin origin) {
  const double slack = std::min(find_slack(scene, frustum, request), 0.5 * frustum.texel_size_ws);
  const double step = origin == Origin::kSceneInDouble ? kDoubleStep : kSingleStep;
  const char* what = slack < 0.5 * frustum.texel_size_ws ? "the bias" : "half a texel";
  return {slack / (step * kWay.x * find_size(scene)), TheoryKind::kRounding,
          fmt::format("{:.3g} m / (2^{:.0f} x {:g} x {:.3g} m): where a coordinate's step is {}", slack,
                      std::log2(step), kWay.x, find_size(scene), what),
          kSource, Verdict::kDegraded};
}

/// A scene that is smaller than the step of its coordinates collapses.
Theory make_collapse() {
  return {1.0 / (kSingleStep * kWay.x), TheoryKind::kRounding,
          fmt::format("1 / (2^-23 x {:g}): where a coordinate's step is the scene's size", kWay.x), kSource,
          Verdict::kBroken};
}

/// Filters of kind bound get no theory of acne: they answer a small error with a soft shadow, and by how much is not
/// known beforehand.
std::vector<Theory> list_theories(const scene::Scene& scene, const scene::LightFrustum& frustum,
                                  const filters::FilterRequest& request, Origin origin) {
  if (origin == Origin::kSceneLate) return {};
  std::vector<Theory> theories;
  if (origin == Origin::kSceneInDouble || request.spec.kind != filters::FilterKind::kBound)
    theories.push_back(make_theory(scene, frustum, request, origin));
  if (origin == Origin::kWorld) theories.push_back(make_collapse());
  return theories;
}

std::vector<std::string> remark(Origin origin, const records::StressCase& record) {
  if (origin == Origin::kWorld || record.samples.empty()) return {};
  const records::StressOnset* met = record.degraded ? &*record.degraded : record.broken ? &*record.broken : nullptr;
  if (origin == Origin::kSceneInDouble && !met) {
    return {
        fmt::format("the remedy holds to {:g} scene sizes, the end of the range: what is relative to the scene before "
                    "it becomes float does not know how far away it is",
                    record.samples.back().value)};
  }
  if (origin == Origin::kSceneLate && met) {
    return {
        fmt::format("no remedy: subtracting what was rounded already keeps the rounded shapes, which differ from "
                    "{:.3g} scene sizes on",
                    met->value)};
  }
  return {};
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request, const scene::Scene& scene,
               const Setting& setting) {
  const std::string variant = fmt::format("{}, {}", setting.name, describe(setting.origin));
  Case item = start_case(inputs, request, variant, Level::kGl);
  if (!item.is_available()) return item;
  const auto drawer = std::make_shared<SceneDrawer>(inputs, request);
  item.theories = list_theories(scene, drawer->fit(scene), request, setting.origin);
  item.remark = [origin = setting.origin](const records::StressCase& record) { return remark(origin, record); };
  item.observe = [drawer, scene, size = find_size(scene), origin = setting.origin,
                  expected = std::optional<Drawing>()](double sizes) mutable {
    if (!expected) expected = drawer->draw(scene);
    return judge_drawing(drawer->draw(move(scene, kWay * (sizes * size), origin)), *expected, kBound);
  };
  return item;
}

/// A floor that the light meets at right angles has no bias but the constant one; turned, so that no axis of the light
/// is the world's.
scene::Scene make_facing_floor() {
  const glm::dmat4 turned =
      glm::rotate(glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1.0, 0.0, 0.0)), 0.5, glm::dvec3(0.0, 0.0, 1.0));
  return make_slab_scene({.world_from_local = glm::dmat3(turned)});
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  const scene::Scene floor = scene::validate(make_facing_floor(), "facing floor");
  const scene::Scene cubes = load_drawn_scene(inputs, "cubes");
  std::vector<Case> cases = make_gl_cases(inputs, [&](const AxisInputs&, const filters::FilterRequest& request) {
    return make_case(inputs, request, floor, {"floor", Origin::kWorld});
  });
  cases.push_back(make_case(inputs, inputs.filters.front(), floor, {"floor", Origin::kSceneInDouble}));
  for (const Origin origin : {Origin::kWorld, Origin::kSceneLate, Origin::kSceneInDouble})
    cases.push_back(make_case(inputs, inputs.filters.front(), cubes, {"cubes", origin}));
  return cases;
}

}  // namespace position

Axis make_position_axis() {
  using namespace position;
  Axis axis;
  axis.title = "Distance of a scene from the world's origin";
  axis.quantity = "distance / size of the scene";
  axis.range = {1e-2, 1e8};
  axis.limits = {1e-6, 1e9};
  axis.coarse_samples = 21;
  axis.measured = "share of the pixels that differ by more than 0.1 from the origin";
  axis.bound = kBound;
  axis.broken_when = "visibility is not finite, all lit or all dark, or no triangle is left";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
