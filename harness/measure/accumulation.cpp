#include "harness/measure/accumulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "harness/measure/timing.h"
#include "reference/metrics/error_stats.h"

namespace shadowbench::measure {
namespace {

/// The radical inverse: the digits of a number, mirrored at the point.
double find_radical_inverse(int number, int base) {
  double sum = 0.0;
  for (double digit = 1.0 / base; number > 0; number /= base, digit /= base) sum += digit * (number % base);
  return sum;
}

constexpr int kAtRest = 16;          // frames before the motion, and those of what the filter itself sees at rest
constexpr double kTrial_rad = 1e-3;  // small beside what a shadow's caster is seen under
constexpr int kMovingFrames = 8;     // that a shadow moves for
constexpr int kMostAtRest = 64;      // frames that it is followed for then

/// How far the shadow at a receiver moves in the trial, in texels; nothing where there is no shadow.
std::optional<double> find_move(const TaskRig& rig, const LightMap& map, const images::Image& depths,
                                const glm::dvec3& receiver) {
  const scene::Light& light = rig.task.scene->light;
  const scene::LightFrustum& frustum = map.frustum();
  const glm::dvec3 place = frustum.place(receiver, depths.width);
  const int x = static_cast<int>(place.x), y = depths.height - 1 - static_cast<int>(place.y);
  if (place.x < 0.0 || place.y < 0.0 || x >= depths.width || y < 0) return std::nullopt;
  const double above_m = (place.z - static_cast<double>(*depths.at(x, y))) * frustum.depth_range_ws;
  const double texel_m = frustum.texel_size_at(receiver);
  if (above_m < texel_m) return std::nullopt;
  const glm::vec3 caster(receiver + above_m * frustum.to_light(receiver));
  const glm::dvec3 move(scene::to_light(scene::turn_about_vertical(light, kTrial_rad), caster) -
                        scene::to_light(light, caster));
  return glm::length(move) * above_m / texel_m;
}

GhostMotion make_motion(const TaskRig& rig, double texels, double turn_per_texel) {
  const SceneTruth& start = rig.truth();
  GhostMotion motion;
  motion.texels = texels;
  for (int i = 0; i <= kMovingFrames; ++i)
    motion.lights.push_back(scene::turn_about_vertical(rig.task.scene->light, i * texels * turn_per_texel));
  const scene::Light& last = motion.lights.back();
  motion.end =
      trace_scene(rig.assets.tracer(), last, read_view_receivers(rig.gbuffer(), last), rig.options.truth_weight);
  motion.revealed.resize(start.mask.size());
  if (!motion.end.absent.empty()) return motion;
  const auto limit = static_cast<float>(records::kGhostLimit);
  for (std::size_t i = 0; i < start.mask.size(); ++i)
    motion.revealed[i] = start.mask[i] && motion.end.mask[i] && start.area.texels[i] <= limit &&
                         motion.end.area.texels[i] >= 1.0f - limit;
  return motion;
}

/// The pixels of a motion at which a filter is right when it is at rest.
std::vector<std::size_t> list_pixels(const GhostMotion& motion, const images::Image& at_rest) {
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < motion.revealed.size(); ++i) {
    const float error = std::abs(at_rest.texels[i] - motion.end.area.texels[i]);
    if (motion.revealed[i] && error <= static_cast<float>(records::kGhostLimit)) pixels.push_back(i);
  }
  return pixels;
}

double find_mean_error(const images::Image& image, const images::Image& truth, const std::vector<std::size_t>& pixels) {
  double sum = 0.0;
  for (const std::size_t i : pixels) sum += std::abs(static_cast<double>(image.texels[i] - truth.texels[i]));
  return sum / static_cast<double>(pixels.size());
}

/// Follows one motion of one filter.
class GhostHunt {
 public:
  GhostHunt(const TaskRig& rig, const GhostMotion& motion, FrameDrawing& drawing)
      : rig_(rig),
        motion_(motion),
        drawing_(drawing),
        resolves_(make_resolves(rig, kFirstExponential)),
        pixels_(list_pixels(motion, drawing.average(show(kMovingFrames), kAtRest))) {
    for (std::size_t i = kFirstExponential; i < list_resolve_rules().size(); ++i)
      ghosts_.push_back(
          {motion.texels, list_resolve_rules()[i].name, static_cast<std::int64_t>(pixels_.size()), {}, {}});
  }

