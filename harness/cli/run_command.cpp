#include <fmt/format.h>
#include <sys/prctl.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <csignal>
#include <memory>
#include <optional>
#include <tuple>

#include "filters/error.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/experiment_loader.h"
#include "harness/cli/progress_bar.h"
#include "harness/gl/pixel_format.h"
#include "harness/scene/load.h"

namespace shadowbench::cli {
namespace {

constexpr double kLargestDepthRatio = 1e7;
constexpr int kMostRounds = 10000;
constexpr const char* kReferenceFilter = "none";  // what the others' times are ratios to

/// The command line as text; parsed and checked before anything is made.
struct RunArguments {
  std::vector<std::string> scenes;
  bool ground = false;
  std::string filters;
  std::vector<std::string> filter_files;
  std::string map_sizes = "1024";
  std::string size = "960x540";
  std::vector<std::string> bias;
  std::string fit = "tight";
  std::string snap = "off";
  std::string map_format = "d32f";
  bool reversed_depth = false;
  std::optional<double> perspective_depth;
  std::string light;
  std::string border = "border";
  std::string far_test = "on";
  std::string behind_test = "on";
  bool border_page = false;
  std::string rounds = "auto";
  double precision = 0.05;
  double budget_s = 1.0;
  std::uint32_t seed = 1;
  std::string backend = "auto";
  double cell_timeout_s = 60.0;
  std::string out = "report/out";
  bool no_truth = false;
  bool no_attribution = false;
  std::string cache;
  bool no_cache = false;
  bool worker = false;
  std::optional<double> pad_texels;  ///< workers see the same map as the run they belong to
};

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

std::vector<int> parse_map_sizes(const std::string& text) {
  std::vector<int> sizes;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(',', begin);
    const int size = parse_count(text.substr(begin, end == std::string::npos ? end : end - begin), "--map-size");
    if (std::find(sizes.begin(), sizes.end(), size) != sizes.end()) fail(fmt::format("--map-size names {} twice", size));
    sizes.push_back(size);
  }
  return sizes;
}

std::vector<std::string> builtin_scenes(const run::Resources& resources) {
  std::vector<std::string> names;
  for (const scene::SceneInfo& info : scene::list_scenes(resources.scenes)) names.push_back(info.name);
  return names;
}

void add_filters(run::RunOptions& options, const RunArguments& arguments) {
  filters::Catalogue catalogue(options.resources.filters);
  for (const std::string& file : arguments.filter_files) catalogue.add_user_file(file);
  options.filters = catalogue.parse_requests(arguments.filters);
  for (const std::string& file : arguments.filter_files) {
    const std::string id = std::filesystem::path(file).stem().string();
    const auto is_it = [&](const filters::FilterRequest& request) { return request.spec.id == id; };
    if (std::any_of(options.filters.begin(), options.filters.end(), is_it)) continue;
    options.filters.push_back(catalogue.parse_requests(id).front());
  }
  require_distinct(options.filters);
}

void check(const RunArguments& arguments) {
  if (!(arguments.cell_timeout_s > 0.0 && arguments.cell_timeout_s <= 86400.0)) {
    fail(fmt::format("--cell-timeout: {} is out of range: choose more than 0, at most 86400 seconds", arguments.cell_timeout_s));
  }
  // Above, single precision cannot tell the ratio from the ratio less 1, by which depth is linearised.
  const double ratio = arguments.perspective_depth.value_or(2.0);
  if (!(ratio > 1.0 && ratio <= kLargestDepthRatio)) {
    fail(fmt::format("--perspective-depth: {} is out of range: choose far over near, more than 1, at most {:g}", ratio, kLargestDepthRatio));
  }
}

double parse_angle(const std::string& text, const char* name, double limit_deg) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= limit_deg)) {
    fail(fmt::format("--light: the {} '{}' must be a number of degrees, {} .. {}", name, text, -limit_deg, limit_deg));
  }
  return value;
}

run::LightAngles parse_light(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) fail(fmt::format("--light: '{}' must be AZIMUTH,ELEVATION in degrees, such as 120,35", text));
  return {parse_angle(text.substr(0, comma), "azimuth", 360.0), parse_angle(text.substr(comma + 1), "elevation", 90.0)};
}

void set_map_and_light(run::RunOptions& options, const RunArguments& arguments) {
  options.map = {gl::parse_depth_format(arguments.map_format).internal_format, {arguments.reversed_depth, arguments.perspective_depth.value_or(1.0)}};
  options.fit = scene::parse_fit_mode(arguments.fit);
  options.snap = arguments.snap == "on";
  if (!arguments.light.empty()) options.light = parse_light(arguments.light);
}

