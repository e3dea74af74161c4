#include "report/regress/regress_page.h"

#include <fmt/format.h>

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

page::Section make_rest_section(const std::vector<const Comparison*>& rest) {
  page::Table block{"Each with what is worst about it",
                    {{"outcome", "scene", "filter", "settings", "what differs", "accepted"}, {}}};
  for (const Comparison* each : rest)
    block.table.rows.push_back({name_of(each->outcome), each->scene, each->label, each->settings,
                                each->findings.front().text, each->accepted ? "yes" : "no"});
  return {"rest", "Further cells that differ", {std::move(block)}};
}

}  // namespace

page::Page make_regress_page(const RegressReport& report) {
  page::Page page{"Comparison with the baseline", {}, {}};
  page::Facts facts{{{"run", report.options.run.string()},
                     {"baseline", report.options.baseline.string()},
                     {"result", describe_counts(report)}}};
  page.sections.push_back({{}, {}, {std::move(facts)}});
  if (const std::string ending = describe_ending(report); !ending.empty())
    page.sections.push_back({"accept", "", {page::Paragraph{ending}}, report.failed() > 0});
  std::size_t place = 0;
  std::vector<const Comparison*> rest;
  for (const Comparison& comparison : report.comparisons) {
    if (!comparison.differs()) continue;
    if (++place <= kMostListed)
      page.sections.push_back(make_cell_section(comparison, place));
    else
      rest.push_back(&comparison);
  }
  if (!rest.empty()) page.sections.push_back(make_rest_section(rest));
  page.sections.push_back({"data", "", {pages::link_data({"regress.json"})}});
  return page;
}

}  // namespace shadowbench::regress
