#include "report/regress/baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "report/images/picture_io.h"
#include "report/records/json_values.h"

namespace shadowbench::regress {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr int kBaselineVersion = 1;
constexpr const char* kTruthStem = "truth.area";
constexpr const char* kVisibility = "visibility";

/// Calls `visit(name, value)` with what is written of a cell, but for its values; `Cell` is const where it is read
/// only.
template <class Cell, class Visit>
void visit_fields(Cell& cell, const Visit& visit) {
  visit("key", cell.key);
  visit("scene", cell.scene);
  visit("view", cell.view);
  visit("filter", cell.filter);
  visit("label", cell.label);
  visit("map_size", cell.map_size);
  visit("width", cell.width);
  visit("height", cell.height);
  visit("seed", cell.origin.seed);
  visit("renderer", cell.origin.renderer);
  visit("machine", cell.origin.machine);
  visit("commit", cell.origin.commit);
}

ordered_json to_json(const BaselineCell& cell) {
  ordered_json written;
  visit_fields(cell, [&](const char* name, const auto& value) { written[name] = value; });
  written["values"] = ordered_json::object();
  for (const auto& [path, value] : cell.values.numbers) written["values"][path] = records::number_json(value);
  written["ratios"] = ordered_json::object();
  for (const auto& [path, ratio] : cell.values.ratios) written["ratios"][path] = records::value_json(ratio);
  return written;
}

BaselineCell from_json(const json& read) {
  BaselineCell cell;
  visit_fields(cell, [&]<class T>(const char* name, T& value) { value = records::read_value<T>(read.at(name)); });
  for (const auto& [path, value] : read.at("values").items())
    cell.values.numbers[path] = records::read_value<double>(value);
  for (const auto& [path, value] : read.at("ratios").items())
    cell.values.ratios[path] = records::read_value<records::Ratio>(value);
  return cell;
}

constexpr const char* kAdvice = "restore the file, or remove its folder and accept a run again";

std::vector<BaselineCell> read_cell_list(const std::filesystem::path& file) {
  const json root = records::read_json_file(file, 1024 * kMebibyte, kAdvice);
  try {
    if (root.at("baseline_version") != kBaselineVersion)
      throw std::invalid_argument(fmt::format("it is of another version than {}", kBaselineVersion));
    std::vector<BaselineCell> cells;
    for (const json& cell : root.at("cells")) cells.push_back(from_json(cell));
    return cells;
  } catch (const std::exception& error) {
    fail_input(fmt::format("this is no baseline of cells: {}; {}", error.what(), kAdvice), file.string());
  }
}

std::vector<images::Part> read_parts(const std::filesystem::path& file) {
  try {
    return images::read_exr(file).parts;
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}; {}", error.message(), kAdvice), error.where());
  }
}

std::filesystem::path with_extension(std::filesystem::path stem, const char* extension) { return stem += extension; }

images::Part make_part(const std::string& key, const char* id, const images::Image& image) {
  return {key + "." + id, {"Y"}, image, true};
}

std::vector<images::Part> make_parts(const CellFile& file) {
  std::vector<images::Part> parts;
  for (const BaselineCell& cell : file.cells) {
    const auto found = file.images.find(cell.key);
    if (found == file.images.end() || found->second.visibility.empty()) continue;
    const CellImages& images = found->second;
    parts.push_back(make_part(cell.key, kVisibility, images.visibility));
    for (const images::UncertaintyImage& each : images::list_uncertainty_images()) {
      const images::Image& image = images.uncertainty.*each.image;
      if (!image.empty()) parts.push_back(make_part(cell.key, each.id, image));
    }
  }
  return parts;
}

void keep_part(std::map<std::string, CellImages>& images, images::Part part) {
  const std::size_t dot = part.name.rfind('.');
  if (dot == std::string::npos) return;
  CellImages& cell = images[part.name.substr(0, dot)];
  const std::string id = part.name.substr(dot + 1);
  if (id == kVisibility) cell.visibility = std::move(part.image);
  for (const images::UncertaintyImage& each : images::list_uncertainty_images())
    if (id == each.id) cell.uncertainty.*each.image = std::move(part.image);
}

/// The entries of a folder, sorted; none where there is no such folder.
std::vector<std::filesystem::path> list_folder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> entries;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    entries.push_back(at->path());
  if (error && error != std::errc::no_such_file_or_directory) {
    throw Error(ErrorKind::kInput, fmt::format("the folder cannot be listed ({}); check its rights", error.message()),
                folder.string());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

void remove_file(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error)
    throw Error(ErrorKind::kOutput,
                fmt::format("the file cannot be removed ({}); check the folder's rights", error.message()),
                file.string());
}

}  // namespace

CellName name_cell(const records::CellRecord& cell) {
  return {cell.key, cell.scene, cell.view, cell.filter, cell.images.parts.value_or(cell.filter)};
}

std::string truth_key(const records::CellRecord& cell) {
  return fmt::format("{} {}x{} {}", make_file_stem(cell.view), cell.width, cell.height, cell.light);
}

bool Baseline::exists() const {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(folder_, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_directory(status))
    throw Error(ErrorKind::kInput, "this is a file: name the folder of a baseline", folder_.string());
  return std::filesystem::exists(tolerance_file(), error);
}

std::filesystem::path Baseline::stem(const std::string& scene, const std::string& filter) const {
  return folder_ / make_file_stem(scene) / make_file_stem(filter);
}

std::vector<BaselineCell> Baseline::list_cells() const {
  std::vector<BaselineCell> cells;
  for (const std::filesystem::path& folder : list_folder(folder_)) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const std::filesystem::path& file : list_folder(folder))
      if (file.extension() == ".json" && !is_temporary(file))
        std::ranges::move(read_cell_list(file), std::back_inserter(cells));
  }
  return cells;
}