run::RoundLimits parse_rounds(const RunArguments& arguments) {
  if (!(arguments.precision > 0.0 && arguments.precision <= 1.0)) {
    fail(fmt::format("--precision: {} is out of range: choose more than 0, at most 1", arguments.precision));
  }
  if (!(arguments.budget_s > 0.0 && arguments.budget_s <= 3600.0)) {
    fail(fmt::format("--budget: {} is out of range: choose more than 0, at most 3600 seconds", arguments.budget_s));
  }
  if (arguments.rounds != "auto") {
    const int rounds = parse_count(arguments.rounds, "--rounds");
    if (rounds > kMostRounds) fail(fmt::format("--rounds: {} is out of range: choose 1 .. {}, or auto", rounds, kMostRounds));
    return run::RoundLimits::exactly(rounds);
  }
  run::RoundLimits limits;
  limits.precision = arguments.precision;
  limits.budget_ms = 1e3 * arguments.budget_s;
  return limits;
}

run::RunOptions make_options(const RunArguments& arguments, std::vector<std::string> command) {
  check(arguments);
  run::RunOptions options;
  options.resources = run::find_resources();
  options.scenes = arguments.scenes.empty() ? builtin_scenes(options.resources) : arguments.scenes;
  options.ground = arguments.ground;
  add_filters(options, arguments);
  options.map_sizes = parse_map_sizes(arguments.map_sizes);
  std::tie(options.width, options.height) = parse_picture_size(arguments.size);
  set_map_and_light(options, arguments);
  options.bias = run::parse_bias(arguments.bias);
  options.bias_texts = arguments.bias;
  run::require_drawable(options.bias, options.map);
  for (const filters::FilterRequest& request : options.filters) run::require_usable(options.bias, request.spec);
  options.range = {filters::parse_border(arguments.border), arguments.far_test == "on", arguments.behind_test == "on"};
  options.border_page = arguments.border_page;
  options.rounds = parse_rounds(arguments);
  options.reference = filters::Catalogue(options.resources.filters).parse_requests(kReferenceFilter).front();
  options.seed = arguments.seed;
  options.backend = gl::parse_backend(arguments.backend);
  options.cell_timeout_s = arguments.cell_timeout_s;
  options.out = arguments.out;
  options.command = std::move(command);
  options.truth = !arguments.no_truth && !arguments.worker;
  options.attribution = !arguments.no_attribution;
  options.cache = choose_cache(arguments.cache, arguments.no_cache);
  options.worker = arguments.worker;
  options.pad_texels = arguments.pad_texels;
  return options;
}

int run(const RunArguments& arguments, std::vector<std::string> command) {
  // A worker must not outlive the run that waits for it.
  if (arguments.worker) prctl(PR_SET_PDEATHSIG, SIGKILL);
  const run::RunOptions options = make_options(arguments, std::move(command));
  {
    const std::unique_ptr<run::Progress> progress = make_progress();
    load_and_run_experiment(options, *progress);
  }
  if (!options.worker) fmt::print("report: {}\n", (options.out / "index.html").string());
  return 0;
}

void add_scene_options(CLI::App& command, RunArguments& a) {
  command.add_option("--scene", a.scenes, "a built-in scene, or a .toml, .gltf, .glb or .obj file; may be repeated (default: all built-in scenes)")->allow_extra_args(false);
  command.add_flag("--ground", a.ground, "put a floor under a bare model");
  command.add_option("--map-size", a.map_sizes, "texels along a side of the shadow map; several with commas")->capture_default_str();
  command.add_option("--size", a.size, "picture size in pixels, WIDTHxHEIGHT")->capture_default_str();
  command.add_option("--map-format", a.map_format, "how the map stores depth: d16, d24 or d32f")->capture_default_str();
  command.add_flag("--reversed-depth", a.reversed_depth, "store 1 - depth; filters see depth as ever");
  command.add_option("--perspective-depth", a.perspective_depth, "store depth as a perspective projection does whose far plane is so many times as far as its near plane; filters see linear depth as ever");
  command.add_option("--fit", a.fit, "light frustum: 'tight' around casters and receivers, 'sphere', stable under rotation, or 'view', "
                     "what the camera sees and the casters before it")->capture_default_str();
  command.add_option("--snap", a.snap, "keep the map's texels fixed in the world while a 'view' moves: on or off")
      ->check(CLI::IsMember({"on", "off"}))->capture_default_str();
  command.add_option("--light", a.light, "AZIMUTH,ELEVATION in degrees, where the light stands in every scene: azimuth 0 is +z, 90 is +x")
      ->check([](const std::string& text) { return text.empty() ? std::string("AZIMUTH,ELEVATION in degrees are missing") : std::string(); });
}

