#include "harness/cli/run_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "filters/base/error.h"
#include "harness/gl/pixel_format.h"
#include "harness/options/light_counts.h"
#include "harness/tune/tuned_parameters.h"

namespace shadowbench::cli {
namespace {

constexpr double kLargestDepthRatio = 1e7;
constexpr double kMostPadding = 1000.0;  // in texels; no kernel is wider
constexpr int kMostRounds = 10000;
constexpr const char* kReferenceFilter = "none";  // the times of the others are given as ratios to its times

/// Parses whole numbers, 1 or more, with commas between them. Refuses one that is named twice.
std::vector<int> parse_counts(const std::string& text, const char* option) {
  std::vector<int> counts;
  for (const std::string& each : split_list(text)) {
    const int count = parse_count(each, option);
    if (std::find(counts.begin(), counts.end(), count) != counts.end())
      fail(fmt::format("{} names {} twice", option, count));
    counts.push_back(count);
  }
  return counts;
}

std::vector<int> parse_lights(const std::string& text) {
  if (text.empty()) return {};
  std::vector<int> counts = parse_counts(text, "--lights");
  std::sort(counts.begin(), counts.end());
  if (counts.back() > options::kMostLights)
    fail(fmt::format("--lights: {} is out of range: choose counts of 1 .. {}", counts.back(), options::kMostLights));
  return counts;
}

void choose_filters(options::RunOptions& options, const RunArguments& arguments) {
  filters::Catalogue catalogue(options.resources.filters);
  for (const std::string& file : arguments.filter_files) catalogue.add_user_file(file);
  options.filters = catalogue.parse_requests(arguments.filters);
  for (const std::string& file : arguments.filter_files) {
    const std::string id = std::filesystem::path(file).stem().string();
    const auto is_it = [&](const filters::FilterRequest& request) { return request.spec.id == id; };
    if (std::any_of(options.filters.begin(), options.filters.end(), is_it)) continue;
    options.filters.push_back(catalogue.parse_requests(id).front());
  }
  if (!arguments.tuned.empty())
    options.notes = tune::apply_tuned(options.filters, catalogue, arguments.tuned, options.map_sizes);
  require_distinct(options.filters);
}

void require_in_range(const char* option, double value, double more_than, double most, const char* unit = "") {
  if (value > more_than && value <= most) return;
  fail(fmt::format("{}: {} is out of range: choose more than {:g}, at most {:g}{}", option, value, more_than, most,
                   unit));
}

void check_ranges(const RunArguments& arguments) {
  const double padding = arguments.pad_texels.value_or(0.0);
  if (!(padding >= 0.0 && padding <= kMostPadding))
    fail(fmt::format("--pad-texels: {} is out of range: choose 0 .. {:g}", padding, kMostPadding));
  if (arguments.phases < 1 || arguments.phases > std::uint32_t{options::kMostPhases})
    fail(fmt::format("--phases: {} is out of range: choose 1 .. {}", arguments.phases, options::kMostPhases));
  require_in_range("--cell-timeout", arguments.cell_timeout_s, 0.0, 86400.0, " seconds");
  // With a larger ratio, single precision cannot tell it from the ratio less 1, which linearises depth.
  require_in_range("--perspective-depth", arguments.perspective_depth.value_or(2.0), 1.0, kLargestDepthRatio,
                   " (the far plane's distance over the near one's)");
}

void set_map_and_light(options::RunOptions& options, const RunArguments& arguments) {
  options.map = {gl::parse_depth_format(arguments.map_format).internal_format,
                 {arguments.reversed_depth, arguments.perspective_depth.value_or(1.0)}};
  if (!arguments.fits.empty()) options.fits.clear();
  for (const std::string& fit : arguments.fits) options.fits.push_back(scene::parse_fit_rule(fit));
  options.fit = options.fits.front();
  options.snap = arguments.snap == "on";
  if (!arguments.light.empty()) options.light = parse_light(arguments.light);
}

options::RoundLimits parse_rounds(const RunArguments& arguments) {
  require_in_range("--precision", arguments.precision, 0.0, 1.0);
  require_in_range("--budget", arguments.budget_s, 0.0, 3600.0, " seconds");
  if (arguments.rounds != "auto") {
    const int rounds = parse_count(arguments.rounds, "--rounds");
    if (rounds > kMostRounds)
      fail(fmt::format("--rounds: {} is out of range: choose 1 .. {}, or auto", rounds, kMostRounds));
    return options::RoundLimits::exactly(rounds);
  }
  options::RoundLimits limits;
  limits.precision = arguments.precision;
  limits.budget_ms = 1e3 * arguments.budget_s;
  return limits;
}

std::vector<options::PictureSize> parse_sizes(const std::string& text) {
  std::vector<options::PictureSize> sizes;
  for (const std::string& each : split_list(text)) {
    const auto [width, height] = parse_picture_size(each);
    const options::PictureSize size{width, height};
    if (std::find(sizes.begin(), sizes.end(), size) != sizes.end()) fail(fmt::format("--size names {} twice", each));
    sizes.push_back(size);
  }
  return sizes;
}

options::Shard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) fail(fmt::format("--shard: '{}' must be I/N, such as 1/3", text));
  const options::Shard shard{parse_count(text.substr(0, slash), "--shard") - 1,
                             parse_count(text.substr(slash + 1), "--shard")};
  if (shard.index >= shard.count)
    fail(fmt::format("--shard: {} has no {} of {}; choose 1 .. {}", text, shard.index + 1, shard.count, shard.count));
  return shard;
}

}  // namespace

