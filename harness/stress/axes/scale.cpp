#include <fmt/format.h>

#include "harness/scene/validate.h"
#include "harness/stress/drawn_scene.h"

namespace shadowbench::stress {
namespace scale {

constexpr double kBound = 0.01;  // of the pixels

glm::vec3 scale(const glm::vec3& p, double factor) { return glm::vec3(glm::dvec3(p) * factor); }

scene::Scene scale(scene::Scene scene, double factor) {
  for (scene::Mesh& mesh : scene.meshes)
    for (scene::Vertex& vertex : mesh.vertices) vertex.position_ws = scale(vertex.position_ws, factor);
  for (scene::Camera& camera : scene.cameras) {
    camera.position_ws = scale(camera.position_ws, factor);
    camera.orthographic_height_m *= static_cast<float>(factor);
  }
  return scene::validate(std::move(scene), "scaled scene");
}

/// Every length in the passes is relative to the scene, to the light's frustum or to the map's texels.
Theory make_theory() {
  return {std::nullopt, TheoryKind::kRounding,
          "none: no length in the chain is absolute, and floats round alike at every scale",
          "derived: IEEE 754, normal numbers", Verdict::kDegraded};
}

std::vector<std::string> remark(const records::StressCase& record) {
  if (!is_ok_throughout(record)) return {};
  return {fmt::format("from {:g} to {:g} times its size no more than {:.2g} of the pixels change",
                      record.samples.front().value, record.samples.back().value, find_largest_measured(record))};
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request) {
  const scene::Scene scene = load_drawn_scene(inputs, "cubes");
  Case item = start_case(inputs, request, scene.name, Level::kGl);
  if (!item.is_available()) return item;
  item.theories = {make_theory()};
  item.remark = remark;
  const auto drawer = std::make_shared<SceneDrawer>(inputs, request);
  item.observe = [drawer, scene, expected = std::optional<Drawing>()](double factor) mutable {
    if (!expected) expected = drawer->draw(scene);
    return judge_drawing(drawer->draw(scale(scene, factor)), *expected, kBound);
  };
  return item;
}

}  // namespace scale

Axis make_scale_axis() {
  using namespace scale;
  Axis axis;
  axis.title = "Size of a scene";
  axis.quantity = "factor on every length";
  axis.range = {1e-6, 1e6};
  axis.limits = {1e-15, 1e10};
  axis.coarse_samples = 18;
  axis.measured = "share of the pixels that differ by more than 0.1 from factor 1";
  axis.measured_scale = Scale::kLinear;
  axis.bound = kBound;
  axis.broken_when = "visibility is not finite, all lit or all dark";
  axis.make_cases = [](const AxisInputs& inputs) { return make_gl_cases(inputs, make_case); };
  return axis;
}

}  // namespace shadowbench::stress
