#include "harness/options/run_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "base/error.h"
#include "base/text.h"
#include "filters/kernel.h"
#include "harness/gl/objects.h"

namespace shadowbench::options {
namespace {

double parse_angle(const std::string& text, const char* name, double limit_deg) {
  const std::optional<double> value = parse_number(text);
  if (value && std::abs(*value) <= limit_deg) return *value;
  fail(fmt::format("--light: the {} '{}' must be a number of degrees, {} .. {}", name, text, -limit_deg, limit_deg));
}

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

template <class T>
requires std::is_enum_v<T> std::string tell(const T& value) { return name_of(value); }
template <class T>
requires std::is_enum_v<T>
void take(const char* name, const std::string& told, T& value) { value = parse_name<T>(told, name); }

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
void take(const char* name, const Texts& texts, std::vector<scene::FitRule>& fits) {
  fits.clear();
  for (const std::string& text : texts) {
    const scene::FitRule fit = scene::parse_fit_rule(text);
    const auto is_it = [&](const scene::FitRule& other) {
      return scene::describe_fit(other) == scene::describe_fit(fit);
    };
    if (std::ranges::any_of(fits, is_it)) fail(fmt::format("{} names {} twice", name, scene::describe_fit(fit)));
    fits.push_back(fit);
  }
}

std::string tell(const std::optional<scene::SkyAngles>& light) {
  return light ? fmt::format("{},{}", light->azimuth_deg, light->elevation_deg) : "";
}
void take(const char*, const std::string& text, std::optional<scene::SkyAngles>& light) {
  if (!text.empty()) light = parse_light(text);
}

std::string tell(const RoundLimits& rounds) { return rounds.is_fixed() ? fmt::format("{}", rounds.most) : kAuto; }
void take(const char* name, const std::string& text, RoundLimits& rounds) {
  if (text == kAuto) return;
  rounds.fewest = rounds.most = parse_count(text, name);
  if (rounds.most > kMostRounds)
    fail(fmt::format("{}: {} is out of range: choose 1 .. {}, or auto", name, rounds.most, kMostRounds));
}

std::string tell(const images::SheetWidth& width) {
  return fmt::format("{}{}", width.value, width.in_inches ? "in" : "");
}
void take(const char* name, std::string text, images::SheetWidth& width) {
  width.in_inches = text.ends_with("in");
  const std::string told = text;
  if (width.in_inches) text.resize(text.size() - 2);
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, width.value);
  if (read.ec != std::errc() || read.ptr != end)
    fail(fmt::format("{}: '{}' must be pixels, such as 1920, or inches, such as 3.3in", name, told));
  if (width.in_inches)
    require_in_range(name, width.value, 2.0, 20.0, " inches");
  else
    require_in_range(name, width.value, 480.0, 7680.0, " pixels");
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

std::string Option::value_name() const {
  if (!value.empty()) return value;
  if (!choices.empty()) return fmt::format("{}", fmt::join(choices, "|"));
  switch (kind) {
    case ValueKind::kFile: return "FILE";
    case ValueKind::kFolder: return "FOLDER";
    case ValueKind::kScene: return "SCENE";
    case ValueKind::kFilters: return "FILTERS";
    default: break;
  }
  const bool number = std::holds_alternative<std::uint32_t*>(variable) || std::holds_alternative<double*>(variable) ||
                      std::holds_alternative<std::optional<double>*>(variable);
  return number ? "N" : "TEXT";
}

std::string Option::default_value() const {
  if (const auto* text = std::get_if<std::string*>(&variable)) return **text;
  if (const auto* number = std::get_if<double*>(&variable)) return fmt::format("{:g}", **number);
  if (const auto* number = std::get_if<std::uint32_t*>(&variable)) return fmt::format("{}", **number);
  return {};
}

void fail(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

void require_in_range(const char* option, double value, double more_than, double most, const char* unit) {
  if (value > more_than && value <= most) return;
  fail(fmt::format("{}: {} is out of range: choose more than {:g}, at most {:g}{}", option, value, more_than, most,
                   unit));
}

int parse_count(const std::string& text, const char* option) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1)
    fail(fmt::format("{}: '{}' must be a whole number, 1 or more", option, text));
  return value;
}

std::pair<int, int> parse_picture_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos) fail(fmt::format("--size: '{}' must be WIDTHxHEIGHT, such as 960x540", text));
  return {parse_count(text.substr(0, cross), "--size"), parse_count(text.substr(cross + 1), "--size")};
}

scene::SkyAngles parse_light(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos)
    fail(fmt::format("--light: '{}' must be AZIMUTH,ELEVATION in degrees, such as 120,35", text));
  return {parse_angle(text.substr(0, comma), "azimuth", 360.0), parse_angle(text.substr(comma + 1), "elevation", 90.0)};
}

std::string RunOption::key() const {
  std::string key = name.substr(2);
  std::ranges::replace(key, '-', '_');
  return key;
}

