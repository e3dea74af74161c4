#include "harness/run/task_images.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <utility>

#include "harness/measure/stability_meter.h"
#include "harness/run/exr_metadata.h"
#include "report/analysis/summary.h"
#include "report/files/file_name.h"
#include "report/images/color_values.h"
#include "report/images/grid.h"
#include "report/images/picture_io.h"
#include "report/images/value_file.h"
#include "report/records/format.h"

namespace shadowbench::run {
namespace {

std::string caption(const records::CellRecord& cell, const records::GlRecord& gl) {
  std::string text = records::describe_params(cell.params);
  if (!cell.suspect_of.empty()) text += fmt::format("{}SUSPECT: see the report", text.empty() ? "" : " · ");
  if (!cell.time_ms.lookup) return text;
  if (!text.empty()) text += " · ";
  text += fmt::format("lookup {} ms", records::format_number(cell.time_ms.lookup->median));
  if (cell.time_ms.prefilter)
    text += fmt::format(" + prefilter {} ms", records::format_number(cell.time_ms.prefilter->median));
  text += gl.software ? " (CPU)" : " (GPU)";
  if (cell.error.rmse) text += fmt::format(" · RMSE {}", records::format_number(*cell.error.rmse));
  return text;
}

images::Rect choose_crop(const options::RunOptions& options, const std::vector<measure::MeasuredCell>& cells) {
  const auto is_suspect = [](const measure::MeasuredCell& cell) { return !cell.record.suspect_of.empty(); };
  const bool all_are = std::ranges::all_of(cells, is_suspect);
  std::vector<const images::Image*> visibility;
  std::size_t reference = 0;
  for (const measure::MeasuredCell& cell : cells) {
    if (is_suspect(cell) && !all_are) continue;
    if (cell.record.filter == "none") reference = visibility.size();
    visibility.push_back(&cell.visibility);
  }
  return images::find_hardest_edge(visibility, reference, images::choose_crop_size({options.width, options.height}));
}

/// The truth comes first: what every filter would like to look like.
std::vector<images::GridTile> make_truth_tiles(const measure::SceneTask& task, const measure::SceneTruth& truth) {
  if (!truth.absent.empty()) return {};
  const std::string sun = fmt::format("rays to {}, standard error {}", scene::describe_light(task.scene->light),
                                      records::format_number(truth.standard_error));
  return {{"truth, hard", "one ray to the light's centre", truth.hard_picture, truth.hard,
           measure::make_error_image(truth.hard, truth), ""},
          {"truth, area", sun, truth.area_picture, truth.area, measure::make_error_image(truth.area, truth), ""}};
}

/// One scale for the pictures of a task, so that they compare; what suspect cells make does not count. The last tiles
/// are those of the cells. Nothing where there are no errors.
std::optional<double> choose_error_scale(const std::vector<images::GridTile>& tiles,
                                         const std::vector<measure::MeasuredCell>& cells) {
  std::vector<const images::Image*> errors;
  const std::size_t others = tiles.size() - cells.size();
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const bool is_suspect = i >= others && cells[i - others].record.status == records::CellStatus::kSuspect;
    if (!is_suspect && !tiles[i].error.empty()) errors.push_back(&tiles[i].error);
  }
  if (errors.empty()) return std::nullopt;
  return images::choose_error_scale(errors);
}

images::Grid make_grid(const options::RunOptions& options, const measure::SceneTask& task,
                       const measure::SceneMeasurement& measured, const measure::SceneTruth& truth,
                       const records::GlRecord& gl) {
  images::Grid grid;
  grid.title =
      task.scene->title.empty() ? task.scene->name : fmt::format("{}: {}", task.scene->name, task.scene->title);
  grid.subtitle =
      records::describe_settings(measured.cells.front().record) + " · times: " + records::describe_clock(gl);
  const std::string coverage = records::describe_coverage(measured.cells.front().record.coverage);
  if (!coverage.empty()) grid.subtitle += " · " + coverage;
  grid.tiles = make_truth_tiles(task, truth);
  for (const measure::MeasuredCell& cell : measured.cells) {
    grid.tiles.push_back({cell.label, caption(cell.record, gl), cell.picture, cell.visibility,
                          measure::make_error_image(cell.visibility, truth), cell.record.message,
                          images::make_attribution_bar(cell.record)});
    grid.tiles.back().attribution_words = grid.tiles.back().attribution
                                              ? records::describe_shares(*records::list_shares(cell.record))
                                              : "no attribution: " + records::explain_no_attribution(cell.record);
  }
  grid.error_scale = choose_error_scale(grid.tiles, measured.cells);
  grid.columns = truth.absent.empty() ? 4 : 3;
  grid.crop = choose_crop(options, measured.cells);
  return grid;
}

/// Turns values of the view's pixels into an image of one channel.
template <class T>
images::Image make_image(const measure::SceneTruth& truth, const std::vector<T>& values) {
  images::Image image(truth.area.width, truth.area.height, 1);
  std::copy(values.begin(), values.end(), image.texels.begin());
  return image;
}

template <class T>
images::Part make_part(const std::string& name, const measure::SceneTruth& truth, const std::vector<T>& values) {
  return {name, {"Y"}, make_image(truth, values), false};
}

/// Where every pixel's surface is, metres, and its geometric normal: what filters and truth share.
void add_receiver_parts(std::vector<images::Part>& parts, const truth::ReceiverImage& receivers) {
  images::Image position(receivers.width, receivers.height, 3), normal = position;
  for (std::size_t i = 0; i < receivers.points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      position.texels[3 * i + static_cast<std::size_t>(axis)] = receivers.points[i].position_ws[axis];
      normal.texels[3 * i + static_cast<std::size_t>(axis)] = receivers.points[i].normal_ws[axis];
    }
  }
  parts.push_back({"receiver.position", {"X", "Y", "Z"}, std::move(position), false});
  parts.push_back({"receiver.normal", {"X", "Y", "Z"}, std::move(normal), false});
}

