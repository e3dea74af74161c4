#include "report/pages/bias_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "report/page/embedded.h"
#include "report/page/html_parts.h"
#include "report/pages/bias_chart.h"
#include "report/pages/tables.h"
#include "report/records/csv.h"
#include "report/records/text_table.h"

namespace shadowbench::pages {
namespace {

using Rate = std::optional<double> records::BiasPoint::*;

std::string format_rate(const std::optional<double>& rate) {
  return rate ? fmt::format("{:.3g} %", 100.0 * *rate) : "absent";
}

const records::BiasPoint* find_point(const records::BiasCurve& curve, double factor) {
  const auto found = std::find_if(curve.points.begin(), curve.points.end(),
                                  [&](const records::BiasPoint& p) { return p.factor == factor; });
  return found == curve.points.end() ? nullptr : &*found;
}

bool has_any(const records::BiasCurve& curve, Rate rate) {
  return std::any_of(
      curve.points.begin(), curve.points.end(), [&](const records::BiasPoint& p) { return (p.*rate).has_value(); });
}

std::string describe_need(const records::BiasCurve& curve) {
  const std::optional<double> enough = find_enough(curve);
  if (!enough) return curve.filter + " has more at every amount swept";
  if (*enough == 0.0) return curve.filter + " needs none";
  return fmt::format("{} needs {}", curve.filter, name_factor(*enough));
}

/// Says between which values a rate lies over the filters, at theory.
std::string describe_range(const records::BiasModeRecord& mode, Rate rate, const std::string& name) {
  const records::BiasCurve *least = nullptr, *most = nullptr;
  const auto value = [&](const records::BiasCurve* curve) { return *(find_point(*curve, 1.0)->*rate); };
  for (const records::BiasCurve& curve : mode.curves) {
    const records::BiasPoint* point = find_point(curve, 1.0);
    if (!point || !(point->*rate)) continue;
    if (!least || value(&curve) < value(least)) least = &curve;
    if (!most || value(&curve) > value(most)) most = &curve;
  }
  if (!least) return name + " is absent";
  if (value(least) == value(most)) return fmt::format("{} is {}", name, format_rate(value(least)));
  return fmt::format("{} lies between {} ({}) and {} ({})", name, format_rate(value(least)), least->filter,
                     format_rate(value(most)), most->filter);
}

records::TextTable make_amount_table(const records::BiasModeRecord& mode) {
  records::TextTable table{
      {"filter", mode.mode + ":" + mode.key, "depth", "texels", "metres", "enough", "acne", "contact gap"}, {}};
  for (const records::BiasCurve& curve : mode.curves) {
    const records::BiasPoint* theory = find_point(curve, 1.0);
    const auto enough = find_enough(curve);
    const std::string need = !has_any(curve, &records::BiasPoint::acne) ? "absent"
                             : enough                                   ? name_factor(*enough)
                                                                        : "more than swept";
    table.rows.push_back({curve.filter, fmt::format("{:.4g}", curve.theory_setting),
                          fmt::format("{:.3g}", curve.lift_depth), fmt::format("{:.3g}", curve.lift_texels),
                          fmt::format("{:.3g}", curve.lift_m), need, format_rate(theory ? theory->acne : std::nullopt),
                          format_rate(theory ? theory->contact_gap : std::nullopt)});
  }
  return table;
}

records::TextTable make_fixed_table(const records::BiasModeRecord& mode) {
  records::TextTable table{{"filter", "acne", "contact gap"}, {}};
  for (const records::BiasCurve& curve : mode.curves)
    for (const records::BiasPoint& point : curve.points)
      table.rows.push_back({curve.filter, format_rate(point.acne), format_rate(point.contact_gap)});
  return table;
}

std::string html_mode(const records::BiasModeRecord& mode, const records::BiasSweepRecord& sweep) {
  const bool swept = !mode.key.empty();
  std::string page = fmt::format("<section id=\"{0}\">\n<h2>{0}</h2>\n<p class=\"note\">{1}</p>\n",
                                 page::escape_html(mode.mode), page::escape_html(mode.meaning));
  std::vector<std::string> words = describe_bias_mode(mode);
  words.insert(words.end(), mode.left_out.begin(), mode.left_out.end());
  page += page::html_list(words) + "<div class=\"mode\">\n";
  if (swept)
    page += "<figure>" + make_bias_chart(mode, sweep.filters) + "<figcaption>" + make_bias_legend(mode, sweep.filters) +
            "</figcaption></figure>\n";
  if (mode.curves.empty()) return page + "</div>\n</section>\n";
  page += swept ? page::html_table(make_amount_table(mode), "At theory: amount, move towards the light, rates", "sweep")
                : page::html_table(make_fixed_table(mode), "Takes no amount", "sweep");
  page += "</div>\n";
  if (!mode.picture.empty()) page += page::figure(mode.picture, mode.picture_caption, "grid");
  return page + "</section>\n";
}

std::vector<std::pair<std::string, std::string>> list_facts(const records::BiasSweepRecord& sweep) {
  return {{"scene", sweep.title.empty() ? sweep.scene : sweep.scene + ": " + sweep.title},
          {"view", fmt::format("{}, {} x {} pixels", sweep.view, sweep.width, sweep.height)},
          {"shadow map", fmt::format("{0} x {0} texels of {1:.3g} m, depth range {2:.3g} m", sweep.map_size,
                                     sweep.texel_m, sweep.depth_range_m)},
          {"steepest lit surfaces",
           fmt::format(
               "{:.3g}th percentile of slope: |dz/du| + |dz/dv| = {:.3g} of depth per texel, {:.3g} degrees between "
               "normal and light",
               100.0 * sweep.percentile, sweep.slope_depth, sweep.angle_deg)},
          {"drawn by", sweep.renderer}};
}

std::vector<std::string> explain(const records::BiasSweepRecord& sweep) {
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
                fmt::format("wholly blocked by something that touches them, the share with visibility above {}",
                            sweep.gap_above)
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

std::vector<std::string> describe_bias_mode(const records::BiasModeRecord& mode) {
  if (mode.key.empty()) return {};
  std::vector<std::string> needs;
  for (const records::BiasCurve& curve : mode.curves)
    if (has_any(curve, &records::BiasPoint::acne)) needs.push_back(describe_need(curve));
  std::vector<std::string> words;
  if (!needs.empty()) {
    words.push_back(
        fmt::format("For acne below {} %, in theoretical amounts: {}.", 100.0 * kLittleAcne, fmt::join(needs, "; ")));
  }
  if (mode.curves.empty()) return {"No filter of this run can use it."};
  words.push_back(fmt::format("At the theoretical amount, {}; {}.",
                              describe_range(mode, &records::BiasPoint::acne, "acne"),
                              describe_range(mode, &records::BiasPoint::contact_gap, "contact gap")));
  return words;
}

std::string make_bias_html(const records::BiasSweepRecord& sweep) {
  const std::string title = "Depth bias: acne against contact";
  std::string page = page::html_head(title, std::string(page::page_style()) + std::string(page::bias_page_style()));
  page += fmt::format("<body>\n<main>\n<h1>{}</h1>\n<nav>", title);
  for (const records::BiasModeRecord& mode : sweep.modes)
    page += fmt::format("<a href=\"#{0}\">{0}</a> ", page::escape_html(mode.mode));
  page += "</nav>\n" + page::html_facts(list_facts(sweep)) + page::html_list(explain(sweep));
  page += "<p>Data: " + page::link("bias.csv", "bias.csv") + ".</p>\n";
  for (const records::BiasModeRecord& mode : sweep.modes) page += html_mode(mode, sweep);
  return page + "</main>\n</body>\n</html>\n";
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
