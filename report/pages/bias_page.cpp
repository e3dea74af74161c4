#include "report/pages/bias_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "report/analysis/findings.h"
#include "report/pages/write_page.h"
#include "report/records/csv_tables.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

/// A filter with less acne than this, a pixel in a thousand, has enough bias.
constexpr double kLittleAcne = 0.001;
constexpr double kNarrowGap = 0.01, kWideGap = 0.1;

/// The first point with less acne than that; null where none has.
const records::BiasPoint* find_enough_point(const records::BiasCurve& curve) {
  const auto found = std::ranges::find_if(
      curve.points, [](const records::BiasPoint& point) { return point.acne && *point.acne < kLittleAcne; });
  return found == curve.points.end() ? nullptr : &*found;
}

/// Its factor; nothing where there is none, or the mode takes no amount.
std::optional<double> find_enough(const records::BiasCurve& curve) {
  const records::BiasPoint* point = find_enough_point(curve);
  return point ? point->factor : std::nullopt;
}

/// Says whose light a text is of, where there are several.
std::string name_light(const std::vector<records::BiasSweepRecord>& sweeps, const records::BiasSweepRecord& sweep,
                       const std::string& text) {
  return sweeps.size() > 1 ? sweep.light + ": " + text : text;
}

/// For comparison: an absent gap, of which nothing is known, is worse than a small one and better than a wide one.
double weigh_gap(const std::optional<double>& gap) { return gap.value_or(kWideGap); }

std::string explain_amounts() {
  return fmt::format(
      "The smallest amount swept, in theoretical ones, that leaves less than {:g} % acne, and the contact "
      "gap there. \u2717: none does, or the gap is {:g} % or more.",
      100.0 * kLittleAcne, 100.0 * kWideGap);
}

/// What a mode comes to for a filter, at the smallest amount swept that is enough where it takes an amount.
std::pair<std::string, document::Grade> judge_curve(const records::BiasCurve& curve) {
  if (curve.points.empty()) return {"absent", document::Grade::kNone};
  const records::BiasPoint* enough = find_enough_point(curve);
  const records::BiasPoint& point = enough ? *enough : curve.points.back();
  if (!point.acne) return {"acne absent", document::Grade::kNone};
  if (*point.acne >= kLittleAcne) return {"acne " + records::format_rate(point.acne), document::Grade::kBad};
  const std::optional<double>& gap = point.contact_gap;
  return {(point.factor ? name_factor(*point.factor) + ", " : "") + "gap " + records::format_rate(gap),
          !gap                ? document::Grade::kNone
          : *gap < kNarrowGap ? document::Grade::kGood
          : *gap < kWideGap   ? document::Grade::kNear
                              : document::Grade::kBad};
}

/// What each mode comes to for each filter.
document::Table make_verdict_table(const records::BiasSweepRecord& sweep) {
  document::Table table{"Enough bias, and the contact gap it opens", {{"mode"}, {}}};
  for (const records::BiasModeRecord& mode : sweep.modes)
    for (const records::BiasCurve& curve : mode.curves) {
      auto [text, grade] = judge_curve(curve);
      table.judge(mode.mode, curve.filter, std::move(text), grade);
    }
  return table;
}

/// How many filters some mode frees of acne, and the widest contact gap that it then opens.
std::string describe_bias_answer(const records::BiasSweepRecord& sweep) {
  if (!sweep.refused.empty()) return sweep.refused;
  const std::vector<records::BiasToShip> ships = list_bias_to_ship({sweep});
  const auto is_free = [](const records::BiasToShip& ship) { return !ship.bias.empty(); };
  std::string text = fmt::format("With the bias below {} of {} filters {} less than {:g} % acne",
                                 std::ranges::count_if(ships, is_free), ships.size(),
                                 ships.size() == 1 ? "has" : "have", 100.0 * kLittleAcne);
  const auto widest =
      std::ranges::max_element(ships, {}, [](const auto& ship) { return ship.contact_gap.value_or(-1.0); });
  if (widest != ships.end() && widest->contact_gap)
    return text + fmt::format("; the widest contact gap is {}, of {}.", records::format_rate(widest->contact_gap),
                              widest->filter);
  return text +
         fmt::format("; contact gaps are absent: fewer than {} receivers are left to rate.", sweep.fewest_receivers);
}

