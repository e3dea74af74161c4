#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "filters/screen.h"
#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {

Axis make_picture_size_axis();

namespace picture_size {

constexpr records::StressRange kRange{4.0, 512.0};
constexpr int kMapTexels = 512, kRows = 32;
constexpr float kOccluder = 0.3f, kSurface = 0.6f;
constexpr double kPenumbra = 8.0, kStretch = 32.0;  // radius, and what the picture's width shows: texels of the map
constexpr double kPays = 0.95;                      // of the error: a pass that leaves more is not worth its cost
constexpr double kNoError = 1e-6;                   // root mean square, of rounding

/// A surface that faces the light and the camera, and over it a straight edge whose penumbra lies in the middle.
SyntheticScene make_scene(int width) {
  SyntheticScene scene{kMapTexels, make_split_depths(kMapTexels, kOccluder, kSurface), {}};
  const double pixel = kStretch / width / kMapTexels;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < width; ++x)
      scene.receivers.emplace_back(static_cast<float>(0.5 + (x + 0.5 - 0.5 * width) * pixel),
                                   static_cast<float>(0.5 + (y + 0.377 - 0.5 * kRows) * pixel), kSurface);
  return scene;
}

render::LightSetup make_light(std::uint32_t seed) {
  const scene::LightFrustum frustum = make_axis_frustum(1.0, kMapTexels);
  const double gap = static_cast<double>(kSurface) - static_cast<double>(kOccluder);
  return {frustum, 2.0 * kPenumbra * frustum.texel_size_ws / gap, {}, seed, {}};
}

/// The error of a picture, as a share of another's. What is right is the mean of each column of the other one: its
/// pixels have the same taps, each turned its own way. Root mean square; empty where the other has no error.
std::optional<double> find_error_left(const std::vector<double>& with, const std::vector<double>& without, int width) {
  double left = 0.0, all = 0.0;
  for (std::size_t x = 0, columns = static_cast<std::size_t>(width); x < columns; ++x) {
    double mean = 0.0;
    for (std::size_t i = x; i < without.size(); i += columns) mean += without[i] / kRows;
    for (std::size_t i = x; i < without.size(); i += columns) {
      left += (with[i] - mean) * (with[i] - mean);
      all += (without[i] - mean) * (without[i] - mean);
    }
  }
  if (all <= kNoError * kNoError * static_cast<double>(without.size())) return std::nullopt;
  return std::sqrt(left / all);
}

std::optional<double> find_model_error_left(const AxisInputs& inputs, const filters::FilterRequest& request,
                                            int width) {
  const SyntheticScene scene = make_scene(width);
  const auto light_size = static_cast<float>(make_light(inputs.seed).light_size);
  const filters::ScalarModel* model = filters::find_model(request.spec);
  const filters::DepthMap map{scene.size, scene.depths};
  const auto lookup = model->prepare({request.spec, request.values, map, {}, inputs.seed}, filters::Precision::kDouble);
  filters::ScreenPicture picture(width, kRows);
  for (std::size_t i = 0; i < scene.receivers.size(); ++i) {
    filters::Receiver receiver = make_receiver(scene, i);
    receiver.pixel = {static_cast<int>(i) % width, static_cast<int>(i) / width};
    receiver.light_size = light_size;
    picture.add(receiver, lookup->at(receiver));
  }
  const auto list = [&] {
    std::vector<double> visibility;
    for (const filters::ScreenPicture::Pixel& pixel : picture.pixels()) visibility.push_back(pixel.result.visibility);
    return visibility;
  };
  const std::vector<double> without = list();
  picture.filter(*model, request.spec, request.values, filters::Precision::kDouble);
  return find_error_left(list(), without, width);
}

Observation judge_error_left(std::optional<double> left) {
  if (!left) return {};
  if (!std::isfinite(*left)) return {Verdict::kBroken, std::nullopt, "visibility is NaN or infinite"};
  return judge_by_bounds(*left, kPays, std::numeric_limits<double>::infinity(), [&](double bound) {
    return fmt::format("{:.3g} of the error is left, over {:g}", *left, bound);
  });
}

/// Finds the widest picture in which the model's pass does not pay, as the GL's is found.
std::vector<Theory> make_theories(const AxisInputs& inputs, const filters::FilterRequest& request) {
  Case model;
  model.observe = [&](double width) {
    return judge_error_left(find_model_error_left(inputs, request, static_cast<int>(width)));
  };
  const records::StressCase seen = find_onsets(model, make_picture_size_axis());
  Theory theory{std::nullopt, TheoryKind::kSlope,
                fmt::format("none: in the scalar model no picture keeps {:g} of the error", kPays),
                "derived: a mean over neighbours that lie within the penumbra's width", Verdict::kDegraded};
  if (seen.degraded) {
    theory.onset = seen.degraded->value;
    theory.formula = fmt::format(
        "in the scalar model {:g} of the error is left where pixels are {:.3g} texels of the map apart, the penumbra's "
        "radius {:g}",
        kPays, kStretch / seen.degraded->value,
        std::min(kPenumbra, filters::radius_texels(request.spec, request.values)));
  }
  return {theory};
}

/// Lists how a filter may be asked for screen passes.
std::vector<filters::FilterRequest> list_screen_requests(const filters::FilterRequest& request) {
  std::vector<filters::FilterRequest> found;
  for (const std::string& choice : list_choices(request, "screen")) {
    filters::FilterRequest with = request;
    with.values["screen"] = choice;
    if (!filters::list_screens(with.spec, with.values).empty()) found.push_back(std::move(with));
  }
  return found;
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest&, const filters::FilterRequest& with,
               Level level) {
  Case item = start_case(inputs, with, "penumbra of a straight edge", level);
  if (!item.is_available()) return item;
  if (!find_model_error_left(inputs, with, static_cast<int>(kRange.high))) {
    item.not_available = "all pixels have the same taps: there is no noise that a pass could take";
    return item;
  }
  item.theories = make_theories(inputs, with);
  const auto filtered = std::make_shared<FilterBench>(inputs, with, true);
  const auto plain = std::make_shared<FilterBench>(inputs, with);
  item.observe = [filtered, plain, light = make_light(inputs.seed)](double value) {
    const int width = static_cast<int>(value);
    const SyntheticScene scene = make_scene(width);
    const auto draw = [&](FilterBench& bench) -> std::vector<double> {
      bench.resize({scene.size, width, kRows});
      bench.map().upload(scene.depths);
      bench.upload_receivers(scene.receivers, kFacingLight);
      const std::vector<float> image = bench.look_up(light, bench.request().values);
      return {image.begin(), image.end()};
    };
    return judge_error_left(find_error_left(draw(*filtered), draw(*plain), width));
  };
  return item;
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  return make_filter_cases(inputs, list_screen_requests, make_case, "no chosen filter has a screen pass", {Level::kGl});
}

}  // namespace picture_size

Axis make_picture_size_axis() {
  using namespace picture_size;
  Axis axis;
  axis.title = "Error that a screen pass leaves, over picture size";
  axis.quantity = "width of a picture of 4 penumbra radii";
  axis.unit = "pixels";
  axis.range = kRange;
  axis.limits = kRange;
  axis.coarse_samples = 13;
  axis.whole = true;
  axis.from = SearchFrom::kHigh;
  axis.measured = "error of visibility with the pass, as a share of the error without it";
  axis.bound = kPays;
  axis.broken_when = "visibility is not finite";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
