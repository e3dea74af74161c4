#include "harness/stress/axis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "filters/model.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/stability_meter.h"
#include "harness/render/picture_passes.h"
#include "harness/run/run_plan.h"
#include "reference/metrics/error_stats.h"
#include "reference/truth/cached_tracer.h"
#include "report/images/color_values.h"
#include "report/images/grid.h"
#include "report/records/format.h"
#include "report/records/text_table.h"

namespace shadowbench::stress {

namespace {

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

const Axis& find_axis(const std::string& id, const char* option) {
  const std::vector<Axis>& table = axis_table();
  const auto found = std::ranges::find(table, id, &Axis::id);
  if (found != table.end()) return *found;
  std::vector<std::string> known;
  for (const Axis& axis : table) known.push_back(axis.id);
  fail(fmt::format("{}: there is no axis '{}'{}", option, id, did_you_mean_or_known(id, known)));
}

double parse_end(const std::string& text, const std::string& range) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    fail(fmt::format("--range: '{}' of '{}' must be a finite number, as in --range esm-exponent=10,200", text, range));
  return value;
}

records::StressRange parse_ends(const std::string& ends, const std::string& range) {
  const std::size_t comma = ends.find(',');
  if (comma == std::string::npos)
    fail(fmt::format("--range: '{}' must be AXIS=LO,HI, as in --range esm-exponent=10,200", range));
  return {parse_end(ends.substr(0, comma), range), parse_end(ends.substr(comma + 1), range)};
}

void require_usable(records::StressRange range, const Axis& axis, const std::string& text) {
  if (range.low == range.high) fail(fmt::format("--range: '{}' is empty: the ends must differ", text));
  if (range.low > range.high)
    fail(fmt::format("--range: '{}' is reversed: write {}={},{}", text, axis.id, range.high, range.low));
  const bool whole = range.low == std::floor(range.low) && range.high == std::floor(range.high);
  if (axis.whole && !whole) fail(fmt::format("--range: '{}': the {} takes whole numbers", text, axis.quantity));
  if (range.low >= axis.limits.low && range.high <= axis.limits.high) return;
  fail(fmt::format("--range: '{}' reaches beyond what the axis can do: the {} lies within {:g} .. {:g}", text,
                   axis.quantity, axis.limits.low, axis.limits.high));
}

}  // namespace

const char* name_of(Level level) {
  if (level == Level::kGl) return "GL";
  return level == Level::kModel ? "model" : "arithmetic";
}

std::vector<Axis> choose_axes(const std::string& text) {
  if (text.empty()) return axis_table();
  std::vector<Axis> axes;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const Axis& axis = find_axis(text.substr(begin, end - begin), "--axes");
    if (std::ranges::find(axes, axis.id, &Axis::id) != axes.end())
      fail(fmt::format("--axes names '{}' twice; name it once", axis.id));
    axes.push_back(axis);
    begin = end + 1;
  }
  return axes;
}

void apply_range(std::vector<Axis>& axes, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    fail(fmt::format("--range: '{}' must be AXIS=LO,HI, as in --range esm-exponent=10,200", text));
  const Axis& known = find_axis(text.substr(0, equals), "--range");
  const records::StressRange range = parse_ends(text.substr(equals + 1), text);
  require_usable(range, known, text);
  const auto chosen = std::ranges::find(axes, known.id, &Axis::id);
  if (chosen == axes.end())
    fail(fmt::format("--range: the axis '{}' is not among --axes; name it there too", known.id));
  chosen->range = range;
}

std::string find_exponent(const filters::FilterSpec& spec) {
  return spec.holds_moments ? std::string() : spec.exponent;
}

std::vector<std::string> list_choices(const filters::FilterRequest& request, const std::string& param) {
  const filters::ParamSpec* spec = request.spec.find_param(param);
  if (!spec) return {};
  if (request.set_by_user.contains(param)) return {filters::to_string(request.values.at(param))};
  std::vector<std::string> choices;
  for (const filters::ParamValue& choice : spec->choices) choices.push_back(filters::to_string(choice));
  return choices;
}

Case start_case(const AxisInputs& inputs, const filters::FilterRequest& request, std::string variant, Level level) {
  Case item{.filter = request.spec.id, .variant = std::move(variant), .level = level};
  if (level == Level::kGl && !inputs.renderer)
    item.not_available = "there is no GL";
  else if (!filters::make_model(request.spec))
    item.not_available = filters::kNoModel;
  else
    item.params = request.values;
  return item;
}

Observation judge_by_bounds(double measured, double degraded_over, double broken_over,
                            const std::function<std::string(double bound)>& describe) {
  if (measured > broken_over) return {Verdict::kBroken, measured, describe(broken_over)};
  if (measured > degraded_over) return {Verdict::kDegraded, measured, describe(degraded_over)};
  return {Verdict::kOk, measured, {}};
}