CellFile Baseline::read_cells(const std::string& scene, const std::string& filter) const {
  const std::filesystem::path numbers = with_extension(stem(scene, filter), ".json");
  if (!std::filesystem::exists(numbers)) return {};
  CellFile file{read_cell_list(numbers), {}};
  const std::filesystem::path images = with_extension(stem(scene, filter), ".exr");
  for (images::Part& part : read_parts(images)) keep_part(file.images, std::move(part));
  return file;
}

void Baseline::write_cells(const std::string& scene, const std::string& filter, const CellFile& cells) {
  const std::filesystem::path numbers = with_extension(stem(scene, filter), ".json"),
                              images = with_extension(stem(scene, filter), ".exr");
  if (cells.cells.empty()) {
    remove_file(numbers);
    remove_file(images);
    return;
  }
  ordered_json root = {{"baseline_version", kBaselineVersion}, {"cells", ordered_json::array()}};
  for (const BaselineCell& cell : cells.cells) root["cells"].push_back(to_json(cell));
  const std::vector<images::Part> parts = make_parts(cells);
  if (parts.empty())
    remove_file(images);
  else
    images::write_exr(images, parts, {});
  write_text_file(numbers, root.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

std::map<std::string, TruthImages> Baseline::read_truths(const std::string& scene) const {
  std::map<std::string, TruthImages> truths;
  const std::filesystem::path file = with_extension(stem(scene, kTruthStem), ".exr");
  if (!std::filesystem::exists(file)) return truths;
  for (images::Part& part : read_parts(file)) {
    const std::size_t dot = part.name.rfind('.');
    TruthImages& truth = truths[part.name.substr(0, dot)];
    (part.name.substr(dot + 1) == "area" ? truth.area : truth.standard_error) = std::move(part.image);
  }
  return truths;
}

void Baseline::write_truths(const std::string& scene, const std::map<std::string, TruthImages>& truths) {
  const std::filesystem::path file = with_extension(stem(scene, kTruthStem), ".exr");
  if (truths.empty()) {
    remove_file(file);
    return;
  }
  std::vector<images::Part> parts;
  for (const auto& [key, truth] : truths) {
    parts.push_back(make_part(key, "area", truth.area));
    parts.push_back(make_part(key, "standard_error", truth.standard_error));
  }
  images::write_exr(file, parts, {});
}

namespace {

constexpr float kNegligibleBound = 0x1p-14f;

/// What a pixel was given, of coarse bounds: 0 stands for anything below kNegligibleBound.
float bound_at(const images::Image& rounding, std::size_t i) {
  return rounding.empty() ? 0.0f : std::max(rounding.texels[i], kNegligibleBound);
}

float coarsen(float bound) {
  if (bound == images::kMayFlip) return bound;
  if (bound < kNegligibleBound) return 0.0f;
  if (!(bound < kWidestBound)) return 1.0f;
  return std::exp2(std::ceil(std::log2(bound)));
}

bool says_nothing(float bound) { return bound >= kWidestBound && bound != images::kMayFlip; }

}  // namespace

images::Image coarsen_rounding(const images::Image& rounding) {
  images::Image coarse = rounding;
  for (float& bound : coarse.texels) bound = coarsen(bound);
  return coarse;
}

PixelChange compare_pixels(const CellImages& actual, const CellImages& expected, double tolerance) {
  assert(actual.visibility.texels.size() == expected.visibility.texels.size());
  PixelChange change;
  const images::Image bounds = coarsen_rounding(actual.uncertainty.rounding),
                      known_bounds = coarsen_rounding(expected.uncertainty.rounding);
  const auto width = static_cast<std::size_t>(actual.visibility.width);
  for (std::size_t i = 0; i < actual.visibility.texels.size(); ++i) {
    const float own = bound_at(bounds, i), known = bound_at(known_bounds, i);
    // A pixel that is not finite on both sides counts as the same; the metric 'nan' limits how many there are.
    const bool same = !std::isfinite(actual.visibility.texels[i]) && !std::isfinite(expected.visibility.texels[i]);
    const bool finite =
        same || (std::isfinite(actual.visibility.texels[i]) && std::isfinite(expected.visibility.texels[i]));
    const double difference = same     ? 0.0
                              : finite ? std::abs(static_cast<double>(actual.visibility.texels[i]) -
                                                  static_cast<double>(expected.visibility.texels[i]))
                                       : 1.0;
    if (known == images::kMayFlip || says_nothing(known)) ++change.excused_expected;
    const bool flips = own == images::kMayFlip || known == images::kMayFlip;
    if (finite && (flips || says_nothing(own) || says_nothing(known))) {
      ++(flips ? change.excused_flips : change.excused_rounding);
      change.excused_squares += difference * difference;
      // Where rounding moves a pixel far, another rounding moves it: not farther than it could with the widest bounds.
      const double most = flips ? tolerance : tolerance + 2.0 * static_cast<double>(kWidestBound);
      if (difference > most) ++change.excused_changed;
      continue;
    }
    ++change.compared;
    if (!finite || difference > tolerance + static_cast<double>(own) + static_cast<double>(known)) ++change.changed;
    change.mean += difference;
    change.rms += difference * difference;
    if (difference <= change.max) continue;
    change.max = difference;
    change.max_x = static_cast<int>(i % width);
    change.max_y = static_cast<int>(i / width);
  }
  const double count = change.compared > 0 ? static_cast<double>(change.compared) : 1.0;
  change.mean /= count;
  change.rms = std::sqrt(change.rms / count);
  return change;
}

}  // namespace shadowbench::regress