document::Table make_ship_table(const std::vector<records::BiasToShip>& ships) {
  document::Table table{"Bias to ship", {{"light"}, {}}};
  for (const records::BiasToShip& ship : ships)
    table.judge(ship.light, ship.filter, describe_bias_to_ship(ship),
                ship.bias.empty() ? document::Grade::kBad : document::Grade::kNone);
  return table;
}

/// The top of the page: what modes come to under each light, and the bias to ship.
document::Section make_bias_answers(const std::vector<records::BiasSweepRecord>& sweeps) {
  document::Section section{"answer", "", {}};
  for (const records::BiasSweepRecord& sweep : sweeps)
    section.blocks.emplace_back(document::Paragraph{name_light(sweeps, sweep, describe_bias_answer(sweep))});
  section.blocks.emplace_back(make_ship_table(list_bias_to_ship(sweeps)));
  section.blocks.emplace_back(document::Paragraph{
      fmt::format("The narrowest contact gap of the modes that leave less than {:g} % acne, as --bias takes it.",
                  100.0 * kLittleAcne),
      true});
  return section;
}

/// The least amount of a mode without acne.
struct Need {
  double setting = 0.0;  ///< of the mode's key
  double depth = 0.0;    ///< how far that moves the steepest receiver towards the light, in [0,1] over the range
  double texels = 0.0;   ///< the same, in widths of a texel
  double metres = 0.0;   ///< the same
  double texel_m = 0.0;
  double sine = 0.0;  ///< of the angle between that receiver's normal and the light
  double cosine = 1.0;
};

/// A setting of an engine, and what becomes of a need.
struct EngineSetting {
  const char* name;
  const char* mode;
  double (*convert)(const Need&);
  const char* how;
};

constexpr double kSoftKernel = 2.5;  // by which Unity multiplies both of its biases where a light's shadows are soft
constexpr double kSoftLow = 2.0;     // the radius by which Godot multiplies its bias at its default quality

constexpr EngineSetting kSettings[] = {
    {"three.js bias", "constant", [](const Need& need) { return -need.depth; },
     "three.js adds `bias` to the receiver's depth in [0,1]; less is nearer to the light (LightShadow, "
     "shadowmap_pars_fragment)."},
    {"Unity URP Depth Bias", "constant", [](const Need& need) { return need.texels / kSoftKernel; },
     "Unity's universal pipeline moves casters away from the light by so many texels, 2.5 times as far for soft "
     "shadows, which stand here (ShadowUtils.GetShadowBias, Shadows.hlsl). It sets glPolygonOffset(2.5, 1) besides."},
    {"Godot Bias", "constant", [](const Need& need) { return 100.0 * need.depth / kSoftLow; },
     "Godot moves receivers towards the light by a hundredth of it times the depth range, the light's blur (1 by "
     "default) and the radius of its quality, 2 at Soft Low, the default (light_storage.cpp, 4.x)."},
    {"Filament constantBias", "constant", [](const Need& need) { return need.metres; },
     "Filament takes metres (LightManager::ShadowOptions)."},
    {"three.js normalBias", "normal-offset", [](const Need& need) { return need.setting * need.texel_m * need.sine; },
     "three.js moves receivers along the normal by so many metres at every angle (shadowmap_vertex)."},
    {"Unity URP Normal Bias", "normal-offset",
     [](const Need& need) { return need.setting * need.sine / (1.0 - need.cosine) / kSoftKernel; },
     "Unity moves casters along the normal by so many texels times 1 - n.l, 2.5 times as far for soft shadows."},
    {"Godot Normal Bias", "normal-offset",
     [](const Need& need) { return need.setting / (need.sine * (1.0 - need.cosine)); },
     "Godot moves receivers along the normal by so many texels times 1 - n.l, less the part along the light "
     "(scene_forward_clustered.glsl)."},
    {"Filament normalBias", "normal-offset", [](const Need& need) { return 2.0 * need.setting; },
     "Filament moves receivers along the normal by half of it in texels, times the sine of the angle to the light "
     "(ShadowMapManager.cpp, light_space.fs)."},
    {"glPolygonOffset factor", "polygon-offset", [](const Need& need) { return need.setting; },
     "The factor, with no units."}};

