#include "harness/run/report_pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <tuple>

#include "base/bytes.h"
#include "base/files.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/picture_passes.h"
#include "harness/run/float_images.h"
#include "harness/run/task_images.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cells.h"
#include "report/analysis/measures.h"
#include "report/images/canvas.h"
#include "report/images/heat_figures.h"
#include "report/images/picture_io.h"
#include "report/pages/answer.h"
#include "report/records/format.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

/// One light of a scene, through one view and map settings: what was measured of it, and what was drawn.
struct Lit {
  const PlannedScene* scene;
  const PlannedTask* task;
  std::vector<records::CellRecord> cells;
  images::ExrFile file;
};

/// Tasks that differ in the light alone.
std::vector<std::vector<Lit>> group_lights(const RunPlan& plan) {
  std::map<std::tuple<std::string, std::string, int, std::string, int, int>, std::vector<Lit>> groups;
  for (const PlannedTask& task : plan.tasks) {
    const PlannedScene& scene = plan.scenes[task.scene];
    if (scene.scene.light.name.empty()) continue;
    groups[{scene::name_without_light(scene.scene), task.task.camera->name, task.task.map_size,
            scene::describe_fit(scene.options.fit), scene.options.width, scene.options.height}]
        .push_back({&scene, &task, {}, {}});
  }
  std::vector<std::vector<Lit>> list;
  for (auto& [key, group] : groups)
    if (group.size() > 1) list.push_back(std::move(group));
  return list;
}

/// Whether all that was measured and drawn of a light could be read.
bool read_lights(Lit& lit, const options::RunOptions& options) {
  try {
    lit.cells = records::read_cells(options.out, lit.task->keys);
    lit.file = images::read_exr(options.out / exr_name(lit.scene->options, lit.task->task));
    return true;
  } catch (const Error&) {
    return false;  // another shard's, or drawn with --no-grids
  }
}

const images::Image* find_part(const Lit& lit, const std::string& name) {
  const auto found = std::ranges::find(lit.file.parts, name, &images::Part::name);
  return found == lit.file.parts.end() ? nullptr : &found->image;
}

/// The sum of a part over all lights. Each holds the ambient light, which counts once. Empty where one has none.
images::Image add_up(const std::vector<Lit>& lights, const std::string& part) {
  images::Image sum;
  for (const Lit& lit : lights) {
    const images::Image *own = find_part(lit, part), *ambient = find_part(lit, kAmbientPart);
    if (!own || !ambient) return {};
    if (sum.empty()) sum = *ambient;
    for (std::size_t i = 0; i < sum.texels.size(); ++i) sum.texels[i] += own->texels[i] - ambient->texels[i];
  }
  return sum;
}

/// What a frame costs whose lights all move; nothing where several kinds of machine measured the lights.
std::string describe_frame(const std::vector<Lit>& lights, const std::string& label, const records::GlRecord& gl) {
  std::vector<records::CellRecord> cells;
  for (const Lit& lit : lights) {
    const auto cell = std::ranges::find(lit.cells, label, [](const auto& c) { return c.images.parts.value_or(""); });
    if (cell == lit.cells.end()) return {};
    cells.push_back(*cell);
  }
  if (auto withheld = analysis::withhold_mixed_times(cells)) cells = std::move(*withheld);
  const analysis::CostKind kind = analysis::choose_cost(cells);
  const auto cost = analysis::measure_cost(analysis::point_to(cells), kind, analysis::LightMotion::kMoving);
  if (!cost) return {};
  return fmt::format("{} for all {} lights, each with a map of its own",
                     analysis::format_cost(cost->mean * static_cast<double>(lights.size()), kind, gl), lights.size());
}

/// The factor that keeps all but the brightest hundredth of a picture in range.
double choose_exposure(const images::Image& picture) {
  std::vector<float> values = picture.texels;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return 1.0 / std::max(static_cast<double>(*place), 1.0);
}

