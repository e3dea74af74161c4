#include "harness/options/run_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <type_traits>

#include "base/error.h"
#include "base/split_list.h"
#include "filters/kernel_width.h"
#include "harness/gl/pixel_format.h"

namespace shadowbench::options {
namespace {

using Texts = std::vector<std::string>;

constexpr double kLargestDepthRatio = 1e7;
constexpr double kMostPadding = 1000.0;  // in texels; no kernel is wider
constexpr int kMostRounds = 10000;
constexpr const char *kDefaultGpus = "navi21,vega10", *kAuto = "auto";
const std::string kOwnWidth = "own";

// How a value of a run is told, and how it is taken from what the option `name` was told; most are told as they are.

template <class T>
T tell(const T& value) {
  return value;
}
template <class T>
void take(const char*, const T& told, T& value) {
  value = told;
}

std::uint32_t tell(int count) { return static_cast<std::uint32_t>(count); }
void take(const char* name, std::uint32_t told, int& count) {
  if (told < 1 || told > std::uint32_t{kMostAveraged})
    fail(fmt::format("{}: {} is out of range: choose 1 .. {}", name, told, kMostAveraged));
  count = static_cast<int>(told);
}

std::string tell(const std::vector<int>& counts) { return fmt::format("{}", fmt::join(counts, ",")); }
void take(const char* name, const std::string& text, std::vector<int>& counts) {
  counts.clear();
  for (const std::string& each : text.empty() ? Texts() : split_list(text)) {
    const int count = parse_count(each, name);
    if (std::ranges::count(counts, count) > 0) fail(fmt::format("{} names {} twice", name, count));
    counts.push_back(count);
  }
}

std::string tell(const std::vector<PictureSize>& sizes) {
  Texts texts;
  for (const PictureSize& size : sizes) texts.push_back(fmt::format("{}x{}", size.width, size.height));
  return fmt::format("{}", fmt::join(texts, ","));
}
void take(const char* name, const std::string& text, std::vector<PictureSize>& sizes) {
  sizes.clear();
  for (const std::string& each : split_list(text)) {
    const auto [width, height] = parse_picture_size(each);
    if (std::ranges::count(sizes, PictureSize{width, height}) > 0) fail(fmt::format("{} names {} twice", name, each));
    sizes.push_back({width, height});
  }
}

std::string tell(const render::MapSettings& map) { return std::string(gl::pixel_format(map.format).name); }
void take(const char*, const std::string& text, render::MapSettings& map) {
  map.format = gl::parse_depth_format(text).internal_format;
}

std::optional<double> tell(const filters::DepthCurve& curve) {
  return curve.is_linear() ? std::nullopt : std::optional(curve.far_over_near);
}
void take(const char* name, const std::optional<double>& ratio, filters::DepthCurve& curve) {
  // With a larger ratio, single precision cannot tell it from the ratio less 1, which linearises depth.
  if (ratio) require_in_range(name, *ratio, 1.0, kLargestDepthRatio, " (the far plane's distance over the near one's)");
  curve.far_over_near = ratio.value_or(curve.far_over_near);
}

Texts tell(const std::vector<scene::FitRule>& fits) {
  Texts texts;
  for (const scene::FitRule& fit : fits) texts.push_back(scene::describe_fit(fit));
  return texts;
}
void take(const char*, const Texts& texts, std::vector<scene::FitRule>& fits) {
  fits.clear();
  for (const std::string& text : texts) fits.push_back(scene::parse_fit_rule(text));
}

std::string tell(const std::optional<scene::SkyAngles>& light) {
  return light ? fmt::format("{},{}", light->azimuth_deg, light->elevation_deg) : "";
}
void take(const char*, const std::string& text, std::optional<scene::SkyAngles>& light) {
  if (!text.empty()) light = parse_light(text);
}

std::string tell(filters::Border border) { return filters::to_string(border); }
void take(const char*, const std::string& text, filters::Border& border) { border = filters::parse_border(text); }

std::string tell(render::BlendCasters casters) { return render::to_string(casters); }
void take(const char*, const std::string& text, render::BlendCasters& casters) {
  casters = render::parse_blend_casters(text);
}

std::string tell(TruthWeight weight) { return weight == TruthWeight::kArea ? "area" : "cosine"; }
void take(const char* name, const std::string& text, TruthWeight& weight) {
  if (text != "area" && text != "cosine") fail(fmt::format("{}: '{}' must be area or cosine", name, text));
  weight = text == "area" ? TruthWeight::kArea : TruthWeight::kCosine;
}

std::string tell(const RoundLimits& rounds) { return rounds.is_fixed() ? fmt::format("{}", rounds.most) : kAuto; }
void take(const char* name, const std::string& text, RoundLimits& rounds) {
  if (text == kAuto) return;
  rounds.fewest = rounds.most = parse_count(text, name);
  if (rounds.most > kMostRounds)
    fail(fmt::format("{}: {} is out of range: choose 1 .. {}, or auto", name, rounds.most, kMostRounds));
}

std::string tell(const Part&) { return {}; }  // a shard is no part of an experiment
void take(const char* name, const std::string& text, Part& part) {
  if (text.empty()) return;
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) fail(fmt::format("{}: '{}' must be I/N, such as 1/3", name, text));
  const int index = parse_count(text.substr(0, slash), name), count = parse_count(text.substr(slash + 1), name);
  if (index > count) fail(fmt::format("{}: {} has no {} of {}; choose 1 .. {}", name, text, index, count, count));
  part.shard = index;
  part.shards = count;
}

/// Collects options, one after another; all of a stretch decide the same.
class Table {
 public:
  std::vector<RunOption> rows;
  Decides decides = Decides::kCells;

