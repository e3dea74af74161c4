#include "harness/run/all_lights.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "harness/run/float_images.h"
#include "harness/run/task_images.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/trade_measures.h"
#include "report/files/file_name.h"
#include "report/images/grid.h"
#include "report/images/picture_io.h"
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
bool read(Lit& lit, const options::RunOptions& options) {
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

images::Grid make_grid(const std::vector<Lit>& lights, const records::GlRecord& gl) {
  images::Grid grid;
  std::vector<std::string> names;
  for (const Lit& lit : lights) names.push_back(lit.scene->scene.light.name);
  grid.title = fmt::format("{}: all lights at once", scene::name_without_light(lights.front().scene->scene));
  grid.subtitle = fmt::format("{}: {}; ambient light counts once. Each is measured by itself", names.size(),
                              fmt::join(names, ", "));
  const auto add = [&](const std::string& label, const std::string& caption, const std::string& part) {
    images::Image picture = add_up(lights, part);
    if (!picture.empty()) grid.tiles.push_back({label, caption, std::move(picture), {}, {}, ""});
  };
  add("truth, area", "rays to each light", kTruthPicturePart);
  for (const records::CellRecord& cell : lights.front().cells) {
    const std::string label = cell.images.parts.value_or("");
    if (!label.empty()) add(label, describe_frame(lights, label, gl), picture_part(label));
  }
  if (!grid.tiles.empty()) grid.exposure = choose_exposure(grid.tiles.front().picture);
  return grid;
}

}  // namespace

void draw_all_lights(const options::RunOptions& options, const RunPlan& plan, const records::GlRecord& gl) {
  for (std::vector<Lit>& lights : group_lights(plan)) {
    if (!std::ranges::all_of(lights, [&](Lit& lit) { return read(lit, options); })) continue;
    const images::Grid grid = make_grid(lights, gl);
    if (grid.tiles.empty()) continue;
    const Lit& first = lights.front();
    const std::string stem = task_stem(first.scene->options, first.task->task);
    const std::string file = files::make_file_stem(scene::name_without_light(first.scene->scene)) +
                             stem.substr(files::make_file_stem(first.scene->scene.name).size()) +
                             ".all_lights.grid.png";
    images::write_grid(options.out / file, grid);
    for (Lit& lit : lights) {
      for (records::CellRecord& cell : lit.cells) {
        cell.images.all_lights = file;
        records::write_cell(options.out, cell);
      }
    }
  }
}

}  // namespace shadowbench::run
