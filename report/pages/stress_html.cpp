#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/page/embedded.h"
#include "report/page/html_parts.h"
#include "report/pages/stress_plots.h"
#include "report/pages/stress_text.h"

namespace shadowbench::pages {
namespace {

std::vector<std::pair<std::string, std::string>> list_facts(const records::StressRecord& record) {
  return {{"filters", fmt::format("{}", fmt::join(record.filters, "; "))},
          {"OpenGL", fmt::format("{} ({}), {}", record.gl.renderer, record.gl.backend, record.gl.version)},
          {"machine", fmt::format("{}, {} cores", record.machine.cpu, record.machine.cores)},
          {"program", record.commit},
          {"command", fmt::format("{}", fmt::join(record.command, " "))},
          {"took", fmt::format("{:.1f} s", record.seconds)}};
}

std::string html_sentences(const std::string& title, const std::vector<std::string>& sentences) {
  return sentences.empty() ? std::string()
                           : fmt::format("<p>{}</p>\n{}", page::escape_html(title), page::html_list(sentences));
}

std::string html_warnings(const records::StressRecord& record) {
  std::vector<std::string> sentences;
  for (const records::StressAxis& axis : record.axes)
    for (const std::string& sentence : describe_disagreements(axis)) sentences.push_back(axis.id + ": " + sentence);
  if (!record.no_plots.empty()) sentences.push_back("There are no plots: " + record.no_plots + ".");
  return sentences.empty()
             ? std::string()
             : "<section class=\"warnings\">\n<h2>Warnings</h2>\n" + page::html_list(sentences) + "</section>\n";
}

std::string html_exhibit(const records::StressExhibit& exhibit) {
  std::string html =
      fmt::format("<h3>{}</h3>\n", page::escape_html(exhibit.title)) + page::html_list(exhibit.sentences);
  if (exhibit.table) html += page::html_table(*exhibit.table, exhibit.title, "stress");
  for (const records::StressExhibit::Picture& picture : exhibit.pictures)
    html += page::figure(picture.file, picture.caption, "grid");
  return html;
}

std::string html_axis(const records::StressAxis& axis, bool plotted) {
  std::string html =
      fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n<p class=\"note\">{}</p>\n", page::escape_html(axis.id),
                  page::escape_html(axis.title), page::escape_html(describe_axis(axis)));
  html += page::html_table(make_case_table(axis), "What is safe, and where it ends", "stress");
  if (plotted && has_plot(axis))
    html += page::figure(plot_file(axis),
                         fmt::format("{} over {}; filled: broken, at the upper edge where nothing finite was measured",
                                     axis.measured, axis.quantity),
                         "grid");
  html += html_sentences("Not what theory says, and why:", describe_explanations(axis));
  html += html_sentences("Not what theory says, and not explained:", describe_disagreements(axis));
  html += html_sentences("Also seen:", describe_notes(axis));
  for (const records::StressExhibit& exhibit : axis.exhibits) html += html_exhibit(exhibit);
  return html + "</section>\n";
}

}  // namespace

std::string make_stress_html(const records::StressRecord& record) {
  const std::string title = "Where filters break";
  std::string page = page::html_head(title, std::string(page::page_style()) + std::string(page::bias_page_style()));
  page += fmt::format("<body>\n<main>\n<h1>{}</h1>\n<nav>", title);
  for (const records::StressAxis& axis : record.axes)
    page += fmt::format("<a href=\"#{0}\">{0}</a> ", page::escape_html(axis.id));
  page += "</nav>\n" + page::html_facts(list_facts(record)) + html_warnings(record);
  page += "<section>\n<h2>Measured against theoretical limits</h2>\n" +
          page::html_table(make_limit_table(record), "Where each verdict is first met, found to 1 %", "stress") +
          html_sentences("Not met, and not expected:", describe_out_of_sight(record)) + "</section>\n";
  for (const records::StressAxis& axis : record.axes) page += html_axis(axis, record.no_plots.empty());
  page += "<p>Data: " + page::link("stress.json", "stress.json") + ", " + page::link("stress.csv", "stress.csv") +
          ", " + page::link("stress.md", "stress.md") + ".</p>\n";
  return page + "</main>\n</body>\n</html>\n";
}

}  // namespace shadowbench::pages
