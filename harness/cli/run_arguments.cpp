#include "harness/cli/run_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "filters/base/error.h"
#include "harness/options/experiment_file.h"
#include "harness/options/light_counts.h"
#include "harness/options/options.h"
#include "harness/render/bias_rule.h"

namespace shadowbench::cli {
namespace {

/// The options that an experiment may hold: all that say what is measured, none that say where.
const std::vector<std::string>& experiment_keys() {
  static const std::vector<std::string> keys = {
      "scene",  "ground",      "view",       "filter_file",    "map_size",
      "size",   "bias",        "map_format", "reversed_depth", "perspective_depth",
      "fit",    "snap",        "light",      "lights",         "pad_texels",
      "tuned",  "border",      "far_test",   "behind_test",    "border_page",
      "rounds", "precision",   "budget",     "cell_timeout",   "seed",
      "truth",  "attribution", "stability",  "uncertainty",    "grids"};
  return keys;
}

void apply_setting(CLI::App& command, const options::ExperimentSetting& setting) {
  CLI::Option* option = command.get_option(setting.option);
  if (option->count() > 0) return;
  try {
    if (option->get_items_expected_max() > 1)
      for (const std::string& value : setting.values) option->add_result(value);
    else
      option->add_result(fmt::format("{}", fmt::join(setting.values, ",")));
    option->run_callback();
  } catch (const CLI::Error& error) {
    throw Error(ErrorKind::kInput, error.what(), setting.where);
  }
}

void add_scene_options(CLI::App& command, RunArguments& a) {
  command
      .add_option(
          "--scene", a.scenes,
          "a built-in scene, or a .toml, .gltf, .glb or .obj file; may be repeated (default: all built-in scenes)")
      ->allow_extra_args(false);
  command.add_flag("--ground", a.ground, "put a floor under a bare model");
  command.add_option("--map-size", a.map_sizes, "texels along a side of the shadow map; several with commas")
      ->capture_default_str();
  command.add_option("--pad-texels", a.pad_texels,
                     "texels around the scene in the map (default: what the widest kernel of the run needs); set it "
                     "where runs of different filters are compared");
  command.add_option("--view", a.views, "a scene's camera by its name; may be repeated (default: all)")
      ->allow_extra_args(false);
  command.add_option("--size", a.sizes, "picture size in pixels, WIDTHxHEIGHT; several with commas")
      ->capture_default_str();
  command.add_option("--map-format", a.map_format, "how the map stores depth: d16, d24 or d32f")->capture_default_str();
  command.add_flag("--reversed-depth", a.reversed_depth, "store 1 - depth; filters see depth as ever");
  command.add_option("--perspective-depth", a.perspective_depth,
                     "store depth as a perspective projection does whose far plane is so many times as far as its near "
                     "plane; filters see linear depth as ever");
  command
      .add_option("--fit", a.fit,
                  "light frustum: 'tight' around casters and receivers, 'sphere', stable under rotation, or 'view', "
                  "what the camera sees and the casters before it")
      ->capture_default_str();
  command.add_option("--snap", a.snap, "keep the map's texels fixed in the world while a 'view' moves: on or off")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  command
      .add_option("--light", a.light,
                  "AZIMUTH,ELEVATION in degrees, where the light stands in every scene: azimuth 0 is +z, 90 is +x")
      ->check([](const std::string& text) {
        return text.empty() ? std::string("AZIMUTH,ELEVATION in degrees are missing") : std::string();
      });
}

void add_range_options(CLI::App& command, RunArguments& a) {
  const CLI::IsMember switch_words({"on", "off"});
  command
      .add_option("--border", a.border,
                  "what lookups read outside the map: 'border', depth 1, which is right; to see what goes wrong, "
                  "'edge', which smears casters at the map's edge outwards, or 'repeat', which tiles the map's "
                  "shadows. See it on --scene edge")
      ->check(CLI::IsMember(filters::border_names()))
      ->capture_default_str();
  command
      .add_option("--far-test", a.far_test,
                  "whether what lies beyond the map's far plane is lit; 'off' compares it, and all of it is dark")
      ->check(switch_words)
      ->capture_default_str();
  command
      .add_option("--behind-test", a.behind_test,
                  "whether what lies behind the light is lit; 'off' mirrors the map through the light. Only projective "
                  "maps have a behind, and no light of this version has such a map")
      ->check(switch_words)
      ->capture_default_str();
  command.add_flag("--border-page", a.border_page,
                   "also draw SCENE.borders.png: every filter with the right border, with each wrong one, and without "
                   "the far-plane test");
}

void add_filter_options(CLI::App& command, RunArguments& a) {
  command.add_option(
      "--filters", a.filters,
      "filters with parameters, such as none,vsm:radius=6,min_variance=1e-4,esm (default: all; see 'list filters')");
  command.add_option("--filter-file", a.filter_files, "a filter of your own, one GLSL file; may be repeated")
      ->allow_extra_args(false);
  command.add_option("--tuned", a.tuned,
                     "a tuned.json of 'shadowbench tune': every filter it names takes its parameters, but for those "
                     "that --filters sets");
  command
      .add_option(
          "--bias", a.bias,
          "bias, MODE:KEY=X,...; repeat to add up: " + render::list_bias_modes() +
              ". Units: depth (0..1 over the light's range), texels (their width), world (metres), kernels (half-width "
              "of "
              "the filter's kernel plus one texel). plane: what the receiver's plane gains over so many texels; slope: "
              "times "
              "1 - n.l, or constant where that is more; receiver-plane: the plane's depth at every tap; front-cull, "
              "midpoint: "
              "what the map holds (default plane:kernels=1,depth=2e-5). Planes steeper than 10:1 towards the light are "
              "biased as 10:1")
      ->allow_extra_args(false);
}

}  // namespace

void add_run_options(CLI::App& command, RunArguments& a) {
  command
      .add_option("experiment", a.experiment,
                  "an experiment, by name or as a .toml file, whose keys these options override")
      ->capture_default_str();
  add_scene_options(command, a);
  add_range_options(command, a);
  add_filter_options(command, a);
  command
      .add_option("--rounds", a.rounds,
                  "how often each filter is timed: a number, or 'auto', until its ratio to the unfiltered lookup is "
                  "precise enough or the budget is spent")
      ->capture_default_str();
  command
      .add_option("--precision", a.precision, "of 'auto' rounds: width of the ratio's 95 % interval, over the ratio")
      ->capture_default_str();
  command.add_option("--budget", a.budget_s, "of 'auto' rounds: seconds of timed work for each filter on each map")
      ->capture_default_str();
  command
      .add_option("--lights", a.lights,
                  fmt::format("also time frames lit by so many suns, each with a map of its own, casters still and "
                              "moving: counts of 1 .. {} with commas (default: none)",
                              options::kMostLights))
      ->check([](const std::string& text) {
        return text.empty() ? std::string("counts of lights are missing, such as 1,2,4,8") : std::string();
      });
  command.add_option("--seed", a.seed, "of random rotations and of the order of timing")->capture_default_str();
  command.add_option("--gl", a.backend, "OpenGL context: auto, osmesa, egl or glfw")->capture_default_str();
  command.add_option("--cell-timeout", a.cell_timeout_s, "seconds that a filter of your own may take on one scene")
      ->capture_default_str();
  command.add_flag("--truth,!--no-truth", a.truth, "trace rays, and score every filter against them (default)");
  command.add_flag("--attribution,!--no-attribution", a.attribution,
                   "take the errors apart: trace kernels, run models (default)");
  command.add_flag("--stability,!--no-stability", a.stability,
                   "say where numbers break, as pictures and counts: overflow, negative variance, 16- against 32-bit "
                   "stores, bounds that do not hold");
  command.add_flag("--uncertainty,!--no-uncertainty", a.uncertainty,
                   "keep how far rounding and other seeds can move each pixel, which 'regress' allows for");
  command.add_flag(
      "--grids,!--no-grids", a.grids,
      fmt::format(
          "compare all filters of a view in one picture, and keep their float images (default up to {} filters)",
          kFiltersOfAGrid));
  command
      .add_option("--shard", a.shard, "I/N: every N-th cell only, from the I-th on; 'merge' joins the N report folders")
      ->check([](const std::string& text) { return text.empty() ? std::string("I/N is missing") : std::string(); });
  command.add_flag("--fresh", a.fresh,
                   "measure every cell, also those that an earlier run of the same left finished in the report folder");
  command.add_flag("--yes", a.yes, "run however many cells there are");
  command.add_option(
      "--cache", a.cache,
      "folder that keeps traced images for later runs (default: shadowbench in $XDG_CACHE_HOME or ~/.cache)");
  command.add_flag("--no-cache", a.no_cache, "trace everything, keep nothing");
  command.add_option("--out", a.out, "report folder")->capture_default_str();
  command.add_flag("--worker", a.worker, "")->group("");
}

std::string apply_experiment(CLI::App& command, RunArguments& arguments) {
  const options::Resources resources = options::find_resources();
  const options::Experiment experiment = options::read_experiment(
      options::find_experiment(resources.experiments, arguments.experiment), experiment_keys());
  for (const options::ExperimentSetting& setting : experiment.settings) apply_setting(command, setting);
  if (experiment.filters.empty() || command.get_option("--filters")->count() > 0) return experiment.title;
  filters::Catalogue catalogue(resources.filters);
  for (const std::string& file : arguments.filter_files) catalogue.add_user_file(file);
  arguments.filters = options::expand_filters(experiment, catalogue);
  return experiment.title;
}

}  // namespace shadowbench::cli
