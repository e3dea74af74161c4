#include "harness/cli/run_arguments.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/options/experiment_file.h"
#include "harness/options/light_counts.h"
#include "harness/options/options.h"
#include "harness/render/bias/bias_rule.h"

namespace shadowbench::cli {
namespace {

/// The options that an experiment may set: those that say what is measured, not those that say where.
const std::vector<std::string>& experiment_keys() {
  static const std::vector<std::string> keys = split_list(
      "scene,ground,view,light_name,filters,filter_file,map_size,size,bias,map_format,reversed_depth,perspective_depth,"
      "fit,snap,"
      "light,lights,pad_texels,tuned,border,far_test,behind_test,border_page,phases,rounds,precision,budget,"
      "cell_timeout,seed,gpu,truth,attribution,stability,uncertainty,grids");
  return keys;
}

const std::vector<std::string> kSwitch = {"on", "off"};

void add_map_options(Command& command, RunArguments& a) {
  add_scenes_options(command, a.scenes, a.ground);
  command.add("--map-size", &a.map_sizes, "texels along a side of the shadow map; several with commas");
  command.add(
      "--pad-texels", &a.pad_texels,
      "texels around the scene in the map (default: what the widest kernel of the run needs); set it where runs "
      "of different filters are compared");
  command.add("--view", &a.views, "a scene's camera by its name; may be repeated (default: all)");
  command.add("--light-name", &a.light_names,
              "one of a scene's several lights by its name; may be repeated (default: all, each by itself)");
  command.add("--size", &a.sizes, "picture size in pixels, WIDTHxHEIGHT; several with commas");
  command.add("--map-format", &a.map_format, "how the map stores depth: d16, d24 or d32f")
      .such_as({"d16", "d24", "d32f"});
  command.add("--reversed-depth", &a.reversed_depth, "store 1 - depth; filters read the same depth as without it");
  command.add("--perspective-depth", &a.perspective_depth,
              "store depth as a perspective projection would whose far plane is this many times as far away as its "
              "near plane; filters read linear depth all the same");
  command
      .add("--fit", &a.fits,
           "light frustum: 'tight' around casters and receivers; 'sphere', which is stable under rotation; 'view', "
           "around what the camera sees and the casters before it; 'cascades', which give slices of that a map each: "
           "cascades:count=2..4,split=uniform|practical|logarithmic,blend=0.1,depths=all|seen; 'focused', 'lispsm', "
           "'psm', 'tsm' or 'logpsm', which warp it; of a point light 'paraboloid'; may be repeated (default: tight)")
      .such_as(scene::list_fit_names());
  command
      .add("--snap", &a.snap,
           "keep the map's texels fixed in the world while the frusta of --fit view and cascades move: on or off")
      .one_of(kSwitch);
  command
      .add("--light", &a.light,
           "AZIMUTH,ELEVATION in degrees, where the light stands in every scene: azimuth 0 is +z, 90 is +x")
      .never_empty("AZIMUTH,ELEVATION in degrees");
}

void add_range_options(Command& command, RunArguments& a) {
  command
      .add(
          "--border", &a.border,
          "what lookups read outside the map: 'border', depth 1, which is right; to see what goes wrong, 'edge', which "
          "smears casters at the map's edge outwards, or 'repeat', which tiles the map's shadows. See it on --scene "
          "edge")
      .one_of(filters::border_names());
  command
      .add("--far-test", &a.far_test,
           "whether what lies beyond the map's far plane is lit; 'off' compares it, and all of it is dark")
      .one_of(kSwitch);
  command
      .add("--behind-test", &a.behind_test,
           "whether a spot light leaves out what is behind it; 'off' mirrors its cone, its cookie and its map through "
           "the light")
      .one_of(kSwitch);
  command.add("--border-page", &a.border_page,
              "also draw SCENE.borders.png: every filter with the right border, with each wrong one, and without the "
              "far-plane test");
}

void add_filter_options(Command& command, RunArguments& a) {
  command
      .add(kFiltersOption, &a.filters,
           "filters with parameters, such as none,vsm:radius=6,min_variance=1e-4,esm:width=medium; width, a class of "
           "'list filters' or texels, sets the radius; 'all' is every filter but those for teaching (default: those of "
           "the experiment 'default')")
      .names(ValueKind::kFilters)
      .also_called(kFilterOption);
  command.add("--filter-file", &a.filter_files, "a filter of your own, one GLSL file; may be repeated")
      .names(ValueKind::kFile);
  command
      .add("--tuned", &a.tuned,
           "a tuned.json of 'shadowbench tune': every filter it names takes its parameters, but for those that "
           "--filters sets")
      .names(ValueKind::kFile);
  command.add(
      "--bias", &a.bias,
      "depth bias, MODE:KEY=X,...; several add up: " + render::list_bias_modes() +
          ". Units: depth (0..1 over the light's range), texels (their width), world (metres), kernels (how "
          "far the filter's comparisons reach). plane: what the receiver's plane gains over so many texels; slope: "
          "times "
          "1 - n.l, or constant where that is more; receiver-plane: the plane's depth at every tap; front-cull, "
          "midpoint: what the map holds (default plane:kernels=1,depth=2e-5). Planes steeper than 10:1 towards the "
          "light "
          "are biased as 10:1");
}

void add_timing_options(Command& command, RunArguments& a) {
  command.add(
      "--rounds", &a.rounds,
      "how often each filter is timed: a number, or 'auto', until its ratio to the unfiltered lookup is precise "
      "enough or the budget is spent");
  command.add("--phases", &a.phases,
              "places of the map's grid, moved by parts of a texel, over which errors are averaged: 1 .. " +
                  std::to_string(options::kMostPhases));
  command.add("--precision", &a.precision,
              "for --rounds auto: how wide the ratio's 95 % interval may be, relative to the ratio");
  command.add("--budget", &a.budget_s, "for --rounds auto: seconds of timed work for each filter on each map");
  command
      .add("--lights", &a.lights,
           fmt::format("also time frames lit by so many suns, each with a map of its own, casters still and moving: "
                       "counts of 1 .. {} with commas (default: none)",
                       options::kMostLights))
      .never_empty("counts of lights, such as 1,2,4,8");
  command
      .add("--gpu", &a.gpus,
           "also say what filters cost on these GPUs, which need not be there: names of 'list gpus' with commas, or "
           "'none'")
      .never_empty("names of 'list gpus', or none");
  command.add("--seed", &a.seed, "seed of random rotations and of the order in which filters are timed");
  command.add("--cell-timeout", &a.cell_timeout_s, "seconds that a filter of your own may take on one scene");
}

void add_measurement_options(Command& command, RunArguments& a) {
  command.add("--truth", &a.truth, "trace rays, and score every filter against them (default)").with_opposite();
  command.add("--attribution", &a.attribution, "take the errors apart: trace kernels, run models (default)")
      .with_opposite();
  command
      .add("--stability", &a.stability,
           "say where numbers break, as pictures and counts: overflow, negative variance, 16- against 32-bit stores, "
           "bounds that do not hold")
      .with_opposite();
  command
      .add("--uncertainty", &a.uncertainty,
           "keep how far rounding and other seeds can move each pixel, which 'regress' allows for")
      .with_opposite();
  command
      .add("--grids", &a.grids,
           fmt::format("compare all filters of a view in one picture, and keep their float images (default up to {} "
                       "filters)",
                       kFiltersOfAGrid))
      .with_opposite();
}

}  // namespace

void add_run_options(Command& command, RunArguments& a) {
  a.out = "report/out";
  command
      .add("experiment", &a.experiment, "an experiment, by name or as a .toml file, whose keys these options override")
      .names(ValueKind::kExperiment);
  add_map_options(command, a);
  add_range_options(command, a);
  add_filter_options(command, a);
  add_timing_options(command, a);
  add_measurement_options(command, a);
  command.add("--shard", &a.shard, "I/N: every N-th cell only, from the I-th on; 'merge' joins the N report folders")
      .never_empty("I/N");
  command.add("--fresh", &a.fresh,
              "measure every cell again, even those that an earlier run finished in the report folder");
  command.add("--yes", &a.yes, "start even where there are very many cells");
  command.add("--strict", &a.strict,
              "exit code 1 where the finished run has a warning, or a cell that failed; the report is written all the "
              "same");
  add_drawing_options(command, a, "shadowbench in $XDG_CACHE_HOME or ~/.cache");
  command.add("--worker", &a.worker, "").hide();
  command.add("--task", &a.task, "").hide();
  command.add("--pictures", &a.pictures, "").with_opposite().hide();
}

std::string apply_experiment(const CommandLine& line, RunArguments& arguments) {
  const options::Resources resources = options::find_resources();
  const auto read = [&](const std::string& name) {
    return options::read_experiment(options::find_experiment(resources.experiments, name), experiment_keys());
  };
  const auto take = [&](const options::ExperimentSetting& setting) {
    if (!line.has(setting.option)) line.set(setting.option, setting.values, setting.where);
  };
  const options::Experiment experiment = read(arguments.experiment);
  std::ranges::for_each(experiment.settings, take);
  if (line.has(kFiltersOption)) return experiment.title;
  if (experiment.filters.empty()) {
    for (const options::ExperimentSetting& setting : read(kDefaultExperiment).settings)
      if (setting.option == kFiltersOption) take(setting);
    return experiment.title;
  }
  filters::Catalogue catalogue(resources.filters);
  for (const std::string& file : arguments.filter_files) catalogue.add_user_file(file);
  arguments.filters = options::expand_filters(experiment, catalogue);
  return experiment.title;
}

}  // namespace shadowbench::cli
