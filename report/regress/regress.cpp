#include "report/regress/regress.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/files.h"
#include "base/folder_lock.h"
#include "base/text.h"
#include "report/images/color_values.h"
#include "report/images/crop.h"
#include "report/images/heat_figures.h"
#include "report/images/picture_io.h"
#include "report/pages/write_page.h"
#include "report/records/format.h"
#include "report/records/json_io.h"
#include "report/regress/comparison.h"

namespace shadowbench::regress {
namespace {

bool chosen(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::ranges::find(names, name) != names.end();
}

using Parts = std::map<std::string, images::Image>;

/// The parts of an image file, by name; the reason where it cannot be read.
struct ImageFile {
  Parts parts;
  std::string unreadable;
};

ImageFile read_image_file(const std::filesystem::path& path) {
  ImageFile file;
  try {
    for (images::Part& part : images::read_exr(path).parts) file.parts[part.name] = std::move(part.image);
  } catch (const Error& error) {
    file.unreadable = error.what();
  }
  return file;
}

images::Image find_part(const Parts& parts, const std::string& name) {
  const auto found = parts.find(name);
  return found == parts.end() ? images::Image() : found->second;
}

void read_images(ActualCell& cell, const ImageFile& file) {
  if (!file.unreadable.empty()) {
    cell.unreadable = file.unreadable;
    return;
  }
  const std::string prefix = *cell.record.images.parts + ".";
  cell.images.visibility = find_part(file.parts, prefix + "visibility");
  for (const images::UncertaintyImage& each : images::list_uncertainty_images())
    cell.images.uncertainty.*each.image = find_part(file.parts, prefix + each.id);
}

/// Why a cell has no image; empty where it has one.
std::string explain_no_image(const records::CellRecord& cell) {
  if (!records::is_drawn(cell)) return "the run could not measure it: " + records::describe_status(cell);
  if (!cell.images.exr || !cell.images.parts) return "the run kept no float images: run it with --grids";
  return "";
}

std::map<std::string, std::vector<const records::CellRecord*>> group_by_file(
    const std::vector<records::CellRecord>& cells) {
  std::map<std::string, std::vector<const records::CellRecord*>> groups;
  for (const records::CellRecord& cell : cells)
    groups[explain_no_image(cell).empty() ? *cell.images.exr : std::string()].push_back(&cell);
  return groups;
}

}  // namespace

bool Selection::holds(const std::string& scene, const std::string& filter) const {
  return chosen(scenes, scene) && chosen(filters, filter);
}

namespace {

/// Pictures are for people: where a whole run moved, those of the worst cells are enough.
constexpr int kMostPictures = 50;

using images::Image;
using images::Rect;

float magnitude(float v) { return std::isfinite(v) ? std::abs(v) : 2.0f; }

/// The place where the images differ most.
Rect crop_worst(const Image& difference) {
  const auto smaller = [](float a, float b) { return magnitude(a) < magnitude(b); };
  const int worst = static_cast<int>(std::max_element(difference.texels.begin(), difference.texels.end(), smaller) -
                                     difference.texels.begin());
  const images::Size size = images::choose_crop_size({difference.width, difference.height});
  return {std::clamp(worst % difference.width - size.width / 2, 0, difference.width - size.width),
          std::clamp(worst / difference.width - size.height / 2, 0, difference.height - size.height), size.width,
          size.height};
}

std::string describe_change(const Comparison& comparison) {
  if (!comparison.pixels) return comparison.findings.front().text;
  const PixelChange& change = *comparison.pixels;
  return fmt::format(
      "{} of {} pixels moved, by {} at most; excused by name: {} where a comparison may flip, {} for rounding",
      change.changed, change.compared, records::format_number(change.max), change.excused_flips,
      change.excused_rounding);
}

/// Draws what was expected, what was drawn, and the difference, side by side, with the worst place magnified, into a
/// PNG file. Requires two images of one size, not empty, of one channel. Throws Error(kOutput).
void write_regress_picture(const std::filesystem::path& path, const Comparison& comparison, const Image& expected,
                           const Image& actual) {
  Image difference = actual;
  for (std::size_t i = 0; i < difference.texels.size(); ++i) difference.texels[i] -= expected.texels[i];
  const images::ColorScale scale = images::make_signed_scale(images::choose_error_scale({&difference}));
  const Rect crop = crop_worst(difference);
  images::Figure figure{fmt::format("{} on {}: {}", comparison.label, comparison.scene, name_of(comparison.outcome)),
                        comparison.settings + " · " + describe_change(comparison)};
  figure.stacks = {images::show_part({"expected"}, expected, crop, images::distance_from_lit, images::map_grey),
                   images::show_part({"actual"}, actual, crop, images::distance_from_lit, images::map_grey),
                   images::show_part({"difference"}, difference, crop, magnitude, scale)};
  figure.legend = {images::make_color_bar(
      scale,
      "actual less expected: darker now (blue), brighter now (red); below: the outlined part, with the largest "
      "difference")};
  images::write_figure(path, figure);
}

/// One comparison of a run with its baseline.
class Regression {
 public:
  explicit Regression(const RegressOptions& options)
      : options_(options), baseline_(options.baseline), run_(records::read_results(options.run / "results.json")) {
    const bool known = baseline_.exists();
    if (options.accept) lock_.emplace(options.baseline, true);
    if (!options.accept && !known)
      throw Error(ErrorKind::kInput,
                  "there is no baseline here (no baseline.toml); make one: " + make_accept_command(options_),
                  options_.baseline.string());
    if (known) tolerances_ = read_tolerances(baseline_.tolerance_file());
    expected_ = baseline_.list_cells();
    report_.is_new = options.accept && expected_.empty();
    require_known(
        options.selection.filters, "--filters", [](const auto& cell) { return cell.filter; });
    require_known(
        options.selection.scenes, "--scene", [](const auto& cell) { return cell.scene; });
    const auto is_left_out = [&](const auto& cell) { return !options.selection.holds(cell.scene, cell.filter); };
    std::erase_if(expected_, is_left_out);
    std::erase_if(run_.cells, is_left_out);
    if (run_.cells.empty() && expected_.empty())
      throw Error(ErrorKind::kInput, "neither the run nor the baseline has a cell", options.run.string());
  }