void add_range_options(CLI::App& command, RunArguments& a) {
  const CLI::IsMember switch_words({"on", "off"});
  command.add_option("--border", a.border, "what lookups read outside the map: 'border', depth 1, which is right; to see what goes wrong, 'edge', which smears casters at the map's edge outwards, or 'repeat', which tiles the map's shadows. See it on --scene edge")
      ->check(CLI::IsMember(filters::border_names()))->capture_default_str();
  command.add_option("--far-test", a.far_test, "whether what lies beyond the map's far plane is lit; 'off' compares it, and all of it is dark")
      ->check(switch_words)->capture_default_str();
  command.add_option("--behind-test", a.behind_test, "whether what lies behind the light is lit; 'off' mirrors the map through the light. Only projective maps have a behind, and no light of this version has such a map")
      ->check(switch_words)->capture_default_str();
  command.add_flag("--border-page", a.border_page, "also draw SCENE.borders.png: every filter with the right border, with each wrong one, and without the far-plane test");
}

void add_filter_options(CLI::App& command, RunArguments& a) {
  command.add_option("--filters", a.filters, "filters with parameters, such as none,vsm:radius=6,min_variance=1e-4,esm (default: all; see 'list filters')");
  command.add_option("--filter-file", a.filter_files, "a filter of your own, one GLSL file; may be repeated")->allow_extra_args(false);
  command.add_option("--bias", a.bias,
                     "bias, MODE:KEY=X,...; repeat to add up: " + run::list_bias_modes() +
                     ". Units: depth (0..1 over the light's range), texels (their width), world (metres), kernels (half-width of "
                     "the filter's kernel plus one texel). plane: what the receiver's plane gains over so many texels; slope: times "
                     "1 - n.l, or constant where that is more; receiver-plane: the plane's depth at every tap; front-cull, midpoint: "
                     "what the map holds (default plane:kernels=1,depth=2e-5). Planes steeper than 10:1 towards the light are "
                     "biased as 10:1")->allow_extra_args(false);
}

}  // namespace

void add_run_command(CLI::App& app, Action& action, const std::vector<std::string>& words) {
  CLI::App* command = app.add_subcommand("run", "Render scenes with filters and write a report");
  auto a = std::make_shared<RunArguments>();
  add_scene_options(*command, *a);
  add_range_options(*command, *a);
  add_filter_options(*command, *a);
  command->add_option("--rounds", a->rounds, "how often each filter is timed: a number, or 'auto', until its ratio to the unfiltered lookup is precise enough or the budget is spent")->capture_default_str();
  command->add_option("--precision", a->precision, "of 'auto' rounds: width of the ratio's 95 % interval, over the ratio")->capture_default_str();
  command->add_option("--budget", a->budget_s, "of 'auto' rounds: seconds of timed work for each filter on each map")->capture_default_str();
  command->add_option("--seed", a->seed, "of random rotations and of the order of timing")->capture_default_str();
  command->add_option("--gl", a->backend, "OpenGL context: auto, osmesa, egl or glfw")->capture_default_str();
  command->add_option("--cell-timeout", a->cell_timeout_s, "seconds that a filter of your own may take on one scene")->capture_default_str();
  command->add_flag("--no-truth", a->no_truth, "do not trace rays: no truth, no errors");
  command->add_flag("--no-attribution", a->no_attribution, "do not take the errors apart: no kernels are traced, no models run");
  command->add_option("--cache", a->cache, "folder that keeps traced images for later runs (default: shadowbench in $XDG_CACHE_HOME or ~/.cache)");
  command->add_flag("--no-cache", a->no_cache, "trace everything, keep nothing");
  command->add_option("--out", a->out, "report folder")->capture_default_str();
  command->add_flag("--worker", a->worker, "")->group("");
  command->add_option("--pad-texels", a->pad_texels, "")->group("");
  command->callback([&action, a, words] { action = [a, words] { return run(*a, words); }; });
}

}  // namespace shadowbench::cli
