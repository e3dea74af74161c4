#include "report/regress/regress_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/pages/write_page.h"
#include "report/regress/regress_text.h"

namespace shadowbench::regress {
namespace {

page::Section make_cell_section(const Comparison& comparison, std::size_t place) {
  page::Section section{fmt::format("cell-{}", place),
                        fmt::format("{}: {}", name_of(comparison.outcome), name_cell(comparison)),
                        {page::Sentences{comparison.accepted ? "Accepted." : "", describe_differences(comparison)}}};
  if (comparison.picture)
    section.blocks.emplace_back(
        page::Gallery{{}, {{*comparison.picture, "Expected, actual, and their difference: " + name_cell(comparison)}}});
  return section;
}

/// By how many times its limit the worst error or difference of pixels of a cell moved; nothing where none did.
std::string describe_excess(const Comparison& comparison) {
  double most = 0.0;
  for (const Finding& finding : comparison.findings)
    if ((finding.expected && finding.metric.starts_with("error.")) || finding.metric.starts_with("visibility."))
      if (finding.actual && finding.limit > 0.0)
        most = std::max(most, std::abs(*finding.actual - finding.expected.value_or(0.0)) / *finding.limit);
  return most > 0.0 ? fmt::format(", {:.3g} x its limit", most) : "";
}

page::Section make_answer(const RegressReport& report) {
  std::string text = describe_counts(report) + ".";
  if (report.failed() > 0) text += " Worst: " + describe_worst(report) + ".";
  if (!report.damaged.empty()) text += " Damaged in the baseline: " + describe_damage(report.damaged) + ".";
  page::Table table{"The worst cell of each scene and filter", {{"scene"}, {}}};
  for (const Comparison& each : report.comparisons)  // the worst first
    table.judge(each.scene, each.filter, name_of(each.outcome) + (each.accepted ? ", accepted" : describe_excess(each)),
                each.failed()    ? page::Grade::kBad
                : each.differs() ? page::Grade::kNear
                                 : page::Grade::kGood);
  return {"answer", "", {page::Paragraph{std::move(text)}, std::move(table)}};
}

}  // namespace

page::Page make_regress_page(const RegressReport& report) {
  page::Page page{"Comparison with the baseline", {make_answer(report)}, {}};
  if (const std::string ending = describe_ending(report); !ending.empty())
    page.sections.push_back({"accept", "", {page::Paragraph{ending}}, report.failed() > 0});
  std::size_t place = 0;
  for (const Comparison& comparison : report.comparisons)
    if (comparison.differs() && ++place <= kMostListed) page.sections.push_back(make_cell_section(comparison, place));
  if (place > kMostListed)
    page.sections.push_back(
        {"rest", "", {page::Paragraph{fmt::format("{} more cells differ: see regress.json.", place - kMostListed)}}});
  page.sections.push_back({"data",
                           "",
                           {page::Details{"Settings and data",
                                          {page::Facts{{{"run", report.options.run.string()},
                                                        {"baseline", report.options.baseline.string()}}},
                                           pages::link_data({"regress.json"})}}}});
  return page;
}

}  // namespace shadowbench::regress