options::RunOptions make_run_options(const RunArguments& arguments, std::vector<std::string> words) {
  check_ranges(arguments);
  options::RunOptions options;
  take_drawing_options(arguments, options);
  options.scenes = arguments.scenes.empty() ? list_builtin_scenes(options.resources) : arguments.scenes;
  options.ground = arguments.ground;
  options.map_sizes = parse_counts(arguments.map_sizes, "--map-size");
  choose_filters(options, arguments);
  options.sizes = parse_sizes(arguments.sizes);
  options.views = arguments.views;
  options.light_names = arguments.light_names;
  set_map_and_light(options, arguments);
  options.bias = render::parse_bias(arguments.bias);
  options.bias_texts = arguments.bias;
  render::require_drawable(options.bias, options.map);
  for (const filters::FilterRequest& request : options.filters) render::require_usable(options.bias, request.spec);
  options.range = {filters::parse_border(arguments.border), arguments.far_test == "on", arguments.behind_test == "on"};
  options.border_page = arguments.border_page;
  options.rounds = parse_rounds(arguments);
  options.phases = static_cast<int>(arguments.phases);
  options.lights = parse_lights(arguments.lights);
  options.gpus = gpu::choose_gpus(gpu::load_gpus(options.resources.gpus), split_list(arguments.gpus));
  options::require_light_maps_fit(options);
  options.reference = filters::Catalogue(options.resources.filters).parse_requests(kReferenceFilter).front();
  options.seed = arguments.seed;
  options.cell_timeout_s = arguments.cell_timeout_s;
  options.command = std::move(words);
  options.truth = arguments.truth && !arguments.worker;
  options.attribution = arguments.attribution;
  options.stability = arguments.stability;
  options.uncertainty = arguments.uncertainty;
  options.shard = parse_shard(arguments.shard);
  options.grids = arguments.grids > 0 || (arguments.grids == 0 && options.filters.size() <= kFiltersOfAGrid);
  options.pictures = arguments.pictures;
  if (options.grids && options.shard.count > 1)
    fail("--shard needs --no-grids: a grid shows all filters of a view, and a shard has some of them");
  options.fresh = arguments.fresh;
  options.large_is_fine = arguments.yes;
  options.worker = arguments.worker;
  options.pad_texels = arguments.pad_texels;
  return options;
}

}  // namespace shadowbench::cli
