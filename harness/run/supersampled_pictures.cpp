#include "harness/run/supersampled_pictures.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

#include "base/content_hash.h"
#include "harness/measure/filter_setup.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/shade_pass.h"
#include "harness/run/task_images.h"
#include "report/files/file_name.h"
#include "report/images/canvas.h"
#include "report/images/picture_io.h"
#include "report/pages/answer/answer.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

/// Samples of a whole picture: their G-buffer takes 268 MB.
constexpr int kMostSamples = 1 << 23;
/// Of the truth at a sample; that of a pixel's 16 is as small as it was measured.
constexpr double kStandardError = 0.02;

/// Samples of a pixel along each axis; 1 where more would not fit.
int choose_side(int width, int height) {
  for (const int side : {4, 2})
    if (std::int64_t{width} * height * side * side <= kMostSamples) return side;
  return 1;
}

/// One view through one map, drawn with many samples.
class SampledView {
 public:
  SampledView(measure::Renderer& renderer, const PlannedScene& planned, const measure::SceneTask& task,
              measure::SceneAssets& assets, int side)
      : renderer_(renderer),
        planned_(planned),
        task_(task),
        assets_(assets),
        gbuffer_(side * planned.options.width, side * planned.options.height) {
    assets.draw_view(gbuffer_, *task.camera);
  }

  images::Image draw(const filters::FilterRequest& request) {
    measure::LightMap& light = assets_.light_map(*task_.camera, task_.map_size);
    const auto passes = measure::make_filter_passes(renderer_, planned_.options, planned_.scene, light, request);
    render::ImageTarget target("visibility", GL_R32F, gbuffer_.width(), gbuffer_.height());
    passes->prefilter(light.map);
    passes->lookup(gbuffer_, light.map, target);
    return shade(target.texture(), planned_.options.range);
  }

  images::Image draw_truth() { return shade(render::upload_image(trace()), {}); }

 private:
  measure::Renderer& renderer_;
  const PlannedScene& planned_;
  const measure::SceneTask& task_;
  measure::SceneAssets& assets_;
  render::GBuffer gbuffer_;

  images::Image shade(const gl::Texture& visibility, const filters::RangeRule& range) {
    return images::fit_image(
        render::shade(renderer_.shaders, gbuffer_, visibility, planned_.scene, *task_.camera, range),
        {planned_.options.width, planned_.options.height});
  }

  /// The light that arrives at the samples. Where a pixel's rays and those of its neighbours all agreed, that is known
  /// of the samples on the pixel's own surface.
  images::Image trace() {
    const measure::SceneTruth& truth = assets_.truth(*task_.camera);
    measure::ViewReceivers samples = measure::read_view_receivers(gbuffer_, planned_.scene.light);
    std::vector<std::uint8_t> traced(samples.image.points.size());
    const auto pixel_of = [&](std::size_t sample) {
      const auto width = static_cast<std::size_t>(gbuffer_.width());
      const std::size_t side = width / static_cast<std::size_t>(planned_.options.width);
      return sample / width / side * (width / side) + sample % width / side;
    };
    for (std::size_t i = 0; i < traced.size(); ++i) {
      truth::ReceiverPoint& sample = samples.image.points[i];
      const std::size_t pixel = pixel_of(i);
      const bool is_known = truth.rays.area.rays[pixel] == truth::kRaysOfSettledPixel &&
                            measure::lie_on_one_surface(truth.receivers.image.points[pixel], sample);
      traced[i] = sample.counts && !is_known ? 1 : 0;
    }
    ContentHash hash;
    hash.add(samples.image.content);
    hash.add_values(std::span<const std::uint8_t>(traced));
    truth::ReceiverImage open = samples.image;
    for (std::size_t i = 0; i < traced.size(); ++i) open.points[i].counts = traced[i] != 0;
    open.content = hash.name();
    std::vector<float> arriving =
        assets_.tracer().trace_light(open, scene::make_area_light(planned_.scene.light), kStandardError);
    for (std::size_t i = 0; i < traced.size(); ++i)
      if (traced[i] == 0 && samples.image.points[i].counts) arriving[i] = truth.ratio.texels[pixel_of(i)];
    return samples.to_image(arriving);
  }
};

/// What this run measured of the cells that are shown, in the order of the plan's tasks.
struct ShownCell {
  const PlannedTask* task = nullptr;
  const filters::FilterRequest* request = nullptr;
  records::CellRecord* cell = nullptr;
};

std::vector<ShownCell> list_shown(const RunPlan& plan, std::vector<records::CellRecord>& cells) {
  const std::vector<std::string> keys = pages::list_first_pictures(cells);
  std::vector<ShownCell> shown;
  for (const PlannedTask& task : plan.tasks) {
    if (std::ranges::none_of(keys, [&](const auto& key) { return std::ranges::count(task.keys, key) > 0; })) continue;
    for (const filters::FilterRequest& request : task.task.filters) {
      const std::string key = measure::make_record(plan.scenes[task.scene].options, task.task, request).key;
      if (request.user_file || std::ranges::count(keys, key) == 0) continue;  // one is drawn by a process of its own
      shown.push_back({&task, &request, &*std::ranges::find(cells, key, &records::CellRecord::key)});
    }
  }
  return shown;
}

}  // namespace

void draw_supersampled_pictures(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache,
                                std::vector<records::CellRecord>& cells) {
  const gl::Recorder::Pause pause(renderer.recorder.get());
  std::optional<measure::SceneAssets> assets;
  std::optional<SampledView> view;
  const PlannedTask* before = nullptr;
  std::string truth;
  for (const auto& [task, request, cell] : list_shown(plan, cells)) {
    const PlannedScene& planned = plan.scenes[task->scene];
    const int side = choose_side(planned.options.width, planned.options.height);
    if (side == 1) continue;
    const std::string stem = "images/" + task_stem(planned.options, task->task);
    const std::filesystem::path& out = planned.options.out;
    if (before != task) {
      view.reset();
      if (!before || before->scene != task->scene)
        assets.emplace(renderer, planned.options, planned.scene, cache, measure::padding_texels(planned.options));
      view.emplace(renderer, planned, task->task, *assets, side);
      truth = stem + ".truth.supersampled.png";
      images::write_picture_png(out / truth, view->draw_truth());
      before = task;
    }
    const std::string picture = stem + "." + files::make_file_stem(request->label()) + ".supersampled.png";
    images::write_picture_png(out / picture, view->draw(*request));
    cell->images.supersampled = picture;
    cell->images.truth_supersampled = truth;
    cell->images.samples = side * side;
    records::write_cell(out, *cell);
  }
}

}  // namespace shadowbench::run
