#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "base/text.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/terminal.h"
#include "harness/run/compare_pictures.h"
#include "reference/metrics/flip.h"
#include "report/images/heat_figures.h"
#include "report/records/format.h"
#include "report/regress/regress.h"

namespace shadowbench::cli {
namespace {

constexpr const char* kAllMetrics = "all";
constexpr double kLeastPixelsPerDegree = 0.1;    // FLIP sees no feature of a picture with fewer
constexpr double kMostPixelsPerDegree = 1000.0;  // FLIP's time grows with it

struct DiffArguments {
  std::string image;
  std::string truth;
  std::optional<std::string> mask;
  double pixels_per_degree = metrics::kDefaultPixelsPerDegree;
  std::string metric = kAllMetrics;
  std::optional<std::string> out;  ///< a PNG file
  std::string html;                ///< gone
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

/// Refuses a run's folder and results: what moved between two runs is the work of `regress`.
void require_picture(const std::filesystem::path& argument) {
  std::error_code ignored;
  if (std::filesystem::exists(argument / "results.json", ignored) || argument.extension() == ".json")
    fail(fmt::format("'{}' is a run, and diff compares two pictures: compare runs with 'shadowbench regress'",
                     argument.string()));
}

/// The numbers in one line each.
void print_text(const run::ComparisonOptions& options, const run::Comparison& result) {
  const auto print_line = [](std::string_view name, const auto& value) { print("{:<11} {}\n", name, value); };
  for (const metrics::Metric& metric : options.metrics) {
    const std::string name(metric.name());
    if (const auto value = result.values.find(name); value != result.values.end())
      print_line(name, value->second);
    else
      print_line(name, "absent: " + result.absent.at(name));
  }
  print_line("compared", result.compared);
  print_line("not_finite", result.not_finite);
}

void write_image(const std::string& file, const run::ComparisonOptions& options, const run::Comparison& result) {
  std::vector<std::string> facts;
  for (const auto& [name, value] : result.values)
    facts.push_back(fmt::format("{} {}", name, records::format_number(value)));
  std::string note = fmt::format("{}", fmt::join(facts, " · "));
  if (const auto no_flip = result.absent.find("flip"); result.flip.empty())
    note += "; no FLIP: " + (no_flip == result.absent.end() ? "" : no_flip->second);
  images::write_figure(file, {fmt::format("{} less {}", options.image, options.truth), note,
                              images::show_difference(result.difference, result.flip), 2});
}

/// Refuses what would be written over a picture that is read.
void check_output(const DiffArguments& arguments) {
  if (!arguments.out) return;
  if (std::filesystem::path(*arguments.out).extension() != ".png")
    fail(fmt::format("--out: '{}' must end in .png", *arguments.out));
  for (const std::string& read : {arguments.image, arguments.truth, arguments.mask.value_or("")}) {
    std::error_code ignored;
    if (std::filesystem::equivalent(read.substr(0, read.find('#')), *arguments.out, ignored))
      fail(fmt::format("--out: '{}' is read by this command and would be lost: choose another file", *arguments.out));
  }
}

int diff(const DiffArguments& arguments) {
  require_picture(arguments.image);
  require_picture(arguments.truth);
  check_pixels_per_degree(arguments.pixels_per_degree);
  check_output(arguments);
  const run::ComparisonOptions options{arguments.image,
                                       arguments.truth,
                                       arguments.mask,
                                       choose_metrics(arguments.metric),
                                       arguments.pixels_per_degree,
                                       arguments.out.has_value()};
  const run::Comparison result = run::compare_pictures(options);
  for (const std::string& warning : result.warnings) print_message("warning: {}\n", warning);
  if (arguments.json) print_json(options, result);
  if (result.values.empty()) {
    throw Error(ErrorKind::kInput, fmt::format("nothing can be compared: {}", result.absent.begin()->second),
                options.image + " and " + options.truth);
  }
  if (arguments.out) write_image(*arguments.out, options, result);
  if (!arguments.json) print_text(options, result);
  return 0;
}

struct RegressArguments {
  std::string run;
  std::string baseline;
  std::string filters;
  std::vector<std::string> scenes;
  std::string out;
  bool force = false;
  std::string junit;
  bool accept = false;
  bool remove_missing = false;
  bool json = false;
};

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  for (const std::string& name : split_list(text)) {
    const std::size_t begin = name.find_first_not_of(' ');
    if (begin != std::string::npos) names.push_back(name.substr(begin, name.find_last_not_of(' ') - begin + 1));
  }
  return names;
}

regress::RegressOptions make_regress_options(const RegressArguments& a, const std::vector<std::string>& words) {
  regress::RegressOptions options;
  options.run = find_results(a.run).parent_path();
  options.baseline = a.baseline;
  options.out = a.out.empty() ? options.run / "regress" : std::filesystem::path(a.out);
  options.force = a.force;
  options.selection = {split_names(a.filters), a.scenes};
  options.accept = a.accept;
  options.remove_missing = a.remove_missing;
  if (!a.junit.empty()) options.junit = a.junit;
  options.brief = isatty(STDOUT_FILENO) == 0;
  options.command = words;
  if (a.remove_missing && !a.accept) fail("--remove-missing changes the baseline: add --accept");
  return options;
}

int regress(const RegressArguments& arguments, const std::vector<std::string>& words) {
  const regress::RegressOptions options = make_regress_options(arguments, words);
  regress::RegressOutcome outcome;
  {
    const Interruption interruption(options.accept ? options.baseline : options.out, kStoppedAdvice);
    outcome = regress::run_regress(options);
  }
  if (arguments.json)
    fmt::print("{}", outcome.json);
  else
    print("{}", outcome.text);
  if (outcome.failure.empty()) return 0;
  throw Error(outcome.kind, outcome.failure);
}

}  // namespace

Command make_diff_command() {
  Command command{"diff", "Compare two images with the metrics of a run"};
  command.about =
      "A and B are images in any format of OpenImageIO; FILE#PART is one part of a multi-part EXR file, such as "
      "report/out/cubes.exr#vsm.visibility. Errors are A minus B over all channels but alpha, as stored (8-bit codes "
      "as code/255). FLIP takes linear RGB clamped to [0,1] and the whole image; sRGB codes are decoded. NaN and "
      "infinite pixels are counted and left out. 'regress' compares two runs.";
  auto a = std::make_shared<DiffArguments>();
  command.add("A", &a->image, "the image").names(ValueKind::kFile).require();
  command.add("B", &a->truth, "the reference").names(ValueKind::kFile).require();
  command.add("--metric", &a->metric,
              fmt::format("the error to print: {} (see 'list metrics')", fmt::join(metric_names(), ", ")));
  command.add("--mask", &a->mask, "one-channel image; pixels count where it is not 0").names(ValueKind::kFile);
  command.add("--pixels-per-degree", &a->pixels_per_degree, "resolution of FLIP's observer");
  command.add("--out", &a->out, "PNG of the signed difference and of FLIP, with scales").names(ValueKind::kFile);
  command.add("--html", &a->html, "").gone("--out draws the difference");
  add_json_option(command, a->json);
  command.action = [a](const CommandLine&) { return diff(*a); };
  return command;
}

Command make_regress_command() {
  Command command{"regress", "Compare a run with a baseline: what changed, and is it still as accurate"};
  command.about =
      "Exit code 1: a cell is less accurate, changed, slower, extra, missing or unreadable. Compares visibility, "
      "errors, artefacts, attribution and costs; on the baseline's machine and OpenGL also times, as ratios to 'none'. "
      "BASELINE/baseline.toml has the tolerances and their reasons. Make the baseline's runs with --uncertainty, which "
      "records how far rounding or another seed can move each pixel.";
  auto a = std::make_shared<RegressArguments>();
  command.add("RUN", &a->run, "the report folder of a run").names(ValueKind::kFolder).require();
  command.add("--baseline", &a->baseline, "folder of the expected results").names(ValueKind::kFolder).require();
  command.add("--filters", &a->filters, "compare these filters only, ids with commas").names(ValueKind::kFilters);
  command.add("--scene", &a->scenes, "compare this scene only; repeatable").names(ValueKind::kScene);
  command.add("--accept", &a->accept, "update the baseline with the run's results");
  command.add("--remove-missing", &a->remove_missing,
              "with --accept: also remove cells from the baseline that the run lacks");
  command.add("--junit", &a->junit, "also write JUnit XML for a build server").names(ValueKind::kFile);
  command.add("--json", &a->json, "print JSON; it also goes to OUT/regress.json");
  command.add("--out", &a->out, "folder for regress.html, .md, .json and images (default 'regress' in RUN)")
      .names(ValueKind::kFolder);
  add_force_option(command, a->force);
  command.action = [a](const CommandLine& line) { return regress(*a, line.words()); };
  return command;
}

}  // namespace shadowbench::cli
