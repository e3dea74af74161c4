#include "harness/measure/accumulation/accumulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "harness/measure/timing/statistics.h"
#include "reference/metrics/error_stats.h"

namespace shadowbench::measure {
namespace {

constexpr int kConverged = 256;                   // frames that noise is measured against
constexpr std::uint32_t kOtherFrames = 1U << 20;  // they are none of those that are measured
constexpr int kTimed = 15;

double find_rmse(const images::Image& image, const images::Image& other, const SceneTruth& truth) {
  const auto error = metrics::measure_error(image.texels, other.texels, truth.mask);
  return error ? error->rmse : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

/// Frames of a view that stands still, and what they are held against.
struct AccumulationMeter::Sequence {
  bool jitter = false;
  const images::Image& truth;
  const images::Image& converged;  ///< empty: noise is not asked for
};

AccumulationMeter::AccumulationMeter(const FrameBench& bench)
    : bench_(bench),
      jittered_(bench.options.width, bench.options.height),
      truth_(bench.assets.truth(*bench.task.camera)),
      jittered_truth_(bench.options.width, bench.options.height, 1),
      ghosts_(make_ghost_bench(bench)) {
  trace_jittered();
  time_resolves();
}

void AccumulationMeter::trace_jittered() {
  const scene::Light& light = bench_.task.scene->light;
  for (int i = 0; i < kJitters; ++i) {
    show_frame(i, true);
    const ViewReceivers receivers = read_view_receivers(jittered_, light);
    images::Image area = receivers.to_image(std::vector<float>(receivers.is_surface.size()));
    if (const SceneTruth traced = trace_scene(bench_.assets.tracer(), light, receivers, bench_.options.truth_weight);
        traced.absent.empty())
      area = traced.area;
    for (std::size_t p = 0; p < area.texels.size(); ++p) jittered_truth_.texels[p] += area.texels[p] / kJitters;
  }
}

void AccumulationMeter::time_resolves() {
  const render::GBuffer& gbuffer = bench_.assets.gbuffer(*bench_.task.camera);
  const gl::Texture visibility = render::upload_image(truth_.area);
  for (render::ResolvePass& resolve : make_resolves(bench_, kFirstExponential)) {
    std::vector<double> times(kTimed);
    for (double& ms : times)
      ms = gl::time_ms(bench_.renderer.timer, [&] {
        resolve.add(bench_.renderer.shaders, *bench_.task.scene, {gbuffer, visibility, *bench_.task.camera});
      });
    resolve_ms_.push_back(summarise(times).median);
  }
}

ShownFrame AccumulationMeter::show_frame(int number, bool jitter) {
  const scene::Camera& camera = *bench_.task.camera;
  if (jitter) bench_.assets.draw_view(jittered_, camera, find_jitter(number));
  return {static_cast<std::uint32_t>(number), bench_.task.scene->light,
          bench_.assets.light_map(camera, bench_.task.map_size), jitter ? jittered_ : bench_.assets.gbuffer(camera)};
}

std::vector<records::ResolveRecord> AccumulationMeter::follow(FrameDrawing& drawing, const Sequence& sequence,
                                                              std::vector<images::Image>& last) {
  std::vector<render::ResolvePass> resolves = make_resolves(bench_);
  std::vector<records::ResolveRecord> records(resolves.size());
  std::vector<std::vector<double>> changes(resolves.size());  // squared, of each step
  last.resize(resolves.size());
  const int frames = bench_.options.frames;
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
  FrameDrawing drawing(bench_, request);
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
  record.ghosts = measure_ghosts(bench_, ghosts_, drawing, images.stopped);
  record.no_ghosts = ghosts_.absent;
  record.exponential_ms = resolve_ms_.front();
  record.clamped_ms = resolve_ms_.back();
  return record;
}

std::vector<images::GridTile> AccumulationMeter::show(const std::string& label, const AccumulatedImages& images) const {
  std::vector<images::GridTile> tiles;
  const auto add = [&](const std::string& caption, const images::Image& visibility, const images::Image& truth) {
    tiles.push_back({label, caption, {}, visibility, make_error_image(visibility, truth, truth_.mask), ""});
  };
  for (std::size_t i = 0; i < images.resolved.size(); ++i)
    add(fmt::format("{}, after {} frames with jitter", list_resolve_rules()[i].name, bench_.options.frames),
        images.resolved[i], jittered_truth_);
  for (std::size_t i = 0; i < images.stopped.size(); ++i)
    add(list_resolve_rules()[kFirstExponential + i].name + ", as shadows stop that moved by 4 texels a frame",
        images.stopped[i], std::ranges::find(ghosts_.motions, kShownTexels, &GhostMotion::texels)->end.area);
  return tiles;
}

}  // namespace shadowbench::measure