  RegressReport compare() {
    compare_run();
    find_missing();
    find_missing_truths();
    std::ranges::stable_sort(report_.comparisons, is_worse);
    report_.options = options_;
    report_.accept_command = make_accept_command(options_);
    if (options_.accept) write_accepted();
    return std::move(report_);
  }

 private:
  const RegressOptions& options_;
  Baseline baseline_;
  records::Results run_;
  Tolerances tolerances_;
  std::vector<BaselineCell> expected_;
  std::set<std::string> seen_;                                              ///< keys of the run's cells
  std::set<std::string> seen_truths_;                                       ///< scene and key
  std::map<std::string, std::map<std::string, TruthImages>> truths_;        ///< by scene and key
  std::map<std::pair<std::string, std::string>, CellFile> accepted_files_;  ///< by scene and filter
  std::set<std::string> accepted_truths_;                                   ///< scenes
  std::optional<FolderLock> lock_;                                          ///< held on a baseline that may change
  RegressReport report_;
  CellFile file_;  ///< the file of the last cell's scene and filter
  std::pair<std::string, std::string> file_name_;
  int pictures_ = 0;

  /// Compares every cell, and the truth of every view once, where there is one. An image file stays in memory while its
  /// cells are compared.
  void compare_run() {
    const records::RunRecord& run = run_.run;
    const Origin origin{.seed = run.seed,
                        .renderer = run.gl.renderer,
                        .machine = fmt::format("{}, {} cores", run.machine.cpu, run.machine.cores),
                        .commit = run.commit};
    for (const auto& [name, cells] : group_by_file(run_.cells)) {
      const ImageFile file = name.empty() ? ImageFile() : read_image_file(options_.run / name);
      for (const records::CellRecord* record : cells) {
        ActualCell cell{*record, origin, {}, explain_no_image(*record)};
        if (cell.unreadable.empty()) read_images(cell, file);
        compare_cell(cell);
      }
      const ActualTruth truth{*cells.front(),
                              {find_part(file.parts, "truth.area"), find_part(file.parts, "truth.standard_error")}};
      if (!truth.images.area.empty() && seen_truths_.insert(truth.record.scene + "/" + truth_key(truth.record)).second)
        compare_truth(truth);
    }
  }

  /// A misspelt name would take cells out of the comparison, and nobody would notice.
  template <class Name>
  void require_known(const std::vector<std::string>& chosen, const char* option, const Name& name_of_cell) const {
    std::set<std::string> names;
    for (const records::CellRecord& cell : run_.cells) names.insert(name_of_cell(cell));
    for (const BaselineCell& cell : expected_) names.insert(name_of_cell(cell));
    const std::vector<std::string> known(names.begin(), names.end());
    for (const std::string& name : chosen) {
      if (names.contains(name)) continue;
      throw Error(ErrorKind::kInput, fmt::format("{}: neither the run nor the baseline has '{}'{}; they have: {}",
                                                 option, name, did_you_mean(name, known), fmt::join(known, ", ")));
    }
  }

