#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace map_edge {

constexpr double kBound = 1.0 / 255.0;  // of visibility: a step of an 8-bit picture
constexpr int kMapSize = 128;
constexpr float kOccluder = 0.3f, kReceiver = 0.6f;
constexpr double kNear = 0.01;  // of the perspective map; its far plane is at 1
constexpr std::size_t kSides = 4;
constexpr double kEarlier = 0.25;  // texels: a receiver must not be darker than one that is so much nearer to the map

/// A border, and what stands there.
enum class BorderKind { kFloor, kOccluders, kFarPlane, kBehindLight };

constexpr BorderKind kBorderKinds[] = {BorderKind::kFloor, BorderKind::kOccluders, BorderKind::kFarPlane,
                                       BorderKind::kBehindLight};

const char* name_of_border(BorderKind border) {
  switch (border) {
    case BorderKind::kFloor: return "on a floor across the border";
    case BorderKind::kOccluders: return "beside occluders at the border";
    case BorderKind::kFarPlane: return "across the far plane";
    case BorderKind::kBehindLight: return "behind a perspective light";
  }
  return "";
}

/// Makes the frustum of a light at (0.5, 0.5, 0) that looks along z and is a quarter turn wide.
scene::LightFrustum make_perspective() {
  scene::LightFrustum frustum = make_axis_frustum(1.0, kMapSize);
  frustum.projective = true;
  const auto steep = static_cast<float>(1.0 / (1.0 - kNear));
  glm::mat4 m(1.0f);
  m[2] = {0.5f, 0.5f, steep, 1.0f};
  m[3] = {-0.5f, -0.5f, -static_cast<float>(kNear) * steep, 0.0f};
  frustum.uv_depth_from_world = m;
  return frustum;
}

/// Places receivers beside all four sides in turn, `outside` texels from them, all over the texels but for the corners.
std::vector<glm::vec3> place_beside(double outside, float depth) {
  std::vector<glm::vec3> receivers;
  const auto across = static_cast<float>(outside / kMapSize);
  for (double along = 0.25; along < 0.75; along += 0.7 / kMapSize) {
    const auto a = static_cast<float>(along);
    for (const auto& [u, v] :
         {std::pair(1.0f + across, a), std::pair(-across, a), std::pair(a, 1.0f + across), std::pair(a, -across)})
      receivers.emplace_back(u, v, depth);
  }
  return receivers;
}

/// Places receivers all over the middle of the map, so many texels' lengths beyond the far plane.
std::vector<glm::vec3> place_beyond(double outside) {
  std::vector<glm::vec3> receivers;
  const auto depth = static_cast<float>(1.0 + outside / kMapSize);
  for (double along = 0.25; along < 0.75; along += 0.7 / kMapSize)
    receivers.emplace_back(static_cast<float>(along), static_cast<float>(1.0 - along), depth);
  return receivers;
}

/// Places receivers behind the light where a map that is mirrored through it would hold them.
std::vector<glm::vec3> place_behind(double outside) {
  std::vector<glm::vec3> receivers;
  const double z = -outside / kMapSize;
  for (double along = -0.25; along < 0.25; along += 0.7 / kMapSize) {
    receivers.emplace_back(static_cast<float>(0.5 + along * z), static_cast<float>(0.5 - along * z),
                           static_cast<float>(z));
  }
  return receivers;
}

std::vector<glm::vec3> place(BorderKind border, double outside) {
  switch (border) {
    case BorderKind::kFloor: return place_beside(outside, kReceiver);
    case BorderKind::kOccluders: return place_beside(outside, kReceiver);
    case BorderKind::kFarPlane: return place_beyond(outside);
    case BorderKind::kBehindLight: return place_behind(outside);
  }
  return {};
}

