#include "harness/stress/synthetic_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "harness/stress/filter_bench.h"

namespace shadowbench::stress {
namespace {

constexpr glm::vec3 kFacingLight{0.0f, 0.0f, -1.0f};
constexpr double kNearlyLit = 1e-3;  // all is lit, or dark: every receiver is this near to it

filters::Receiver make_receiver(const SyntheticScene& scene, std::size_t i) {
  filters::Receiver r;
  r.position_ws = scene.receivers[i];
  r.normal_ws = kFacingLight;
  r.uv = {r.position_ws.x, r.position_ws.y};
  r.depth = r.depth_unbiased = r.position_ws.z;
  r.texel_size_ws = 1.0f / static_cast<float>(scene.size);
  r.view_depth = 1.0f;
  r.pixel = {static_cast<int>(i), 0};
  return r;
}

bool is_all(const std::vector<double>& values, double of) {
  return std::ranges::all_of(
      values, [of](double value) { return std::abs(value - of) < kNearlyLit; });
}

/// The largest fall within a run from any receiver to a later one.
double find_largest_fall(const std::vector<double>& values, std::size_t run) {
  double largest = 0.0;
  for (std::size_t begin = 0; run > 0 && begin + run <= values.size(); begin += run) {
    double highest = values[begin];
    for (std::size_t i = begin; i < begin + run; ++i) {
      highest = std::max(highest, values[i]);
      largest = std::max(largest, highest - values[i]);
    }
  }
  return largest;
}

}  // namespace

std::vector<float> make_split_depths(int size, float left, float right) {
  std::vector<float> depths(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), right);
  for (std::size_t i = 0; i < depths.size(); ++i)
    if (2 * static_cast<int>(i % static_cast<std::size_t>(size)) < size) depths[i] = left;
  return depths;
}

SyntheticLookup make_gl_lookup(const AxisInputs& inputs, const filters::FilterRequest& request) {
  const auto bench = std::make_shared<FilterBench>(inputs, request);
  return [bench, seed = inputs.seed](const SyntheticScene& scene, const filters::ParamValues& values) -> LookupResult {
    const scene::LightFrustum frustum = scene.frustum.value_or(make_axis_frustum(1.0, scene.size));
    bench->resize({scene.size, static_cast<int>(scene.receivers.size())});
    bench->map().upload(scene.depths);
    bench->upload_receivers(scene.receivers, kFacingLight);
    const std::vector<float> image = bench->look_up({frustum, 0.0, {}, seed, {}}, values);
    return {{image.begin(), image.end()}, bench->count_broken_texels()};
  };
}

SyntheticLookup make_model_lookup(const AxisInputs& inputs, const filters::FilterRequest& request,
                                  filters::Precision precision) {
  const std::shared_ptr<filters::ScalarModel> model = filters::make_model(request.spec);
  return [=, spec = request.spec, seed = inputs.seed](const SyntheticScene& scene, const filters::ParamValues& values) {
    const filters::DepthMap map{scene.size, scene.depths};
    const auto lookup = model->prepare({spec, values, map, {}, seed}, precision);
    LookupResult result;
    for (std::size_t i = 0; i < scene.receivers.size(); ++i)
      result.visibility.push_back(lookup->at(make_receiver(scene, i)).visibility);
    return result;
  };
}

filters::Precision expected_precision(const filters::FilterSpec& spec) {
  const bool packs = !spec.passes.empty() && spec.passes.back().is_integer();
  return packs ? filters::Precision::kFloat : filters::Precision::kDouble;
}

double look_at_one_depth(const AxisInputs& inputs, const filters::FilterRequest& request, float stored,
                         float receiver) {
  const int size = 2 * static_cast<int>(std::ceil(filters::radius_texels(request.spec, request.values))) + 6;
  const SyntheticScene scene{size, make_split_depths(size, stored, stored), {{0.5f, 0.5f, receiver}}};
  return make_model_lookup(inputs, request, filters::Precision::kDouble)(scene, request.values).visibility.at(0);
}

SyntheticLookup make_lookup(const AxisInputs& inputs, const filters::FilterRequest& request, Level level) {
  return level == Level::kGl ? make_gl_lookup(inputs, request) : make_model_lookup(inputs, request);
}

double find_largest_error(const std::vector<double>& seen, const std::vector<double>& expected) {
  double largest = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) largest = std::max(largest, std::abs(seen[i] - expected[i]));
  return largest;
}

std::optional<Observation> judge_not_finite(const std::vector<double>& visibility) {
  const auto unusable = std::ranges::count_if(visibility, [](double v) { return !std::isfinite(v); });
  if (unusable == 0) return std::nullopt;
  return Observation{Verdict::kBroken, std::nullopt,
                     fmt::format("{} of {} receivers are NaN or infinite", unusable, visibility.size())};
}

Observation judge(const LookupResult& result, const Expected& expected) {
  std::optional<Observation> not_finite = judge_not_finite(result.visibility);
  const double error = find_largest_error(result.visibility, expected.visibility);
  const auto broken = [&](std::string why) {
    return Observation{Verdict::kBroken, not_finite ? std::nullopt : std::optional(error), std::move(why)};
  };
  if (result.broken_texels > 0) return broken(fmt::format("{} texels of the map overflowed", result.broken_texels));
  if (not_finite) return *not_finite;
  for (const auto& [of, name] : {std::pair(1.0, "lit"), std::pair(0.0, "dark")})
    if (is_all(result.visibility, of) && !is_all(expected.visibility, of))
      return broken(fmt::format("all {} receivers are {}", result.visibility.size(), name));
  const double fall = find_largest_fall(result.visibility, expected.rising_run);
  if (fall > kLargestFall) return broken(fmt::format("visibility falls by {:.2g} where it must rise", fall));
  if (error > expected.bound)
    return {Verdict::kDegraded, error, fmt::format("error {:.2g}, over {:g}", error, expected.bound)};
  return {Verdict::kOk, error, {}};
}

}  // namespace shadowbench::stress