images::Figure make_figure(const std::vector<Lit>& lights, const records::GlRecord& gl) {
  images::Figure figure;
  figure.columns = 3;
  std::vector<std::string> names;
  for (const Lit& lit : lights) names.push_back(lit.scene->scene.light.name);
  figure.title = fmt::format("{}: all lights at once", scene::name_without_light(lights.front().scene->scene));
  figure.note = fmt::format("{}: {}; ambient light counts once. Each is measured by itself", names.size(),
                            fmt::join(names, ", "));
  double exposure = 1.0;
  const auto add = [&](const std::string& label, const std::string& caption, const std::string& part) {
    const images::Image picture = add_up(lights, part);
    if (picture.empty()) return;
    if (figure.stacks.empty()) exposure = choose_exposure(picture);
    figure.stacks.push_back({{label, caption, images::show_picture(picture, exposure)}});
  };
  add("truth, area", "rays to each light", kTruthPicturePart);
  for (const records::CellRecord& cell : lights.front().cells) {
    const std::string label = cell.images.parts.value_or("");
    if (!label.empty()) add(label, describe_frame(lights, label, gl), picture_part(label));
  }
  return figure;
}

/// Samples of a part: their G-buffer takes 268 MB.
constexpr int kMostSamples = 1 << 23;
/// Samples of a pixel along each axis; 1 where more would not fit.
int choose_side(const images::Rect& part) {
  for (const int side : {4, 2})
    if (std::int64_t{part.width} * part.height * side * side <= kMostSamples) return side;
  return 1;
}

/// A part of one view through one map, drawn with many samples.
class SampledView {
 public:
  SampledView(const measure::TaskRig& rig, const images::Rect& part, int side)
      : rig_(rig), part_(part), side_(side), gbuffer_(side * part.width, side * part.height) {
    const glm::ivec2 size(rig.options.width, rig.options.height);
    const glm::ivec2 corner(part.x, size.y - part.y - part.height);
    rig.assets.draw_view(gbuffer_, *rig.task.camera, {}, render::PictureWindow{side * corner, side * size});
  }

  images::Image draw(const filters::FilterRequest& request) {
    const render::ShadowMap& map = rig_.light().map;
    const auto passes = rig_.make_passes(request);
    passes->prefilter(map);
    const auto look = [&](const render::GBuffer& gbuffer) {
      render::ImageTarget target("visibility", GL_R32F, gbuffer.width(), gbuffer.height());
      passes->lookup(gbuffer, map, target);
      return shade(gbuffer, target.texture(), rig_.options.range);
    };
    return put(look(gbuffer_), look(rig_.gbuffer()));
  }

  images::Image draw_truth() {
    return put(shade(gbuffer_, render::upload_image(trace()), {}), rig_.truth().area_picture);
  }

 private:
  const measure::TaskRig rig_;
  images::Rect part_;
  int side_;
  render::GBuffer gbuffer_;

  images::Image shade(const render::GBuffer& gbuffer, const gl::Texture& visibility, const filters::RangeRule& range) {
    return render::shade(rig_.renderer.shaders, gbuffer, visibility, *rig_.task.scene, *rig_.task.camera, range);
  }

  /// The part's mean samples in the whole picture.
  images::Image put(const images::Image& samples, images::Image whole) const {
    images::paste_image(whole, images::fit_image(samples, {part_.width, part_.height}), part_.x, part_.y);
    return whole;
  }

  /// The light that arrives at the samples. Where a pixel's rays and those of its neighbours all agreed, that is known
  /// of the samples on the pixel's own surface.
  images::Image trace() {
    const measure::SceneTruth& truth = rig_.truth();
    const scene::Light& light = rig_.task.scene->light;
    measure::ViewReceivers samples = measure::read_view_receivers(gbuffer_, light);
    const auto pixel_of = [&, side = static_cast<std::size_t>(side_)](std::size_t sample) {
      const auto width = static_cast<std::size_t>(gbuffer_.width());
      const std::size_t x = static_cast<std::size_t>(part_.x) + sample % width / side,
                        y = static_cast<std::size_t>(part_.y) + sample / width / side;
      return y * static_cast<std::size_t>(rig_.options.width) + x;
    };
    std::vector<std::uint8_t> is_known(samples.image.points.size());
    for (std::size_t i = 0; i < is_known.size(); ++i) {
      truth::ReceiverPoint& sample = samples.image.points[i];
      const std::size_t pixel = pixel_of(i);
      if (truth.rays.area.rays[pixel] != truth::kRaysOfSettledPixel ||
          !measure::lie_on_one_surface(truth.receivers.image.points[pixel], sample))
        continue;
      is_known[i] = 1;
      sample.counts = false;  // while the others are traced
    }
    ContentHash hash;
    hash.add(samples.image.content);
    hash.add_values(std::span<const std::uint8_t>(is_known));
    samples.image.content = hash.name();
    std::vector<float> arriving = rig_.assets.tracer().trace_light(samples.image, scene::make_area_light(light));
    for (std::size_t i = 0; i < is_known.size(); ++i) {
      if (is_known[i] == 0) continue;
      samples.image.points[i].counts = true;
      arriving[i] = truth.ratio.texels[pixel_of(i)];
    }
    return samples.to_image(arriving);
  }
};