  static bool is_worse(const Comparison& a, const Comparison& b) {
    if (a.outcome != b.outcome) return a.outcome > b.outcome;
    const double of_a = a.pixels ? a.pixels->rms : 0.0, of_b = b.pixels ? b.pixels->rms : 0.0;
    return of_a > of_b;
  }

  const BaselineCell* find(const std::string& key) const {
    const auto found = std::ranges::find(expected_, key, &BaselineCell::key);
    return found == expected_.end() ? nullptr : &*found;
  }

  const CellFile& read_file(const BaselineCell& cell) {
    const std::pair name(cell.scene, cell.filter);
    if (name != file_name_) {
      file_ = baseline_.read_cells(cell.scene, cell.filter);
      file_name_ = name;
    }
    return file_;
  }

  void compare_cell(const ActualCell& cell) {
    seen_.insert(cell.record.key);
    const BaselineCell* expected = find(cell.record.key);
    Comparison comparison = name_comparison(cell.record);
    CellImages images;
    if (expected) {
      const auto& all = read_file(*expected).images;
      if (const auto found = all.find(expected->key); found != all.end()) images = found->second;
      comparison = regress::compare_cell(cell, *expected, images, tolerances_);
    } else if (!cell.unreadable.empty()) {
      comparison.add(Outcome::kUnreadable, cell.unreadable);
    } else {
      comparison.add(Outcome::kExtra, "the baseline has no such cell");
    }
    conclude(std::move(comparison), cell, images.visibility, cell.images.visibility);
  }

  void compare_truth(const ActualTruth& truth) {
    const auto& known = read_truths(truth.record.scene);
    const auto found = known.find(truth_key(truth.record));
    Comparison comparison = name_truth(truth.record);
    TruthImages expected;
    if (found == known.end()) {
      comparison.add(Outcome::kExtra, "the baseline has no truth of this view");
    } else {
      expected = found->second;
      comparison = regress::compare_truth(truth, expected, tolerances_.find(kTruthName, kLevel).limit);
    }
    conclude(std::move(comparison), truth, expected.area, truth.images.area);
  }

  /// Takes over and draws what was compared, where that is wanted; `Actual` is a cell or a truth.
  template <class Actual>
  void conclude(Comparison comparison, const Actual& actual, const images::Image& expected,
                const images::Image& drawn) {
    if (options_.accept && comparison.differs()) take(comparison, actual);
    const bool moved = comparison.outcome == Outcome::kChanged || comparison.outcome == Outcome::kLessAccurate;
    if (moved && pictures_ < kMostPictures) {
      ++pictures_;
      comparison.picture =
          make_file_stem(fmt::format("{}.{}.{}", comparison.scene, comparison.label, comparison.key)) + ".png";
      write_regress_picture(options_.out / *comparison.picture, comparison, expected, drawn);
    }
    report_.comparisons.push_back(std::move(comparison));
  }

  void add_missing(Comparison comparison, const char* what) {
    comparison.add(Outcome::kMissing, what);
    if (options_.remove_missing) drop(comparison);
    report_.comparisons.push_back(std::move(comparison));
  }

  void find_missing() {
    for (const BaselineCell& cell : expected_)
      if (!seen_.contains(cell.key)) add_missing(name_comparison(cell), "the run has no such cell");
  }

  void find_missing_truths() {
    std::set<std::string> scenes;
    for (const BaselineCell& cell : expected_) scenes.insert(cell.scene);
    for (const std::string& scene : scenes) {
      const std::map<std::string, TruthImages> known = read_truths(scene);  // which may lose some
      for (const auto& [key, truth] : known) {
        if (seen_truths_.contains(scene + "/" + key)) continue;
        add_missing({{.key = key, .scene = scene, .filter = kTruthName, .label = kTruthName}, key},
                    "the run has no such truth");
      }
    }
  }

  /// Reads the truths of a scene once.
  std::map<std::string, TruthImages>& read_truths(const std::string& scene) {
    const auto [place, is_new] = truths_.try_emplace(scene);
    if (is_new) place->second = baseline_.read_truths(scene);
    return place->second;
  }

  /// Takes a cell over into the baseline, if the run could measure it. Ratios that no run is compared with are not
  /// kept: they would only make the files differ.
  void take(Comparison& comparison, const ActualCell& cell) {
    if (cell.images.visibility.empty()) return;
    const records::CellRecord& record = cell.record;
    ComparedValues values = read_values(record);
    std::erase_if(values.ratios,
                  [&](const auto& value) { return std::isinf(tolerances_.find(record.filter, value.first).limit); });
    BaselineCell taken{name_cell(record), record.map_size, record.width, record.height, cell.origin, std::move(values)};
    CellFile& own = accepted_file(record.scene, record.filter);
    const auto same = std::ranges::find(own.cells, taken.key, &BaselineCell::key);
    *(same == own.cells.end() ? own.cells.emplace(same) : same) = std::move(taken);
    CellImages& kept = own.images[record.key] = cell.images;
    kept.uncertainty.rounding = coarsen_rounding(cell.images.uncertainty.rounding);
    note_accepted(comparison, comparison.outcome == Outcome::kExtra ? "added" : "replaced");
  }