std::optional<Need> find_need(const records::BiasSweepRecord& sweep, const char* mode, const std::string& filter) {
  const auto swept = std::ranges::find(sweep.modes, mode, &records::BiasModeRecord::mode);
  if (swept == sweep.modes.end()) return std::nullopt;
  const auto curve = std::ranges::find(swept->curves, filter, &records::BiasCurve::filter);
  const auto enough = curve == swept->curves.end() ? std::nullopt : find_enough(*curve);
  if (!enough) return std::nullopt;
  const double angle = sweep.angle_deg * std::numbers::pi / 180.0;
  return Need{*enough * curve->theory_setting,
              *enough * curve->lift_depth,
              *enough * curve->lift_texels,
              *enough * curve->lift_m,
              sweep.texel_m.most,
              std::sin(angle),
              std::cos(angle)};
}

constexpr double kNeverEnough = 1e6;  // weighs more than any amount swept

using Rate = std::optional<double> records::BiasPoint::*;

constexpr std::pair<Rate, const char*> kRates[] = {{&records::BiasPoint::acne, "acne"},
                                                   {&records::BiasPoint::contact_gap, "contact gap"}};

std::string name_curve(const records::BiasCurve& curve, Rate rate) {
  return fmt::format("{}: {}", curve.filter, rate == &records::BiasPoint::acne ? "acne" : "contact gap");
}

/// The scene without its light's name, which a scene with one light does not have.
std::string name_scene(const records::BiasSweepRecord& sweep) {
  const std::string end = "." + sweep.light;
  return sweep.scene.ends_with(end) ? sweep.scene.substr(0, sweep.scene.size() - end.size()) : sweep.scene;
}

const records::BiasPoint* find_point(const records::BiasCurve& curve, double factor) {
  const auto found = std::find_if(curve.points.begin(), curve.points.end(),
                                  [&](const records::BiasPoint& p) { return p.factor == factor; });
  return found == curve.points.end() ? nullptr : &*found;
}

records::TextTable make_amount_table(const records::BiasModeRecord& mode) {
  records::TextTable table{
      {"filter", mode.mode + ":" + mode.key, "depth", "texels", "metres", "enough", "acne", "contact gap"}, {}};
  for (const records::BiasCurve& curve : mode.curves) {
    const records::BiasPoint* theory = find_point(curve, 1.0);
    const auto enough = find_enough(curve);
    const std::string need = enough ? name_factor(*enough) : !theory || !theory->acne ? "absent" : "more than swept";
    table.rows.push_back({curve.filter, fmt::format("{:.4g}", curve.theory_setting),
                          fmt::format("{:.3g}", curve.lift_depth), fmt::format("{:.3g}", curve.lift_texels),
                          fmt::format("{:.3g}", curve.lift_m), need,
                          records::format_rate(theory ? theory->acne : std::nullopt),
                          records::format_rate(theory ? theory->contact_gap : std::nullopt)});
  }
  return table;
}

/// The factors that a mode's curves have, ascending and once each.
std::vector<double> list_factors(const records::BiasModeRecord& mode) {
  std::set<double> factors;
  for (const records::BiasCurve& curve : mode.curves)
    for (const records::BiasPoint& point : curve.points)
      if (point.factor) factors.insert(*point.factor);
  return {factors.begin(), factors.end()};
}

