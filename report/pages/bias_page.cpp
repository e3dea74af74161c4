#include "report/pages/bias_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "report/pages/write_page.h"
#include "report/records/csv_tables.h"

namespace shadowbench::pages {
namespace {

constexpr double kNeverEnough = 1e6;  // weighs more than any amount swept

using Rate = std::optional<double> records::BiasPoint::*;

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
                          fmt::format("{:.3g}", curve.lift_m), need, format_rate(theory ? theory->acne : std::nullopt),
                          format_rate(theory ? theory->contact_gap : std::nullopt)});
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
  series.title = curve.filter + (gap ? ": contact gap" : ": acne");
  series.color = style.color;
  series.mark = style.mark;
  series.filled = !gap;
  series.line = gap ? document::LineStyle::kDashed : document::LineStyle::kSolid;
  for (const records::BiasPoint& point : curve.points) {
    if (!point.factor || !(point.*rate)) continue;
    const double x = *point.factor > 0.0 ? *point.factor : factors.ticks.front().first;
    document::ChartPoint& added = series.points.emplace_back(document::exact_point(x, *(point.*rate)));
    added.details = {series.title, fmt::format("{} of the theoretical amount: {}", name_factor(*point.factor),
                                               format_rate(point.*rate))};
  }
  return series;
}

/// Filters that need most bias, or whose contacts that opens widest, say most, beside none.
double weigh_curve(const records::BiasCurve& curve) {
  if (curve.filter == "none") return 2.0 * kNeverEnough;
  const records::BiasPoint* enough = find_enough_point(curve);
  return enough && enough->factor ? *enough->factor + enough->contact_gap.value_or(0.0) : kNeverEnough;
}

/// `prefix`: of ids, which a page has once.
document::Section make_mode_section(const records::BiasModeRecord& mode, const records::BiasSweepRecord& sweep,
                                    const std::string& heading, const std::string& prefix) {
  document::Section section{prefix + mode.mode, heading, {document::Paragraph{mode.meaning, true}}};
  if (mode.curves.empty()) section.blocks.emplace_back(document::Paragraph{"No filter of this run can use it."});
  if (!mode.key.empty() && !mode.curves.empty()) {
    document::Chart chart = make_bias_chart(mode, sweep.filters);
    chart.id = "bias." + prefix + mode.mode;
    section.blocks.emplace_back(std::move(chart));
    section.blocks.emplace_back(
        document::Table{"At theory: amount, move towards the light, rates", make_amount_table(mode)});
  }
  if (!mode.left_out.empty())
    section.blocks.emplace_back(document::Details{"Left out", {document::Sentences{{}, mode.left_out}}});
  if (!mode.picture.empty()) section.blocks.emplace_back(document::Gallery{{}, {{mode.picture, mode.picture_caption}}});
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

document::Chart make_bias_chart(const records::BiasModeRecord& mode, const std::vector<std::string>& filters) {
  document::Chart chart;
  chart.id = "bias." + mode.mode;
  chart.title = mode.mode + ": acne and contact gap over the amount";
  chart.x_name = "amount / theoretical amount";
  chart.y_name = "rate";
  const std::vector<double> factors = list_factors(mode);
  chart.x = make_factor_axis(factors);
  chart.y = make_rate_axis(mode);
  const std::pair<Rate, const char*> kinds[] = {{&records::BiasPoint::acne, "acne"},
                                                {&records::BiasPoint::contact_gap, "contact gap"}};
  std::vector<std::pair<double, std::string>> weights;
  for (const records::BiasCurve& curve : mode.curves) {
    const auto place = static_cast<std::size_t>(std::ranges::find(filters, curve.filter) - filters.begin());
    for (const auto& [rate, name] : kinds) {
      document::ChartSeries series = make_rate_series(curve, rate, chart.x, document::style_of(place));
      if (series.points.empty()) continue;
      weights.emplace_back(weigh_curve(curve), series.title);
      chart.series.push_back(std::move(series));
    }
  }
  for (const auto& [rate, name] : kinds)
    if (std::ranges::none_of(weights, [&](const auto& each) { return each.second.ends_with(name); }))
      chart.notes.push_back(fmt::format("{}: absent", name));
  document::show_most_telling(chart, std::move(weights));
  if (std::ranges::find(factors, 1.0) == factors.end()) return chart;
  document::ChartSeries theory;
  theory.title = "theory";
  theory.color = document::kInk;
  theory.line = document::LineStyle::kTies;
  for (const double y : {chart.y.low, chart.y.high}) theory.points.push_back(document::exact_point(1.0, y));
  chart.series.push_back(std::move(theory));
  return chart;
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
    for (const records::BiasModeRecord& mode : sweep.modes)
      page.sections.push_back(make_mode_section(mode, sweep, name_light(sweeps, sweep, mode.mode), prefix));
    settings.blocks.emplace_back(document::Facts{list_bias_facts(sweep)});
    settings.blocks.emplace_back(document::Sentences{{}, define_bias_terms(sweep)});
  }
  settings.blocks.emplace_back(link_data({"bias.csv", "bias.json"}));
  page.sections.push_back({"data", "", {std::move(settings)}});
  return page;
}

std::string make_bias_csv(const std::vector<records::BiasSweepRecord>& sweeps) {
  const auto optional = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string();
  };
  std::string csv =
      "scene,view,map_size,mode,key,filter,factor,setting,lift_depth,lift_texels,lift_m,acne,contact_gap\r\n";
  for (const records::BiasSweepRecord& sweep : sweeps) {
    for (const records::BiasModeRecord& mode : sweep.modes) {
      for (const records::BiasCurve& curve : mode.curves) {
        for (const records::BiasPoint& p : curve.points) {
          const auto scaled = [&](double at_theory) {
            return p.factor ? fmt::format("{}", *p.factor * at_theory) : std::string();
          };
          csv += fmt::format(
              "{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", records::quote_csv(sweep.scene),
              records::quote_csv(sweep.view), sweep.map_size, mode.mode, mode.key, records::quote_csv(curve.filter),
              optional(p.factor), p.factor ? fmt::format("{}", p.setting) : "", scaled(curve.lift_depth),
              scaled(curve.lift_texels), scaled(curve.lift_m), optional(p.acne), optional(p.contact_gap));
        }
      }
    }
  }
  return csv;
}

}  // namespace shadowbench::pages
