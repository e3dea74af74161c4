#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/stress/probe.h"

namespace shadowbench::stress {
namespace map_edge {

constexpr double kBound = 1.0 / 255.0;  // of visibility: a step of an 8-bit picture
constexpr int kMapSize = 128;
constexpr float kOccluder = 0.3f, kReceiver = 0.6f;
constexpr double kNear = 0.01;  // of the perspective map; its far plane is at 1
constexpr std::size_t kSides = 4;
constexpr double kEarlier = 0.25;  // texels: light must not be less than so much nearer to the map

/// What stands at which border.
enum class Place { kFloor, kOccluders, kFarPlane, kBehindLight };

constexpr Place kPlaces[] = {Place::kFloor, Place::kOccluders, Place::kFarPlane, Place::kBehindLight};

const char* name_of_place(Place place) {
  switch (place) {
    case Place::kFloor: return "on a floor across the border";
    case Place::kOccluders: return "beside occluders at the border";
    case Place::kFarPlane: return "across the far plane";
    case Place::kBehindLight: return "behind a perspective light";
  }
  return "";
}

/// Light at (0.5, 0.5, 0) that looks along z, a quarter turn wide.
scene::LightFrustum make_perspective() {
  scene::LightFrustum frustum;
  frustum.width_ws = frustum.depth_range_ws = 1.0;
  frustum.texel_size_ws = 1.0 / kMapSize;
  frustum.projective = true;
  const auto steep = static_cast<float>(1.0 / (1.0 - kNear));
  glm::mat4 m(1.0f);
  m[2] = {0.5f, 0.5f, steep, 1.0f};
  m[3] = {-0.5f, -0.5f, -static_cast<float>(kNear) * steep, 0.0f};
  frustum.uv_depth_from_world = m;
  return frustum;
}

/// Receivers beside all four sides in turn, `outside` texels from them, at places all over the texels; corners are left
/// out.
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

/// Receivers all over the middle of the map, at a depth so many texels' lengths beyond the far plane.
std::vector<glm::vec3> place_beyond(double outside) {
  std::vector<glm::vec3> receivers;
  const auto depth = static_cast<float>(1.0 + outside / kMapSize);
  for (double along = 0.25; along < 0.75; along += 0.7 / kMapSize)
    receivers.emplace_back(static_cast<float>(along), static_cast<float>(1.0 - along), depth);
  return receivers;
}

/// Receivers behind the light that a map mirrored through it would hold.
std::vector<glm::vec3> place_behind(double outside) {
  std::vector<glm::vec3> receivers;
  const double z = -outside / kMapSize;
  for (double along = -0.25; along < 0.25; along += 0.7 / kMapSize) {
    receivers.emplace_back(static_cast<float>(0.5 + along * z), static_cast<float>(0.5 - along * z),
                           static_cast<float>(z));
  }
  return receivers;
}

std::vector<glm::vec3> place(Place where, double outside) {
  switch (where) {
    case Place::kFloor: return place_beside(outside, kReceiver);
    case Place::kOccluders: return place_beside(outside, kReceiver);
    case Place::kFarPlane: return place_beyond(outside);
    case Place::kBehindLight: return place_behind(outside);
  }
  return {};
}

/// Says whether the map can hold nothing of receivers there, so that they must be lit; a floor shadows itself nowhere.
bool must_be_lit(Place where, double outside, double reach) {
  switch (where) {
    case Place::kFloor: return true;
    case Place::kOccluders: return outside > reach;
    case Place::kFarPlane: return outside > 0.0;
    case Place::kBehindLight: return outside >= 0.0;
  }
  return false;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Gives the largest difference along any side. Texels are half-open: on the very border two sides are inside, two
/// outside.
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

/// Says how far off light is, and from where on that is too much.
Observation judge_line(double off, const char* what, double bound = kBound) {
  off = std::max(off, 0.0);
  const std::string why = fmt::format("by {:.2g} {}", off, what);
  if (off > kLargestFall) return {Verdict::kBroken, off, why};
  if (off > bound) return {Verdict::kDegraded, off, why};
  return {Verdict::kOk, bound > kBound ? 0.0 : off, {}};
}

const Observation& worse(const Observation& a, const Observation& b) {
  if (a.verdict != b.verdict) return a.verdict > b.verdict ? a : b;
  return a.measured.value_or(0.0) >= b.measured.value_or(0.0) ? a : b;
}

/// A map that goes on beyond the border, with nothing in it, for a blur to be held against: what it makes of texels
/// inside must be the same. Filters that do not blur decide by the texel, and have nothing there to be wrong.
class WiderMap {
 public:
  WiderMap(const StressContext& context, const filters::FilterRequest& request)
      : values_(request.values), margin_(2 * filters::prefilter_radius_texels(request.spec, request.values)) {
    if (margin_ > 0 && filters::make_model(request.spec.id))
      probe_ = make_model_probe(context, request, filters::Precision::kDouble);
  }

  /// Gives the largest difference of what is seen of a map of occluders; 0 where there is nothing to hold it against.
  double find_difference(const std::vector<glm::vec3>& receivers, const std::vector<double>& seen) const {
    if (!probe_) return 0.0;
    const std::vector<double> wider = probe_->look(widen(receivers), values_).visibility;
    double largest = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) largest = std::max(largest, std::abs(seen[i] - wider[i]));
    return largest;
  }

 private:
  filters::ParamValues values_;
  int margin_;
  std::shared_ptr<Probe> probe_;

  ProbeScene widen(const std::vector<glm::vec3>& receivers) const {
    ProbeScene scene;
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

/// Looks along one border.
struct Looker {
  std::shared_ptr<Probe> probe;
  filters::FilterRequest request;
  std::shared_ptr<const WiderMap> wider;
  Place where = Place::kFloor;
  ProbeScene scene = {};

  std::vector<double> look(double outside) {
    scene.receivers = place(where, outside);
    return probe->look(scene, request.values).visibility;
  }

  Observation observe(double outside) {
    const std::vector<double> seen = look(outside);
    const auto unusable = std::ranges::count_if(seen, [](double v) { return !std::isfinite(v); });
    if (unusable > 0)
      return {Verdict::kBroken, std::nullopt,
              fmt::format("{} of {} receivers are NaN or infinite", unusable, seen.size())};
    const double reach = filters::radius_texels(request.spec, request.values) + 1.0;
    if (must_be_lit(where, outside, reach)) return judge_line(1.0 - *std::ranges::min_element(seen), "too dark");
    if (where != Place::kOccluders) return {};
    // Beyond the last texels' centres a bilinear read takes the border itself, not what the blur made of it.
    const bool reads_texels = outside <= -0.5;
    const Observation blurred =
        judge_line(reads_texels ? wider->find_difference(scene.receivers, seen) : 0.0, "off from a map that goes on");
    return worse(blurred, judge_across(seen, look(outside - kEarlier)));
  }

  /// Where a kernel holds both: even along the border, and never darker than nearer to the map. Its random turns make a
  /// stochastic filter uneven anywhere.
  Observation judge_across(const std::vector<double>& seen, const std::vector<double>& nearer) const {
    const bool even = request.spec.kind != filters::FilterKind::kStochastic;
    const Observation along = judge_line(even ? find_unevenness(seen) : 0.0, "uneven along the border");
    return worse(along,
                 judge_line(mean(nearer) - mean(seen), "darker than nearer to the map", even ? kBound : kLargestFall));
  }
};

Looker make_looker(Looker looker, Place where) {
  looker.where = where;
  looker.scene.size = kMapSize;
  looker.scene.depths.assign(static_cast<std::size_t>(kMapSize) * kMapSize,
                             where == Place::kFloor ? kReceiver : kOccluder);
  if (where == Place::kBehindLight) looker.scene.frustum = make_perspective();
  return looker;
}

Observation observe_all(std::vector<Looker>& lookers, double outside) {
  Observation worst{Verdict::kOk, 0.0, {}};
  for (Looker& looker : lookers) {
    Observation seen = looker.observe(outside);
    if (!seen.why.empty()) seen.why += fmt::format(", {}", name_of_place(looker.where));
    worst = worse(worst, seen);
  }
  return worst;
}

std::vector<std::string> remark(const records::StressCase& record) {
  if (record.degraded || record.broken || record.samples.empty()) return {};
  return {"lit outside the map, beyond its far plane and behind the light, and no line along the border"};
}

Case make_case(const StressContext& context, const filters::FilterRequest& request) {
  constexpr const char* kVariant = "all borders";
  if (!context.renderer) return make_absent_case(request.spec.id, kVariant, Level::kGl, "there is no GL");
  Case item = start_case(request, kVariant, Level::kGl);
  item.theories = {{std::nullopt, TheoryKind::kSlope, "none: what the map does not hold is lit",
                    "by definition: border = encode of depth 1", Verdict::kDegraded}};
  item.remark = remark;
  const std::shared_ptr<Probe> orthographic = make_gl_probe(context, request),
                               perspective = make_gl_probe(context, request);
  std::vector<Looker> lookers;
  const auto wider = std::make_shared<const WiderMap>(context, request);
  for (const Place where : kPlaces)
    lookers.push_back(make_looker({where == Place::kBehindLight ? perspective : orthographic, request, wider}, where));
  item.observe = [lookers](double outside) mutable { return observe_all(lookers, outside); };
  return item;
}

std::vector<Case> make_cases(const StressContext& context) {
  std::vector<Case> cases;
  for (const filters::FilterRequest& request : context.filters) cases.push_back(make_case(context, request));
  return cases;
}

}  // namespace map_edge

Axis make_map_edge_axis() {
  using namespace map_edge;
  Axis axis;
  axis.title = "Receivers across the map's border, its far plane, and behind the light";
  axis.quantity = "distance outside";
  axis.unit = "texels";
  axis.scale = Scale::kLinear;
  axis.range = {-4.0, 8.0};
  axis.limits = {-24.0, 24.0};
  axis.coarse_samples = 49;
  axis.measured = "missing light, or unevenness along the border";
  axis.measured_scale = Scale::kLinear;
  axis.bound = kBound;
  axis.broken_when = "visibility is not finite, or off by more than 0.1";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
