#include "report/html.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/attribution_html.h"
#include "report/embedded.h"
#include "report/html_parts.h"
#include "report/json_values.h"
#include "report/summary.h"
#include "report/text_tables.h"

namespace shadowbench::report {
namespace {

using OptionalPath = std::optional<std::string>;

std::string title_of(const RunRecord& run, const std::string& scene) {
  const auto found = std::find_if(run.scenes.begin(), run.scenes.end(),
                                  [&](const SceneRecord& candidate) { return candidate.name == scene; });
  return found == run.scenes.end() ? std::string() : found->title;
}

// The first path that a cell of the group names: cells of one group share it.
OptionalPath find_path(const CellGroup& group, OptionalPath ImagesRecord::*member) {
  for (const CellRecord& cell : group.cells)
    if (cell.images.*member) return cell.images.*member;
  return std::nullopt;
}

std::string html_gallery(const std::string& title, const std::string& figures, std::string_view style) {
  return figures.empty() ? figures
                         : fmt::format("<details open><summary>{}</summary>\n<div class=\"{}\">\n{}</div></details>\n",
                                       escape_html(title), style, figures);
}

std::string html_attribution_pictures(const CellGroup& group) {
  std::string figures;
  for (const CellRecord& cell : group.cells)
    if (cell.images.attribution)
      figures += figure(*cell.images.attribution, label_cell(group, cell) + ": the error and its four parts", "single");
  return html_gallery("Where in the picture the error comes from", figures, "gallery wide");
}

std::string html_stability_pictures(const CellGroup& group) {
  std::string figures;
  for (const CellRecord& cell : group.cells) {
    if (cell.images.stability)
      figures += figure(*cell.images.stability,
                        label_cell(group, cell) + ": where its numbers break, or come near to it", "single");
  }
  return html_gallery("Where numbers break: overflow, negative variance, 16 bits, and bounds", figures, "gallery wide");
}

std::string html_single_pictures(const CellGroup& group) {
  std::string figures;
  for (const CellRecord& cell : group.cells) {
    const std::string params = cell.params.empty() ? std::string() : " (" + describe_params(cell.params) + ")";
    if (cell.images.picture) figures += figure(*cell.images.picture, cell.filter + params + ": picture", "single");
    if (cell.images.visibility)
      figures += figure(*cell.images.visibility, cell.filter + params + ": visibility", "single");
  }
  return html_gallery("Single pictures", figures, "gallery");
}

std::string html_map_pictures(const CellGroup& group) {
  std::string figures;
  const std::pair<OptionalPath ImagesRecord::*, const char*> pictures[] = {
      {&ImagesRecord::depth_map, "depth map, as the light sees the scene, with its histogram"},
      {&ImagesRecord::texel_density, "how many map texels fall on each pixel"},
      {&ImagesRecord::texel_grid, "the map's texels on the surfaces"}};
  for (const auto& [member, caption] : pictures)
    if (const auto path = find_path(group, member)) figures += figure(*path, caption, "single");
  return html_gallery("The shadow map: its depths, and where its texels fall", figures, "gallery");
}

std::string html_group(const RunRecord& run, const CellGroup& group, std::size_t number) {
  const std::string title = title_of(run, group.scene);
  std::string text = fmt::format("<section id=\"group-{}\">\n<h2>{}{}</h2>\n<p class=\"note\">{}</p>\n", number,
                                 escape_html(group.scene), title.empty() ? "" : ": " + escape_html(title),
                                 escape_html(describe_settings(group.cells.front())));
  text += html_list(describe_group(group, run.gl));
  text += html_table(make_cost_table(group, run.gl), "What it costs: " + describe_clock(run.gl), "cost");
  text += html_table(make_accuracy_table(group), "How wrong it is, and why: errors of visibility in [0,1]", "accuracy");
  text += make_bars_html(group);
  if (const auto grid = find_path(group, &ImagesRecord::grid))
    text += figure(*grid, "all filters on " + group.scene + ", full size behind the link", "grid");
  text += html_attribution_pictures(group);
  text += html_stability_pictures(group);
  text += html_single_pictures(group);
  text += html_map_pictures(group);
  if (const auto exr = find_path(group, &ImagesRecord::exr))
    text += "<p>" + link(*exr, *exr) + " holds the float images of all filters.</p>\n";
  return text + "</section>\n";
}

std::string html_navigation(const std::vector<CellGroup>& groups) {
  std::string text = "<nav>";
  for (std::size_t i = 0; i < groups.size(); ++i)
    text += fmt::format("<a href=\"#group-{}\">{}</a> ", i, escape_html(groups[i].scene));
  return text + "</nav>\n";
}

std::string html_absences(const std::vector<CellRecord>& cells) {
  std::vector<std::string> items;
  for (const auto& [reason, count] : count_absences(cells))
    items.push_back(fmt::format("{} ({} of {} cells)", reason, count, cells.size()));
  return items.empty() ? std::string()
                       : "<section>\n<h2>What is not there, and why</h2>\n" + html_list(items) + "</section>\n";
}

}  // namespace

std::string escape_html(std::string_view text) {
  const auto valid = nlohmann::json::parse(dump_line(std::string(text))).get<std::string>();
  std::string escaped;
  for (const char c : valid) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      case '\'': escaped += "&#39;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

std::string make_index_html(const RunRecord& run, const std::vector<CellRecord>& cells, const std::string& trade) {
  const std::vector<CellGroup> groups = group_cells(cells);
  std::string page = html_head("Shadow filters compared", page_style()) +
                     "<body>\n<main>\n<h1>Shadow filters compared</h1>\n" + html_navigation(groups);
  page += html_facts(list_run_facts(run));
  page += "<p>Data: " + link("summary.md", "summary.md") + ", " + link("timings.csv", "timings.csv") + ", " +
          link("accuracy.csv", "accuracy.csv") + ", " + link("results.json", "results.json") + " (" +
          link("results.schema.json", "its schema") + ").</p>\n";
  if (!run.warnings.empty())
    page += "<section class=\"warnings\">\n<h2>Warnings</h2>\n" + html_list(run.warnings) + "</section>\n";
  page += trade;
  for (std::size_t i = 0; i < groups.size(); ++i) page += html_group(run, groups[i], i);
  return page + html_absences(cells) + "</main>\n</body>\n</html>\n";
}

}  // namespace shadowbench::report