std::vector<RunOption> list_run_options() {
  Table t;
  const std::string scene = "Scene and light", map = "Shadow map", filter = "Filters", measure = "Measurement",
                    output = "Output";
  t.add("--scene",
        "built-in scene, model (.gltf, .glb, .obj), .toml, or folder with one; repeatable (default all built-in)",
        &RunOptions::scenes)
      .in(scene)
      .names(ValueKind::kScene);
  t.add("--ground", "put a floor under a bare model", &RunOptions::ground).in(scene).rarely();
  t.add("--map-size", "texels along a side; several with commas", &RunOptions::map_sizes).in(map).takes("N,...");
  t.add("--equal-bytes", "share the texels of one --map-size among a map's layers (cascades, cube faces)",
        &RunOptions::equal_bytes)
      .in(map)
      .rarely();
  t.add("--pad-texels",
        "margin around the scene in texels (default: what the widest kernel needs); set it to compare runs of "
        "different filters",
        &RunOptions::pad_texels)
      .in(map)
      .rarely();
  t.add("--view", "the scene's camera of this name; repeatable (default all)", &RunOptions::views).in(scene);
  t.add("--light-name", "the scene's light of this name; repeatable (default all, one at a time)",
        &RunOptions::light_names)
      .in(scene)
      .rarely();
  t.add("--size", "image size in pixels; several with commas", &RunOptions::sizes).in(scene).takes("WxH,...");
  t.add("--map-format", "depth format", &RunOptions::map).in(map).takes("d16|d24|d32f").rarely();
  t.add(
       "--reversed-depth", "store 1 - depth; filters still read depth",
       [](auto& o) -> auto& { return o.map.curve.reversed; })
      .in(map)
      .rarely();
  t.add(
       "--perspective-depth",
       "store the depth of a perspective projection with this ratio of far to near plane; filters still read linear "
       "depth",
       [](auto& o) -> auto& { return o.map.curve; })
      .in(map)
      .rarely();
  t.add(
       "--blend-casters",
       "transparent casters (glTF BLEND, opacity below 1) in the map: opaque, hashed per texel, or dithered by an 8 x "
       "8 "
       "matrix; rays are always dimmed by 1 - alpha",
       [](auto& o) -> auto& { return o.map.blend_casters; })
      .one_of(list_names<render::BlendCasters>())
      .in(scene)
      .rarely();
  t.add("--fit",
        "light frustum: tight, sphere, view, cascades, focused, lispsm, psm, tsm, logpsm, or paraboloid; such as "
        "cascades:count=4,split=logarithmic,blend=0.1; repeatable (default tight)",
        &RunOptions::fits)
      .in(map);
  t.add_switch("--snap", "keep texels fixed in the world while the frusta of view and cascades move", &RunOptions::snap)
      .in(map)
      .rarely();
  t.add("--light", "direction of the light in degrees; azimuth 0 is +z, 90 is +x", &RunOptions::light)
      .never_empty("AZIMUTH,ELEVATION in degrees")
      .takes("AZIMUTH,ELEVATION")
      .in(scene);
  t.add(
       "--border", "what lookups outside the map read: depth 1 (border, correct), the edge's depth, or the map again",
       [](auto& o) -> auto& { return o.range.border; })
      .one_of(list_names<filters::Border>())
      .in(map)
      .rarely();
  t.add_switch(
       "--far-test", "light everything beyond the map's far plane; off compares it, which makes it dark",
       [](auto& o) -> auto& { return o.range.far_test; })
      .in(map)
      .rarely();
  t.add_switch(
       "--behind-test", "exclude what is behind a spot light; off mirrors cone and map through the light",
       [](auto& o) -> auto& { return o.range.behind_test; })
      .in(map)
      .rarely();
  t.decides = Decides::kContent;
  t.add("--border-page", "also draw SCENE.borders.png: every filter under each border, and without the far-plane test",
        &RunOptions::border_page)
      .in(map)
      .rarely();
  t.decides = Decides::kCells;
  t.add_row("--filters",
            "none,vsm:radius=6,esm:width=medium, all, or @PRESET of an engine (default: eight, one per "
            "family)",
            std::string())
      .names(ValueKind::kFilters)
      .also_called("--filter")
      .in(filter);
  t.add_row(
       "--width",
       "kernel width unless a filter names one: sharp, medium, soft, texels, light (what the scene's light needs) or "
       "own (the filter's default) (default light)",
       kOwnWidth,
       [](RunOptions& o, const Told& told) {
         const auto& text = std::get<std::string>(told);
         if (text != kOwnWidth && text != filters::kLightWidth && !filters::find_width(text))
           fail(fmt::format("--width: '{}': {}; or '{}'", text, filters::explain_no_width(text), kOwnWidth));
         o.kernel_width = text == kOwnWidth ? std::string() : text;
       },
       [](const RunOptions& o) { return Told(o.kernel_width.empty() ? kOwnWidth : o.kernel_width); })
      .never_empty("a class of width, texels, light or own")
      .in(filter);
  t.add("--filter-file", "a filter of your own, one GLSL file; repeatable", &RunOptions::filter_files)
      .names(ValueKind::kFile)
      .in(filter);
  t.add_row("--tuned", "tuned.json of 'shadowbench tune'; parameters in --filters override it", std::string())
      .names(ValueKind::kFile)
      .in(filter);
  t.add("--bias",
        "depth bias; repeatable, biases add up: " + render::list_bias_modes() +
            ". In units of depth (0..1 over the light's range), texels, world (metres) or kernels (the reach of a "
            "filter's comparisons) (default plane:kernels=1,depth=2e-5)",
        &RunOptions::bias_texts)
      .in(map)
      .takes("MODE:KEY=X")
      .rarely();
  t.decides = Decides::kContent;
  t.add("--rounds", "timings per filter: a number, or auto: until --precision or --budget is reached",
        &RunOptions::rounds)
      .in(measure)
      .rarely();
  t.add("--phases", fmt::format("sub-texel offsets of the map to average errors over, 1 .. {}", kMostAveraged),
        &RunOptions::phases)
      .in(measure);
  t.add("--frames", fmt::format("frames to accumulate visibility over, 1 .. {}", kMostAveraged), &RunOptions::frames)
      .in(measure)
      .rarely();
  t.add(
       "--precision", "for --rounds auto: relative width of the cost ratio's 95 % interval",
       [](auto& o) -> auto& { return o.rounds.precision; })
      .in(measure)
      .rarely();
  t.add_row(
       "--budget", "for --rounds auto: seconds of timing per filter and map", 0.2,
       [](RunOptions& o, const Told& told) { o.rounds.budget_ms = 1e3 * std::get<double>(told); },
       [](const RunOptions& o) { return o.rounds.budget_ms / 1e3; })
      .in(measure)
      .rarely();
  t.add_row(
       "--gpu", "estimate costs on these GPUs of 'list gpus'; none for none", kDefaultGpus,
       [](RunOptions& o, const Told& told) {
         o.gpus = gpu::choose_gpus(gpu::load_gpus(o.resources.gpus), split_list(std::get<std::string>(told)));
       },
       [](const RunOptions& o) {
         Texts names;
         for (const gpu::Gpu& gpu : o.gpus) names.push_back(gpu.name);
         return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ","));
       })
      .never_empty("names of 'list gpus', or none")
      .takes("NAME,...")
      .in(measure);
  t.add("--seed", "seed of random rotations and of the order of timing", &RunOptions::seed).in(measure).rarely();
  t.add("--truth", "ray-trace the scene and score every filter against it (default)", &RunOptions::truth)
      .with_opposite()
      .in(measure);
  t.add("--truth-weight",
        "visibility of the truth: area, the visible share of the light's area (or solid angle), as filters define it; "
        "or cosine, the share of the unshadowed light that arrives; images always use cosine",
        &RunOptions::truth_weight)
      .in(measure)
      .takes("area|cosine")
      .rarely();
  t.add("--attribution", "split errors by cause: trace kernels, run models (default)", &RunOptions::attribution)
      .with_opposite()
      .in(measure)
      .rarely();
  t.add("--stability",
        "count and draw numerical faults: overflow, negative variance, 16-bit against 32-bit stores, "
        "broken bounds",
        &RunOptions::stability)
      .with_opposite()
      .in(measure)
      .rarely();
  t.add("--uncertainty", "keep how far rounding and other seeds can move each pixel, for 'regress'",
        &RunOptions::uncertainty)
      .with_opposite()
      .in(measure)
      .rarely();
  t.add("--all-parts",
        "keep images, parts of errors, receivers and the depth map as floats, so that a filter can be recomputed (8 "
        "times the EXR size)",
        &RunOptions::all_parts)
      .with_opposite()
      .in(output)
      .rarely();
  t.decides = Decides::kCells;
  t.add("--cell-timeout", "seconds that a filter of your own may take per scene", &RunOptions::cell_timeout_s)
      .in(measure)
      .rarely();
  t.add_row("--grids",
            fmt::format("draw image grids and keep float images (default up to {} filters)", kFiltersOfAGrid), 0)
      .with_opposite()
      .in(output)
      .rarely();
  t.add_row("--lights", "", std::string())
      .gone("each copy of a light costs the same; list several lights in the scene's file, and add up their times");
  t.decides = Decides::kWay;
  t.add("--grid-width", "width of SCENE.grid.png; in inches, SCENE.grid.svg with 8 pt text for papers",
        &RunOptions::grid_width)
      .takes("PX|3.3in")
      .in(output)
      .rarely();
  t.add("--shard", "measure every N-th cell from the I-th; 'merge' joins the folders", &RunOptions::part)
      .never_empty("I/N")
      .takes("I/N")
      .in(output)
      .rarely();
  t.add("--fresh", "measure again what the folder already has", &RunOptions::fresh).in(output);
  t.add_row("--until-different", "", std::string())
      .gone("the page says how small a difference the run can see; raise --phases to see a smaller one");
  t.add("--yes", "start even with very many cells", &RunOptions::large_is_fine).in(output).rarely();
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