  /// An option that a value of the run stands for, which `place` gives.
  template <class Place>
  Option& add(const char* name, std::string help, Place place) {
    return add_row(
        name, std::move(help), tell(std::invoke(place, defaults_)),
        [name, place](RunOptions& o, const Told& told) {
          auto& value = std::invoke(place, o);
          take(name, std::get<decltype(tell(value))>(told), value);
        },
        [place](const RunOptions& o) { return Told(tell(std::invoke(place, o))); });
  }

  /// One that is "on" or "off".
  template <class Place>
  Option& add_switch(const char* name, std::string help, Place place) {
    const auto say = [place](const RunOptions& o) { return Told(std::invoke(place, o) ? "on" : "off"); };
    const auto read = [place](RunOptions& o, const Told& told) { std::invoke(place, o) = told == Told("on"); };
    return add_row(name, std::move(help), say(defaults_), read, say).one_of({"on", "off"});
  }

  /// One that is read and written by itself, or by others.
  Option& add_row(const char* name, std::string help, Told initial,
                  std::function<void(RunOptions&, const Told&)> read = {},
                  std::function<Told(const RunOptions&)> write = {}) {
    return rows.emplace_back(
        RunOption{{name, {}, std::move(help)}, decides, std::move(initial), std::move(read), std::move(write)});
  }

 private:
  const RunOptions defaults_;
};

}  // namespace

std::string RunOption::key() const {
  std::string key = name.substr(2);
  std::ranges::replace(key, '-', '_');
  return key;
}

