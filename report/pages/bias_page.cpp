#include "report/pages/bias_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "reference/metrics/metric_table.h"
#include "report/pages/write_page.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

using records::BiasCell;

/// A filter with less acne than this, a pixel in a thousand, has enough bias.
constexpr double kLittleAcne = 0.001;
constexpr double kNarrowGap = 0.01, kWideGap = 0.1;

/// The cells of a filter under a mode, by ascending amount; none where the filter cannot use it.
using Curve = std::span<const BiasCell>;

Curve find_curve(const records::BiasSweepRecord& sweep, const std::string& mode, const std::string& filter) {
  const auto is_own = [&](const BiasCell& cell) { return cell.mode == mode && cell.filter == filter; };
  const auto begin = std::ranges::find_if(sweep.cells, is_own);
  return {begin, std::find_if_not(begin, sweep.cells.end(), is_own)};
}

/// The least amount swept that is enough; null where none is.
const BiasCell* find_enough(Curve curve) {
  const auto found =
      std::ranges::find_if(curve, [](const BiasCell& each) { return each.acne.value_or(1.0) < kLittleAcne; });
  return found == curve.end() ? nullptr : &*found;
}

/// For comparison: an absent gap, of which nothing is known, is worse than a small one and better than a wide one.
double weigh_gap(const BiasCell& cell) { return cell.contact_gap.value_or(kWideGap); }

/// What a mode comes to for a filter.
std::pair<std::string, document::Grade> judge_curve(Curve curve) {
  const BiasCell* enough = find_enough(curve);
  const BiasCell& cell = enough ? *enough : curve.back();
  if (!cell.acne) return {"acne absent", document::Grade::kNone};
  if (!enough) return {"acne " + records::format_rate(cell.acne), document::Grade::kBad};
  return {(cell.factor ? name_factor(*cell.factor) + ", " : "") + "gap " + records::format_rate(cell.contact_gap),
          !cell.contact_gap                ? document::Grade::kNone
          : *cell.contact_gap < kNarrowGap ? document::Grade::kGood
          : *cell.contact_gap < kWideGap   ? document::Grade::kNear
                                           : document::Grade::kBad};
}

/// The bias to ship, and what each mode comes to for each filter.
document::Table make_verdict_table(const records::BiasSweepRecord& sweep) {
  document::Table table{"", {{"mode"}, {}}};
  for (const BiasCell& each : recommend_biases({sweep}))
    table.judge("to ship", each.filter, describe_bias(each),
                each.bias.empty() ? document::Grade::kBad : document::Grade::kNone);
  for (const records::BiasModeRecord& mode : sweep.modes)
    for (const std::string& filter : sweep.filters)
      if (const Curve curve = find_curve(sweep, mode.mode, filter); !curve.empty()) {
        auto [text, grade] = judge_curve(curve);
        table.judge(mode.mode, filter, std::move(text), grade);
      }
  return table;
}

/// How many filters some mode frees of acne, and the widest contact gap that it then opens.
std::string describe_answer(const records::BiasSweepRecord& sweep) {
  const std::vector<BiasCell> biases = recommend_biases({sweep});
  std::string text =
      fmt::format("{} of {} filters have less than {:g} % acne with the bias to ship",
                  biases.size() - static_cast<std::size_t>(std::ranges::count(biases, "", &BiasCell::bias)),
                  biases.size(), 100.0 * kLittleAcne);
  const auto widest = std::ranges::max_element(biases, {}, &BiasCell::contact_gap);
  return text + (widest != biases.end() && widest->contact_gap
                     ? fmt::format("; the widest contact gap is {}, of {}.", records::format_rate(widest->contact_gap),
                                   widest->filter)
                     : "; contact gaps are absent: too few receivers are left to rate.");
}

/// A setting of an engine: its scale times a length of the least bias without acne, the map's texel in metres, the sine
/// of the angle between the steepest lit surfaces' normals and the light, and 1 minus its cosine, each to a power.
struct EngineSetting {
  const char* name;
  const char* mode;
  double scale;
  std::optional<double> BiasCell::*amount;
  int texel, sine, rise;
  const char* how;
};

constexpr double kSoftKernel = 2.5;  // by which Unity multiplies both of its biases where a light's shadows are soft
constexpr double kSoftLow = 2.0;     // the radius by which Godot multiplies its bias at its default quality