  std::vector<records::GhostRecord> run() {
    for (int i = 0; i < kAtRest; ++i) draw(0);
    for (int i = 1; i <= kMovingFrames; ++i) draw(i);
    for (render::ResolvePass& resolve : resolves_) at_stop_.push_back(render::read_image(resolve.texture(), 1));
    if (pixels_.empty()) return ghosts_;
    for (int rest = 0; !look(rest) && rest < kMostAtRest; ++rest) draw(kMovingFrames);
    return ghosts_;
  }

  std::vector<images::Image> at_stop() { return std::move(at_stop_); }

 private:
  const TaskRig& rig_;
  const GhostMotion& motion_;
  FrameDrawing& drawing_;
  std::uint32_t number_ = 0;
  int light_ = -1;               // that the map is of
  std::optional<LightMap> map_;  // one at a time: maps may be large
  std::vector<render::ResolvePass> resolves_;
  std::vector<std::size_t> pixels_;
  std::vector<records::GhostRecord> ghosts_;
  std::vector<images::Image> at_stop_;

  /// The next frame, lit by one of the motion's lights.
  ShownFrame show(int light) {
    const scene::Camera& camera = *rig_.task.camera;
    const scene::Light& shown = motion_.lights[static_cast<std::size_t>(light)];
    if (light != light_) map_.emplace(rig_.assets.make_light_map(shown, camera, rig_.task.map_size));
    light_ = light;
    return {number_++, shown, *map_, rig_.assets.gbuffer(camera)};
  }

  void draw(int light) { drawing_.draw(show(light), resolves_); }

