#include "harness/stress/synthetic_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "filters/kernel.h"
#include "filters/percentage_closer.h"
#include "harness/measure/stability_meter.h"

namespace shadowbench::stress {

FilterBench::FilterBench(const AxisInputs& inputs, filters::FilterRequest request, bool is_picture)
    : shaders_(inputs.renderer->shaders), request_(std::move(request)) {
  if (!is_picture) request_.spec.screens.clear();
}

void FilterBench::resize(const BenchSize& size) {
  if (surfaces_ && size == size_) return;
  if (size.map != size_.map) passes_.reset();
  surfaces_.emplace(size);
  size_ = size;
}

void FilterBench::upload_receivers(const std::vector<glm::vec3>& positions_ws, const glm::vec3& normal_ws) {
  std::vector<float> positions, normals;
  for (const glm::vec3& p : positions_ws) {
    positions.insert(positions.end(), {p.x, p.y, p.z, 1.0f});  // a view depth of 1 marks a surface
    normals.insert(normals.end(), {normal_ws.x, normal_ws.y, normal_ws.z, 0.0f});
  }
  surfaces_->gbuffer.upload(positions, normals);
}

std::vector<float> FilterBench::look_up(const render::LightSetup& light, const filters::ParamValues& values) {
  request_.values = values;
  if (passes_)
    passes_->retune(values, light);
  else
    passes_.emplace(shaders_, request_, surfaces_->map, light);
  passes_->prefilter(surfaces_->map);
  passes_->lookup(surfaces_->gbuffer, surfaces_->map, surfaces_->target);
  return surfaces_->target.texture().read_floats(1);
}

std::int64_t FilterBench::count_broken_texels() { return measure::count_broken_texels(*passes_, surfaces_->map); }

scene::LightFrustum make_axis_frustum(double width_ws, int map_texels) {
  scene::LightFrustum frustum;
  frustum.width_ws = width_ws;
  frustum.texel_size_ws = width_ws / map_texels;
  frustum.depth_range_ws = 1.0;
  return frustum;
}

namespace {

constexpr double kNearlyLit = 1e-3;  // all is lit, or dark: every receiver is this near to it

bool is_all(const std::vector<double>& values, double of) {
  return std::ranges::all_of(
      values, [of](double value) { return std::abs(value - of) < kNearlyLit; });
}

/// The largest difference of two lists of one length.
double find_largest_error(const std::vector<double>& seen, const std::vector<double>& expected) {
  double largest = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) largest = std::max(largest, std::abs(seen[i] - expected[i]));
  return largest;
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

std::vector<float> make_split_depths(int size, float left, float right) {
  std::vector<float> depths(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), right);
  for (std::size_t i = 0; i < depths.size(); ++i)
    if (2 * static_cast<int>(i % static_cast<std::size_t>(size)) < size) depths[i] = left;
  return depths;
}

SyntheticLookup make_gl_lookup(const AxisInputs& inputs, const filters::FilterRequest& request) {
  const auto bench = std::make_shared<FilterBench>(inputs, request);
  return [bench, seed = inputs.seed](const SyntheticScene& scene, const filters::ParamValues& values) -> LookupResult {
    const scene::LightFrustum frustum = make_axis_frustum(1.0, scene.size);
    bench->resize({scene.size, static_cast<int>(scene.receivers.size())});
    bench->map().upload(scene.depths);
    bench->upload_receivers(scene.receivers, kFacingLight);
    const std::vector<float> image = bench->look_up({frustum, 0.0, {}, seed, {}}, values);
    return {{image.begin(), image.end()}, bench->count_broken_texels()};
  };
}

SyntheticLookup make_model_lookup(const AxisInputs& inputs, const filters::FilterRequest& request,
                                  filters::Precision precision) {
  const filters::ScalarModel* model = filters::find_model(request.spec);
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

Observation judge(const LookupResult& result, const Expected& expected) {
  const auto unusable = std::ranges::count_if(result.visibility, [](double v) { return !std::isfinite(v); });
  const double error = find_largest_error(result.visibility, expected.visibility);
  const auto broken = [&](std::string why) {
    return Observation{Verdict::kBroken, unusable > 0 ? std::nullopt : std::optional(error), std::move(why)};
  };
  if (result.broken_texels > 0) return broken(fmt::format("{} texels of the map overflowed", result.broken_texels));
  if (unusable > 0)
    return broken(fmt::format("{} of {} receivers are NaN or infinite", unusable, result.visibility.size()));
  for (const auto& [of, name] : {std::pair(1.0, "lit"), std::pair(0.0, "dark")})
    if (is_all(result.visibility, of) && !is_all(expected.visibility, of))
      return broken(fmt::format("all {} receivers are {}", result.visibility.size(), name));
  const double fall = find_largest_fall(result.visibility, expected.rising_run);
  if (fall > kLargestFall) return broken(fmt::format("visibility falls by {:.2g} where it must rise", fall));
  if (error > expected.bound)
    return {Verdict::kDegraded, error, fmt::format("error {:.2g}, over {:g}", error, expected.bound)};
  return {Verdict::kOk, error, {}};
}

namespace {

constexpr int kEdgeSize = 2 * kWidestRadius + 4;  // a texel to spare: no rounding of a place reaches the border
constexpr int kEdgeReceivers = 37;                // no divisor of the steps: none falls on a texel's border
constexpr float kOccluder = 0.3f, kSurface = 0.6f;
constexpr int kBetweenTexels = 7;     // receivers between the two texel centres at an edge, where there is no prefilter
constexpr double kNearlyNone = 1e-6;  // of a kernel: so much is lost where its weights are added
constexpr int kAcrossKernel = 31;     // receivers across an edge and a kernel: none falls on a texel's border

/// A receiver's place across an edge.
struct EdgeOffset {
  double texels;  ///< from the edge
  double lit_share;
};

std::vector<EdgeOffset> place_across(int radius) {
  std::vector<EdgeOffset> places;
  for (int i = 1; radius == 0 && i <= kBetweenTexels; ++i) {
    const double share = static_cast<double>(i) / (kBetweenTexels + 1);
    places.push_back({share - 0.5, share});
  }
  if (radius == 0) return places;
  const std::vector<float> weights = filters::gaussian_weights(radius);
  double sum = 0.0, lit = 0.0;
  for (const float weight : weights) sum += static_cast<double>(weight);
  // The kernel's right end moves over the edge, texel by texel.
  for (int i = 0; i < 2 * radius; ++i) {
    lit += static_cast<double>(weights[static_cast<std::size_t>(2 * radius - i)]);
    places.push_back({i - radius + 0.5, lit / sum});
  }
  return places;
}

/// The share of the kernel's texels that lie right of the edge, every texel compared.
std::vector<EdgeOffset> place_across(const filters::Kernel& kernel) {
  const double reach = kernel.half_width();
  const int middle = 2 * static_cast<int>(std::ceil(reach)) + 1;  // the farthest kernel stays inside
  SyntheticScene scene{2 * middle, make_split_depths(2 * middle, 0.0f, 1.0f), {}};
  std::vector<double> offsets;
  for (int i = 0; i < kAcrossKernel; ++i) {
    offsets.push_back(reach * (2.0 * (i + 0.5) / kAcrossKernel - 1.0));
    scene.receivers.push_back({static_cast<float>((middle + offsets.back()) / scene.size), scene.uv(middle), 0.5f});
  }
  const std::vector<double> shares = compare_whole_kernel(scene, kernel);
  std::vector<EdgeOffset> places;
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (shares[i] > kNearlyNone && shares[i] < 1.0 - kNearlyNone) places.push_back({offsets[i], shares[i]});
  return places;
}

EdgeScene make_bands_of_edges(const std::vector<EdgeOffset>& places, int reach_texels,
                              const std::vector<EdgeDepths>& bands, int least_size) {
  const int count = static_cast<int>(bands.size());
  const int height = 2 * reach_texels + 2;  // of a band, so that no kernel leaves it
  EdgeScene edge;
  edge.scene.size = std::max({least_size, count * height, 4 * reach_texels + 4});
  edge.run = places.size();
  for (int b = 0; b < count; ++b) {
    const int middle = edge.scene.size * (2 * b + 1) / (2 * count);
    for (const EdgeOffset& place : places) {
      const double x = (edge.scene.size / 2 + place.texels) / edge.scene.size;
      edge.scene.receivers.push_back({static_cast<float>(x), edge.scene.uv(middle), 0.0f});
      edge.lit_share.push_back(place.lit_share);
      edge.band.push_back(static_cast<std::size_t>(b));
    }
  }
  set_depths(edge, bands);
  return edge;
}

}  // namespace

SyntheticScene make_straight_edge(double radius_texels) {
  SyntheticScene scene;
  scene.size = kEdgeSize;
  scene.depths = make_split_depths(kEdgeSize, kOccluder, kSurface);
  const double reach = 0.5 + std::min(kWidestRadius - radius_texels, radius_texels + 2.0);
  for (int i = 0; i < kEdgeReceivers; ++i) {
    const double texels = kEdgeSize / 2 + reach * (2.0 * (i + 0.5) / kEdgeReceivers - 1.0);
    scene.receivers.push_back({static_cast<float>(texels / kEdgeSize), scene.uv(kEdgeSize / 2), kSurface});
  }
  return scene;
}

std::vector<double> compare_whole_kernel(const SyntheticScene& scene, const filters::Kernel& kernel) {
  const filters::DepthMap map{scene.size, scene.depths};
  const filters::PercentageCloser closer(kernel, map);
  std::vector<double> visibility;
  for (const glm::vec3& place : scene.receivers) {
    filters::Receiver receiver;
    receiver.uv = {place.x, place.y};
    receiver.depth = receiver.depth_unbiased = place.z;
    visibility.push_back(closer.at(receiver));
  }
  return visibility;
}

Observation judge_edge(const LookupResult& seen, std::vector<double> expected, filters::FilterKind kind) {
  const bool rises = kind == filters::FilterKind::kComparison || kind == filters::FilterKind::kBound;
  return judge(seen, {std::move(expected), kVisibleError, rises ? seen.visibility.size() : 0});
}

EdgeScene make_edge_scene(int radius_texels, const std::vector<EdgeDepths>& bands, int least_size) {
  return make_bands_of_edges(place_across(radius_texels), radius_texels, bands, least_size);
}

EdgeScene make_edge_scene(const filters::Kernel& kernel, const std::vector<EdgeDepths>& bands) {
  return make_bands_of_edges(place_across(kernel), static_cast<int>(std::ceil(kernel.half_width())), bands, 0);
}

void set_depths(EdgeScene& edge, const std::vector<EdgeDepths>& bands) {
  const auto size = static_cast<std::size_t>(edge.scene.size);
  edge.scene.depths.resize(size * size);
  for (std::size_t y = 0; y < size; ++y) {
    const EdgeDepths& band = bands[y * bands.size() / size];
    for (std::size_t x = 0; x < size; ++x)
      edge.scene.depths[y * size + x] = x < size / 2 ? band.occluder : band.receiver;
  }
  for (std::size_t i = 0; i < edge.band.size(); ++i) edge.scene.receivers[i].z = bands[edge.band[i]].receiver;
}

namespace {

constexpr int kStackReceivers = 16;  // in a row: each has other shares

/// Which occluder a texel holds. Neighbours along a row differ by one, along a column by about the root of their count:
/// small kernels hold as many as they can.
std::size_t choose_layer(int x, int y, std::size_t count) {
  const int step = count == 2 ? 1 : static_cast<int>(std::lround(std::sqrt(static_cast<double>(count))));
  return static_cast<std::size_t>(x + step * y) % count;
}

/// The weights of texels `first` .. on one axis.
struct Span {
  int first = 0;
  std::vector<double> weights;
};

Span make_span(int radius, int texel) {
  if (radius == 0) return {texel, {0.5, 0.5}};
  Span span{texel - radius, {}};
  double sum = 0.0;
  for (const float weight : filters::gaussian_weights(radius)) sum += static_cast<double>(weight);
  for (const float weight : filters::gaussian_weights(radius))
    span.weights.push_back(static_cast<double>(weight) / sum);
  return span;
}

std::vector<double> find_shares(const Span& x, const Span& y, std::size_t count) {
  std::vector<double> shares(count, 0.0);
  for (std::size_t j = 0; j < y.weights.size(); ++j) {
    for (std::size_t i = 0; i < x.weights.size(); ++i) {
      shares[choose_layer(x.first + static_cast<int>(i), y.first + static_cast<int>(j), count)] +=
          x.weights[i] * y.weights[j];
    }
  }
  return shares;
}

}  // namespace

LayerStack make_layer_stack(int count, double first_gap, double gap_ratio, double receiver) {
  LayerStack stack{{}, receiver};
  const double last = receiver - gap_ratio * first_gap;
  for (int i = 0; i < count; ++i) stack.depths.push_back(last - first_gap * (count - 1 - i) / (count - 1));
  return stack;
}

LayerScene make_layer_scene(int radius_texels, const LayerStack& stack) {
  LayerScene layers;
  SyntheticScene& scene = layers.scene;
  scene.size = std::max(64, 2 * radius_texels + kStackReceivers + 2);
  for (int y = 0; y < scene.size; ++y)
    for (int x = 0; x < scene.size; ++x)
      scene.depths.push_back(static_cast<float>(stack.depths[choose_layer(x, y, stack.depths.size())]));
  const float between = radius_texels == 0 ? 0.5f / static_cast<float>(scene.size) : 0.0f;
  const int row = scene.size / 2, first = (scene.size - kStackReceivers) / 2;
  for (int x = first; x < first + kStackReceivers; ++x) {
    scene.receivers.push_back({scene.uv(x) + between, scene.uv(row) + between, static_cast<float>(stack.receiver)});
    layers.shares.push_back(
        find_shares(make_span(radius_texels, x), make_span(radius_texels, row), stack.depths.size()));
  }
  return layers;
}

double find_chebyshev(const LayerStack& stack, const std::vector<double>& shares) {
  double mean = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) mean += shares[i] * stack.depths[i];
  for (std::size_t i = 0; i < shares.size(); ++i)
    variance += shares[i] * (stack.depths[i] - mean) * (stack.depths[i] - mean);
  const double distance = stack.receiver - mean;
  return variance / (variance + distance * distance);
}

double find_exponential(const LayerStack& stack, const std::vector<double>& shares, double c) {
  double sum = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) sum += shares[i] * std::exp(-c * (stack.receiver - stack.depths[i]));
  return sum;
}

