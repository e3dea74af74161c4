#include "report/pages/bias_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "report/analysis/extremes.h"
#include "report/pages/write_page.h"
#include "report/records/csv_tables.h"

namespace shadowbench::pages {
namespace {

constexpr double kNarrowGap = 0.01, kWideGap = 0.1;
constexpr double kNeverEnough = 1e6;  // weighs more than any amount swept

using Rate = std::optional<double> records::BiasPoint::*;

std::string format_rate(const std::optional<double>& rate) {
  return rate ? fmt::format("{:.3g} %", 100.0 * *rate) : "absent";
}

const records::BiasPoint* find_point(const records::BiasCurve& curve, double factor) {
  const auto found = std::find_if(curve.points.begin(), curve.points.end(),
                                  [&](const records::BiasPoint& p) { return p.factor == factor; });
  return found == curve.points.end() ? nullptr : &*found;
}

std::string explain_amounts() {
  return fmt::format(
      "The smallest amount swept, in theoretical ones, that leaves less than {:g} % acne, and the contact "
      "gap there. \u2717: none does, or the gap is {:g} % or more.",
      100.0 * kLittleAcne, 100.0 * kWideGap);
}

/// What a mode comes to for a filter, at the smallest amount swept that is enough where it takes an amount.
struct BiasVerdict {
  std::string text;
  document::Grade grade = document::Grade::kBad;
  std::optional<bool> free = {};  ///< of acne
  std::optional<double> gap = {};
};

BiasVerdict judge_curve(const records::BiasCurve& curve) {
  if (curve.points.empty()) return {"absent", document::Grade::kNone};
  const auto enough = find_enough(curve);
  const records::BiasPoint& point = enough ? *find_point(curve, *enough) : curve.points.back();
  if (!point.acne || *point.acne >= kLittleAcne)
    return point.acne ? BiasVerdict{"acne " + format_rate(point.acne), document::Grade::kBad, false}
                      : BiasVerdict{"acne absent", document::Grade::kNone};
  BiasVerdict verdict{(enough ? name_factor(*enough) + ", " : "") + "gap " + format_rate(point.contact_gap)};
  verdict.free = true;
  verdict.gap = point.contact_gap;
  if (!verdict.gap)
    verdict.grade = document::Grade::kNone;
  else if (*verdict.gap < kWideGap)
    verdict.grade = *verdict.gap < kNarrowGap ? document::Grade::kGood : document::Grade::kNear;
  return verdict;
}

/// One rate of the modes, each with the filters that can use it.
struct ComparedModes {
  std::vector<analysis::Rated> modes;
  int absent = 0, cells = 0;  ///< modes with a filter: those that lack the rate, and all that could have it

  void add(const std::string& mode, double rate) { modes.push_back({mode, rate, format_rate(rate)}); }

  std::string describe(const records::BiasSweepRecord& sweep) const {
    const std::string why = fmt::format("fewer than {} receivers are left to rate", sweep.fewest_receivers);
    if (modes.empty()) return absent > 0 ? "absent, since " + why : "none";
    return analysis::describe_extremes(modes, "under", "modes") +
           (absent > 0 ? fmt::format("; absent in {} of {} cells, where {}", absent, cells, why) : "");
  }
};

/// Acne and contact gap each have a sentence: one mode can be the best of one, and the worst of the other.
struct BiasHeadline {
  ComparedModes acne, gap;

  void add(const std::string& mode, const std::vector<BiasVerdict>& verdicts) {
    int rated = 0, kept = 0;
    std::optional<double> widest;
    for (const BiasVerdict& verdict : verdicts) {
      ++acne.cells;
      ++(verdict.free ? rated : acne.absent);
      if (verdict.free == false) ++kept;
      if (verdict.free != true) continue;
      ++gap.cells;
      if (!verdict.gap) ++gap.absent;
      if (verdict.gap) widest = std::max(widest.value_or(0.0), *verdict.gap);
    }
    if (rated > 0) acne.add(mode, static_cast<double>(kept) / rated);
    if (widest) gap.add(mode, *widest);
  }