/// What this run measured of the cells that are shown, in the order of the plan's tasks.
struct ShownCell {
  const PlannedTask* task = nullptr;
  const filters::FilterRequest* request = nullptr;
  records::CellRecord* cell = nullptr;
  images::Rect part = {};  ///< of all that are shown of its task, whole pixels
};

/// The whole pixels that hold parts.
class Bounds {
 public:
  void add(const std::array<double, 4>& part) {
    low_ = glm::min(low_, glm::ivec2(glm::floor(glm::dvec2(part[0], part[1]))));
    high_ = glm::max(high_, glm::ivec2(glm::ceil(glm::dvec2(part[0] + part[2], part[1] + part[3]))));
  }
  images::Rect rect() const { return {low_.x, low_.y, high_.x - low_.x, high_.y - low_.y}; }

 private:
  glm::ivec2 low_{std::numeric_limits<int>::max()}, high_{0};
};

std::vector<ShownCell> list_shown(const RunPlan& plan, std::vector<records::CellRecord>& cells) {
  const std::vector<pages::FirstPicture> first = pages::list_first_pictures(cells);
  std::vector<ShownCell> shown;
  for (const PlannedTask& task : plan.tasks) {
    Bounds bounds;
    for (const auto& [key, part] : first)
      if (std::ranges::count(task.keys, key) > 0) bounds.add(part);
    if (bounds.rect().width < 0) continue;
    for (const filters::FilterRequest& request : task.task.filters) {
      const std::string key = measure::make_record(plan.scenes[task.scene].options, task.task, request).key;
      if (request.user_file || std::ranges::count(first, key, &pages::FirstPicture::key) == 0)
        continue;  // a user's is drawn by a process of its own
      shown.push_back({&task, &request, &*std::ranges::find(cells, key, &records::CellRecord::key), bounds.rect()});
    }
  }
  return shown;
}

}  // namespace

void draw_all_lights(const options::RunOptions& options, const RunPlan& plan, const records::GlRecord& gl) {
  for (std::vector<Lit>& lights : group_lights(plan)) {
    if (!std::ranges::all_of(lights, [&](Lit& lit) { return read_lights(lit, options); })) continue;
    const images::Figure figure = make_figure(lights, gl);
    if (figure.stacks.empty()) continue;
    const Lit& first = lights.front();
    const std::string stem = task_stem(first.scene->options, first.task->task);
    const std::string file = make_file_stem(scene::name_without_light(first.scene->scene)) +
                             stem.substr(make_file_stem(first.scene->scene.name).size()) + ".all_lights.grid.png";
    images::write_figure(options.out / file, figure);
    for (Lit& lit : lights) {
      for (records::CellRecord& cell : lit.cells) {
        cell.images.all_lights = file;
        records::write_cell(options.out, cell);
      }
    }
  }
}

void draw_supersampled_pictures(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache,
                                std::vector<records::CellRecord>& cells) {
  const gl::Recorder::Pause pause(renderer.recorder.get());
  std::optional<measure::SceneAssets> assets;
  std::optional<SampledView> view;
  const PlannedTask* before = nullptr;
  std::string truth;
  for (const auto& [task, request, cell, part] : list_shown(plan, cells)) {
    const PlannedScene& planned = plan.scenes[task->scene];
    const int side = choose_side(part);
    if (side == 1) continue;
    const std::string stem = "images/" + task_stem(planned.options, task->task);
    const std::filesystem::path& out = planned.options.out;
    if (before != task) {
      view.reset();
      if (!before || before->scene != task->scene)
        assets.emplace(renderer, planned.options, planned.scene, cache, measure::padding_texels(planned.options));
      view.emplace(measure::TaskRig{renderer, planned.options, task->task, *assets}, part, side);
      truth = stem + ".truth.supersampled.png";
      images::write_picture_png(out / truth, view->draw_truth());
      before = task;
    }
    const std::string picture = stem + "." + make_file_stem(request->label()) + ".supersampled.png";
    images::write_picture_png(out / picture, view->draw(*request));
    cell->images.supersampled = picture;
    cell->images.truth_supersampled = truth;
    cell->images.samples = side * side;
    records::write_cell(out, *cell);
  }
}

}  // namespace shadowbench::run