namespace {

constexpr int kReceivers = 64;          // along each axis
constexpr double kStep_texels = 0.628;  // between them: meets every place within a texel
constexpr double kLeastAcne = 1e-6;     // mean shadow: one receiver by 1/256
constexpr double kRoundings = 8.0;      // of a depth, on its way into the map and from the receiver

double tangent(const PlaneTilt& tilt) { return std::tan(tilt.angle_deg * std::numbers::pi / 180.0); }

/// What the light sees of the plane, with a margin.
double find_depth_range_m(const PlaneTilt& tilt) { return std::max(2.0 * tangent(tilt), 1e-3); }

/// The light's axes: along the map's rows and columns, and away from it. The plane is y = 0.
struct LightAxes {
  glm::dvec3 right, up, away;
};

LightAxes make_axes(const PlaneTilt& tilt) {
  const double angle = tilt.angle_deg * std::numbers::pi / 180.0;
  const glm::dvec3 falling(std::cos(angle), std::sin(angle), 0.0), level(0.0, 0.0, 1.0),
      away(std::sin(angle), -std::cos(angle), 0.0);
  if (!tilt.diagonal) return {falling, level, away};
  return {(falling + level) / std::numbers::sqrt2, (level - falling) / std::numbers::sqrt2, away};
}

/// The point of the plane that a place on the map, metres from its middle, shows.
glm::dvec3 find_point(const PlaneTilt& tilt, const glm::dvec2& place) {
  const LightAxes axes = make_axes(tilt);
  const glm::dvec3 seen = place.x * axes.right + place.y * axes.up;
  return seen - axes.away * (seen.y / axes.away.y);
}

/// The receivers, metres from the map's middle.
std::vector<glm::dvec2> place_receivers() {
  std::vector<glm::dvec2> places;
  const auto place = [](int i) { return (i - 0.5 * (kReceivers - 1)) * kStep_texels * kPlaneTexel_m; };
  for (int y = 0; y < kReceivers; ++y)
    for (int x = 0; x < kReceivers; ++x) places.emplace_back(place(x), place(y));
  return places;
}

scene::LightFrustum make_plane_frustum(const PlaneTilt& tilt) {
  const LightAxes axes = make_axes(tilt);
  scene::LightFrustum frustum = make_axis_frustum(1.0, kPlaneMapTexels);
  frustum.depth_range_ws = find_depth_range_m(tilt);
  frustum.direction_ws = glm::vec3(axes.away);
  frustum.light_from_world = glm::transpose(glm::dmat4(glm::dvec4(axes.right, 0.0), glm::dvec4(axes.up, 0.0),
                                                       glm::dvec4(-axes.away, 0.0), glm::dvec4(0.0, 0.0, 0.0, 1.0)));
  const double depth = -1.0 / frustum.depth_range_ws;
  frustum.clip_from_light = glm::dmat4(glm::dvec4(2.0, 0.0, 0.0, 0.0), glm::dvec4(0.0, 2.0, 0.0, 0.0),
                                       glm::dvec4(0.0, 0.0, depth, 0.0), glm::dvec4(0.0, 0.0, 0.5, 1.0));
  const glm::dmat4 uv_from_light(glm::dvec4(1.0, 0.0, 0.0, 0.0), glm::dvec4(0.0, 1.0, 0.0, 0.0),
                                 glm::dvec4(0.0, 0.0, depth, 0.0), glm::dvec4(0.5, 0.5, 0.5, 1.0));
  frustum.clip_from_world = glm::mat4(frustum.clip_from_light * frustum.light_from_world);
  frustum.uv_depth_from_world = glm::mat4(uv_from_light * frustum.light_from_world);
  return frustum;
}

/// Makes the plane, larger than the map on every side.
scene::Scene make_plane_scene(const PlaneTilt& tilt) {
  scene::Scene scene;
  scene.materials.emplace_back();
  scene::Mesh mesh;
  for (const auto& [x, y] : {std::pair(-0.6, -0.6), {0.6, -0.6}, {0.6, 0.6}, {-0.6, 0.6}})
    mesh.vertices.push_back({glm::vec3(find_point(tilt, {x, y})), {0.0f, 1.0f, 0.0f}, {}});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

}  // namespace

double find_gain_m(const PlaneTilt& tilt, double reach_texels) {
  return reach_texels * kPlaneTexel_m * tangent(tilt) * (tilt.diagonal ? std::numbers::sqrt2 : 1.0);
}

double TiltedPlane::rounding_m() const { return kRoundings * 0x1p-24 * find_depth_range_m(tilt_); }

void TiltedPlane::tilt(const PlaneTilt& tilt) {
  tilt_ = tilt;
  bench_.resize({kPlaneMapTexels, kReceivers, kReceivers});
  bench_.map().draw(bench_.shaders(), render::Geometry(make_plane_scene(tilt)), make_plane_frustum(tilt));
  std::vector<glm::vec3> receivers;
  for (const glm::dvec2& place : place_receivers()) receivers.emplace_back(find_point(tilt, place));
  bench_.upload_receivers(receivers, {0.0f, 1.0f, 0.0f});
}

double TiltedPlane::find_acne(double bias_m) {
  const scene::LightFrustum frustum = make_plane_frustum(tilt_);
  render::Bias bias;
  bias.constant_depth = bias_m / frustum.depth_range_ws;
  const std::vector<float> visibility = bench_.look_up({frustum, 0.0, bias, seed_, {}}, bench_.request().values);
  double shadow = 0.0;
  for (const float v : visibility) shadow += (1.0 - static_cast<double>(v)) / static_cast<double>(visibility.size());
  return shadow;
}

std::optional<double> TiltedPlane::find_needed_bias(double theory_m) {
  const auto has_acne = [&](double bias_m) { return find_acne(bias_m) > kLeastAcne; };
  if (!has_acne(0.0)) return 0.0;
  double low = 0.0, high = 2.0 * theory_m + rounding_m();
  if (has_acne(high)) return std::nullopt;
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    (has_acne(middle) ? low : high) = middle;
  }
  return high;
}

}  // namespace shadowbench::stress
