#include "report/pages/html.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/analysis/cell_group.h"
#include "report/analysis/summary.h"
#include "report/page/embedded.h"
#include "report/page/html_parts.h"
#include "report/pages/attribution_html.h"
#include "report/pages/text_tables.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::pages {
namespace {

using OptionalPath = std::optional<std::string>;

std::string title_of(const records::RunRecord& run, const std::string& scene) {
  const auto found = std::find_if(run.scenes.begin(), run.scenes.end(),
                                  [&](const records::SceneRecord& candidate) { return candidate.name == scene; });
  return found == run.scenes.end() ? std::string() : found->title;
}

// The first path that a cell of the group names: cells of one group share it.
OptionalPath find_path(const analysis::CellGroup& group, OptionalPath records::ImagesRecord::*member) {
  for (const records::CellRecord& cell : group.cells)
    if (cell.images.*member) return cell.images.*member;
  return std::nullopt;
}

std::string html_gallery(const std::string& title, const std::string& figures, std::string_view style) {
  return figures.empty() ? figures
                         : fmt::format("<details open><summary>{}</summary>\n<div class=\"{}\">\n{}</div></details>\n",
                                       page::escape_html(title), style, figures);
}

std::string html_attribution_pictures(const analysis::CellGroup& group) {
  std::string figures;
  for (const records::CellRecord& cell : group.cells)
    if (cell.images.attribution)
      figures += page::figure(*cell.images.attribution,
                              analysis::label_cell(group, cell) + ": the error and its four parts", "single");
  return html_gallery("Where in the picture the error comes from", figures, "gallery wide");
}

std::string html_stability_pictures(const analysis::CellGroup& group) {
  std::string figures;
  for (const records::CellRecord& cell : group.cells) {
    if (cell.images.stability)
      figures +=
          page::figure(*cell.images.stability,
                       analysis::label_cell(group, cell) + ": where its numbers break, or come near to it", "single");
  }
  return html_gallery("Where numbers break: overflow, negative variance, 16 bits, and bounds", figures, "gallery wide");
}

std::string html_single_pictures(const analysis::CellGroup& group) {
  std::string figures;
  for (const records::CellRecord& cell : group.cells) {
    const std::string params = cell.params.empty() ? std::string() : " (" + records::describe_params(cell.params) + ")";
    if (cell.images.picture)
      figures += page::figure(*cell.images.picture, cell.filter + params + ": picture", "single");
    if (cell.images.visibility)
      figures += page::figure(*cell.images.visibility, cell.filter + params + ": visibility", "single");
  }
  return html_gallery("Single pictures", figures, "gallery");
}

std::string html_map_pictures(const analysis::CellGroup& group) {
  std::string figures;
  const std::pair<OptionalPath records::ImagesRecord::*, const char*> pictures[] = {
      {&records::ImagesRecord::depth_map, "depth map, as the light sees the scene, with its histogram"},
      {&records::ImagesRecord::texel_density, "how many map texels fall on each pixel"},
      {&records::ImagesRecord::texel_grid, "the map's texels on the surfaces"}};
  for (const auto& [member, caption] : pictures)
    if (const auto path = find_path(group, member)) figures += page::figure(*path, caption, "single");
  return html_gallery("The shadow map: its depths, and where its texels fall", figures, "gallery");
}

std::string html_group(const records::RunRecord& run, const analysis::CellGroup& group, std::size_t number) {
  const std::string title = title_of(run, group.scene);
  std::string text = fmt::format("<section id=\"group-{}\">\n<h2>{}{}</h2>\n<p class=\"note\">{}</p>\n", number,
                                 page::escape_html(group.scene), title.empty() ? "" : ": " + page::escape_html(title),
                                 page::escape_html(records::describe_settings(group.cells.front())));
  text += page::html_list(analysis::describe_group(group, run.gl));
  text += page::html_table(make_cost_table(group, run.gl), "What it costs: " + records::describe_clock(run.gl), "cost");
  text += page::html_table(make_accuracy_table(group), "How wrong it is, and why: errors of visibility in [0,1]",
                           "accuracy");
  text += make_bars_html(group);
  if (const auto grid = find_path(group, &records::ImagesRecord::grid))
    text += page::figure(*grid, "all filters on " + group.scene + ", full size behind the link", "grid");
  text += html_attribution_pictures(group);
  text += html_stability_pictures(group);
  text += html_single_pictures(group);
  text += html_map_pictures(group);
  if (const auto exr = find_path(group, &records::ImagesRecord::exr))
    text += "<p>" + page::link(*exr, *exr) + " holds the float images of all filters.</p>\n";
  return text + "</section>\n";
}

std::string html_navigation(const std::vector<analysis::CellGroup>& groups) {
  std::string text = "<nav>";
  for (std::size_t i = 0; i < groups.size(); ++i)
    text += fmt::format("<a href=\"#group-{}\">{}</a> ", i, page::escape_html(groups[i].scene));
  return text + "</nav>\n";
}

std::string html_absences(const std::vector<records::CellRecord>& cells) {
  std::vector<std::string> items;
  for (const auto& [reason, count] : analysis::count_absences(cells))
    items.push_back(fmt::format("{} ({} of {} cells)", reason, count, cells.size()));
  return items.empty() ? std::string()
                       : "<section>\n<h2>What is not there, and why</h2>\n" + page::html_list(items) + "</section>\n";
}

}  // namespace

std::string make_index_html(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                            const std::string& trade) {
  const std::vector<analysis::CellGroup> groups = analysis::group_cells(cells);
  std::string page = page::html_head("Shadow filters compared", page::page_style()) +
                     "<body>\n<main>\n<h1>Shadow filters compared</h1>\n" + html_navigation(groups);
  page += page::html_facts(analysis::list_run_facts(run));
  page += "<p>Data: " + page::link("summary.md", "summary.md") + ", " + page::link("timings.csv", "timings.csv") +
          ", " + page::link("accuracy.csv", "accuracy.csv") + ", " + page::link("results.json", "results.json") + " (" +
          page::link("results.schema.json", "its schema") + ").</p>\n";
  if (!run.warnings.empty())
    page += "<section class=\"warnings\">\n<h2>Warnings</h2>\n" + page::html_list(run.warnings) + "</section>\n";
  page += trade;
  for (std::size_t i = 0; i < groups.size(); ++i) page += html_group(run, groups[i], i);
  return page + html_absences(cells) + "</main>\n</body>\n</html>\n";
}

}  // namespace shadowbench::pages