/// The truth, how sure it is, and which pixels count for what.
void add_truth_parts(std::vector<images::Part>& parts, const measure::SceneTruth& truth,
                     const std::optional<metrics::ArtefactMasks>& masks) {
  parts.push_back({"truth.hard", {"Y"}, truth.hard, false});
  parts.push_back({kTruthPart, {"Y"}, truth.area, false});
  parts.push_back(make_part("truth.standard_error", truth, truth.rays.area.standard_error));
  parts.push_back(make_part(kTruthMaskPart, truth, truth.mask));
  parts.push_back({kTruthPicturePart, {"R", "G", "B"}, truth.area_picture, true});
  add_receiver_parts(parts, truth.receivers.image);
  if (!masks) return;
  parts.push_back(make_part("truth.mask.acne", truth, masks->acne));
  parts.push_back(make_part("truth.mask.leak", truth, masks->leak));
  parts.push_back(make_part("truth.mask.contact_gap", truth, masks->contact_gap));
}

void add_stability_parts(std::vector<images::Part>& parts, const measure::MeasuredCell& cell) {
  for (const images::StabilityImage& each : images::list_stability_images()) {
    const images::Image& image = cell.stability.*each.image;
    if (!image.empty()) parts.push_back({stability_part(cell.label, each), {"Y"}, image, false});
  }
}

void add_uncertainty_parts(std::vector<images::Part>& parts, const measure::MeasuredCell& cell) {
  for (const images::UncertaintyImage& each : images::list_uncertainty_images()) {
    const images::Image& image = cell.uncertainty.*each.image;
    if (!image.empty()) parts.push_back({uncertainty_part(cell.label, each), {"Y"}, image, false});
  }
}

/// A worker hands its phases to the run that scores them; nobody else needs them.
void add_phase_parts(std::vector<images::Part>& parts, const measure::MeasuredCell& cell) {
  for (std::size_t i = 0; i < cell.phases.size(); ++i)
    parts.push_back({phase_part(cell.label, i), {"Y"}, cell.phases[i], false});
}

/// What is only looked at takes less room in steps: 255 of FLIP, and as many of a part of the error as 16 bits hold.
images::Image round_values(images::Image image, float steps) {
  for (float& value : image.texels) value = std::round(steps * value) / steps;
  return image;
}

/// Keeps 8 significant bits of values that span decades.
images::Image round_significant(images::Image image) {
  for (float& value : image.texels) {
    int exponent = 0;
    const float fraction = std::frexp(value, &exponent);
    if (std::isfinite(value)) value = std::ldexp(std::round(256.0f * fraction) / 256.0f, exponent);
  }
  return image;
}

