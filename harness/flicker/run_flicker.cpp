#include "harness/flicker/run_flicker.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/atomic_file.h"
#include "base/error.h"
#include "harness/flicker/bench.h"
#include "harness/run/provenance.h"
#include "harness/run/scene_loading.h"
#include "report/files/folder_lock.h"
#include "report/images/heat_figures.h"
#include "report/pages/flicker_page.h"
#include "report/pages/write_page.h"
#include "report/records/flicker_record.h"

namespace shadowbench::flicker {
namespace {

using Clock = std::chrono::steady_clock;
using Stats = std::vector<metrics::FlickerStats>;

records::FlickerMotion describe_motion(Motion motion, double step) {
  records::FlickerMotion record;
  record.id = name_of(motion);
  record.fit = scene::name_of(fit_of(motion));
  record.picture = fmt::format("flicker.{}.png", record.id);
  if (motion == Motion::kLight) {
    record.title = "The light turns";
    record.how = fmt::format(
        "The sun turns about the vertical; the step is chosen so that the median receiver moves by {:g} texels in the "
        "map without snapping, in the first step.",
        kStepTexels);
    record.step = glm::degrees(step);
    record.step_unit = "degrees";
  } else {
    record.title = "The camera moves";
    record.how = fmt::format(
        "The camera moves to its right by {:g} of a texel's width a step, and the light's map follows what it sees.",
        kStepTexels);
    record.step = step;
    record.step_unit = "m";
  }
  return record;
}

images::Image to_image(const metrics::FlickerStats& stats, const options::RunOptions& options) {
  return images::make_image(options.width, options.height, stats.by_pixel);
}

class FlickerRun {
 public:
  FlickerRun(const FlickerOptions& options, options::Progress& progress)
      : options_(options),
        progress_(progress),
        motions_(parse_motions(options.motions)),
        scene_(run::load_scene(options.run, options.run.scenes.front())),
        renderer_(measure::make_renderer(options.run.backend, options.run.resources)),
        cache_(options.run.cache, [&progress](const std::string& message) { progress.note("warning: " + message); }),
        bench_(renderer_, options.run, scene_, cache_) {}

  void run() {
    const files::FolderLock lock(options_.run.out,
                                 options_.run.force);  // a folder that cannot be written is better found now
    const auto start = Clock::now();
    describe();
    progress_.begin(count_frames(), 0);
    for (const Motion motion : motions_) record_.motions.push_back(measure(motion));
    record_.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    progress_.show(done_, "writing");
    lock.require_in_place();
    pages::write_page(options_.run.out, "flicker", pages::make_flicker_page(record_));
    write_text_file(options_.run.out / "flicker.csv", records::make_flicker_csv(record_));
    write_text_file(options_.run.out / "flicker.json", records::make_flicker_json(record_));
  }

 private:
  const FlickerOptions& options_;
  options::Progress& progress_;
  std::vector<Motion> motions_;
  scene::Scene scene_;
  measure::Renderer renderer_;
  truth::TruthCache cache_;
  FlickerBench bench_;
  records::FlickerRecord record_;
  int done_ = 0;

  int count_frames() const {
    int passes = 0;
    for (const Motion motion : motions_)
      passes += motion == Motion::kLight ? 3 : 2;  // the truth, and without and with snapping
    return passes * options_.frames;
  }

  void describe() {
    for (const std::string& reason : renderer_.refused) progress_.note("not used: " + reason);
    static_cast<records::Provenance&>(record_) =
        run::describe_provenance(renderer_, options_.run.seed, options_.run.command);
    record_.scene = scene_.name;
    record_.view = scene_.cameras.front().name;
    record_.width = options_.run.width;
    record_.height = options_.run.height;
    record_.map_size = options_.run.map_sizes.front();
    record_.frames = options_.frames;
    record_.return_above = metrics::kReturn;
  }

  std::function<void(int)> show(const std::string& what) {
    return [this, what](int frame) {
      progress_.show(done_++, fmt::format("{} · frame {} of {}", what, frame + 1, options_.frames));
    };
  }