std::vector<RunOption> list_run_options() {
  Table t;
  t.add("--scene",
        "a built-in scene, or a .toml, .gltf, .glb or .obj file, or a folder with one of these; may be repeated "
        "(default: all built-in scenes)",
        &RunOptions::scenes)
      .names(ValueKind::kScene);
  t.add("--ground", "put a floor under a bare model", &RunOptions::ground);
  t.add("--map-size", "texels along a side of the shadow map; several with commas", &RunOptions::map_sizes);
  t.add(
      "--equal-bytes",
      "let the layers of a map, cascades or a cube's faces, together have the texels of one map of --map-size, so that "
      "fits compare at equal bytes",
      &RunOptions::equal_bytes);
  t.add("--pad-texels",
        "texels around the scene in the map (default: what the widest kernel of the run needs); set it where runs "
        "of different filters are compared",
        &RunOptions::pad_texels);
  t.add("--view", "a scene's camera by its name; may be repeated (default: all)", &RunOptions::views);
  t.add("--light-name", "one of a scene's several lights by its name; may be repeated (default: all, each by itself)",
        &RunOptions::light_names);
  t.add("--size", "picture size in pixels, WIDTHxHEIGHT; several with commas", &RunOptions::sizes);
  t.add("--map-format", "how the map stores depth: d16, d24 or d32f", &RunOptions::map);
  t.add(
      "--reversed-depth", "store 1 - depth; filters read the same depth as without it",
      [](auto& o) -> auto& { return o.map.curve.reversed; });
  t.add(
      "--perspective-depth",
      "store depth as a perspective projection would whose far plane is this many times as far away as its "
      "near plane; filters read linear depth all the same",
      [](auto& o) -> auto& { return o.map.curve; });
  t.add(
       "--blend-casters",
       "how the map holds casters that one sees through, glTF's BLEND or an opacity below 1: 'opaque', as if one did "
       "not; 'hashed', in texels by a hash of the place on the surface; 'dither', by a matrix of 8 x 8 texels. Rays of "
       "the truth are dimmed by 1 - alpha in any case",
       [](auto& o) -> auto& { return o.map.blend_casters; })
      .one_of(render::blend_caster_names());
  t.add("--fit",
        "light frustum: 'tight' around casters and receivers; 'sphere', which is stable under rotation; 'view', "
        "around what the camera sees and the casters before it; 'cascades', which give slices of that a map each: "
        "cascades:count=2..4,split=uniform|practical|logarithmic,blend=0.1,depths=all|seen, or in metres "
        "cascades:splits=5/20,near=0.1,far=80; 'focused', 'lispsm', "
        "'psm', 'tsm' or 'logpsm', which warp it; of a point light 'paraboloid'; may be repeated (default: tight)",
        &RunOptions::fits);
  t.add_switch("--snap",
               "keep the map's texels fixed in the world while the frusta of --fit view and cascades move: on or off",
               &RunOptions::snap);
  t.add("--light", "AZIMUTH,ELEVATION in degrees, where the light stands in every scene: azimuth 0 is +z, 90 is +x",
        &RunOptions::light)
      .never_empty("AZIMUTH,ELEVATION in degrees");
  t.add(
       "--border",
       "what lookups read outside the map: 'border', depth 1, which is right; to see what goes wrong, 'edge', which "
       "smears casters at the map's edge outwards, or 'repeat', which tiles the map's shadows. See it on --scene "
       "edge",
       [](auto& o) -> auto& { return o.range.border; })
      .one_of(filters::border_names());
  t.add_switch(
      "--far-test", "whether what lies beyond the map's far plane is lit; 'off' compares it, and all of it is dark",
      [](auto& o) -> auto& { return o.range.far_test; });
  t.add_switch(
      "--behind-test",
      "whether a spot light leaves out what is behind it; 'off' mirrors its cone, its cookie and its map "
      "through the light",
      [](auto& o) -> auto& { return o.range.behind_test; });
  t.decides = Decides::kContent;
  t.add("--border-page",
        "also draw SCENE.borders.png: every filter with the right border, with each wrong one, and without the "
        "far-plane test",
        &RunOptions::border_page);
  t.decides = Decides::kCells;
  t.add_row("--filters",
            "filters with parameters, such as none,vsm:radius=6,min_variance=1e-4,esm:width=medium; width, a class of "
            "'list filters' or texels, sets the radius; 'all' is every filter but those for teaching; @ before a name "
            "of 'list presets' is what an engine ships (default: those of the experiment 'default')",
            std::string())
      .names(ValueKind::kFilters)
      .also_called("--filter");
  t.add_row(
       "--width",
       "the kernel's width of every filter that --filters tells none, and no radius: a class of 'list filters', "
       "texels, "
       "'light', what the scene's light asks for in each map, or 'own', that of each filter's own defaults",
       kOwnWidth,
       [](RunOptions& o, const Told& told) {
         const auto& text = std::get<std::string>(told);
         if (text != kOwnWidth && text != filters::kLightWidth && !filters::find_width(text))
           fail(fmt::format("--width: '{}': {}; or '{}'", text, filters::explain_no_width(text), kOwnWidth));
         o.kernel_width = text == kOwnWidth ? std::string() : text;
       },
       [](const RunOptions& o) { return Told(o.kernel_width.empty() ? kOwnWidth : o.kernel_width); })
      .never_empty("a class of width, texels, light or own");
  t.add("--filter-file", "a filter of your own, one GLSL file; may be repeated", &RunOptions::filter_files)
      .names(ValueKind::kFile);
  t.add_row("--tuned",
            "a tuned.json of 'shadowbench tune': every filter it names takes its parameters, but for those that "
            "--filters sets",
            std::string())
      .names(ValueKind::kFile);
  t.add("--bias",
        "depth bias, MODE:KEY=X,...; several add up: " + render::list_bias_modes() +
            ". Units: depth (0..1 over the light's range), texels (their width), world (metres), kernels (how far the "
            "filter's comparisons reach). plane: what the receiver's plane gains over so many texels; slope: times "
            "1 - n.l, or constant where that is more; receiver-plane: the plane's depth at every tap; front-cull, "
            "midpoint: what the map holds (default plane:kernels=1,depth=2e-5). Planes steeper than 10:1 towards the "
            "light are biased as 10:1",
        &RunOptions::bias_texts);
  t.decides = Decides::kContent;
  t.add("--rounds",
        "how often each filter is timed: a number, or 'auto', until its ratio to the unfiltered lookup is precise "
        "enough or the budget is spent",
        &RunOptions::rounds);
  t.add("--phases",
        fmt::format("places of the map's grid, moved by parts of a texel, over which errors are averaged: 1 .. {}",
                    kMostAveraged),
        &RunOptions::phases);
  t.add("--frames",
        fmt::format("also accumulate visibility over so many frames: 1, which is none, .. {}", kMostAveraged),
        &RunOptions::frames);
  t.add(
      "--precision", "for --rounds auto: how wide the ratio's 95 % interval may be, relative to the ratio",
      [](auto& o) -> auto& { return o.rounds.precision; });
  t.add_row(
      "--budget", "for --rounds auto: seconds of timed work for each filter on each map", 0.4,
      [](RunOptions& o, const Told& told) { o.rounds.budget_ms = 1e3 * std::get<double>(told); },
      [](const RunOptions& o) { return o.rounds.budget_ms / 1e3; });
  t.add_row(
       "--gpu",
       "also say what filters cost on these GPUs, which need not be there: names of 'list gpus' with commas, or "
       "'none'",
       kDefaultGpus,
       [](RunOptions& o, const Told& told) {
         o.gpus = gpu::choose_gpus(gpu::load_gpus(o.resources.gpus), split_list(std::get<std::string>(told)));
       },
       [](const RunOptions& o) {
         Texts names;
         for (const gpu::Gpu& gpu : o.gpus) names.push_back(gpu.name);
         return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ","));
       })
      .never_empty("names of 'list gpus', or none");
  t.add("--seed", "seed of random rotations and of the order in which filters are timed", &RunOptions::seed);
  t.add("--truth", "trace rays, and score every filter against them (default)", &RunOptions::truth).with_opposite();
  t.add("--truth-weight",
        "what visibility is held against: 'area', the share of the light's area (of a sphere's solid angle) that is "
        "seen, as filters define it, or 'cosine', the share of the unshadowed light that arrives, as a renderer has "
        "it; pictures are always held against the latter",
        &RunOptions::truth_weight);
  t.add("--attribution", "take the errors apart: trace kernels, run models (default)", &RunOptions::attribution)
      .with_opposite();
  t.add("--stability",
        "say where numbers break, as pictures and counts: overflow, negative variance, 16- against 32-bit stores, "
        "bounds that do not hold",
        &RunOptions::stability)
      .with_opposite();
  t.add("--uncertainty", "keep how far rounding and other seeds can move each pixel, which 'regress' allows for",
        &RunOptions::uncertainty)
      .with_opposite();
  t.add("--all-parts",
        "keep pictures, the parts of errors, receivers and the depth map as floats, too, from which a filter can be "
        "computed again: EXR files take eight times the room",
        &RunOptions::all_parts)
      .with_opposite();
  t.decides = Decides::kCells;
  t.add("--cell-timeout", "seconds that a filter of your own may take on one scene", &RunOptions::cell_timeout_s);
  t.add_row("--grids",
            fmt::format("compare all filters of a view in one picture, and keep their float images (default up to {} "
                        "filters)",
                        kFiltersOfAGrid),
            0)
      .with_opposite();
  t.add_row("--lights", "", std::string())
      .gone("each copy of a light costs the same; list several lights in the scene's file, and add up their times");
  t.decides = Decides::kWay;
  t.add("--shard", "I/N: every N-th cell only, from the I-th on; 'merge' joins the N report folders", &RunOptions::part)
      .never_empty("I/N");
  t.add("--fresh", "measure every cell again, even those that an earlier run finished in the report folder",
        &RunOptions::fresh);
  t.add_row("--until-different", "", std::string())
      .gone("the page says how small a difference the run can see; raise --phases to see a smaller one");
  t.add("--yes", "start even where there are very many cells", &RunOptions::large_is_fine);
  t.add("--pictures", "", &RunOptions::pictures).with_opposite().hide();
  return std::move(t.rows);
}

