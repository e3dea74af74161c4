#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "base/nearest_name.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/print.h"
#include "harness/run/compare_pictures.h"
#include "reference/metrics/flip.h"
#include "report/analysis/repeat.h"
#include "report/files/folder_lock.h"
#include "report/images/heat_figures.h"
#include "report/pages/comparison_page.h"
#include "report/records/format.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

namespace shadowbench::cli {
namespace {

using analysis::ErrorApart;
using analysis::RatioApart;
using records::CellRecord;

constexpr std::size_t kMostNamed = 10;

const std::optional<records::Ratio>& ratio_of(const CellRecord& cell, const std::string& name) {
  const records::RatioRecord& ratios = cell.ratio_to_none;
  return name == "lookup" ? ratios.lookup : name == "moving" ? ratios.moving : ratios.static_light;
}

std::string describe_cell(const CellRecord& cell) {
  return fmt::format("{} ({}), {}{}, map {}, picture {} x {}", cell.scene, cell.view, cell.filter,
                     cell.params.empty() ? "" : " (" + records::describe_params(cell.params) + ")", cell.map_size,
                     cell.width, cell.height);
}

std::string describe_apart(const RatioApart& apart) {
  return fmt::format("{}: {} {} against {}", describe_cell(*apart.a), apart.ratio,
                     records::format_ratio(ratio_of(*apart.a, apart.ratio)),
                     records::format_ratio(ratio_of(*apart.b, apart.ratio)));
}

std::string describe_apart(const ErrorApart& apart) {
  return fmt::format("{}: RMSE {} against {}, a difference of {}", describe_cell(*apart.a),
                     records::format_number(apart.a->error.rmse), records::format_number(apart.b->error.rmse),
                     records::format_interval(apart.gap.value, {apart.gap.low, apart.gap.high}));
}

void print_some(const auto& all) {
  for (std::size_t i = 0; i < std::min(all.size(), kMostNamed); ++i) print("  {}\n", describe_apart(all[i]));
  if (all.size() > kMostNamed) print("  and {} more\n", all.size() - kMostNamed);
}

void print_runs(const analysis::RepeatComparison& found) {
  print("cells        {} in both\n", *found.record.cells);
  print("overlapping  {} of {} 95 % intervals of ratios to none\n", *found.record.overlapping, *found.record.of);
  if (!found.apart.empty()) print("apart, the widest gap first:\n");
  print_some(found.apart);
  if (found.errors == 0) return;
  print("errors       {} of {} RMSEs are not told apart\n", found.errors - static_cast<int>(found.errors_apart.size()),
        found.errors);
  if (!found.errors_apart.empty()) print("apart, the largest difference first:\n");
  print_some(found.errors_apart);
}

void print_runs_json(const analysis::RepeatComparison& found) {
  nlohmann::ordered_json json = {
      {"cells", *found.record.cells}, {"overlapping", *found.record.overlapping}, {"of", *found.record.of}};
  json["apart"] = nlohmann::ordered_json::array();
  for (const RatioApart& apart : found.apart) {
    json["apart"].push_back({{"key", apart.a->key},
                             {"scene", apart.a->scene},
                             {"view", apart.a->view},
                             {"filter", apart.a->filter},
                             {"ratio", apart.ratio},
                             {"a", records::value_json(*ratio_of(*apart.a, apart.ratio))},
                             {"b", records::value_json(*ratio_of(*apart.b, apart.ratio))},
                             {"gap", apart.gap}});
  }
  json["errors"] = found.errors;
  json["errors_apart"] = nlohmann::ordered_json::array();
  for (const ErrorApart& apart : found.errors_apart) {
    json["errors_apart"].push_back({{"key", apart.a->key},
                                    {"scene", apart.a->scene},
                                    {"view", apart.a->view},
                                    {"filter", apart.a->filter},
                                    {"a", *apart.a->error.rmse},
                                    {"b", *apart.b->error.rmse},
                                    {"difference", apart.gap.value},
                                    {"ci95", {apart.gap.low, apart.gap.high}}});
  }
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

/// Warns where more than chance may have changed the times.
void warn_of_differences(const records::RunRecord& a, const records::RunRecord& b) {
  const auto warn = [](const char* what, const std::string& x, const std::string& y) {
    if (x != y) print_message("warning: the runs differ in {}: {}, and {}\n", what, x, y);
  };
  const auto machine = [](const records::RunRecord& run) {
    return fmt::format("{} with {} cores", run.machine.cpu, run.machine.cores);
  };
  warn("their machine", machine(a), machine(b));
  warn("their OpenGL", a.gl.renderer, b.gl.renderer);
  warn("the program's commit", a.commit, b.commit);
}

/// Whether an argument names a run, which is a folder or a .json file.
bool is_run(const std::filesystem::path& argument) {
  std::error_code ignored;
  return std::filesystem::is_directory(argument, ignored) || argument.extension() == ".json";
}

/// Compares the ratios to `none` and the RMSEs of the cells that two runs have in common; prints how many repeat, and
/// the ones that are farthest apart.
/// Throws Error(kLimit) where some do not, Error(kInput) where there is nothing to compare or a file cannot be read.
int diff_runs(const std::filesystem::path& a, const std::filesystem::path& b, bool json) {
  const records::Results first = records::read_results(find_results(a)),
                         second = records::read_results(find_results(b));
  const analysis::RepeatComparison found = analysis::compare_runs(first.cells, second.cells);
  if (found.record.of == 0) {
    throw Error(
        ErrorKind::kInput,
        fmt::format(
            "the two runs have {} cells in common, and no ratio to none to compare: run the same experiment twice",
            *found.record.cells),
        fmt::format("{} and {}", a.string(), b.string()));
  }
  warn_of_differences(first.run, second.run);
  if (json)
    print_runs_json(found);
  else
    print_runs(found);
  if (!found.errors_apart.empty()) {
    throw Error(ErrorKind::kLimit, fmt::format("{} of {} RMSEs are told apart; the most: {}", found.errors_apart.size(),
                                               found.errors, describe_apart(found.errors_apart.front())));
  }
  if (found.apart.empty()) return 0;
  throw Error(ErrorKind::kLimit, fmt::format("{}; widest apart: {}", analysis::describe_overlap(found.record),
                                             describe_apart(found.apart.front())));
}

constexpr const char* kAllMetrics = "all";
constexpr double kLeastPixelsPerDegree = 0.1;    // FLIP sees no feature of a picture with fewer
constexpr double kMostPixelsPerDegree = 1000.0;  // FLIP's time grows with it

struct DiffArguments {
  std::string image;
  std::string truth;
  std::optional<std::string> mask;
  double pixels_per_degree = metrics::kDefaultPixelsPerDegree;
  std::string metric = kAllMetrics;
  std::optional<std::string> out;   ///< a PNG file
  std::optional<std::string> html;  ///< a folder
  bool force = false;
  bool json = false;
};

std::vector<std::string> metric_names() {
  std::vector<std::string> names = {kAllMetrics};
  for (const metrics::Metric& metric : metrics::picture_metrics()) names.emplace_back(metric.name());
  return names;
}

std::vector<metrics::Metric> choose_metrics(const std::string& chosen) {
  std::vector<metrics::Metric> metrics = metrics::picture_metrics();
  if (chosen == kAllMetrics) return metrics;
  std::erase_if(metrics, [&](const metrics::Metric& metric) { return metric.name() != chosen; });
  if (!metrics.empty()) return metrics;
  throw Error(ErrorKind::kUsage, fmt::format("--metric: there is no '{}'{}; known: {}", chosen,
                                             did_you_mean(chosen, metric_names()), fmt::join(metric_names(), ", ")));
}

void check_pixels_per_degree(double value) {
  if (value >= kLeastPixelsPerDegree && value <= kMostPixelsPerDegree) return;
  throw Error(ErrorKind::kUsage, fmt::format("--pixels-per-degree: {} is out of range: choose {} .. {}", value,
                                             kLeastPixelsPerDegree, kMostPixelsPerDegree));
}

void print_json(const run::ComparisonOptions& options, const run::Comparison& result) {
  nlohmann::ordered_json json = {{"image", options.image},
                                 {"truth", options.truth},
                                 {"mask", nullptr},
                                 {"width", result.width},
                                 {"height", result.height},
                                 {"channels", result.channels},
                                 {"pixels_per_degree", options.pixels_per_degree}};
  if (options.mask) json["mask"] = *options.mask;
  for (const metrics::Metric& metric : options.metrics) {
    const std::string name(metric.name());
    const auto value = result.values.find(name);
    json[name] = value != result.values.end() ? nlohmann::ordered_json(value->second) : nullptr;
  }
  json["compared"] = result.compared;
  json["not_finite"] = result.not_finite;
  json["absent"] = result.absent;
  json["warnings"] = result.warnings;
  // File names need not be UTF-8.
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

/// Whether the command line names two runs, and not two pictures.
bool name_runs(const CommandLine& line, const DiffArguments& arguments) {
  const bool a = is_run(arguments.image), b = is_run(arguments.truth);
  if (!a && !b) return false;
  if (a != b) {
    throw Error(
        ErrorKind::kInput,
        fmt::format(
            "'{}' is a run's folder or results, and '{}' is not: name two pictures, or the report folders of two runs",
            a ? arguments.image : arguments.truth, a ? arguments.truth : arguments.image));
  }
  for (const char* option : {"--metric", "--mask", "--pixels-per-degree", "--out", "--html"})
    if (line.has(option)) fail(fmt::format("{} is of pictures, and these are runs: leave it out", option));
  return true;
}

/// The numbers in one line each, as they are printed.
std::vector<std::pair<std::string, std::string>> list_numbers(const run::ComparisonOptions& options,
                                                              const run::Comparison& result) {
  std::vector<std::pair<std::string, std::string>> numbers;
  for (const metrics::Metric& metric : options.metrics) {
    const std::string name(metric.name());
    const auto value = result.values.find(name);
    numbers.emplace_back(
        name, value != result.values.end() ? fmt::format("{}", value->second) : "absent: " + result.absent.at(name));
  }
  numbers.emplace_back("compared", fmt::format("{}", result.compared));
  numbers.emplace_back("not_finite", fmt::format("{}", result.not_finite));
  return numbers;
}

void write_images(const DiffArguments& arguments, const run::ComparisonOptions& options,
                  const run::Comparison& result) {
  const auto numbers = list_numbers(options, result);
  const run::ComparedImages& made = *result.images;
  if (arguments.out) {
    std::vector<std::string> facts;
    for (const auto& [name, value] : result.values)
      facts.push_back(fmt::format("{} {}", name, records::format_number(value)));
    std::string note = fmt::format("{}", fmt::join(facts, " · "));
    if (const auto no_flip = result.absent.find("flip"); made.flip.empty())
      note += "; no FLIP: " + (no_flip == result.absent.end() ? "" : no_flip->second);
    images::write_figure(*arguments.out, {fmt::format("{} less {}", options.image, options.truth), note,
                                          images::show_difference(made.difference, made.flip), 2});
  }
  if (!arguments.html) return;
  const files::FolderLock lock(*arguments.html, arguments.force);
  pages::write_comparison_page(*arguments.html, {options.image, options.truth, made.image, made.truth, made.image_grey,
                                                 made.truth_grey, made.mask, made.flip, numbers});
}

/// Refuses what would be written over a picture that is read.
void check_outputs(const DiffArguments& arguments) {
  if (arguments.out && std::filesystem::path(*arguments.out).extension() != ".png")
    fail(fmt::format("--out: '{}' must end in .png; --html writes a page", *arguments.out));
  for (const std::string& read : {arguments.image, arguments.truth, arguments.mask.value_or("")}) {
    const std::filesystem::path file = read.substr(0, read.find('#'));
    std::error_code ignored;
    if (arguments.out && std::filesystem::equivalent(file, *arguments.out, ignored))
      fail(fmt::format("--out: '{}' is read by this command and would be lost: choose another file", *arguments.out));
    if (arguments.html &&
        std::filesystem::equivalent(file.parent_path(), std::filesystem::path(*arguments.html) / "images", ignored))
      fail(fmt::format("--html: '{}' holds '{}', which could be lost: choose another folder", *arguments.html, read));
  }
}

int diff(const CommandLine& line, const DiffArguments& arguments) {
  if (name_runs(line, arguments)) return diff_runs(arguments.image, arguments.truth, arguments.json);
  check_pixels_per_degree(arguments.pixels_per_degree);
  check_outputs(arguments);
  const run::ComparisonOptions options{arguments.image,
                                       arguments.truth,
                                       arguments.mask,
                                       choose_metrics(arguments.metric),
                                       arguments.pixels_per_degree,
                                       arguments.out || arguments.html};
  const run::Comparison result = run::compare_pictures(options);
  for (const std::string& warning : result.warnings) print_message("warning: {}\n", warning);
  if (arguments.json) print_json(options, result);
  if (result.values.empty()) {
    throw Error(ErrorKind::kInput, fmt::format("nothing can be compared: {}", result.absent.begin()->second),
                options.image + " and " + options.truth);
  }
  if (result.images) write_images(arguments, options, result);
  if (arguments.json) return 0;
  for (const auto& [name, value] : list_numbers(options, result)) print("{:<11} {}\n", name, value);
  return 0;
}

}  // namespace

Command make_diff_command() {
  Command command{"diff", "Compare two pictures as a run compares its own, or the times of two runs"};
  command.about =
      "A and B are pictures in any format that OpenImageIO reads; FILE#PART is one part of a multi-part EXR file, such "
      "as report/out/cubes.exr#vsm.visibility. Errors are A minus B, over all channels but alpha, of the values as "
      "stored (8-bit codes as code/255). FLIP alone takes linear RGB clamped to [0,1], and the whole picture: sRGB "
      "codes are decoded, and one channel is grey. Pixels that are NaN or infinite are counted and left out.\n"
      "Where A and B are report folders of runs (or their results.json), the command counts how many of their cells' "
      "ratios to 'none' repeat, that is, have 95 % intervals that overlap. Exit code 1: some do not.";
  auto a = std::make_shared<DiffArguments>();
  command.add("A", &a->image, "the picture, or a run's folder").names(ValueKind::kFile).require();
  command.add("B", &a->truth, "what it should look like, or another run's folder").names(ValueKind::kFile).require();
  command.add("--metric", &a->metric,
              fmt::format("the error to print: {} (see 'list metrics')", fmt::join(metric_names(), ", ")));
  command.add("--mask", &a->mask, "a picture of one channel: pixels count where it is not 0").names(ValueKind::kFile);
  command.add("--pixels-per-degree", &a->pixels_per_degree, "how large FLIP's observer sees the pixels");
  command.add("--out", &a->out, "write a PNG of the signed difference and of FLIP, with their scales")
      .names(ValueKind::kFile);
  command.add("--html", &a->html, "write a page into this folder on which the two can be looked at")
      .names(ValueKind::kFolder);
  add_force_option(command, a->force);
  add_json_option(command, a->json);
  command.action = [a](const CommandLine& line) { return diff(line, *a); };
  return command;
}

}  // namespace shadowbench::cli