constexpr EngineSetting kSettings[] = {
    {"three.js bias", "constant", -1.0, &BiasCell::lift_depth, 0, 0, 0,
     "three.js adds `bias` to the receiver's depth in [0,1]; less is nearer to the light (LightShadow, "
     "shadowmap_pars_fragment)."},
    {"Unity URP Depth Bias", "constant", 1.0 / kSoftKernel, &BiasCell::lift_texels, 0, 0, 0,
     "Unity's universal pipeline moves casters away from the light by so many texels, 2.5 times as far for soft "
     "shadows, which stand here (ShadowUtils.GetShadowBias, Shadows.hlsl). It sets glPolygonOffset(2.5, 1) besides."},
    {"Godot Bias", "constant", 100.0 / kSoftLow, &BiasCell::lift_depth, 0, 0, 0,
     "Godot moves receivers towards the light by a hundredth of it times the depth range, the light's blur (1 by "
     "default) and the radius of its quality, 2 at Soft Low, the default (light_storage.cpp, 4.x)."},
    {"Filament constantBias", "constant", 1.0, &BiasCell::lift_m, 0, 0, 0,
     "Filament takes metres (LightManager::ShadowOptions)."},
    {"three.js normalBias", "normal-offset", 1.0, &BiasCell::setting, 1, 1, 0,
     "three.js moves receivers along the normal by so many metres at every angle (shadowmap_vertex)."},
    {"Unity URP Normal Bias", "normal-offset", 1.0 / kSoftKernel, &BiasCell::setting, 0, 1, -1,
     "Unity moves casters along the normal by so many texels times 1 - n.l, 2.5 times as far for soft shadows."},
    {"Godot Normal Bias", "normal-offset", 1.0, &BiasCell::setting, 0, -1, -1,
     "Godot moves receivers along the normal by so many texels times 1 - n.l, less the part along the light "
     "(scene_forward_clustered.glsl)."},
    {"Filament normalBias", "normal-offset", 2.0, &BiasCell::setting, 0, 0, 0,
     "Filament moves receivers along the normal by half of it in texels, times the sine of the angle to the light "
     "(ShadowMapManager.cpp, light_space.fs)."},
    {"glPolygonOffset factor", "polygon-offset", 1.0, &BiasCell::setting, 0, 0, 0, "The factor, with no units."}};

std::string convert(const EngineSetting& setting, const records::BiasSweepRecord& sweep, const BiasCell& enough) {
  const double angle = sweep.angle_deg * std::numbers::pi / 180.0;
  const double value = setting.scale * *(enough.*setting.amount) * std::pow(sweep.texel_m.high, setting.texel) *
                       std::pow(std::sin(angle), setting.sine) * std::pow(1.0 - std::cos(angle), setting.rise);
  return fmt::format("{:.3g}", value + 0.0);  // no -0
}

using Rate = std::optional<double> BiasCell::*;
constexpr std::pair<Rate, const char*> kRates[] = {{&BiasCell::acne, "acne"}, {&BiasCell::contact_gap, "contact gap"}};

/// Filters that need most bias under some mode, or whose contacts that opens widest, say most, beside none.
double weigh_filter(const records::BiasSweepRecord& sweep, const std::string& filter) {
  constexpr double kNeverEnough = 1e6;  // weighs more than any amount swept
  if (filter == "none") return 2.0 * kNeverEnough;
  double weight = 0.0;
  for (const records::BiasModeRecord& mode : sweep.modes) {
    const Curve curve = find_curve(sweep, mode.mode, filter);
    if (curve.empty() || !curve.front().factor) continue;
    const BiasCell* enough = find_enough(curve);
    weight = std::max(weight, enough ? *enough->factor + enough->contact_gap.value_or(0.0) : kNeverEnough);
  }
  return weight;
}

/// A filter's acne, solid with marks, or its contact gap, dashed with hollow ones, over the places of the amounts.
document::ChartSeries make_rate_series(Curve curve, Rate rate, std::string title, const document::ChartStyle& style) {
  const bool is_gap = rate == &BiasCell::contact_gap;
  document::ChartSeries series = document::make_line(std::move(title), style);
  series.filled = !is_gap;
  if (is_gap) series.line = document::LineStyle::kDashed;
  for (const BiasCell& cell : curve) {
    if (!(cell.*rate)) continue;
    document::ChartPoint& added = series.points.emplace_back(
        document::exact_point(static_cast<double>(&cell - curve.data()), 100.0 * *(cell.*rate)));
    added.details = {series.title, fmt::format("{} of the theoretical amount: {}", name_factor(*cell.factor),
                                               records::format_rate(cell.*rate))};
  }
  return series;
}