  std::string describe(const records::BiasSweepRecord& sweep) const {
    if (acne.cells == 0) return "No filter of this run can use any bias.";
    return fmt::format("Filters with acne: {}. Widest contact gap of those without: {}.", acne.describe(sweep),
                       gap.describe(sweep));
  }
};

document::Section make_bias_answer(const records::BiasSweepRecord& sweep) {
  document::Table table{"Enough bias, and the contact gap it opens", {{"mode"}, {}}};
  BiasHeadline headline;
  for (const records::BiasModeRecord& mode : sweep.modes) {
    std::vector<BiasVerdict> verdicts;
    for (const records::BiasCurve& curve : mode.curves) {
      verdicts.push_back(judge_curve(curve));
      table.judge(mode.mode, curve.filter, verdicts.back().text, verdicts.back().grade);
    }
    headline.add(mode.mode, verdicts);
  }
  return {
      "answer",
      "",
      {document::Paragraph{headline.describe(sweep)}, std::move(table), document::Paragraph{explain_amounts(), true}}};
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
  const auto enough = find_enough(curve);
  return enough ? *enough + find_point(curve, *enough)->contact_gap.value_or(0.0) : kNeverEnough;
}

document::Section make_mode_section(const records::BiasModeRecord& mode, const records::BiasSweepRecord& sweep) {
  document::Section section{mode.mode, mode.mode, {document::Paragraph{mode.meaning, true}}};
  if (mode.curves.empty()) section.blocks.emplace_back(document::Paragraph{"No filter of this run can use it."});
  if (!mode.key.empty() && !mode.curves.empty()) {
    section.blocks.emplace_back(make_bias_chart(mode, sweep.filters));
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
          {"view", fmt::format("{}, {} x {} pixels", sweep.view, sweep.width, sweep.height)},
          {"shadow map", fmt::format("{0} x {0} texels of {1} m, depth range {2:.3g} m", sweep.map_size,
                                     describe_texels(sweep), sweep.depth_range_m)},
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
                fmt::format("wholly lit, with their surroundings, the share with visibility below {}", sweep.acne_below)
                    .c_str(),
                sweep.acne_receivers),
          count("Contact gap",
                fmt::format(
                    "wholly blocked by something that touches them, less those that a filter shows brighter than {0} "
                    "without bias, the share that bias makes brighter by more than {0}; absent where fewer than "
                    "{1} are left",
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

std::optional<double> find_enough(const records::BiasCurve& curve) {
  for (const records::BiasPoint& point : curve.points)
    if (point.factor && point.acne && *point.acne < kLittleAcne) return point.factor;
  return std::nullopt;
}

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

document::Page make_bias_page(const records::BiasSweepRecord& sweep) {
  document::Page page{"Depth bias: acne against contact", {make_bias_answer(sweep)}, {}};
  page.sections.push_back(make_engine_section(sweep));
  for (const records::BiasModeRecord& mode : sweep.modes) page.sections.push_back(make_mode_section(mode, sweep));
  page.sections.push_back(
      {"data",
       "",
       {document::Details{"Settings, terms and data",
                          {document::Facts{list_bias_facts(sweep)}, document::Sentences{{}, define_bias_terms(sweep)},
                           link_data({"bias.csv"})}}}});
  return page;
}

std::string make_bias_csv(const records::BiasSweepRecord& sweep) {
  const auto optional = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string();
  };
  std::string csv =
      "scene,view,map_size,mode,key,filter,factor,setting,lift_depth,lift_texels,lift_m,acne,contact_gap\r\n";
  for (const records::BiasModeRecord& mode : sweep.modes) {
    for (const records::BiasCurve& curve : mode.curves) {
      for (const records::BiasPoint& p : curve.points) {
        const auto scaled = [&](double at_theory) {
          return p.factor ? fmt::format("{}", *p.factor * at_theory) : std::string();
        };
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", records::quote_csv(sweep.scene),
                           records::quote_csv(sweep.view), sweep.map_size, mode.mode, mode.key,
                           records::quote_csv(curve.filter), optional(p.factor),
                           p.factor ? fmt::format("{}", p.setting) : "", scaled(curve.lift_depth),
                           scaled(curve.lift_texels), scaled(curve.lift_m), optional(p.acne), optional(p.contact_gap));
      }
    }
  }
  return csv;
}

}  // namespace shadowbench::pages