  /// Notes the errors after so many frames at rest; whether all are small.
  bool look(int rest) {
    for (std::size_t i = 0; i < ghosts_.size(); ++i) {
      const double error = find_mean_error(render::read_image(resolves_[i].texture(), 1), motion_.end.area, pixels_);
      if (rest == 0) ghosts_[i].at_stop = error;
      if (!ghosts_[i].frames_until && error <= records::kGhostLimit) ghosts_[i].frames_until = rest;
    }
    return std::ranges::all_of(ghosts_, [](const auto& ghost) { return ghost.frames_until.has_value(); });
  }
};

/// The angle in radians by which the light turns about the vertical while shadows move by a texel: at the median of the
/// pixels that lie in shadow, whose casters' distances the map holds. Nothing where there is no shadow, or none moves.
std::optional<double> find_turn_per_texel(const TaskRig& rig) {
  const SceneTruth& truth = rig.truth();
  const LightMap& map = rig.light();
  const images::Image depths = read_linear_depth(map.map);
  std::vector<double> moves;
  for (std::size_t i = 0; i < truth.mask.size(); ++i) {
    if (!truth.mask[i] || truth.hard.texels[i] > 0.0f) continue;
    if (const auto move = find_move(rig, map, depths, glm::dvec3(truth.receivers.image.points[i].position_ws)))
      moves.push_back(*move);
  }
  if (moves.empty()) return std::nullopt;
  const auto middle = moves.begin() + static_cast<std::ptrdiff_t>(moves.size() / 2);
  std::ranges::nth_element(moves, middle);
  constexpr double kLeast = 1e-6;
  return *middle < kLeast ? std::nullopt : std::optional(kTrial_rad / *middle);
}

constexpr int kConverged = 256;                   // frames that noise is measured against
constexpr std::uint32_t kOtherFrames = 1U << 20;  // they are none of those that are measured
constexpr int kTimed = 15;

double find_rmse(const images::Image& image, const images::Image& other, const SceneTruth& truth) {
  const auto error = metrics::measure_error(image.texels, other.texels, truth.mask);
  return error ? error->rmse : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

glm::dvec2 find_jitter(int frame) {
  const int point = frame % kJitters + 1;
  return {find_radical_inverse(point, 2) - 0.5, find_radical_inverse(point, 3) - 0.5};
}

const std::vector<NamedRule>& list_resolve_rules() {
  static const std::vector<NamedRule> rules = {{"newest", {.least_weight = 1.0f, .clamps = false}},
                                               {"mean", {.least_weight = 0.0f, .clamps = false}},
                                               {"exponential", {.clamps = false}},
                                               {"clamped", {}}};
  return rules;
}

std::vector<render::ResolvePass> make_resolves(const TaskRig& rig, std::size_t first) {
  std::vector<render::ResolvePass> resolves;
  for (std::size_t i = first; i < list_resolve_rules().size(); ++i)
    resolves.emplace_back(list_resolve_rules()[i].rule, rig.options.width, rig.options.height);
  return resolves;
}

FrameDrawing::FrameDrawing(const TaskRig& rig, const filters::FilterRequest& request)
    : rig_(rig),
      filter_(rig.make_passes(request)),
      target_("visibility", GL_R32F, rig.options.width, rig.options.height) {}

void FrameDrawing::draw(const ShownFrame& frame, std::vector<render::ResolvePass>& resolves) {
  render::LightLayers light = make_filter_light(rig_.options, frame.light, frame.map.layers, filter_->request());
  for (render::LightSetup& layer : light) layer.frame = frame.number;
  render::ShaderLibrary& shaders = rig_.renderer.shaders;
  filter_->retune(light);
  filter_->prefilter(frame.map.map);
  filter_->lookup(frame.gbuffer, frame.map.map, target_);
  for (render::ResolvePass& resolve : resolves)
    resolve.add(shaders, *rig_.task.scene, {frame.gbuffer, target_.texture(), *rig_.task.camera});
}

images::Image FrameDrawing::average(ShownFrame frame, int count) {
  std::vector<render::ResolvePass> mean;
  mean.emplace_back(render::ResolveRule{.least_weight = 0.0f, .clamps = false}, rig_.options.width,
                    rig_.options.height);
  for (int i = 0; i < count; ++i, ++frame.number) draw(frame, mean);
  return render::read_image(mean.front().texture(), 1);
}

GhostBench make_ghost_bench(const TaskRig& rig) {
  GhostBench ghosts;
  if (rig.light().layers.size() > 1) {
    ghosts.absent = "the light's map has several layers, and one is followed";
    return ghosts;
  }
  const std::optional<double> turn_per_texel = find_turn_per_texel(rig);
  if (!turn_per_texel) ghosts.absent = "no shadow in view moves when the light turns about the vertical";
  for (const double texels : {1.0, kShownTexels, 16.0})
    if (turn_per_texel) ghosts.motions.push_back(make_motion(rig, texels, *turn_per_texel));
  return ghosts;
}

std::vector<records::GhostRecord> measure_ghosts(const TaskRig& rig, const GhostBench& ghosts, FrameDrawing& drawing,
                                                 std::vector<images::Image>& images) {
  std::vector<records::GhostRecord> records;
  for (const GhostMotion& motion : ghosts.motions) {
    GhostHunt hunt(rig, motion, drawing);
    std::ranges::copy(hunt.run(), std::back_inserter(records));
    if (motion.texels == kShownTexels) images = hunt.at_stop();
  }
  return records;
}

/// Frames of a view that stands still, and what they are held against.
struct AccumulationMeter::Sequence {
  bool jitter = false;
  const images::Image& truth;
  const images::Image& converged;  ///< empty: noise is not asked for
};

AccumulationMeter::AccumulationMeter(const TaskRig& rig)
    : rig_(rig),
      jittered_(rig.options.width, rig.options.height),
      truth_(rig.truth()),
      jittered_truth_(rig.options.width, rig.options.height, 1),
      ghosts_(make_ghost_bench(rig)) {
  trace_jittered();
  time_resolves();
}

void AccumulationMeter::trace_jittered() {
  const scene::Light& light = rig_.task.scene->light;
  for (int i = 0; i < kJitters; ++i) {
    show_frame(i, true);
    const ViewReceivers receivers = read_view_receivers(jittered_, light);
    images::Image area = receivers.to_image(std::vector<float>(receivers.is_surface.size()));
    if (const SceneTruth traced = trace_scene(rig_.assets.tracer(), light, receivers, rig_.options.truth_weight);
        traced.absent.empty())
      area = traced.area;
    for (std::size_t p = 0; p < area.texels.size(); ++p) jittered_truth_.texels[p] += area.texels[p] / kJitters;
  }
}

void AccumulationMeter::time_resolves() {
  const render::GBuffer& gbuffer = rig_.gbuffer();
  const gl::Texture visibility = render::upload_image(truth_.area);
  for (render::ResolvePass& resolve : make_resolves(rig_, kFirstExponential)) {
    std::vector<double> times(kTimed);
    for (double& ms : times)
      ms = gl::time_ms(rig_.renderer.timer, [&] {
        resolve.add(rig_.renderer.shaders, *rig_.task.scene, {gbuffer, visibility, *rig_.task.camera});
      });
    resolve_ms_.push_back(summarise(times).median);
  }
}

ShownFrame AccumulationMeter::show_frame(int number, bool jitter) {
  const scene::Camera& camera = *rig_.task.camera;
  if (jitter) rig_.assets.draw_view(jittered_, camera, find_jitter(number));
  return {static_cast<std::uint32_t>(number), rig_.task.scene->light, rig_.assets.light_map(camera, rig_.task.map_size),
          jitter ? jittered_ : rig_.assets.gbuffer(camera)};
}

std::vector<records::ResolveRecord> AccumulationMeter::follow(FrameDrawing& drawing, const Sequence& sequence,
                                                              std::vector<images::Image>& last) {
  std::vector<render::ResolvePass> resolves = make_resolves(rig_);
  std::vector<records::ResolveRecord> records(resolves.size());
  std::vector<std::vector<double>> changes(resolves.size());  // squared, of each step
  last.resize(resolves.size());
  const int frames = rig_.options.frames;
  for (int frame = 0; frame < frames; ++frame) {
    drawing.draw(show_frame(frame, sequence.jitter), resolves);
    for (std::size_t i = 0; i < resolves.size(); ++i) {
      const images::Image before = std::exchange(last[i], render::read_image(resolves[i].texture(), 1));
      records[i].rmse.push_back(find_rmse(last[i], sequence.truth, truth_));
      if (!sequence.converged.empty()) {
        if (frame == 0) records[i].noise.emplace();
        records[i].noise->push_back(find_rmse(last[i], sequence.converged, truth_));
      }
      if (frame < std::max(1, frames / 2)) continue;
      const std::array<std::span<const float>, 2> step{before.texels, last[i].texels};
      if (const auto change = metrics::measure_change(step, 1, truth_.mask))
        changes[i].push_back(change->value * change->value);
    }
  }
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].rule = list_resolve_rules()[i].name;
    records[i].jitter = sequence.jitter;
    if (!changes[i].empty())
      records[i].flicker =
          std::sqrt(std::reduce(changes[i].begin(), changes[i].end()) / static_cast<double>(changes[i].size()));
  }
  return records;
}