double find_largest_measured(const records::StressCase& record) {
  double largest = 0.0;
  for (const records::StressSample& sample : record.samples) largest = std::max(largest, sample.measured.value_or(0.0));
  return largest;
}

std::string explain_broken_throughout(const Disagreement& missed) {
  const bool throughout = std::ranges::all_of(
      missed.record.samples, [](const records::StressSample& sample) { return sample.verdict == Verdict::kBroken; });
  if (!throughout || !missed.record.broken) return {};
  return fmt::format("with the chosen parameters it is broken at every value ({}), which is not this axis' doing",
                     missed.record.broken->why);
}

namespace {

using images::Image;

constexpr images::Size kPlot{880, 480};
constexpr int kPen = 3;  // width of the curve
constexpr images::Rgb kInk{0.11f, 0.12f, 0.14f};

/// Places a value between an axis' ends, [0,1].
double place(const HeatAxis& axis, double value) {
  return (value - axis.range.low) / (axis.range.high - axis.range.low);
}

std::vector<images::Tick> list_ticks(const HeatAxis& axis) {
  std::vector<images::Tick> ticks;
  for (const double tick : axis.ticks) ticks.push_back({place(axis, tick), fmt::format("{:g}", tick)});
  return ticks;
}

Image draw_values(const Image& values, const images::ColorScale& scale) {
  Image plot(kPlot.width, kPlot.height, 3);
  for (int y = 0; y < plot.height; ++y)
    for (int x = 0; x < plot.width; ++x)
      std::ranges::copy(scale(*values.at(x * values.width / plot.width, y * values.height / plot.height)),
                        plot.at(x, y));
  return plot;
}

/// Every column is drawn from where the one before ended: steep parts stay in one piece.
void draw_curve(Image& plot, const HeatMap& map) {
  std::optional<int> before;
  for (int x = 0; x < plot.width; ++x) {
    const double share = static_cast<double>(x) / (plot.width - 1);
    const double value = map.curve(map.x.range.low + share * (map.x.range.high - map.x.range.low));
    const bool inside = value <= map.y.range.high;
    const int y = inside ? static_cast<int>(std::lround((1.0 - place(map.y, value)) * (plot.height - 1))) : 0;
    const int top = std::min(y, before.value_or(y)), bottom = std::max(y, before.value_or(y));
    images::fill_rect(plot, {x - kPen / 2, top - kPen / 2, kPen, bottom - top + kPen}, kInk);
    if (!inside) return;
    before = y;
  }
}

}  // namespace

images::Figure make_figure(const HeatMap& map) {
  assert(map.values.channels == 1 && map.curve);
  const images::ColorScale scale =
      images::make_linear_scale(0.0, map.scale, 1, [](float at) { return images::map_diverging(at, 1.0f); });
  Image plot = draw_values(map.values, scale);
  draw_curve(plot, map);
  return {map.title,
          map.note,
          {{{"", "up: " + map.y.label, std::move(plot), list_ticks(map.x), list_ticks(map.y)},
            {"", "to the right: " + map.x.label + "; black line: theory"},
            images::make_color_bar(scale, map.quantity)}}};
}

