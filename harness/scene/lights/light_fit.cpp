#include "harness/scene/lights/light_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "filters/base/error.h"

namespace shadowbench::scene {
namespace {

constexpr std::array<std::string_view, 3> kFitNames = {"sphere", "tight", "view"};  // in the order of FitMode

}  // namespace

std::string_view name_of(FitMode mode) { return kFitNames[static_cast<std::size_t>(mode)]; }

FitMode parse_fit_mode(std::string_view name) {
  const auto found = std::find(kFitNames.begin(), kFitNames.end(), name);
  if (found != kFitNames.end()) return static_cast<FitMode>(found - kFitNames.begin());
  throw Error(ErrorKind::kUsage,
              fmt::format("--fit: unknown fit '{}'; there are {}", name, fmt::join(kFitNames, ", ")));
}

truth::MapGrid make_map_grid(const LightFrustum& frustum) {
  const glm::dmat4 rows = glm::transpose(frustum.light_from_world);
  return {-glm::dvec3(frustum.direction_ws), glm::dvec3(rows[0]), glm::dvec3(rows[1]), frustum.texel_size_ws};
}

LightFrustum fit_light(const Scene& scene, FitMode mode, int map_size, double pad_texels) {
  return fit_light(scene, FitRequest{.mode = mode, .map_size = map_size, .pad_texels = pad_texels});
}

LightFrustum fit_light(const Scene& scene, const FitRequest& request) {
  const Light& light = request.light ? *request.light : scene.light;
  const MapWindow* window = light.map_window ? &*light.map_window : nullptr;
  return std::visit([&](const Sun& sun) { return fit_sun(sun, window, scene, request); }, light.kind);
}

}  // namespace shadowbench::scene
