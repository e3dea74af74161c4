#include "harness/scene/unseen_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "harness/scene/complete.h"
#include "harness/scene/shadow_edges.h"

namespace shadowbench::scene {
namespace {

/// Some digits of a place, as the scene's file is to have it.
std::string write(const char* key, const glm::vec3& place_ws, const glm::dvec3& origin) {
  const auto number = [&](int axis) { return std::stod(fmt::format("{:.4g}", place_ws[axis])) + origin[axis]; };
  return fmt::format("{} = [{:.10g}, {:.10g}, {:.10g}]", key, number(0), number(1), number(2));
}

/// A camera that sees edges of the light's shadows, if one of those that are tried does.
std::optional<Camera> find_camera(const Scene& lit, double aspect) {
  constexpr ViewFreedom kFree{.camera = true};
  const ViewChoice choice = choose_view(lit, kFree);
  if (choice.edges.at_edge == 0) return std::nullopt;
  return frame_choice(lit, choice, aspect, kFree);
}

/// Lifts a lamp until one of the cameras that are tried sees edges of its shadows.
std::optional<glm::vec3> find_place(Scene lit, double aspect) {
  constexpr int kSteps = 8;
  const std::optional<Beam> lamp = find_beam(lit.light);
  if (!lamp) return std::nullopt;
  const Bounds bounds = lit.bounds();
  const float height = bounds.max.y - bounds.min.y;
  glm::vec3 place(lamp->position_ws);
  const float lowest = std::max(place.y, bounds.min.y), highest = bounds.max.y + 0.25f * height;
  for (int step = 1; step <= kSteps && lowest < highest; ++step) {
    place.y = lowest + (highest - lowest) * static_cast<float>(step) / kSteps;
    std::visit(
        [&](auto& kind) {
          if constexpr (requires { kind.position_ws; }) kind.position_ws = place;
        },
        lit.light.kind);
    if (find_camera(lit, aspect)) return place;
  }
  return std::nullopt;
}

}  // namespace

std::string advise_on_unseen_light(const Scene& lit, std::span<const Camera> views, double aspect) {
  constexpr std::array kWidths = {EdgeMeter::kCoarseWidth, 10 * EdgeMeter::kCoarseWidth};
  const EdgeMeter meter(lit);
  for (const int width : kWidths)
    for (const Camera& view : views)
      if (meter.count(view, lit.light, aspect, width).lit > 0) return {};
  const std::string& name = lit.light.name;
  if (const auto camera = find_camera(lit, aspect))
    return fmt::format("write into its file a [[camera]] with name = \"{}\"{}, {}, {}, vertical_fov_deg = {:.4g}",
                       name.empty() ? "lit" : name, name.empty() ? "" : fmt::format(", light = \"{}\"", name),
                       write("position", camera->position_ws, lit.origin_ws),
                       write("target", camera->position_ws + camera->forward_ws, lit.origin_ws),
                       glm::degrees(camera->vertical_fov_rad));
  if (const auto place = find_place(lit, aspect))
    return fmt::format("it is enclosed; write into its [[light]] {}", write("position", *place, lit.origin_ws));
  return "no view that was tried sees it; write another place or direction into its [[light]]";
}

}  // namespace shadowbench::scene