namespace {

constexpr int kMapSize = 512, kWidth = 480, kHeight = 270;
constexpr const char* kTitle = "A famous mistake, replayed";

/// What one set-up of the filters resulted in.
struct Result {
  images::GridTile tile;
  images::Image receivers;
  double rmse = 0.0;
  std::int64_t broken_texels = 0;
};

options::RunOptions make_options(const AxisInputs& inputs, const Mistake& mistake) {
  options::RunOptions options;
  options.phases = 1;  // no error is averaged
  options.resources = inputs.resources;
  options.scenes = {mistake.scene};
  const filters::Catalogue catalogue(inputs.resources.filters);
  for (const std::vector<std::string>* setups : {&mistake.setups, &mistake.others})
    for (const std::string& setup : *setups) options.filters.push_back(catalogue.parse_requests(setup).front());
  options.map_sizes = {kMapSize};
  options.width = kWidth;
  options.height = kHeight;
  options.seed = inputs.seed;
  return options;
}

/// A pixel that is not finite counts as wholly wrong.
double measure_rmse(std::vector<float> image, const measure::SceneTruth& truth) {
  for (std::size_t i = 0; i < image.size(); ++i)
    if (!std::isfinite(image[i])) image[i] = truth.area.texels[i] > 0.5f ? 0.0f : 1.0f;
  const auto stats = metrics::measure_error(image, truth.area.texels, truth.mask);
  return stats ? stats->rmse : 1.0;
}

/// Draws one set-up, all but its shaded picture.
Result draw(render::FilterPasses& passes, const render::ShadowMap& map, const render::GBuffer& gbuffer,
            render::ImageTarget& target, const measure::SceneTruth& truth) {
  Result result;
  images::GridTile& tile = result.tile;
  tile.label = passes.request().label();
  tile.visibility = measure::draw_visibility(passes, map, gbuffer, target);
  tile.error = measure::make_error_image(tile.visibility, truth);
  result.receivers = images::make_image(kWidth, kHeight, truth.mask);
  result.broken_texels = measure::count_broken_texels(passes, map);
  result.rmse = measure_rmse(tile.visibility.texels, truth);
  tile.caption =
      fmt::format("RMSE {} · {} overflown texels", records::format_number(result.rmse), result.broken_texels);
  return result;
}

/// Draws all set-ups on the first view of the scene.
std::vector<Result> draw_all(const AxisInputs& inputs, const Mistake& mistake) {
  const options::RunOptions options = make_options(inputs, mistake);
  const scene::Scene scene = run::load_scene(options, mistake.scene);
  const scene::Camera& camera = scene.cameras.front();
  truth::TruthCache cache(inputs.cache, [progress = inputs.progress](const std::string& message) {
    if (progress) progress->note("warning: " + message);
  });
  measure::Renderer& renderer = *inputs.renderer;
  measure::SceneAssets assets(renderer, options, scene, cache, measure::largest_padding_texels(options.filters));
  const measure::LightMap& light = assets.light_map(camera, kMapSize);
  const measure::SceneTruth& truth = assets.truth(camera);
  render::ImageTarget target("replayed visibility", GL_R32F, kWidth, kHeight);
  std::vector<Result> results;
  for (const filters::FilterRequest& request : options.filters) {
    const auto passes = measure::make_filter_passes(renderer, options, scene, light, request);
    results.push_back(draw(*passes, light.map, assets.gbuffer(camera), target, truth));
    results.back().tile.picture =
        render::shade(renderer.shaders, assets.gbuffer(camera), target.texture(), scene, camera);
  }
  return results;
}

/// Ranks a result where one set-up of the mistake's filter is compared with the others, of which there are so many at
/// the end of the results: "3 of 3".
std::string rank(const Result& result, const Result& setup, const std::vector<Result>& results, std::ptrdiff_t others) {
  const auto is_better = [&](const Result& other) { return other.rmse < result.rmse; };
  const auto better = std::count_if(results.end() - others, results.end(), is_better) + (is_better(setup) ? 1 : 0);
  return fmt::format("{} of {}", better + 1, others + 1);
}

records::TextTable make_table(const std::vector<Result>& results, std::ptrdiff_t others) {
  records::TextTable table{
      {"set-up", "overflown texels", "RMSE to area truth", "rank with the wrong set-up", "rank, corrected"}, {}};
  for (std::ptrdiff_t i = 0; i < std::ssize(results); ++i) {
    const Result& result = results[static_cast<std::size_t>(i)];
    const auto rank_with = [&](std::ptrdiff_t setup) {
      const bool takes_part = i == setup || i >= std::ssize(results) - others;
      return takes_part ? rank(result, results[static_cast<std::size_t>(setup)], results, others)
                        : std::string(records::kNothing);
    };
    table.rows.push_back({result.tile.label, fmt::format("{} of {}", result.broken_texels, kMapSize * kMapSize),
                          records::format_number(result.rmse), rank_with(0), rank_with(1)});
  }
  return table;
}

std::vector<std::string> describe(const std::vector<Result>& results, const Mistake& mistake) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < mistake.setups.size(); ++i) {
    const Result& result = results[i];
    const std::string ranked = rank(result, result, results, std::ssize(mistake.others)),
                      rmse = records::format_number(result.rmse);
    words.push_back(
        i > 0 ? fmt::format("{} ranks {} (RMSE {}), with {} overflown texels.", result.tile.label, ranked, rmse,
                            result.broken_texels)
              : fmt::format("On '{}', {} ranks {} by its error (RMSE {}), and {} of the {} texels of its map "
                            "overflowed: that number, which every run reports as a warning, says that the comparison "
                            "is of an overflow, not of a filter.",
                            mistake.scene, result.tile.label, ranked, rmse, result.broken_texels, kMapSize * kMapSize));
  }
  return words;
}

}  // namespace

Exhibit replay(const AxisInputs& inputs, const Mistake& mistake, const std::string& id) {
  std::vector<Result> results = draw_all(inputs, mistake);
  Exhibit exhibit{.id = id,
                  .title = kTitle,
                  .sentences = describe(results, mistake),
                  .table = make_table(results, std::ssize(mistake.others)),
                  .pictures = {{fmt::format("stress.{}.png", id),
                                fmt::format("picture, visibility and error of each set-up on {}", mistake.scene)}}};
  images::Grid grid;
  grid.title = kTitle;
  grid.subtitle = fmt::format("scene {}, map {}", mistake.scene, kMapSize);
  grid.columns = 4;
  grid.mask = results.front().receivers;
  for (Result& result : results) grid.tiles.push_back(std::move(result.tile));
  images::write_grid(inputs.out / exhibit.pictures.front().file, grid);
  return exhibit;
}

}  // namespace shadowbench::stress