/// What the page's viewer shows of a cell beside its picture.
images::ValuePlanes list_planes(const measure::MeasuredCell& cell) {
  images::ValuePlanes planes = {{"visibility", cell.visibility}};
  for (std::size_t p = 0; p < cell.error_parts.size(); ++p)
    if (!cell.error_parts[p].empty())
      planes.emplace_back(records::list_error_parts()[p].id, round_values(cell.error_parts[p], 32767.0f));
  if (!cell.flip.empty()) planes.emplace_back("flip", round_values(cell.flip, 255.0f));
  for (const images::StabilityImage& each : images::list_stability_images())
    if (const images::Image& image = cell.stability.*each.image; image.texels.size() == cell.visibility.texels.size())
      planes.emplace_back(fmt::format("stability.{}", each.id), round_significant(image));
  if (!cell.uncertainty.rounding.empty()) planes.emplace_back("rounding", round_significant(cell.uncertainty.rounding));
  return planes;
}

/// Writes a cell's own pictures; no two labels share a file.
void write_cell_pictures(const options::RunOptions& options, const std::string& stem, measure::MeasuredCell& cell) {
  if (cell.picture.empty()) return;
  const std::string base = "images/" + stem + "." + files::make_file_stem(cell.label);
  cell.record.images.picture = base + ".picture.png";
  cell.record.images.visibility = base + ".visibility.png";
  cell.record.images.values = base + ".values.js";
  images::write_picture_png(options.out / *cell.record.images.picture, cell.picture);
  images::write_grey_png(options.out / *cell.record.images.visibility, cell.visibility);
  images::write_value_file(options.out / *cell.record.images.values, *cell.record.images.values, list_planes(cell));
}

/// Writes what the page's viewer shows of the truth.
void write_truth_pictures(const options::RunOptions& options, const std::string& stem,
                          measure::SceneMeasurement& measured, const measure::SceneTruth& truth) {
  if (!truth.absent.empty()) return;
  const std::string picture = "images/" + stem + ".truth.area.png", values = "images/" + stem + ".truth.area.values.js";
  images::write_picture_png(options.out / picture, truth.area_picture);
  images::write_value_file(options.out / values, values,
                           {{"area", truth.area},
                            {"hard", truth.hard},
                            {"standard_error", make_image(truth, truth.rays.area.standard_error)},
                            {"mask", make_image(truth, truth.mask)}});
  for (measure::MeasuredCell& cell : measured.cells) {
    cell.record.images.truth_picture = picture;
    cell.record.images.truth_values = values;
  }
}

/// Writes what is shown of each cell by itself, and of the truth.
void write_shown(const options::RunOptions& options, const std::string& stem, measure::SceneMeasurement& measured,
                 const measure::SceneTruth& truth, const std::function<void(double part)>& on_part) {
  write_truth_pictures(options, stem, measured, truth);
  std::atomic<std::size_t> written = 0;
  tbb::parallel_for_each(measured.cells, [&](measure::MeasuredCell& cell) {
    write_cell_pictures(options, stem, cell);
    on_part(static_cast<double>(++written) / static_cast<double>(measured.cells.size()));
  });
  for (measure::MeasuredCell& cell : measured.cells) measure::write_stability(options, stem, cell);
}

}  // namespace

std::string task_stem(const options::RunOptions& options, const measure::SceneTask& task) {
  std::string name = task.scene->name;
  if (task.scene->cameras.size() > 1) name += "." + task.camera->name;
  if (options.map_sizes.size() > 1) name += fmt::format(".map{}", task.map_size);
  if (options.fits.size() > 1) name += "." + scene::describe_fit(options.fit);
  if (options.sizes.size() > 1) name += fmt::format(".{}x{}", options.width, options.height);
  return files::make_file_stem(name);
}

std::string exr_name(const options::RunOptions& options, const measure::SceneTask& task) {
  return task_stem(options, task) + ".exr";
}

std::string visibility_part(const std::string& label) { return label + ".visibility"; }
std::string picture_part(const std::string& label) { return label + ".picture"; }
std::string unbiased_part(const std::string& label) { return label + ".unbiased"; }

std::string stability_part(const std::string& label, const images::StabilityImage& image) {
  return fmt::format("{}.stability.{}", label, image.id);
}

std::string uncertainty_part(const std::string& label, const images::UncertaintyImage& image) {
  return fmt::format("{}.{}", label, image.id);
}