/// A logarithmic axis with a tick for each factor. It has no place for no bias at all, which is drawn at half the
/// smallest amount.
document::ChartAxis make_factor_axis(const std::vector<double>& factors) {
  const auto positive = std::ranges::upper_bound(factors, 0.0);
  const double least = positive == factors.end() ? 1.0 : *positive;
  document::ChartAxis axis{true, least, least, {}};
  for (const double factor : factors) {
    axis.ticks.emplace_back(factor > 0.0 ? factor : 0.5 * least, name_factor(factor));
    axis.low = std::min(axis.low, axis.ticks.back().first);
    axis.high = std::max(axis.high, axis.ticks.back().first);
  }
  axis.low /= 1.2;
  axis.high *= 1.2;
  return axis;
}

document::ChartAxis make_rate_axis(const records::BiasModeRecord& mode) {
  std::vector<double> rates = {0.0, 0.01};
  for (const records::BiasCurve& curve : mode.curves)
    for (const records::BiasPoint& point : curve.points)
      for (const auto& rate : {point.acne, point.contact_gap})
        if (rate) rates.push_back(*rate);
  document::ChartAxis axis = document::choose_axis(rates, {}, document::TickKind::kNumber);
  for (auto& [rate, label] : axis.ticks) label = fmt::format("{:.6g} %", 100.0 * rate);
  return axis;
}

/// A filter's acne, solid with marks, or its contact gap, dashed with hollow ones.
document::ChartSeries make_rate_series(const records::BiasCurve& curve, Rate rate, const document::ChartAxis& factors,
                                       const document::ChartStyle& style) {
  const bool gap = rate == &records::BiasPoint::contact_gap;
  document::ChartSeries series;
  series.title = name_curve(curve, rate);
  series.color = style.color;
  series.mark = style.mark;
  series.filled = !gap;
  series.line = gap ? document::LineStyle::kDashed : document::LineStyle::kSolid;
  for (const records::BiasPoint& point : curve.points) {
    if (!point.factor || !(point.*rate)) continue;
    const double x = *point.factor > 0.0 ? *point.factor : factors.ticks.front().first;
    document::ChartPoint& added = series.points.emplace_back(document::exact_point(x, *(point.*rate)));
    added.details = {series.title, fmt::format("{} of the theoretical amount: {}", name_factor(*point.factor),
                                               records::format_rate(point.*rate))};
  }
  return series;
}

/// Filters that need most bias, or whose contacts that opens widest, say most, beside none.
double weigh_curve(const records::BiasCurve& curve) {
  if (curve.filter == "none") return 2.0 * kNeverEnough;
  const records::BiasPoint* enough = find_enough_point(curve);
  return enough && enough->factor ? *enough->factor + enough->contact_gap.value_or(0.0) : kNeverEnough;
}

/// A mode's rates over the amount: acne solid, contact gap dashed, theory as a vertical line. What is absent is left
/// out, and said where a whole kind is. A filter's place in `filters` gives it its colour and its mark.
document::Chart make_bias_chart(const records::BiasModeRecord& mode, const std::vector<std::string>& filters) {
  document::Chart chart;
  chart.title = mode.mode;
  chart.x_name = "amount / theoretical amount";
  chart.y_name = "rate";
  const std::vector<double> factors = list_factors(mode);
  chart.x = make_factor_axis(factors);
  chart.y = make_rate_axis(mode);
  for (const auto& [rate, name] : kRates) {
    bool is_absent = true;
    for (const records::BiasCurve& curve : mode.curves) {
      const auto place = static_cast<std::size_t>(std::ranges::find(filters, curve.filter) - filters.begin());
      document::ChartSeries series = make_rate_series(curve, rate, chart.x, document::style_of(place));
      if (series.points.empty()) continue;
      is_absent = false;
      chart.series.push_back(std::move(series));
    }
    if (is_absent) chart.notes.push_back(fmt::format("{}: absent", name));
  }
  if (std::ranges::find(factors, 1.0) == factors.end()) return chart;
  document::ChartSeries theory;
  theory.title = "theory";
  theory.color = document::kInk;
  theory.line = document::LineStyle::kTies;
  for (const double y : {chart.y.low, chart.y.high}) theory.points.push_back(document::exact_point(1.0, y));
  chart.series.push_back(std::move(theory));
  return chart;
}