/// Whether receivers must be lit: where the map holds nothing that could shadow them, and on a floor, which does
/// not shadow itself.
bool must_be_lit(BorderKind border, double outside, double reach) {
  switch (border) {
    case BorderKind::kFloor: return true;
    case BorderKind::kOccluders: return outside > reach;
    case BorderKind::kFarPlane: return outside > 0.0;
    case BorderKind::kBehindLight: return outside >= 0.0;
  }
  return false;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The largest difference along any side. Sides are not compared with each other: on the very border two of them
/// are inside the map and two outside.
double find_unevenness(const std::vector<double>& beside) {
  double largest = 0.0;
  for (std::size_t side = 0; side < kSides; ++side) {
    double low = beside[side], high = beside[side];
    for (std::size_t i = side; i < beside.size(); i += kSides) {
      low = std::min(low, beside[i]);
      high = std::max(high, beside[i]);
    }
    largest = std::max(largest, high - low);
  }
  return largest;
}

/// Judges by how much visibility is off. An error under a wider bound than the axis' own is not reported.
Observation judge_line(double off, const char* what, double bound = kBound) {
  off = std::max(off, 0.0);
  Observation seen =
      judge_by_bounds(off, bound, kLargestFall, [&](double) { return fmt::format("by {:.2g} {}", off, what); });
  if (seen.verdict == Verdict::kOk && bound > kBound) seen.measured = 0.0;
  return seen;
}

const Observation& worse(const Observation& a, const Observation& b) {
  if (a.verdict != b.verdict) return a.verdict > b.verdict ? a : b;
  return a.measured.value_or(0.0) >= b.measured.value_or(0.0) ? a : b;
}

/// A map that goes on beyond the border with nothing in it. A blur must make the same of the texels inside. Filters
/// that do not blur decide by the texel, and are not held against it.
class WiderMap {
 public:
  WiderMap(const AxisInputs& inputs, const filters::FilterRequest& request)
      : values_(request.values), margin_(2 * filters::prefilter_radius_texels(request.spec, request.values)) {
    if (margin_ > 0) lookup_ = make_model_lookup(inputs, request, expected_precision(request.spec));
  }

  /// The largest difference of what is seen of a map of occluders; 0 where there is nothing to hold it against.
  double find_difference(const std::vector<glm::vec3>& receivers, const std::vector<double>& seen) const {
    if (!lookup_) return 0.0;
    return find_largest_error(seen, lookup_(widen(receivers), values_).visibility);
  }

 private:
  filters::ParamValues values_;
  int margin_;
  SyntheticLookup lookup_;

  SyntheticScene widen(const std::vector<glm::vec3>& receivers) const {
    SyntheticScene scene;
    scene.size = kMapSize + 2 * margin_;
    for (int i = 0; i < scene.size * scene.size; ++i) {
      const int x = i % scene.size, y = i / scene.size;
      const bool inside = std::min({x, y, scene.size - 1 - x, scene.size - 1 - y}) >= margin_;
      scene.depths.push_back(inside ? kOccluder : 1.0f);
    }
    const auto widen_uv = [&](float uv) {
      return (uv * static_cast<float>(kMapSize) + static_cast<float>(margin_)) / static_cast<float>(scene.size);
    };
    for (const glm::vec3& r : receivers) scene.receivers.emplace_back(widen_uv(r.x), widen_uv(r.y), r.z);
    return scene;
  }
};

/// Whether a lookup draws lots, and so is uneven anywhere: of a filter that takes random taps, and of one whose scalar
/// model sees something else between the same texels with another seed.
bool draws_lots(const AxisInputs& inputs, const filters::FilterRequest& request) {
  if (request.spec.kind == filters::FilterKind::kStochastic) return true;
  SyntheticScene scene{kMapSize, make_split_depths(kMapSize, kOccluder, kReceiver),
                       place_beside(-kMapSize / 2.25, kReceiver)};
  AxisInputs reseeded = inputs;
  ++reseeded.seed;
  return make_model_lookup(inputs, request)(scene, request.values).visibility !=
         make_model_lookup(reseeded, request)(scene, request.values).visibility;
}

/// Looks along one border.
struct Looker {
  SyntheticLookup lookup;
  filters::FilterRequest request;
  std::shared_ptr<const WiderMap> wider;
  bool even = true;  ///< receivers along the border must see the same
  BorderKind border = BorderKind::kFloor;
  SyntheticScene scene = {};

  std::vector<double> look(double outside) {
    scene.receivers = place(border, outside);
    return lookup(scene, request.values).visibility;
  }

  Observation observe(double outside) {
    const std::vector<double> seen = look(outside);
    if (const auto not_finite = judge_not_finite(seen)) return *not_finite;
    const double reach = filters::radius_texels(request.spec, request.values) + 1.0;
    if (must_be_lit(border, outside, reach)) return judge_line(1.0 - *std::ranges::min_element(seen), "too dark");
    if (border != BorderKind::kOccluders) return {};
    // Beyond the last texels' centres a bilinear read takes the border itself, not what the blur made of it.
    const bool reads_texels = outside <= -0.5;
    const Observation blurred =
        judge_line(reads_texels ? wider->find_difference(scene.receivers, seen) : 0.0, "off from a map that goes on");
    return worse(blurred, judge_across(seen, look(outside - kEarlier)));
  }

  /// Judges receivers whose kernel reaches across the border: they must be even along it where they are even anywhere,
  /// and never darker than those nearer to the map.
  Observation judge_across(const std::vector<double>& seen, const std::vector<double>& nearer) const {
    const Observation along = judge_line(even ? find_unevenness(seen) : 0.0, "uneven along the border");
    return worse(along,
                 judge_line(mean(nearer) - mean(seen), "darker than nearer to the map", even ? kBound : kLargestFall));
  }
};

Looker make_looker(Looker looker, BorderKind border) {
  looker.border = border;
  looker.scene.size = kMapSize;
  looker.scene.depths.assign(static_cast<std::size_t>(kMapSize) * kMapSize,
                             border == BorderKind::kFloor ? kReceiver : kOccluder);
  if (border == BorderKind::kBehindLight) looker.scene.frustum = make_perspective();
  return looker;
}

Observation observe_all(std::vector<Looker>& lookers, double outside) {
  Observation worst{Verdict::kOk, 0.0, {}};
  for (Looker& looker : lookers) {
    Observation seen = looker.observe(outside);
    if (!seen.why.empty()) seen.why += fmt::format(", {}", name_of_border(looker.border));
    worst = worse(worst, seen);
  }
  return worst;
}

std::vector<std::string> remark(const records::StressCase& record) {
  if (record.samples.empty() || record.degraded || record.broken) return {};
  return {"lit outside the map, beyond its far plane and behind the light, and no line along the border"};
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request) {
  Case item = start_case(inputs, request, "all borders", Level::kGl);
  if (!item.is_available()) return item;
  item.theories = {{std::nullopt, TheoryKind::kSlope, "none: what the map does not hold is lit",
                    "by definition: border = encode of depth 1", Verdict::kDegraded}};
  item.remark = remark;
  const SyntheticLookup orthographic = make_gl_lookup(inputs, request), perspective = make_gl_lookup(inputs, request);
  std::vector<Looker> lookers;
  const auto wider = std::make_shared<const WiderMap>(inputs, request);
  const bool even = !draws_lots(inputs, request);
  for (const BorderKind border : kBorderKinds)
    lookers.push_back(
        make_looker({border == BorderKind::kBehindLight ? perspective : orthographic, request, wider, even}, border));
  item.observe = [lookers](double outside) mutable { return observe_all(lookers, outside); };
  return item;
}

}  // namespace map_edge

Axis make_map_edge_axis() {
  using namespace map_edge;
  Axis axis;
  axis.title = "Receivers across the map's border, its far plane, and behind the light";
  axis.quantity = "distance outside";
  axis.unit = "texels";
  axis.log = false;
  axis.range = {-4.0, 8.0};
  axis.limits = {-24.0, 24.0};
  axis.coarse_samples = 49;
  axis.measured = "missing light, or unevenness along the border";
  axis.measured_log = false;
  axis.bound = kBound;
  axis.broken_when = "visibility is not finite, or off by more than 0.1";
  axis.make_cases = [](const AxisInputs& inputs) { return make_gl_cases(inputs, make_case); };
  return axis;
}

}  // namespace shadowbench::stress
