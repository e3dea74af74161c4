#include "harness/run/compare_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "base/error.h"
#include "harness/measure/scene_truth.h"
#include "report/images/picture_io.h"

namespace shadowbench::run {
namespace {

using Mask = std::vector<std::uint8_t>;

/// A picture without its alpha.
struct Colors {
  std::string name;
  images::Image image;
  bool srgb = false;
  int origin_x = 0;
  int origin_y = 0;
};

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::kInput, message); }

images::Image drop_channel(const images::Image& image, int dropped) {
  images::Image rest(image.width, image.height, image.channels - 1);
  auto to = rest.texels.begin();
  for (std::size_t i = 0; i < image.texels.size(); ++i)
    if (static_cast<int>(i % static_cast<std::size_t>(image.channels)) != dropped) *to++ = image.texels[i];
  return rest;
}

Colors read_colors(const std::string& name) {
  images::StoredPicture stored = images::read_stored_picture(name);
  const bool has_alpha = stored.alpha_channel >= 0 && stored.image.channels > 1;
  return {name, has_alpha ? drop_channel(stored.image, stored.alpha_channel) : std::move(stored.image), stored.srgb,
          stored.origin_x, stored.origin_y};
}

void require_same_window(const Colors& a, const Colors& b) {
  if (a.image.width != b.image.width || a.image.height != b.image.height) {
    fail(fmt::format("{} has {} x {} pixels and {} has {} x {}: only pictures of one size can be compared", a.name,
                     a.image.width, a.image.height, b.name, b.image.width, b.image.height));
  }
  if (a.origin_x == b.origin_x && a.origin_y == b.origin_y) return;
  fail(fmt::format("the data window of {} begins at ({}, {}) and that of {} at ({}, {}): crop them alike", a.name,
                   a.origin_x, a.origin_y, b.name, b.origin_x, b.origin_y));
}

void require_same_channels(const Colors& a, const Colors& b) {
  if (a.image.channels == b.image.channels) return;
  fail(fmt::format("{} has {} channels and {} has {} (alpha left out): only pictures of as many can be compared",
                   a.name, a.image.channels, b.name, b.image.channels));
}

/// Gives 1 for each pixel that counts.
Mask read_mask(const std::optional<std::string>& name, const Colors& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.image.width) * static_cast<std::size_t>(image.image.height);
  if (!name) return Mask(pixels, 1);
  const Colors stored = read_colors(*name);
  require_same_window(stored, image);
  if (stored.image.channels != 1) {
    fail(fmt::format("the mask {} has {} channels: give a picture of one, or name one part as FILE#PART", *name,
                     stored.image.channels));
  }
  Mask mask;
  for (const float value : stored.image.texels) {
    if (!std::isfinite(value)) fail(fmt::format("the mask {} has pixels that are NaN or infinite: mend it", *name));
    mask.push_back(value != 0.0f ? 1 : 0);
  }
  return mask;
}

bool is_finite(const images::Image& image, std::size_t pixel) {
  const auto channels = static_cast<std::size_t>(image.channels);
  const float* texel = &image.texels[pixel * channels];
  return std::all_of(texel, texel + channels, [](float value) { return std::isfinite(value); });
}

Mask keep_finite(Mask mask, const Colors& a, const Colors& b) {
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (!is_finite(a.image, i) || !is_finite(b.image, i)) mask[i] = 0;
  return mask;
}

/// A pixel counts with all of its channels.
Mask repeat(const Mask& mask, int channels) {
  Mask result;
  for (const std::uint8_t counts : mask) result.insert(result.end(), static_cast<std::size_t>(channels), counts);
  return result;
}

images::Image to_linear_rgb(const Colors& colors) {
  images::Image rgb(colors.image.width, colors.image.height, 3);
  const auto step = static_cast<std::size_t>(colors.image.channels);
  for (std::size_t i = 0; i < rgb.texels.size(); ++i) {
    const float value = colors.image.texels[step == 1 ? i / 3 : i];
    rgb.texels[i] = colors.srgb ? images::decode_srgb(value) : value;
  }
  return rgb;
}

/// Two pictures of one shape, and the pixels to compare.
struct Pair {
  Colors image;
  Colors truth;
  Mask counts;  ///< as the user wants it
  Mask mask;    ///< of these, the pixels that are finite in both
};