document::Details make_mode_details(const records::BiasModeRecord& mode) {
  document::Details details{mode.mode, {document::Paragraph{mode.meaning, true}}};
  if (mode.curves.empty()) details.blocks.emplace_back(document::Paragraph{"No filter of this run can use it."});
  if (!mode.key.empty() && !mode.curves.empty())
    details.blocks.emplace_back(
        document::Table{"At theory: amount, move towards the light, rates", make_amount_table(mode)});
  if (!mode.left_out.empty()) details.blocks.emplace_back(document::Sentences{"Left out:", mode.left_out});
  if (!mode.picture.empty()) details.blocks.emplace_back(document::Gallery{{}, {{mode.picture, mode.picture_caption}}});
  return details;
}

/// `prefix`: of ids, which a page has once.
document::Section make_modes_section(const records::BiasSweepRecord& sweep, const std::string& prefix) {
  document::Section section{prefix + "modes", "Acne and contact gap by mode", {}};
  if (document::ChartChoice charts = make_bias_charts(sweep, prefix); !charts.charts.empty())
    section.blocks.emplace_back(std::move(charts));
  section.blocks.emplace_back(document::Details{
      "Which modes are enough", {make_verdict_table(sweep), document::Paragraph{explain_amounts(), true}}});
  for (const records::BiasModeRecord& mode : sweep.modes) section.blocks.emplace_back(make_mode_details(mode));
  return section;
}

/// Under a lamp a texel is as large as it is far away.
std::string describe_texels(const records::BiasSweepRecord& sweep) {
  const std::string least = fmt::format("{:.3g}", sweep.texel_m.least),
                    most = fmt::format("{:.3g}", sweep.texel_m.most);
  return least == most ? least : least + " to " + most;
}

std::vector<std::pair<std::string, std::string>> list_bias_facts(const records::BiasSweepRecord& sweep) {
  return {{"scene", sweep.title.empty() ? sweep.scene : sweep.scene + ": " + sweep.title},
          {"light", sweep.light},
          {"view", fmt::format("{}, {} x {} pixels", sweep.view, sweep.width, sweep.height)},
          {"shadow map", fmt::format("{0} x {0} texels of {1} m, fit {3}, depth range {2:.3g} m", sweep.map_size,
                                     describe_texels(sweep), sweep.depth_range_m, sweep.fit)},
          {"steepest lit surfaces",
           fmt::format(
               "{:.3g}th percentile of slope: |dz/du| + |dz/dv| = {:.3g} of depth per texel, {:.3g} degrees between "
               "normal and light",
               100.0 * sweep.percentile, sweep.slope_depth, sweep.angle_deg)},
          {"drawn by", sweep.renderer}};
}