std::optional<records::AccumulationRecord> AccumulationMeter::measure(const filters::FilterRequest& request,
                                                                      AccumulatedImages& images) {
  FrameDrawing drawing(rig_, request);
  images::Image converged;
  if (request.spec.kind == filters::FilterKind::kStochastic) {
    ShownFrame other = show_frame(0, false);
    other.number = kOtherFrames;
    converged = drawing.average(other, kConverged);
  }
  records::AccumulationRecord record;
  record.resolves = follow(drawing, {false, truth_.area, converged}, images.resolved);
  std::ranges::move(follow(drawing, {true, jittered_truth_, {}}, images.resolved), std::back_inserter(record.resolves));
  for (const records::ResolveRecord& resolve : record.resolves)
    if (std::ranges::any_of(resolve.rmse, [](double rmse) { return std::isnan(rmse); })) return std::nullopt;
  record.ghosts = measure_ghosts(rig_, ghosts_, drawing, images.stopped);
  record.no_ghosts = ghosts_.absent;
  record.exponential_ms = resolve_ms_.front();
  record.clamped_ms = resolve_ms_.back();
  return record;
}

std::vector<images::ErrorTile> AccumulationMeter::show(const std::string& label,
                                                       const AccumulatedImages& images) const {
  std::vector<images::ErrorTile> tiles;
  const auto add = [&](const std::string& caption, const images::Image& visibility, const images::Image& truth) {
    tiles.push_back({label, caption, visibility, make_error_image(visibility, truth, truth_.mask)});
  };
  for (std::size_t i = 0; i < images.resolved.size(); ++i)
    add(fmt::format("{}, after {} frames with jitter", list_resolve_rules()[i].name, rig_.options.frames),
        images.resolved[i], jittered_truth_);
  for (std::size_t i = 0; i < images.stopped.size(); ++i)
    add(list_resolve_rules()[kFirstExponential + i].name + ", as shadows stop that moved by 4 texels a frame",
        images.stopped[i], std::ranges::find(ghosts_.motions, kShownTexels, &GhostMotion::texels)->end.area);
  return tiles;
}

}  // namespace shadowbench::measure
