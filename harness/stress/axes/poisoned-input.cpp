#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "harness/render/shadow_map.h"
#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace poisoned_input {

constexpr int kMapSize = 64;
constexpr float kOccluder = 0.3f, kReceiver = 0.6f;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
constexpr float kDenormal = 1e-40f;

/// A number that does not belong into a map, and a depth: the number should do no more harm than that depth does.
struct Drop {
  float value;
  float harmless;
};

/// The numbers that are put into a map's texels, in turn.
struct Poison {
  const char* name;
  std::vector<Drop> drops;
};

Poison not_numbers() { return {"NaN in the map", {{kNaN, kReceiver}}}; }
Poison infinities() { return {"infinities in the map", {{kInfinity, 1.0f}, {-kInfinity, 0.0f}}}; }
Poison denormals() { return {"denormals in the map", {{kDenormal, 0.0f}, {-kDenormal, 0.0f}}}; }
Poison overflows() { return {"overflow in the map", {{1.0f, kReceiver}}}; }

/// exp(100) is infinite in 32 bits, exp(60) of the receivers' own depth is not.
constexpr double kOverflowingExponent = 100.0;

/// Spreads texels all over the map, in an order that does not depend on how many there are; no texel twice.
glm::ivec2 place_texel(int i) {
  constexpr int kStride = 1117;  // has no divisor in common with the number of texels
  const int at = (kMapSize * kMapSize / 2 + 7 + i * kStride) % (kMapSize * kMapSize);
  return {at % kMapSize, at / kMapSize};
}

/// Makes a map with occluders on its left half, and a receiver at every texel, behind them or beside.
SyntheticScene make_scene() {
  SyntheticScene scene{kMapSize, make_split_depths(kMapSize, kOccluder, kReceiver), {}};
  for (int y = 0; y < kMapSize; ++y)
    for (int x = 0; x < kMapSize; ++x) scene.receivers.emplace_back(scene.uv(x), scene.uv(y), kReceiver);
  return scene;
}

/// The scene with so many texels poisoned, or made as deep as is harmless.
SyntheticScene poison(SyntheticScene scene, int count, const Poison& poison, float Drop::*part) {
  for (int i = 0; i < count; ++i) {
    const glm::ivec2 texel = place_texel(i);
    scene.depths[static_cast<std::size_t>(texel.y * kMapSize + texel.x)] =
        poison.drops[static_cast<std::size_t>(i) % poison.drops.size()].*part;
  }
  return scene;
}

/// Marks the receivers whose kernel holds a poisoned texel, and those nearer to the map's border than `border` texels.
std::vector<bool> find_reached(int count, int reach, int border) {
  std::vector<bool> reached(static_cast<std::size_t>(kMapSize) * kMapSize, false);
  for (int i = 0; i < kMapSize * kMapSize; ++i) {
    const int x = i % kMapSize, y = i / kMapSize;
    reached[static_cast<std::size_t>(i)] = std::min({x, y, kMapSize - 1 - x, kMapSize - 1 - y}) < border;
  }
  for (int i = 0; i < count; ++i) {
    const glm::ivec2 texel = place_texel(i);
    for (int y = std::max(texel.y - reach, 0); y <= std::min(texel.y + reach, kMapSize - 1); ++y)
      for (int x = std::max(texel.x - reach, 0); x <= std::min(texel.x + reach, kMapSize - 1); ++x)
        reached[static_cast<std::size_t>(y * kMapSize + x)] = true;
  }
  return reached;
}

/// Counts of harmed receivers, by where they are.
struct Harm {
  int reachable = 0;   ///< receivers whose kernel holds poison
  int inside = 0;      ///< of them: not finite, or not what the harmless depth gives
  int not_finite = 0;  ///< of those
  int outside = 0;     ///< the same of all others
};

Harm count_harm(const std::vector<double>& seen, const std::vector<double>& harmless,
                const std::vector<bool>& reached) {
  constexpr double kSame = 1e-6;
  Harm harm;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const bool harmed = !(std::abs(seen[i] - harmless[i]) <= kSame);
    if (reached[i]) ++harm.reachable;
    if (harmed) ++(reached[i] ? harm.inside : harm.outside);
    if (!std::isfinite(seen[i])) ++harm.not_finite;
  }
  return harm;
}

Observation judge_harm(const Harm& harm, int count, int reach) {
  const double share = static_cast<double>(harm.inside) / std::max(harm.reachable, 1);
  if (harm.outside > 0)
    return {Verdict::kBroken, share,
            fmt::format("{} receivers are harmed farther than {} texels from all {} poisoned ones", harm.outside, reach,
                        count)};
  if (harm.inside == 0) return {Verdict::kOk, 0.0, {}};
  return {Verdict::kDegraded, share,
          fmt::format("{} of the {} receivers within {} texels are harmed, {} of them not finite; none beyond",
                      harm.inside, harm.reachable, reach, harm.not_finite)};
}

