#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>

#include "harness/render/bias/bias_rule.h"
#include "harness/scene/validate.h"
#include "harness/stress/drawn_scene.h"
#include "harness/stress/slab_scene.h"
#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace position {

constexpr double kBound = 0.01;              // of the pixels
constexpr glm::dvec3 kWay{0.8, 0.36, 0.48};  // the scene is moved along it; unit length
constexpr double kSingleStep = 0x1p-23;      // ulp of a coordinate, relative
constexpr double kDoubleStep = 0x1p-52;
constexpr double kFarDepth = 0.999;  // of a floor behind everything else
constexpr double kFar = 1e4;         // sizes: there the padding is steps of coordinates
constexpr int kHalvings = 12;        // of a range from one power of two to the next
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
  bool slab_over_floor = false;  ///< the floor is at the far end of the depth range, the slab at the near one
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

/// The first depth, of those from 0 to 1, at which `changes`; 1 where none does. Requires that it stays changed for a
/// while: it is looked for by doubling, and then by halving.
double find_first_depth(const std::function<bool(double)>& changes) {
  double before = 0.0, with = kSingleStep;
  while (with < 1.0 && !changes(with)) before = std::exchange(with, 2.0 * with);
  if (with >= 1.0) return 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (before + with);
    (changes(middle) ? with : before) = middle;
  }
  return with;
}

/// The visibility of a receiver before a map of one depth, both in [0,1].
using Formula = std::function<double(double stored, double receiver)>;

/// A comparison where the filter has no model.
Formula find_formula(const AxisInputs& inputs, const filters::FilterRequest& request) {
  if (!filters::make_model(request.spec))
    return [](double stored, double receiver) { return stored < receiver ? 0.0 : 1.0; };
  return [&inputs, request](double stored, double receiver) {
    return look_at_one_depth(inputs, request, static_cast<float>(stored), static_cast<float>(receiver));
  };
}

/// How far behind its own surface a receiver may lie, in depth, before it darkens visibly. A comparison darkens at
/// once; what a filter makes of a small error besides is what its formula makes of it: Chebyshev's inequality with a
/// minimum m of the variance, for instance, leaves m / (m + e^2) at e.
double find_softness(const Formula& formula, double depth) {
  const double own = formula(depth, depth);
  return find_first_depth([&](double e) { return own - formula(depth - e, depth) > kVisibleDifference; });
}

/// How far a receiver may be off along the light before its own surface in the map shadows it: by the constant bias,
/// by what the plane's bias has left over the half texel that the sampling grid needs, and by what the filter softens.
double find_slack(const scene::Scene& scene, const scene::LightFrustum& frustum, const filters::FilterRequest& request,
                  const Formula& formula) {
  const glm::dvec3 normal(scene.meshes.front().vertices.front().normal_ws), light(frustum.direction_ws);
  const double facing = std::abs(glm::dot(normal, light)),
               tangent = std::sqrt(std::max(1.0 - facing * facing, 0.0)) / facing;
  const render::Bias bias = render::resolve_bias({}, frustum, request.spec, request.values);
  const double softness = find_softness(formula, kFarDepth);
  return (bias.constant_depth + softness) * frustum.depth_range_ws + 0.5 * frustum.texel_size_ws * tangent;
}

/// A distance in scene sizes at which pictures begin to differ.
struct Onset {
  double sizes = 0.0;
  std::string formula;
};

/// Acne; and shadows move by whole texels where the step of a coordinate reaches half a texel.
Onset find_step_onset(const scene::Scene& scene, const scene::LightFrustum& frustum,
                      const filters::FilterRequest& request, Origin origin, const Formula& formula) {
  const double slack = std::min(find_slack(scene, frustum, request, formula), 0.5 * frustum.texel_size_ws);
  const double step = origin == Origin::kSceneInDouble ? kDoubleStep : kSingleStep;
  const char* what = slack < 0.5 * frustum.texel_size_ws ? "what the bias and the filter tolerate" : "half a texel";
  return {slack / (step * kWay.x * find_size(scene)),
          fmt::format("{:.3g} m / (2^{:.0f} x {:g} x {:.3g} m): where a coordinate's step is {}", slack,
                      std::log2(step), kWay.x, find_size(scene), what)};
}