Pair read_pair(const ComparisonOptions& options) {
  Pair pair{read_colors(options.image), read_colors(options.truth), {}, {}};
  require_same_window(pair.image, pair.truth);
  require_same_channels(pair.image, pair.truth);
  pair.counts = read_mask(options.mask, pair.image);
  pair.mask = keep_finite(pair.counts, pair.image, pair.truth);
  return pair;
}

Comparison describe(const Pair& pair) {
  Comparison result;
  result.width = pair.image.image.width;
  result.height = pair.image.image.height;
  result.channels = pair.image.image.channels;
  result.compared = std::count(pair.mask.begin(), pair.mask.end(), 1);
  result.not_finite = std::count(pair.counts.begin(), pair.counts.end(), 1) - result.compared;
  if (pair.image.srgb == pair.truth.srgb) return result;
  const auto encoding = [](const Colors& each) {
    return fmt::format("{} holds {}", each.name, each.srgb ? "sRGB codes" : "linear values");
  };
  result.warnings.push_back(
      fmt::format("{} and {}: all but FLIP compare the values as stored", encoding(pair.image), encoding(pair.truth)));
  return result;
}

using MetricValue = std::variant<double, std::string>;

/// Gives FLIP, or why there is none.
MetricValue measure_flip(const Pair& pair, double pixels_per_degree) {
  const int channels = pair.image.image.channels;
  if (channels != 1 && channels != 3)
    return fmt::format("FLIP is for pictures of 1 or 3 channels, these have {}", channels);
  const auto flip =
      measure::measure_mean_flip(to_linear_rgb(pair.image), to_linear_rgb(pair.truth), pair.mask, pixels_per_degree);
  if (flip) return *flip;
  return "a pixel is NaN or infinite, and FLIP would spread it over its neighbours";
}

/// Gives a metric of pixels that count, or why there is none.
MetricValue measure_metric(const metrics::Metric& metric, const metrics::ErrorStats& stats, const Pair& pair,
                           double pixels_per_degree) {
  if (metric.statistic) return stats.*metric.statistic;
  if (metric.path == "error.flip") return measure_flip(pair, pixels_per_degree);
  return fmt::format("nothing measures {} of two pictures", metric.path);
}

void add_metrics(Comparison& result, const Pair& pair, const ComparisonOptions& options) {
  const auto stats = metrics::measure_error(pair.image.image.texels, pair.truth.image.texels,
                                            repeat(pair.mask, pair.image.image.channels));
  const std::string nothing = result.not_finite ? "no pixel is finite in both pictures" : "the mask is 0 everywhere";
  for (const metrics::Metric& metric : options.metrics) {
    const MetricValue value = stats ? measure_metric(metric, *stats, pair, options.pixels_per_degree) : nothing;
    const std::string name(metric.name());
    if (const auto* number = std::get_if<double>(&value))
      result.values[name] = *number;
    else
      result.absent[name] = std::get<std::string>(value);
  }
}

images::Image average_channels(const images::Image& image) {
  images::Image grey(image.width, image.height, 1);
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < image.texels.size(); ++i) grey.texels[i / channels] += image.texels[i];
  for (float& value : grey.texels) value /= static_cast<float>(channels);
  return grey;
}

void add_images(Comparison& result, const Pair& pair, double pixels_per_degree) {
  const images::Image &a = pair.image.image, &b = pair.truth.image;
  const images::Image grey = average_channels(a), expected_grey = average_channels(b);
  result.difference = images::Image(a.width, a.height, 1);
  for (std::size_t i = 0; i < grey.texels.size(); ++i)
    result.difference.texels[i] = !pair.counts[i] ? std::numeric_limits<float>::infinity()
                                  : pair.mask[i]  ? grey.texels[i] - expected_grey.texels[i]
                                                  : std::numeric_limits<float>::quiet_NaN();
  if (a.channels != 1 && a.channels != 3) return;
  const auto seen = measure::view_picture(to_linear_rgb(pair.image), pixels_per_degree),
             expected = measure::view_picture(to_linear_rgb(pair.truth), pixels_per_degree);
  if (!seen || !expected) return;
  result.flip = images::Image(a.width, a.height, 1);
  result.flip.texels = metrics::measure_flip(*seen, *expected);
}

}  // namespace

Comparison compare_pictures(const ComparisonOptions& options) {
  const Pair pair = read_pair(options);
  Comparison result = describe(pair);
  add_metrics(result, pair, options);
  if (options.images) add_images(result, pair, options.pixels_per_degree);
  return result;
}

}  // namespace shadowbench::run