document::Chart make_bias_chart(const records::BiasSweepRecord& sweep, const std::string& mode) {
  document::Chart chart;
  chart.title = mode;
  chart.x_name = "amount / theoretical amount";
  chart.y_name = "receivers, %";
  std::vector<double> rates = {0.0, 1.0};
  std::vector<std::pair<double, std::string>> weights;
  for (std::size_t i = 0; i < sweep.filters.size(); ++i) {
    const Curve curve = find_curve(sweep, mode, sweep.filters[i]);
    if (curve.empty()) continue;
    if (chart.x.ticks.empty())
      for (const BiasCell& cell : curve)
        chart.x.ticks.emplace_back(static_cast<double>(&cell - curve.data()), name_factor(*cell.factor));
    for (const auto& [rate, name] : kRates) {
      document::ChartSeries series =
          make_rate_series(curve, rate, fmt::format("{}: {}", sweep.filters[i], name), document::style_of(i));
      if (series.points.empty()) continue;
      for (const document::ChartPoint& point : series.points) rates.push_back(point.y.value);
      weights.emplace_back(weigh_filter(sweep, sweep.filters[i]), series.title);
      chart.series.push_back(std::move(series));
    }
  }
  chart.x.low = -0.3;
  chart.x.high = static_cast<double>(chart.x.ticks.size()) - 0.7;
  chart.y = document::choose_axis(rates, {}, document::TickKind::kNumber);
  document::show_most_telling(chart, std::move(weights));
  for (const auto& [place, label] : chart.x.ticks)
    if (label == name_factor(1.0))
      chart.series.push_back(
          {.title = "theory",
           .color = document::kInk,
           .line = document::LineStyle::kTies,
           .points = {document::exact_point(place, chart.y.low), document::exact_point(place, chart.y.high)}});
  return chart;
}

document::Details make_mode_details(const records::BiasModeRecord& mode) {
  document::Details details{mode.mode, {document::Paragraph{mode.meaning, true}}};
  if (!mode.left_out.empty()) details.blocks.emplace_back(document::Sentences{"Left out:", mode.left_out});
  if (!mode.picture.empty()) details.blocks.emplace_back(document::Gallery{{}, {{mode.picture, mode.picture_caption}}});
  return details;
}

std::vector<std::string> define_bias_terms() {
  return {fmt::format("Table: the smallest amount swept, in theoretical ones, that leaves less than {:g} % acne, and "
                      "the contact gap there. \u2717: none does, or the gap is {:g} % or more. To ship: the mode with "
                      "the narrowest gap, as --bias takes it.",
                      100.0 * kLittleAcne, 100.0 * kWideGap),
          fmt::format("Acne: {}.", metrics::find_metric("artefact.acne").definition),
          fmt::format("Contact gap: {}.", metrics::find_metric("artefact.contact_gap").definition),
          "Theory: on a plane, the depth between a kernel's farthest texel and the receiver, which is the kernel's "
          "half-width (and half a texel where the map is read unfiltered) times |dz/du| + |dz/dv|; the theoretical "
          "amount is that of the steepest lit surfaces. For VSM and ESM, which take slopes into account themselves, it "
          "is that of a comparison with their kernel."};
}

/// `number`: of the light, from 1 on; 0 where there is one.
document::Section make_light_section(const records::BiasSweepRecord& sweep, std::size_t number) {
  const std::string prefix = number > 0 ? fmt::format("light{}-", number) : std::string();
  document::Section section{prefix + "answer", number > 0 ? sweep.light : std::string(), {}};
  if (!sweep.refused.empty()) {
    section.blocks.emplace_back(document::Paragraph{sweep.refused});
    return section;
  }
  section.blocks = {document::Paragraph{describe_answer(sweep)}, make_verdict_table(sweep)};
  section.blocks.emplace_back(make_bias_charts(sweep, prefix));
  section.blocks.emplace_back(make_engine_details(sweep));
  for (const records::BiasModeRecord& mode : sweep.modes) section.blocks.emplace_back(make_mode_details(mode));
  section.blocks.emplace_back(document::Details{"Settings", {document::Facts{sweep.facts}}});
  return section;
}

}  // namespace

