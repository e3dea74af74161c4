#include "harness/scene/lights/cascades.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "harness/scene/view_clip.h"

namespace shadowbench::scene {
namespace {

/// A camera that stands in the geometry has no nearest depth, and logarithmic slices need one.
constexpr double kNearestSplit = 1e-3;  // of the farthest

DepthSpan find_depths(const Scene& scene, const FitRequest& request) {
  if (request.cascades.seen && request.seen) return *request.seen;
  DepthSpan span{std::numeric_limits<double>::max(), 0.0};
  for (const glm::dvec3& p : list_visible_corners(scene, *request.camera, request.aspect)) {
    const double depth = view_depth(*request.camera, p);
    span = {std::min(span.near_m, depth), std::max(span.far_m, depth)};
  }
  return span;
}

/// Where the slice around a border fades: its neighbours share the last part of the nearer one.
double fade_begin(const std::vector<double>& borders, std::size_t border, double blend) {
  return borders[border] - blend * (borders[border] - borders[border - 1]);
}

/// Every depth before the first border is the first slice's, and every one after the last the last one's.
ViewSlice make_slice(const std::vector<double>& borders, std::size_t slice, double blend) {
  const double everything = borders.back() * 1e6;
  ViewSlice made{-2.0 * everything, -everything, everything, 2.0 * everything, borders[slice + 1]};
  if (slice > 0) {
    made.fade_in_begin = fade_begin(borders, slice, blend);
    made.fade_in_end = borders[slice];
  }
  if (slice + 2 < borders.size()) {
    made.fade_out_begin = fade_begin(borders, slice + 1, blend);
    made.fade_out_end = borders[slice + 1];
  }
  return made;
}

/// Ends of a sphere around what the camera can see between two depths: its size does not change when the camera turns.
std::vector<glm::dvec3> bound_by_sphere(const Camera& camera, double aspect, const DepthSpan& span,
                                        const glm::dmat3& light_rotation) {
  const ViewCorners corners = list_view_corners(camera, aspect, span);
  glm::dvec3 center(0.0);
  for (const glm::dvec3& corner : corners) center += corner / static_cast<double>(corners.size());
  double radius = 0.0;
  for (const glm::dvec3& corner : corners) radius = std::max(radius, glm::length(corner - center));
  std::vector<glm::dvec3> ends;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) ends.push_back(center + side * radius * glm::transpose(light_rotation)[axis]);
  return ends;
}

}  // namespace

std::vector<double> split_depths(const CascadeRule& rule, double near_m, double far_m) {
  assert(near_m > 0.0 && near_m < far_m);
  std::vector<double> depths;
  for (int i = 0; i <= rule.count; ++i) {
    const double part = static_cast<double>(i) / rule.count;
    const double uniform = near_m + part * (far_m - near_m), logarithmic = near_m * std::pow(far_m / near_m, part);
    depths.push_back(rule.split * logarithmic + (1.0 - rule.split) * uniform);
  }
  return depths;
}

std::vector<LightFrustum> fit_cascades(const Sun& sun, const Scene& scene, const FitRequest& request) {
  assert(request.camera);
  const DepthSpan depths = find_depths(scene, request);
  const double far_m = depths.far_m > 0.0 ? depths.far_m * (1.0 + 1e-6) : 1.0;
  const double near_m = std::clamp(depths.near_m, kNearestSplit * far_m, 0.999 * far_m);
  const std::vector<double> borders = split_depths(request.cascades, near_m, far_m);
  const glm::dmat3 rotation = light_rotation(glm::normalize(glm::dvec3(sun.direction_ws)));
  std::vector<LightFrustum> layers;
  for (std::size_t slice = 0; slice + 1 < borders.size(); ++slice) {
    const ViewSlice share = make_slice(borders, slice, request.cascades.blend);
    const DepthSpan span{slice == 0 ? 0.0 : share.fade_in_begin, borders[slice + 1]};
    LightFrustum layer =
        fit_sun_over(sun, scene, request,
                     request.snap ? bound_by_sphere(*request.camera, request.aspect, span, rotation)
                                  : list_visible_corners(scene, *request.camera, request.aspect, span));
    layer.layer = static_cast<int>(slice);
    layer.share = share;
    layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace shadowbench::scene