/// The scene's extent along the light, in metres.
double find_depth_extent(const scene::Scene& scene, const glm::dvec3& direction) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (const scene::Mesh& mesh : scene.meshes) {
    for (const scene::Vertex& vertex : mesh.vertices) {
      const double depth = glm::dot(glm::dvec3(vertex.position_ws), direction);
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  }
  return farthest - nearest;
}

/// What the fit adds to the depth range at either end, in metres.
double find_padding(const SceneDrawer& drawer, const scene::Scene& scene) {
  const scene::LightFrustum frustum = drawer.fit(scene);
  return 0.5 * (frustum.depth_range_ws - find_depth_extent(scene, glm::dvec3(frustum.direction_ws)));
}

/// The fit pads the depth range by a number of steps of the largest coordinate, so that far away a caster at its near
/// end and a floor at its far end come closer together in depth: to 1 - 2 p, p being the padding's share of the range.
/// What a filter with light behind its casters makes of a gap depends on the gap: a series of waves with a period of 2
/// in depth, for instance, takes a gap of nearly 1 for one of nearly none. Pictures differ where visibility does.
Onset find_padding_onset(const SceneDrawer& drawer, const scene::Scene& scene, const Formula& formula) {
  const double extent = find_depth_extent(scene, glm::dvec3(drawer.fit(scene).direction_ws)),
               padding = find_padding(drawer, scene), own = padding / (extent + 2.0 * padding);
  const double expected = formula(own, 1.0 - own);
  const double more = find_first_depth([&](double d) {
    const double p = own + d;
    return p < 0.5 && std::abs(formula(p, 1.0 - p) - expected) > kVisibleDifference;
  });
  const double share = own + more;
  if (share >= 0.5) return {std::numeric_limits<double>::infinity(), {}};
  const double needed = share / (1.0 - 2.0 * share) * extent,
               per_size = find_padding(drawer, move(scene, kWay * (kFar * find_size(scene)), Origin::kWorld)) / kFar;
  return {
      needed / per_size,
      fmt::format("{:.3g} m / {:.3g} m: where the depth range is padded by so much that the light behind casters at "
                  "its other end changes by {:g}",
                  needed, per_size, kVisibleDifference)};
}

/// A scene that is smaller than the step of its coordinates collapses.
Theory make_collapse() {
  return {1.0 / (kSingleStep * kWay.x), TheoryKind::kRounding,
          fmt::format("1 / (2^-23 x {:g}): where a coordinate's step is the scene's size", kWay.x), kSource,
          Verdict::kBroken};
}

/// Of the floor alone it is known that all its shadow is cast from the other end of the depth range.
std::vector<Theory> list_theories(const SceneDrawer& drawer, const scene::Scene& scene,
                                  const filters::FilterRequest& request, const Setting& setting,
                                  const Formula& formula) {
  if (setting.origin == Origin::kSceneLate) return {};
  Onset onset = find_step_onset(scene, drawer.fit(scene), request, setting.origin, formula);
  if (setting.slab_over_floor && setting.origin == Origin::kWorld) {
    Onset padded = find_padding_onset(drawer, scene, formula);
    if (padded.sizes < onset.sizes) onset = std::move(padded);
  }
  std::vector<Theory> theories{
      {onset.sizes, TheoryKind::kRounding, std::move(onset.formula), kSource, Verdict::kDegraded}};
  if (setting.origin == Origin::kWorld) theories.push_back(make_collapse());
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
  item.theories = list_theories(*drawer, scene, request, setting, find_formula(inputs, request));
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
    return make_case(inputs, request, floor, {"floor", Origin::kWorld, true});
  });
  cases.push_back(make_case(inputs, inputs.filters.front(), floor, {"floor", Origin::kSceneInDouble, true}));
  for (const Origin origin : {Origin::kWorld, Origin::kSceneLate, Origin::kSceneInDouble})
    cases.push_back(make_case(inputs, inputs.filters.front(), cubes, {"cubes", origin, false}));
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