std::string name_factor(double factor) {
  return factor > 0.0 && factor < 1.0 ? fmt::format("1/{:.4g}", 1.0 / factor) : fmt::format("{:.4g}", factor);
}

document::ChartChoice make_bias_charts(const records::BiasSweepRecord& sweep, const std::string& prefix) {
  document::ChartChoice all{prefix + "bias", {}, {}};
  for (const records::BiasModeRecord& mode : sweep.modes) {
    const auto cell = std::ranges::find(sweep.cells, mode.mode, &BiasCell::mode);
    if (cell == sweep.cells.end() || !cell->factor) continue;
    all.charts.push_back(make_bias_chart(sweep, mode.mode));
    all.charts.back().id = "bias." + prefix + mode.mode;
  }
  return all;
}

std::vector<BiasCell> recommend_biases(const std::vector<records::BiasSweepRecord>& sweeps) {
  std::vector<BiasCell> recommended;
  for (const records::BiasSweepRecord& sweep : sweeps)
    for (const std::string& filter : sweep.filters) {
      const BiasCell* best = nullptr;
      for (const records::BiasModeRecord& mode : sweep.modes) {
        const BiasCell* enough = find_enough(find_curve(sweep, mode.mode, filter));
        if (enough && (!best || weigh_gap(*enough) < weigh_gap(*best))) best = enough;
      }
      const auto any = std::ranges::find(sweep.cells, filter, &BiasCell::filter);
      if (any == sweep.cells.end()) continue;
      recommended.push_back(best ? *best : *any);
      if (best) continue;
      recommended.back().bias.clear();
      recommended.back().contact_gap.reset();
    }
  return recommended;
}

std::string describe_bias(const BiasCell& recommended) {
  return recommended.bias.empty() ? "no mode removes its acne"
                                  : recommended.bias + ", contact gap " + records::format_rate(recommended.contact_gap);
}

document::Details make_engine_details(const records::BiasSweepRecord& sweep) {
  document::Details details{"In the units of engines", {}};
  if (sweep.texel_m.low < (1.0 - 1e-6) * sweep.texel_m.high) {
    details.blocks.emplace_back(
        document::Paragraph{"Left out: texels differ in size, as under a lamp or in cascades, and each engine "
                            "approximates that in its own way."});
    return details;
  }
  document::Table table{"", {{"filter"}, {}}};
  std::vector<std::string> how;
  for (const EngineSetting& setting : kSettings) {
    table.table.header.emplace_back(setting.name);
    how.push_back(fmt::format("{}, from {}: {}", setting.name, setting.mode, setting.how));
  }
  for (const std::string& filter : sweep.filters) {
    std::vector<std::string>& row = table.table.rows.emplace_back(std::vector{filter});
    for (const EngineSetting& setting : kSettings) {
      const BiasCell* enough = find_enough(find_curve(sweep, setting.mode, filter));
      row.push_back(enough ? convert(setting, sweep, *enough) : records::kNothing);
    }
  }
  details.blocks = {
      std::move(table),
      document::Paragraph{fmt::format("The least amount swept without acne, where no other bias is set. Settings that "
                                      "grow with the angle to the light are equal at {:.3g} degrees, that of the "
                                      "steepest lit surfaces.",
                                      sweep.angle_deg),
                          true},
      document::Sentences{"How these are converted:", std::move(how)}};
  return details;
}

document::Page make_bias_page(const std::string& title, const std::vector<records::BiasSweepRecord>& sweeps) {
  document::Page page{title, {}, {}};
  for (const records::BiasSweepRecord& sweep : sweeps)
    page.sections.push_back(
        make_light_section(sweep, sweeps.size() > 1 ? static_cast<std::size_t>(&sweep - sweeps.data()) + 1 : 0));
  page.sections.push_back({"data",
                           "",
                           {document::Details{"Terms", {document::Sentences{{}, define_bias_terms()}}},
                            link_data({"bias.csv", "bias.json"})}});
  return page;
}

}  // namespace shadowbench::pages
