#include "harness/measure/accumulation/ghosting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shadowbench::measure {
namespace {

constexpr int kAtRest = 16;          // frames before the motion, and those of what the filter itself sees at rest
constexpr double kTrial_rad = 1e-3;  // small beside what a shadow's caster is seen under
constexpr int kMovingFrames = 8;     // that a shadow moves for
constexpr int kMostAtRest = 64;      // frames that it is followed for then

/// How far the shadow at a receiver moves in the trial, in texels; nothing where there is no shadow.
std::optional<double> find_move(const FrameBench& bench, const LightMap& map, const images::Image& depths,
                                const glm::dvec3& receiver) {
  const scene::Light& light = bench.task.scene->light;
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

GhostMotion make_motion(const FrameBench& bench, double texels, double turn_per_texel) {
  const SceneTruth& start = bench.assets.truth(*bench.task.camera);
  GhostMotion motion;
  motion.texels = texels;
  for (int i = 0; i <= kMovingFrames; ++i)
    motion.lights.push_back(scene::turn_about_vertical(bench.task.scene->light, i * texels * turn_per_texel));
  const scene::Light& last = motion.lights.back();
  motion.end =
      trace_scene(bench.assets.tracer(), last, read_view_receivers(bench.assets.gbuffer(*bench.task.camera), last),
                  bench.options.truth_weight);
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
  GhostHunt(const FrameBench& bench, const GhostMotion& motion, FrameDrawing& drawing)
      : bench_(bench),
        motion_(motion),
        drawing_(drawing),
        resolves_(make_resolves(bench, kFirstExponential)),
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
  const FrameBench& bench_;
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
    const scene::Camera& camera = *bench_.task.camera;
    const scene::Light& shown = motion_.lights[static_cast<std::size_t>(light)];
    if (light != light_) map_.emplace(bench_.assets.make_light_map(shown, camera, bench_.task.map_size));
    light_ = light;
    return {number_++, shown, *map_, bench_.assets.gbuffer(camera)};
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
std::optional<double> find_turn_per_texel(const FrameBench& bench) {
  const SceneTruth& truth = bench.assets.truth(*bench.task.camera);
  const LightMap& map = bench.assets.light_map(*bench.task.camera, bench.task.map_size);
  const images::Image depths = read_linear_depth(map.map);
  std::vector<double> moves;
  for (std::size_t i = 0; i < truth.mask.size(); ++i) {
    if (!truth.mask[i] || truth.hard.texels[i] > 0.0f) continue;
    if (const auto move = find_move(bench, map, depths, glm::dvec3(truth.receivers.image.points[i].position_ws)))
      moves.push_back(*move);
  }
  if (moves.empty()) return std::nullopt;
  const auto middle = moves.begin() + static_cast<std::ptrdiff_t>(moves.size() / 2);
  std::ranges::nth_element(moves, middle);
  constexpr double kLeast = 1e-6;
  return *middle < kLeast ? std::nullopt : std::optional(kTrial_rad / *middle);
}

}  // namespace

GhostBench make_ghost_bench(const FrameBench& bench) {
  GhostBench ghosts;
  if (bench.assets.light_map(*bench.task.camera, bench.task.map_size).layers.size() > 1) {
    ghosts.absent = "the light's map has several layers, and one is followed";
    return ghosts;
  }
  const std::optional<double> turn_per_texel = find_turn_per_texel(bench);
  if (!turn_per_texel) ghosts.absent = "no shadow in view moves when the light turns about the vertical";
  for (const double texels : {1.0, kShownTexels, 16.0})
    if (turn_per_texel) ghosts.motions.push_back(make_motion(bench, texels, *turn_per_texel));
  return ghosts;
}

std::vector<records::GhostRecord> measure_ghosts(const FrameBench& bench, const GhostBench& ghosts,
                                                 FrameDrawing& drawing, std::vector<images::Image>& images) {
  std::vector<records::GhostRecord> records;
  for (const GhostMotion& motion : ghosts.motions) {
    GhostHunt hunt(bench, motion, drawing);
    std::ranges::copy(hunt.run(), std::back_inserter(records));
    if (motion.texels == kShownTexels) images = hunt.at_stop();
  }
  return records;
}

}  // namespace shadowbench::measure