  void take(Comparison& comparison, const ActualTruth& truth) {
    accepted_truths(comparison.scene)[comparison.key] = truth.images;
    note_accepted(comparison, comparison.outcome == Outcome::kExtra ? "added" : "replaced");
  }

  /// Removes a cell or a truth that the run lacks from the baseline.
  void drop(Comparison& comparison) {
    if (comparison.filter == kTruthName)
      accepted_truths(comparison.scene).erase(comparison.key);
    else
      std::erase_if(accepted_file(comparison.scene, comparison.filter).cells,
                    [&](const BaselineCell& each) { return each.key == comparison.key; });
    note_accepted(comparison, "removed");
  }

  void note_accepted(Comparison& comparison, const char* what) {
    comparison.accepted = true;
    std::string line = fmt::format("{}: {} {} ({})", what, comparison.scene, comparison.label, comparison.settings);
    if (comparison.outcome != Outcome::kExtra)
      for (const Finding& finding : comparison.findings) line += "\n  - " + finding.text;
    report_.accepted.push_back(std::move(line));
  }

  /// The cells of a scene and filter as they will be.
  CellFile& accepted_file(const std::string& scene, const std::string& filter) {
    const auto [place, is_new] = accepted_files_.try_emplace({scene, filter});
    if (is_new) place->second = baseline_.read_cells(scene, filter);
    return place->second;
  }

  std::map<std::string, TruthImages>& accepted_truths(const std::string& scene) {
    accepted_truths_.insert(scene);
    return read_truths(scene);
  }

  /// Tolerances come first: a folder that is written only in part is then known to be a baseline.
  void write_accepted() {
    if (!baseline_.exists()) write_text_file(baseline_.tolerance_file(), write_tolerances(tolerances_));
    for (const auto& [name, own] : accepted_files_) baseline_.write_cells(name.first, name.second, own);
    for (const std::string& scene : accepted_truths_) baseline_.write_truths(scene, truths_.at(scene));
  }
};

/// What there is to say of a run that ended because of its filters' files.
RegressReport report_mistakes(const RegressOptions& options, const std::vector<filters::FilterMistake>& mistakes) {
  RegressReport report;
  report.options = options;
  for (const filters::FilterMistake& mistake : mistakes) {
    Comparison comparison{{.scene = "filters", .filter = mistake.id, .label = mistake.id}, mistake.file};
    comparison.add(Outcome::kBroken, mistake.message);
    report.comparisons.push_back(std::move(comparison));
  }
  return report;
}

/// Removes the pictures of an earlier comparison, which would be taken for this one's.
void remove_old_pictures(const std::filesystem::path& out) {
  require_plain_file(out / "regress.json", 1024 * kMebibyte);
  std::ifstream stream(out / "regress.json", std::ios::binary);
  const auto old = nlohmann::json::parse(stream, nullptr, false);
  if (!old.is_object() || !old.contains("cells")) return;
  for (const auto& cell : old["cells"]) {
    if (!cell.is_object() || !cell.contains("picture") || !cell["picture"].is_string()) continue;
    const std::filesystem::path name(cell["picture"].get<std::string>());
    std::error_code ignored;
    if (name == name.filename() && name.extension() == ".png") std::filesystem::remove(out / name, ignored);
  }
}

}  // namespace

int RegressReport::count(Outcome outcome) const {
  return static_cast<int>(std::ranges::count(comparisons, outcome, &Comparison::outcome));
}

int RegressReport::failed() const { return static_cast<int>(std::ranges::count_if(comparisons, &Comparison::failed)); }

RegressOutcome run_regress(const RegressOptions& options) {
  const FolderLock lock(options.out, options.force);
  remove_old_pictures(options.out);
  const std::vector<filters::FilterMistake> mistakes = records::read_filter_mistakes(options.run);
  const RegressReport found = mistakes.empty() ? Regression(options).compare() : report_mistakes(options, mistakes);
  RegressOutcome outcome{make_regress_text(found), make_regress_json(found), describe_failure(found),
                         mistakes.empty() ? ErrorKind::kLimit : ErrorKind::kFilter};
  pages::write_page(options.out, "regress", make_regress_page(found));
  write_text_file(options.out / "regress.json", outcome.json);
  if (options.junit) write_text_file(*options.junit, make_junit(found));
  return outcome;
}

}  // namespace shadowbench::regress