  records::FlickerVariant describe_variant(bool snap, const std::vector<scene::LightFrustum>& frusta,
                                           const std::vector<std::uint8_t>& mask) const {
    records::FlickerVariant variant;
    variant.snap = snap;
    variant.texel_m = frusta.front().texel_size_ws;
    variant.grid_texels = measure_grid_move(bench_.receivers().image, mask, frusta, record_.map_size).value();
    variant.resizes = count_resizes(frusta);
    return variant;
  }

  records::FlickerMotion measure(Motion motion) {
    const double step = choose_step(motion, scene_, bench_.receivers().image, bench_.following(false));
    records::FlickerMotion record = describe_motion(motion, step);
    const std::vector<Frame> frames = make_frames(motion, scene_, step, options_.frames);
    std::vector<std::vector<scene::LightFrustum>> frusta;
    for (const bool snap : {false, true}) frusta.push_back(fit_frames(motion, scene_, frames, bench_.following(snap)));
    const std::vector<std::uint8_t> mask = mark(frusta);
    const TruthFrames truth = bench_.trace(motion, frames, mask, show(record.id + " · truth"));
    std::vector<Stats> stats;
    for (std::size_t v = 0; v < frusta.size(); ++v) {
      records::FlickerVariant& variant = record.variants.emplace_back(describe_variant(v == 1, frusta[v], mask));
      stats.push_back(bench_.measure(frusta[v], mask, truth, show(record.id + (variant.snap ? " · snapped" : ""))));
      for (std::size_t i = 0; i < stats[v].size(); ++i)
        variant.filters.push_back({.filter = options_.run.filters[i].label(),
                                   .change = stats[v][i].change,
                                   .flicker = stats[v][i].flicker,
                                   .returning = stats[v][i].returning,
                                   .not_finite = stats[v][i].not_finite,
                                   .step_change = stats[v][i].step_change});
    }
    const metrics::FlickerStats& any = stats.front().front();
    record.receivers = any.receivers;
    record.truth = {.moves = truth.traced,
                    .change = any.truth_change,
                    .returning = any.truth_returning,
                    .noise = truth.noise,
                    .step_change = any.truth_step_change};
    write_picture(record, stats);
    return record;
  }

  /// Marks the receivers that count both without snapping and with it.
  std::vector<std::uint8_t> mark(const std::vector<std::vector<scene::LightFrustum>>& frusta) const {
    std::vector<scene::LightFrustum> all;
    for (const auto& some : frusta) all.insert(all.end(), some.begin(), some.end());
    std::vector<std::uint8_t> mask =
        mark_receivers(bench_.receivers().image, all, record_.map_size, bench_.following(false).pad_texels);
    if (std::ranges::count(mask, std::uint8_t{1}) > 0) return mask;
    throw Error(ErrorKind::kInput, fmt::format("{}: no receiver faces the light and stays in its map in all {} frames; "
                                               "give fewer --frames, a larger --map-size or another --scene",
                                               scene_.name, options_.frames));
  }

  void write_picture(const records::FlickerMotion& motion, const std::vector<Stats>& stats) const {
    images::Figure figure;
    figure.title = fmt::format("{}: flicker by pixel on {}", motion.title, scene_.name);
    figure.note = fmt::format(
        "root mean square, over {} steps, of the change of visibility less the truth's; map {}, {:.3g} {} a step",
        options_.frames - 1, record_.map_size, motion.step, motion.step_unit);
    for (std::size_t i = 0; i < options_.run.filters.size(); ++i) {
      const std::string label = options_.run.filters[i].label();
      figure.stacks.push_back(images::show_flicker(label, to_image(stats[0][i], options_.run)));
      figure.stacks.push_back(images::show_flicker(label + ", snapped", to_image(stats[1][i], options_.run)));
    }
    figure.columns = 4;
    figure.legend = {images::show_flicker_scale()};
    images::write_figure(options_.run.out / motion.picture, figure);
  }
};

}  // namespace

void run_flicker(const FlickerOptions& options, options::Progress& progress) { FlickerRun(options, progress).run(); }

}  // namespace shadowbench::flicker
