#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/page/embedded.h"
#include "report/page/html_parts.h"
#include "report/pages/flicker_plots.h"
#include "report/pages/flicker_text.h"

namespace shadowbench::pages {
namespace {

std::vector<std::pair<std::string, std::string>> list_facts(const records::FlickerRecord& record) {
  return {{"scene", fmt::format("{}, view {}, {} x {} pixels", record.scene, record.view, record.width, record.height)},
          {"shadow map", fmt::format("{0} x {0} texels", record.map_size)},
          {"OpenGL", fmt::format("{} ({}), {}", record.gl.renderer, record.gl.backend, record.gl.version)},
          {"program", record.commit},
          {"command", fmt::format("{}", fmt::join(record.command, " "))},
          {"took", fmt::format("{:.1f} s", record.seconds)}};
}

std::string html_plots(const records::FlickerMotion& motion) {
  std::string html;
  for (const records::FlickerVariant& variant : motion.variants) {
    html += page::figure(flicker_plot_file(motion, variant),
                         fmt::format("mean change of visibility from frame to frame, {} snapping; one scale for both",
                                     variant.snap ? "with" : "without"),
                         "grid");
  }
  return html;
}

std::string html_motion(const records::FlickerMotion& motion, const records::FlickerRecord& record) {
  std::string html =
      fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", page::escape_html(motion.id), page::escape_html(motion.title));
  html += page::html_list(describe_flicker(motion));
  html += page::html_table(make_flicker_table(motion), "Change and flicker: root mean squares of visibility per step",
                           "flicker");
  html += page::html_list(explain_motion(motion, record.frames));
  if (record.no_plots.empty()) html += html_plots(motion);
  return html +
         page::figure(motion.picture, "flicker by pixel, without snapping and with it; grey: less than 0.001", "grid") +
         "</section>\n";
}

}  // namespace

std::string make_flicker_html(const records::FlickerRecord& record) {
  const std::string title = "Flicker: filters in motion against the truth in motion";
  std::string page = page::html_head(title, page::page_style());
  page += fmt::format("<body>\n<main>\n<h1>{}</h1>\n<nav>", title);
  for (const records::FlickerMotion& motion : record.motions)
    page += fmt::format("<a href=\"#{0}\">{0}</a> ", page::escape_html(motion.id));
  page += "</nav>\n" + page::html_facts(list_facts(record)) + page::html_list(define_flicker(record));
  if (!record.no_plots.empty())
    page += fmt::format("<section class=\"warnings\">\n<h2>Warnings</h2>\n{}</section>\n",
                        page::html_list({"There are no plots: " + record.no_plots + "."}));
  for (const records::FlickerMotion& motion : record.motions) page += html_motion(motion, record);
  page += "<p>Data: " + page::link("flicker.json", "flicker.json") + ", " + page::link("flicker.csv", "flicker.csv") +
          ", " + page::link("flicker.md", "flicker.md") + ".</p>\n";
  return page + "</main>\n</body>\n</html>\n";
}

}  // namespace shadowbench::pages