std::vector<std::string> define_bias_terms(const records::BiasSweepRecord& sweep) {
  const auto count = [&](const char* name, const char* which, long receivers) {
    return fmt::format(
        "{}: of {} receivers that rays find {}.{}", name, receivers, which,
        receivers < sweep.fewest_receivers ? fmt::format(" Absent: a rate needs {}.", sweep.fewest_receivers) : "");
  };
  return {count("Acne",
                fmt::format("wholly lit, with their surroundings, the share with visibility below {} of the truth's",
                            sweep.acne_below)
                    .c_str(),
                sweep.acne_receivers),
          count("Contact gap",
                fmt::format(
                    "wholly blocked by something that touches them, less those that a filter shows brighter than {0} "
                    "without bias, the share that bias makes brighter by more than {0}; with those that bias "
                    "lights as much behind something farther; absent where fewer than {1} are left of either kind",
                    sweep.gap_above, sweep.fewest_receivers)
                    .c_str(),
                sweep.contact_receivers),
          "Theory: on a plane, the depth that a kernel's farthest texel differs from the receiver's, which is the "
          "kernel's half-width "
          "(and half a texel where the map is read unfiltered) times |dz/du| + |dz/dv|. A scene has many slopes: the "
          "theoretical amount here is "
          "what theory asks of the mode for the lit receiver at the " +
              fmt::format("{:.3g}", 100.0 * sweep.percentile) + "th percentile, so the others may need more.",
          "VSM and ESM take slopes into account themselves; the theoretical amount is that of a comparison with their "
          "kernel.",
          "Tables: what to give to --bias at theory; how far that moves the receiver that it is reckoned for, as depth "
          "in [0,1], in widths of a "
          "texel and in metres along the light; and the rates there.",
          fmt::format("Enough: the smallest amount swept with acne below {} %, in theoretical amounts.",
                      100.0 * kLittleAcne)};
}

}  // namespace

std::string name_factor(double factor) {
  return factor > 0.0 && factor < 1.0 ? fmt::format("1/{:.4g}", 1.0 / factor) : fmt::format("{:.4g}", factor);
}

document::ChartChoice make_bias_charts(const records::BiasSweepRecord& sweep, const std::string& prefix) {
  document::ChartChoice all{prefix + "bias", {}, {}};
  std::map<std::string, double> weights;
  for (const records::BiasModeRecord& mode : sweep.modes) {
    if (mode.key.empty() || mode.curves.empty()) continue;
    all.charts.push_back(make_bias_chart(mode, sweep.filters));
    all.charts.back().id = "bias." + prefix + mode.mode;
    for (const records::BiasCurve& curve : mode.curves)
      for (const auto& [rate, name] : kRates) {
        double& weight = weights[name_curve(curve, rate)];
        weight = std::max(weight, weigh_curve(curve));
      }
  }
  for (document::Chart& chart : all.charts) {
    std::vector<std::pair<double, std::string>> listed;
    for (const auto& [title, weight] : weights) listed.emplace_back(weight, title);
    document::show_most_telling(chart, std::move(listed));
  }
  return all;
}

document::Page make_bias_page(const std::vector<records::BiasSweepRecord>& sweeps) {
  std::vector<std::string> lights;
  for (const records::BiasSweepRecord& sweep : sweeps) lights.push_back(sweep.light);
  const records::BiasSweepRecord& first = sweeps.front();
  document::Page page{fmt::format("Depth bias on {} under {}, map {}, {} x {}", name_scene(first),
                                  fmt::join(lights, ", "), first.map_size, first.width, first.height),
                      {make_bias_answers(sweeps)},
                      {}};
  document::Details settings{"Settings, terms and data", {}};
  for (const records::BiasSweepRecord& sweep : sweeps) {
    if (!sweep.refused.empty()) continue;
    const std::string prefix = sweeps.size() > 1 ? fmt::format("light{}-", &sweep - sweeps.data() + 1) : std::string();
    page.sections.push_back(make_engine_section(sweep));
    page.sections.back().id = prefix + page.sections.back().id;
    page.sections.back().heading = name_light(sweeps, sweep, page.sections.back().heading);
    page.sections.push_back(make_modes_section(sweep, prefix));
    page.sections.back().heading = name_light(sweeps, sweep, page.sections.back().heading);
    settings.blocks.emplace_back(document::Facts{list_bias_facts(sweep)});
    settings.blocks.emplace_back(document::Sentences{{}, define_bias_terms(sweep)});
  }
  settings.blocks.emplace_back(link_data({"bias.csv", "bias.json"}));
  page.sections.push_back({"data", "", {std::move(settings)}});
  return page;
}