std::string phase_part(const std::string& label, std::size_t phase) { return fmt::format("{}.phase.{}", label, phase); }

std::string error_part(const std::string& label, const records::ErrorPart& part) {
  return fmt::format("{}.error.{}", label, part.id);
}

void take_float_images(measure::MeasuredCell& cell, std::vector<images::Part>& parts) {
  const std::string& label = cell.label;
  std::map<std::string, images::Image*> places = {{visibility_part(label), &cell.visibility},
                                                  {picture_part(label), &cell.picture},
                                                  {unbiased_part(label), &cell.unbiased}};
  for (std::size_t i = 0; i < cell.phases.size(); ++i) places[phase_part(label, i)] = &cell.phases[i];
  std::vector<images::Image> errors(records::list_error_parts().size());
  for (std::size_t p = 0; p < errors.size(); ++p)
    places[error_part(label, records::list_error_parts()[p])] = &errors[p];
  for (const images::StabilityImage& each : images::list_stability_images())
    places[stability_part(label, each)] = &(cell.stability.*each.image);
  for (const images::UncertaintyImage& each : images::list_uncertainty_images())
    places[uncertainty_part(label, each)] = &(cell.uncertainty.*each.image);
  for (images::Part& part : parts)
    if (const auto place = places.find(part.name); place != places.end()) *place->second = std::move(part.image);
  if (!std::ranges::all_of(errors, &images::Image::empty)) cell.error_parts = std::move(errors);
}

void write_float_images(const options::RunOptions& options, const measure::SceneTask& task,
                        const measure::SceneMeasurement& measured, const measure::SceneTruth& truth,
                        const gl::GlInfo& info) {
  std::vector<images::Part> parts;
  for (const measure::MeasuredCell& cell : measured.cells) {
    if (cell.visibility.empty()) continue;
    parts.push_back({visibility_part(cell.label), {"Y"}, cell.visibility, false});
    parts.push_back({picture_part(cell.label), {"R", "G", "B"}, cell.picture, true});
    if (options.part.is_worker()) parts.push_back({unbiased_part(cell.label), {"Y"}, cell.unbiased, false});
    for (std::size_t p = 0; p < cell.error_parts.size(); ++p) {
      if (cell.error_parts[p].empty()) continue;
      parts.push_back({error_part(cell.label, records::list_error_parts()[p]), {"Y"}, cell.error_parts[p], false});
    }
  }
  for (const measure::MeasuredCell& cell : measured.cells) {
    add_stability_parts(parts, cell);
    add_uncertainty_parts(parts, cell);
    add_phase_parts(parts, cell);
  }
  if (truth.absent.empty()) add_truth_parts(parts, truth, measured.masks);
  parts.push_back({"depth_map", {"Z"}, measured.depth_map, false});
  if (!measured.ambient.empty()) parts.push_back({kAmbientPart, {"R", "G", "B"}, measured.ambient, true});
  images::write_exr(options.out / exr_name(options, task), parts, describe_task(options, task, measured, info));
}

void note_float_images(const options::RunOptions& options, const measure::SceneTask& task,
                       measure::SceneMeasurement& measured) {
  for (measure::MeasuredCell& cell : measured.cells) {
    cell.record.images.exr = exr_name(options, task);
    cell.record.images.parts = cell.label;
    if (!options.pictures) cell.record.absent["images"] = "the run was made with --no-pictures";
  }
}

void write_single_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                           measure::SceneMeasurement& measured, const measure::SceneTruth& truth) {
  write_shown(options, task_stem(options, task), measured, truth, [](double) {});
  for (measure::MeasuredCell& cell : measured.cells) cell.record.absent["images"] = "the run was made with --no-grids";
}

void write_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                    measure::SceneMeasurement& measured, const measure::SceneTruth& truth, const records::GlRecord& gl,
                    const std::function<void(double part)>& on_part) {
  const std::string stem = task_stem(options, task);
  const std::string grid_name = stem + ".grid.png";
  images::write_grid(options.out / grid_name, make_grid(options, task, measured, truth, gl));
  on_part(0.5);
  write_shown(options, stem, measured, truth, [&](double part) { on_part(0.5 + 0.5 * part); });
  for (measure::MeasuredCell& cell : measured.cells) cell.record.images.grid = grid_name;
}

}  // namespace shadowbench::run