std::vector<std::string> list_texts(const Told& told) {
  return std::visit(
      [](const auto& value) -> Texts {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, Texts>)
          return value;
        else if constexpr (std::is_same_v<Value, std::optional<double>>)
          return value ? Texts{fmt::format("{}", *value)} : Texts();
        else
          return {fmt::format("{}", value)};
      },
      told);
}

void read_run_options(const std::vector<RunOption>& all, RunOptions& options) {
  for (const RunOption& option : all)
    if (option.read) option.read(options, option.told);
  const double padding = options.pad_texels.value_or(0.0);
  if (!(padding >= 0.0 && padding <= kMostPadding))
    fail(fmt::format("--pad-texels: {} is out of range: choose 0 .. {:g}", padding, kMostPadding));
  require_in_range("--precision", options.rounds.precision, 0.0, 1.0);
  require_in_range("--budget", options.rounds.budget_ms / 1e3, 0.0, 3600.0, " seconds");
  require_in_range("--cell-timeout", options.cell_timeout_s, 0.0, 86400.0, " seconds");
  options.bias = render::parse_bias(options.bias_texts);
  options.fit = options.fits.front();
}

void check_run_options(const RunOptions& options) {
  render::require_drawable(options.bias, options.map);
  for (const filters::FilterRequest& request : options.filters) render::require_usable(options.bias, request.spec);
  if (options.border_page && !options.grids)
    fail(
        fmt::format("--border-page shows all filters side by side, which --no-grids leaves out, as do more than {} "
                    "filters: name fewer, give --grids, or leave it out",
                    kFiltersOfAGrid));
  if (options.grids && options.part.shards > 1)
    fail("--shard needs --no-grids: a grid shows all filters of a view, and a shard has some of them");
}

}  // namespace shadowbench::options
