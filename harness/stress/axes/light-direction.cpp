#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/scene/validate.h"
#include "harness/stress/drawn_scene.h"
#include "harness/stress/slab_scene.h"

namespace shadowbench::stress {
namespace light_direction {

constexpr double kBound = 0.005;    // of the receivers whose visibility is known
constexpr double kPixels_m = 0.05;  // the widest pixel on the floor: nearer to an edge, a pixel's centre decides

/// A way that light may go straight along, and the rotation that turns the scene's down to it; exact.
struct Way {
  const char* name;
  glm::dmat3 world_from_local;
};

std::array<Way, 6> list_ways() {
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  return {{{"-y (straight down)", {x, y, z}},
           {"+y (straight up)", {-x, -y, z}},
           {"-x", {-y, x, z}},
           {"+x", {y, -x, z}},
           {"-z", {x, z, -y}},
           {"+z", {x, -z, y}}}};
}

/// Ways to lean: along the scene's axes, where the light's basis may switch, and between them.
constexpr std::array<double, 4> kLeanTo{0.0, 0.5, 0.25, 1.3};  // of half a turn

SlabSetting lean(const Way& way, double degrees, double to) {
  const double angle = glm::radians(degrees), about = to * 3.14159265358979323846;
  return {way.world_from_local,
          {std::sin(angle) * std::cos(about), -std::cos(angle), std::sin(angle) * std::sin(about)},
          true};
}

/// What came of one picture.
struct Tally {
  int unusable = 0;  ///< not finite, or not in [0,1]
  int known = 0;
  int wrong = 0;
  int wrong_dark = 0;
  void add(const Tally& other) {
    unusable += other.unusable;
    known += other.known;
    wrong += other.wrong;
    wrong_dark += other.wrong_dark;
  }
};

Tally count(const Drawing& drawing, const SlabSetting& setting, double margin_m) {
  Tally tally;
  for (std::size_t i = 0; i < drawing.visibility.size(); ++i) {
    const float seen = drawing.visibility[i];
    if (!(seen >= 0.0f && seen <= 1.0f)) ++tally.unusable;
    if (drawing.position[i].w == 0.0f) continue;
    const std::optional<double> expected = find_slab_visibility(setting, glm::dvec3(drawing.position[i]), margin_m);
    if (!expected) continue;
    ++tally.known;
    const double error = static_cast<double>(seen) - *expected;
    if (std::abs(error) > kVisibleDifference) ++tally.wrong;
    if (error < -kVisibleDifference) ++tally.wrong_dark;
  }
  return tally;
}

/// Draws one filter's pictures under lights near one way.
class Leaner {
 public:
  Leaner(std::shared_ptr<SceneDrawer> drawer, const filters::FilterRequest& request, const Way& way)
      : drawer_(std::move(drawer)),
        reach_texels_(filters::radius_texels(request.spec, request.values) + 1.5),
        way_(way) {}

  Observation observe(double degrees) {
    if (!aligned_) aligned_ = look(0.0, 0.0);
    Tally all = *aligned_;
    for (const double to : kLeanTo) all.add(look(degrees, to));
    return judge(all);
  }

 private:
  std::shared_ptr<SceneDrawer> drawer_;
  double reach_texels_;
  Way way_;
  std::optional<Tally> aligned_;  ///< exactly along the way: the same at every value

  Tally look(double degrees, double to) const {
    const SlabSetting setting = lean(way_, degrees, to);
    const scene::Scene scene = scene::validate(make_slab_scene(setting), "leaning light");
    return count(drawer_->draw(scene), setting, reach_texels_ * drawer_->fit(scene).texel_size_ws + kPixels_m);
  }

  static Observation judge(const Tally& tally) {
    const double share = static_cast<double>(tally.wrong) / std::max(tally.known, 1);
    if (tally.unusable > 0)
      return {Verdict::kBroken, std::nullopt, fmt::format("{} pixels are not finite, or not in [0,1]", tally.unusable)};
    const std::string why = fmt::format("{:.2g} of the receivers are wrong, {} too dark and {} too bright", share,
                                        tally.wrong_dark, tally.wrong - tally.wrong_dark);
    if (tally.known == 0 || share > 0.5) return {Verdict::kBroken, share, why};
    if (share > kBound) return {Verdict::kDegraded, share, why};
    return {Verdict::kOk, share, {}};
  }
};

std::vector<std::string> remark(const records::StressCase& record) {
  if (record.degraded || record.broken || record.samples.empty()) return {};
  double largest = 0.0;
  for (const records::StressSample& sample : record.samples) largest = std::max(largest, sample.measured.value_or(0.0));
  return {fmt::format(
      "exactly along the axis, and from {:g} to {:g} degrees beside it, at most {:.2g} of the receivers are wrong",
      record.samples.front().value, record.samples.back().value, largest)};
}

Case make_case(const StressContext& context, const filters::FilterRequest& request, const Way& way) {
  const std::string variant = fmt::format("light along {}", way.name);
  if (!context.renderer) return make_absent_case(request.spec.id, variant, Level::kGl, "there is no GL");
  Case item = start_case(request, variant, Level::kGl);
  item.theories = {{std::nullopt, TheoryKind::kSlope,
                    "none: the light's axes are chosen beside the axis that its direction is least parallel to",
                    "by construction: h tan(angle)", Verdict::kDegraded}};
  item.remark = remark;
  Leaner leaner(std::make_shared<SceneDrawer>(context, request), request, way);
  item.observe = [leaner](double degrees) mutable { return leaner.observe(degrees); };
  return item;
}

/// One filter sees all ways; which way the light goes is nothing to the others.
std::vector<Case> make_cases(const StressContext& context) {
  std::vector<Case> cases;
  const auto ways = list_ways();
  for (const Way& way : ways) cases.push_back(make_case(context, context.filters.front(), way));
  for (std::size_t i = 1; i < context.filters.size(); ++i)
    cases.push_back(make_case(context, context.filters[i], ways.front()));
  return cases;
}

}  // namespace light_direction

Axis make_light_direction_axis() {
  using namespace light_direction;
  Axis axis;
  axis.title = "Light along an axis, at right angles to one plane and parallel to another";
  axis.quantity = "angle to the axis";
  axis.unit = "degrees";
  axis.range = {1e-9, 10.0};
  axis.limits = {1e-30, 30.0};
  axis.coarse_samples = 21;
  axis.measured = "share of the receivers that are wrong";  // by more than 0.1, away from shadows' edges
  axis.measured_scale = Scale::kLinear;
  axis.bound = kBound;
  axis.broken_when =
      "visibility is not finite or not in [0,1], on the plane that is parallel to the light too, or more than half of "
      "it is wrong";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
