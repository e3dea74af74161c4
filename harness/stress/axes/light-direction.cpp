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

/// A way that light may go along, and the exact rotation that turns the scene's down to it.
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

/// Where the light leans to, in half turns: along the scene's axes, where the light's basis may switch, and between.
constexpr std::array<double, 4> kLeanTo{0.0, 0.5, 0.25, 1.3};

SlabSetting lean(const Way& way, double degrees, double to) {
  const double angle = glm::radians(degrees), about = to * 3.14159265358979323846;
  return {way.world_from_local,
          {std::sin(angle) * std::cos(about), -std::cos(angle), std::sin(angle) * std::sin(about)},
          true};
}

/// Counts of one picture's pixels.
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
    return judge_by_bounds(share, kBound, tally.known == 0 ? -1.0 : 0.5, [&](double) {
      return fmt::format("{:.2g} of the receivers are wrong, {} too dark and {} too bright", share, tally.wrong_dark,
                         tally.wrong - tally.wrong_dark);
    });
  }
};

std::vector<std::string> remark(const records::StressCase& record) {
  if (!is_ok_throughout(record)) return {};
  return {fmt::format(
      "exactly along the axis, and from {:g} to {:g} degrees beside it, at most {:.2g} of the receivers are wrong",
      record.samples.front().value, record.samples.back().value, find_largest_measured(record))};
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request, const Way& way) {
  Case item = start_case(inputs, request, fmt::format("light along {}", way.name), Level::kGl);
  if (!item.is_available()) return item;
  item.theories = {{std::nullopt, TheoryKind::kSlope,
                    "none: the light's axes are chosen beside the axis that its direction is least parallel to",
                    "by construction: h tan(angle)", Verdict::kDegraded}};
  item.remark = remark;
  Leaner leaner(std::make_shared<SceneDrawer>(inputs, request), request, way);
  item.observe = [leaner](double degrees) mutable { return leaner.observe(degrees); };
  return item;
}

/// The first filter sees all ways. The others see one: a filter does not know which way the light goes.
std::vector<Case> make_cases(const AxisInputs& inputs) {
  std::vector<Case> cases;
  const auto ways = list_ways();
  for (const Way& way : ways) cases.push_back(make_case(inputs, inputs.filters.front(), way));
  for (std::size_t i = 1; i < inputs.filters.size(); ++i)
    cases.push_back(make_case(inputs, inputs.filters[i], ways.front()));
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