std::vector<records::BiasToShip> list_bias_to_ship(const std::vector<records::BiasSweepRecord>& sweeps) {
  std::vector<records::BiasToShip> ships;
  for (const records::BiasSweepRecord& sweep : sweeps) {
    for (const std::string& filter : sweep.filters) {
      records::BiasToShip ship{sweep.scene, sweep.light, sweep.map_size, sweep.fit, filter};
      for (const records::BiasModeRecord& mode : sweep.modes) {
        const auto curve = std::ranges::find(mode.curves, filter, &records::BiasCurve::filter);
        if (curve == mode.curves.end()) continue;
        ship.id = curve->id;
        ship.params = curve->params;
        const records::BiasPoint* point = find_enough_point(*curve);
        if (!point || (!ship.bias.empty() && weigh_gap(point->contact_gap) >= weigh_gap(ship.contact_gap))) continue;
        ship.bias = mode.key.empty() ? mode.mode : fmt::format("{}:{}={:.4g}", mode.mode, mode.key, point->setting);
        ship.contact_gap = point->contact_gap;
      }
      if (sweep.refused.empty()) ships.push_back(std::move(ship));
    }
  }
  return ships;
}

std::string describe_bias_to_ship(const records::BiasToShip& ship) {
  return ship.bias.empty() ? "no mode removes its acne"
                           : ship.bias + ", contact gap " + records::format_rate(ship.contact_gap);
}

document::Section make_engine_section(const records::BiasSweepRecord& sweep) {
  document::Section section{"engines", "In the units of engines", {}};
  if (sweep.texel_m.least < (1.0 - 1e-6) * sweep.texel_m.most) {
    section.blocks.emplace_back(
        document::Paragraph{"Left out: texels differ in size, as under a lamp or in cascades, and each engine "
                            "approximates that in its own way."});
    return section;
  }
  records::TextTable table{{"filter"}, {}};
  std::vector<std::string> how;
  for (const EngineSetting& setting : kSettings) {
    table.header.emplace_back(setting.name);
    how.push_back(fmt::format("{}, from {}: {}", setting.name, setting.mode, setting.how));
  }
  for (const std::string& filter : sweep.filters) {
    table.rows.push_back({filter});
    for (const EngineSetting& setting : kSettings) {
      const auto need = find_need(sweep, setting.mode, filter);
      table.rows.back().push_back(need ? fmt::format("{:.3g}", setting.convert(*need) + 0.0) : records::kNothing);
    }
  }
  section.blocks.emplace_back(document::Paragraph{
      fmt::format("The least amount swept without acne, where no other bias is set. Settings that grow with the angle "
                  "to the light are equal at {:.3g} degrees, that of the steepest lit surfaces.",
                  sweep.angle_deg),
      true});
  section.blocks.emplace_back(document::Table{"", std::move(table)});
  section.blocks.emplace_back(document::Details{"How these are converted", {document::Sentences{{}, std::move(how)}}});
  return section;
}

std::string make_bias_csv(const std::vector<records::BiasSweepRecord>& sweeps) {
  const auto write = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string();
  };
  records::TextTable table{{"scene", "view", "map_size", "mode", "key", "filter", "factor", "setting", "lift_depth",
                            "lift_texels", "lift_m", "acne", "contact_gap"},
                           {}};
  for (const records::BiasSweepRecord& sweep : sweeps) {
    for (const records::BiasModeRecord& mode : sweep.modes) {
      for (const records::BiasCurve& curve : mode.curves) {
        for (const records::BiasPoint& p : curve.points) {
          const auto scale = [&](double at_theory) { return p.factor ? write(*p.factor * at_theory) : std::string(); };
          table.rows.push_back({sweep.scene, sweep.view, fmt::to_string(sweep.map_size), mode.mode, mode.key,
                                curve.filter, write(p.factor), p.factor ? write(p.setting) : std::string(),
                                scale(curve.lift_depth), scale(curve.lift_texels), scale(curve.lift_m), write(p.acne),
                                write(p.contact_gap)});
        }
      }
    }
  }
  return records::make_csv(table);
}

}  // namespace shadowbench::pages
