#include <fmt/format.h>

#include <algorithm>

#include "report/analysis/extremes.h"
#include "report/pages/bias_page.h"

namespace shadowbench::pages {
namespace {

constexpr double kNarrowGap = 0.01, kWideGap = 0.1;

/// For comparison: an absent gap, of which nothing is known, is wider than any other.
double weigh_gap(const std::optional<double>& gap) { return gap.value_or(2.0); }

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
  const records::BiasPoint* enough = find_enough_point(curve);
  const records::BiasPoint& point = enough ? *enough : curve.points.back();
  if (!point.acne || *point.acne >= kLittleAcne)
    return point.acne ? BiasVerdict{"acne " + format_rate(point.acne), document::Grade::kBad, false}
                      : BiasVerdict{"acne absent", document::Grade::kNone};
  BiasVerdict verdict{(point.factor ? name_factor(*point.factor) + ", " : "") + "gap " +
                      format_rate(point.contact_gap)};
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

void add_bias_answer(document::Section& section, const std::vector<records::BiasSweepRecord>& sweeps,
                     const records::BiasSweepRecord& sweep) {
  if (!sweep.refused.empty()) {
    section.blocks.emplace_back(document::Paragraph{name_light(sweeps, sweep, sweep.refused)});
    return;
  }
  document::Table table{name_light(sweeps, sweep, "Enough bias, and the contact gap it opens"), {{"mode"}, {}}};
  BiasHeadline headline;
  for (const records::BiasModeRecord& mode : sweep.modes) {
    std::vector<BiasVerdict> verdicts;
    for (const records::BiasCurve& curve : mode.curves) {
      verdicts.push_back(judge_curve(curve));
      table.judge(mode.mode, curve.filter, verdicts.back().text, verdicts.back().grade);
    }
    headline.add(mode.mode, verdicts);
  }
  section.blocks.emplace_back(document::Paragraph{name_light(sweeps, sweep, headline.describe(sweep))});
  section.blocks.emplace_back(std::move(table));
}

document::Table make_ship_table(const std::vector<records::BiasToShip>& ships) {
  document::Table table{"Bias to ship", {{"light"}, {}}};
  for (const records::BiasToShip& ship : ships)
    table.judge(ship.light, ship.filter, describe_bias_to_ship(ship),
                ship.bias.empty() ? document::Grade::kBad : document::Grade::kNone);
  return table;
}

}  // namespace

std::string format_rate(const std::optional<double>& rate) {
  return rate ? fmt::format("{:.3g} %", 100.0 * *rate) : "absent";
}

const records::BiasPoint* find_enough_point(const records::BiasCurve& curve) {
  const auto found = std::ranges::find_if(
      curve.points, [](const records::BiasPoint& point) { return point.acne && *point.acne < kLittleAcne; });
  return found == curve.points.end() ? nullptr : &*found;
}

std::optional<double> find_enough(const records::BiasCurve& curve) {
  const records::BiasPoint* point = find_enough_point(curve);
  return point ? point->factor : std::nullopt;
}

std::string name_light(const std::vector<records::BiasSweepRecord>& sweeps, const records::BiasSweepRecord& sweep,
                       const std::string& text) {
  return sweeps.size() > 1 ? sweep.light + ": " + text : text;
}

document::Section make_bias_answers(const std::vector<records::BiasSweepRecord>& sweeps) {
  document::Section section{"answer", "", {}};
  for (const records::BiasSweepRecord& sweep : sweeps) add_bias_answer(section, sweeps, sweep);
  section.blocks.emplace_back(document::Paragraph{explain_amounts(), true});
  section.blocks.emplace_back(make_ship_table(list_bias_to_ship(sweeps)));
  section.blocks.emplace_back(document::Paragraph{
      "Of the modes that leave less acne than that, each at its smallest such amount, the one with the smallest "
      "contact gap, as --bias takes it.",
      true});
  return section;
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
  return ship.bias.empty() ? "no mode removes its acne" : ship.bias + ", contact gap " + format_rate(ship.contact_gap);
}

}  // namespace shadowbench::pages