/// How many texels the bilinear reads of a kernel reach from a texel's centre.
int find_reach(const filters::FilterRequest& request) {
  return static_cast<int>(std::ceil(filters::radius_texels(request.spec, request.values))) + 1;
}

std::vector<std::string> remark_spread(const records::StressCase& record) {
  const double largest = find_largest_measured(record);
  if (record.broken || record.samples.empty() || largest == 0.0) return {};
  return {
      fmt::format("up to {:.0f} % of the receivers whose kernel holds poison are harmed, and none beyond the kernel",
                  100.0 * largest)};
}

/// How one filter's map is poisoned.
struct MapSetting {
  Poison poison;
  Level level = Level::kGl;
  bool border_is_poison = false;  ///< what lies outside the map is encoded as the poison is
};

/// What a GL stores of poison that is uploaded, if it clamps it.
std::string describe_stored(const Poison& poison) {
  render::ShadowMap map(1);
  std::vector<std::string> changed;
  for (const Drop& drop : poison.drops) {
    map.upload(std::span(&drop.value, 1));
    const float stored = map.read().stored.front();
    if (std::isfinite(stored) && !std::isfinite(drop.value))
      changed.push_back(fmt::format("{:g} as {:g}", drop.value, stored));
  }
  return changed.empty() ? std::string()
                         : fmt::format("this GL stores {} when depths are uploaded", fmt::join(changed, ", "));
}

std::vector<std::string> remark_map(const MapSetting& setting, const records::StressCase& record) {
  std::vector<std::string> sentences = remark_spread(record);
  if (setting.level != Level::kGl || record.samples.empty()) return sentences;
  if (std::string stored = describe_stored(setting.poison); !stored.empty()) sentences.push_back(std::move(stored));
  return sentences;
}

Case make_map_case(const AxisInputs& inputs, const filters::FilterRequest& request, const MapSetting& setting) {
  Case item = start_case(inputs, request, setting.poison.name, setting.level);
  if (!item.is_available()) return item;
  item.theories = {{std::nullopt, TheoryKind::kQuantum, "none: poison stays within the kernel",
                    "derived: a blur of finite support", Verdict::kBroken}};
  item.remark = [setting](const records::StressCase& record) { return remark_map(setting, record); };
  item.observe = [lookup = make_lookup(inputs, request, setting.level), values = request.values, setting,
                  reach = find_reach(request), scene = make_scene()](double number) {
    const int count = static_cast<int>(number);
    const auto look = [&](float Drop::*part) {
      return lookup(poison(scene, count, setting.poison, part), values).visibility;
    };
    const std::vector<double> harmless = look(&Drop::harmless);
    const std::vector<bool> reached = find_reached(count, reach, setting.border_is_poison ? reach : 0);
    return judge_harm(count_harm(look(&Drop::value), harmless, reached), count, reach);
  };
  return item;
}

/// Poisons maps of exponentials by an exponent that overflows at the deepest texels, and at no others.
std::vector<Case> make_overflow_cases(const AxisInputs& inputs) {
  std::vector<Case> cases;
  for (filters::FilterRequest request : inputs.filters) {
    const std::string param = find_exponent(request.spec);
    if (param.empty()) continue;
    request.values[param] = kOverflowingExponent;
    if (request.values.contains("combine")) request.values["combine"] = std::string("linear");
    if (request.values.contains("store")) request.values["store"] = std::string("r32f");
    cases.push_back(make_map_case(inputs, request, {overflows(), Level::kGl, true}));
  }
  return cases;
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  std::vector<Case> cases = make_gl_cases(inputs, [](const AxisInputs& all, const filters::FilterRequest& request) {
    return make_map_case(all, request, {not_numbers()});
  });
  for (const filters::FilterRequest& request : inputs.filters) {
    if (!request.spec.has_encode) continue;  // what compares has nothing to spread poison with
    for (const Poison& kind : {infinities(), denormals()}) cases.push_back(make_map_case(inputs, request, {kind}));
    for (const Poison& kind : {not_numbers(), infinities()})
      cases.push_back(make_map_case(inputs, request, {kind, Level::kModel}));
  }
  for (Case& item : make_overflow_cases(inputs)) cases.push_back(std::move(item));
  return cases;
}

}  // namespace poisoned_input

Axis make_poisoned_input_axis() {
  using namespace poisoned_input;
  Axis axis;
  axis.title = "Poisoned maps: not a number, infinity, denormals";
  axis.quantity = "poisoned texels";
  axis.range = {1.0, 64.0};
  axis.limits = {1.0, 4096.0};
  axis.coarse_samples = 7;
  axis.whole = true;
  axis.measured = "share harmed of the receivers whose kernel holds poison";
  axis.measured_log = false;
  axis.bound = 0.0;
  axis.broken_when = "a receiver is harmed whose kernel holds no poison";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
