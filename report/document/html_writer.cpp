#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>

#include "base/files.h"
#include "report/document/blocks.h"
#include "report/document/embedded.h"
#include "report/document/markdown.h"
#include "report/records/json_values.h"

namespace shadowbench::document {
namespace {

using nlohmann::json;

constexpr std::size_t kShortField = 28;  // characters that stay on one line

/// For elements and quoted attributes; bytes that are not UTF-8 become U+FFFD.
std::string escape_html(std::string_view text) {
  const auto valid = nlohmann::json::parse(records::dump_line(std::string(text))).get<std::string>();
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

/// Everything before the body. What scripts change is shown once they have run, so that nothing moves: a browser waits
/// for the element whose id is "read".
std::string html_head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<link rel=\"expect\" href=\"#read\" blocking=\"render\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n</head>\n",
      escape_html(title), page_style());
}

std::string html_link(const Link& link) {
  return fmt::format("<a href=\"{}\">{}</a>", encode_url_path(link.path), escape_html(link.text));
}

/// The size of a PNG file, so that nothing moves once it is loaded; empty of any other file.
std::string html_size(const std::filesystem::path& file) {
  std::array<char, 24> head{};
  std::ifstream(file, std::ios::binary).read(head.data(), head.size());
  if (std::string_view(&head[1], 3) != "PNG") return {};
  const auto read = [&](std::size_t at) {
    return std::accumulate(&head[at], &head[at + 4], 0U,
                           [](unsigned sum, char c) { return 256 * sum + static_cast<unsigned char>(c); });
  };
  return fmt::format(" width=\"{}\" height=\"{}\"", read(16), read(20));
}

std::string html_facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string html = "<dl>\n";
  for (const auto& [name, value] : facts)
    html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_html(name), escape_html(value));
  return html + "</dl>\n";
}

std::string html_list(const std::vector<std::string>& items) {
  std::string text = "<ul>\n";
  for (const std::string& item : items) text += fmt::format("<li>{}</li>\n", escape_html(item));
  return text + "</ul>\n";
}

/// Writes a line of JSON for a page's scripts. No text in it can end the element that it stands in, or begin a comment.
std::string html_data(std::string_view id, std::string_view line) {
  std::string html = fmt::format("<script type=\"application/json\" id=\"{}\">", id);
  html.reserve(html.size() + line.size() + line.size() / 16);
  for (const char c : line)
    if (c == '<' || c == '>' || c == '&')
      html += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      html += c;
  return html.append("</script>\n");
}

/// What several files of a script declare is theirs alone.
std::string html_script(std::string_view script) {
  return fmt::format("<script>\n(() => {{\n\"use strict\";\n{}}})();\n</script>\n", script);
}

/// Packs the charts of a page for charts.js. Texts that many points share are kept once, and named by their place. Each
/// chart is written once it is packed: as JSON values, the charts of a large run take ten times the memory.
class ChartPacker {
 public:
  void add(const ChartChoice& choice) {
    json selectors = json::array();
    for (const ChartChoice::Selector& each : choice.selectors)
      selectors.push_back({{"label", each.label}, {"options", each.options}, {"costs", each.costs}});
    charts_ += charts_.empty() ? R"({"charts":[)" : R"(,{"charts":[)";
    for (const Chart& each : choice.charts) {
      if (&each != &choice.charts.front()) charts_ += ',';
      charts_ += records::dump_line(pack(each));
    }
    charts_ +=
        fmt::format(R"(],"id":{},"selectors":{}}})", records::dump_line(choice.id), records::dump_line(selectors));
  }

  bool is_empty() const { return charts_.empty(); }

  /// All that was added, as a line of JSON.
  std::string write() const {
    return fmt::format(R"({{"charts":[{}],"texts":{}}})", charts_, records::dump_line(texts_));
  }

 private:
  std::size_t pack(const std::string& text) {
    const auto [found, is_new] = places_.emplace(text, places_.size());
    if (is_new) texts_.push_back(text);
    return found->second;
  }

  json pack(const std::vector<std::string>& texts) {
    json places = json::array();
    for (const std::string& text : texts) places.push_back(pack(text));
    return places;
  }

  /// Six digits are more than a chart shows.
  static json pack(double value) { return std::isfinite(value) ? json::parse(fmt::format("{:.6g}", value)) : json(); }

  static json pack(const analysis::Estimate& estimate) {
    if (estimate.low == estimate.value && estimate.high == estimate.value) return pack(estimate.value);
    return json::array({pack(estimate.value), pack(estimate.low), pack(estimate.high)});
  }

  json pack(const ChartPoint& point) {
    json packed{pack(point.x), pack(point.y), point.label, pack(point.details), point.opens, point.group};
    for (int last = 5; last > 1 && packed.back().empty(); --last) packed.erase(packed.end() - 1);
    return packed;
  }

  static json pack(const std::string& name, const ChartAxis& axis) {
    return {{"name", name}, {"log", axis.log}, {"low", axis.low}, {"high", axis.high}, {"ticks", axis.ticks}};
  }

  json pack(const Chart& chart) {
    static constexpr const char* kLines[] = {"none", "steps", "solid", "dashed", "ties"};
    static constexpr const char* kMarks[] = {"none", "circle", "square", "triangle", "diamond", "down"};
    json series = json::array();
    for (const ChartSeries& each : chart.series) {
      json points = json::array();
      for (const ChartPoint& point : each.points) points.push_back(pack(point));
      series.push_back({{"title", each.title},
                        {"color", each.color},
                        {"mark", kMarks[static_cast<std::size_t>(each.mark)]},
                        {"filled", each.filled},
                        {"faint", each.faint},
                        {"line", kLines[static_cast<std::size_t>(each.line)]},
                        {"whiskers", each.whiskers},
                        {"hidden", each.hidden},
                        {"points", std::move(points)}});
    }
    return {{"id", chart.id},
            {"title", chart.title},
            {"x", pack(chart.x_name, chart.x)},
            {"y", pack(chart.y_name, chart.y)},
            {"series", std::move(series)},
            {"notes", chart.notes}};
  }

  std::map<std::string, std::size_t> places_;
  json texts_ = json::array();
  std::string charts_;
};

/// What a column holds decides how it is aligned and broken into lines: numbers ("n"), short texts ("s") or others.
std::string classify_column(const records::TextTable& table, std::size_t column) {
  bool numbers = false, texts = false, long_texts = false;
  for (const auto& row : table.rows) {
    const std::string& field = row[column];
    const bool number = is_number_like(field);
    numbers = numbers || number;
    texts = texts || !(number || field.size() < 4);  // such as "-"
    long_texts = long_texts || field.size() > kShortField;
  }
  return long_texts ? "" : numbers && !texts ? "n" : "s";
}

/// Writes blocks as HTML, and collects the charts.
class HtmlWriter {
 public:
  explicit HtmlWriter(const std::filesystem::path& dir) : dir_(dir) {}

  std::string write(const std::vector<Block>& blocks) {
    std::string html;
    for (const Block& block : blocks) html += std::visit([this](const auto& each) { return write(each); }, block);
    return html;
  }

  const ChartPacker& charts() const { return charts_; }

 private:
  std::string write(const Picture& picture) const {
    return fmt::format(
        "<figure><a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\"{2} loading=\"lazy\"></a>"
        "<figcaption>{1}</figcaption></figure>\n",
        encode_url_path(picture.path), escape_html(picture.caption), html_size(dir_ / picture.path));
  }

  std::string write(const Facts& facts) { return html_facts(facts.items); }

  std::string write(const Sentences& sentences) {
    return write_lead(sentences.lead) + (sentences.items.empty() ? "" : html_list(sentences.items));
  }

  std::string write(const Paragraph& paragraph) {
    return fmt::format("<p{}>{}</p>\n", paragraph.quiet ? " class=\"note\"" : "", escape_html(paragraph.text));
  }

  std::string write(const Heading& heading) { return fmt::format("<h3>{}</h3>\n", escape_html(heading.text)); }

  std::string write(const Links& links) {
    std::string html = "<p>" + escape_html(links.lead);
    for (std::size_t i = 0; i < links.items.size(); ++i)
      html += (i > 0 ? ", " : links.lead.empty() ? "" : " ") + html_link(links.items[i]);
    return html + "</p>\n";
  }

  std::string write(const Table& table) {
    std::vector<std::string> classes;
    for (std::size_t i = 0; i < table.table.header.size(); ++i) classes.push_back(classify_column(table.table, i));
    const auto write_cell = [&](const char* element, std::size_t column, const std::string& text, Grade grade) {
      static constexpr const char* kGrades[] = {"", "good", "near", "bad"};
      const char* name = kGrades[static_cast<std::size_t>(grade)];
      const std::string both = classes[column] + (classes[column].empty() || !*name ? "" : " ") + name;
      return fmt::format("<{0}{1}>{2}</{0}>", element, both.empty() ? "" : " class=\"" + both + "\"",
                         escape_html(text));
    };
    std::string head, body;
    for (std::size_t i = 0; i < table.table.header.size(); ++i)
      head += write_cell("th", i, table.table.header[i], Grade::kNone);
    for (std::size_t r = 0; r < table.table.rows.size(); ++r) {
      body += "<tr>";
      for (std::size_t i = 0; i < table.table.header.size(); ++i)
        body += write_cell("td", i, table.text_at(r, i), table.grade_at(r, i));
      body += "</tr>\n";
    }
    return fmt::format(
        "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"{0}\"><table>\n<caption>{0}</caption>\n"
        "<thead><tr>{1}</tr>\n</thead>\n<tbody>\n{2}</tbody></table></div>\n",
        escape_html(table.caption), head, body);
  }

  std::string write(const Gallery& gallery) {
    std::string figures;
    for (const Picture& picture : gallery.pictures) figures += write(picture);
    if (gallery.title.empty() || figures.empty()) return figures;
    return fmt::format("<details open><summary>{}</summary>\n<div class=\"gallery{}\">\n{}</div></details>\n",
                       escape_html(gallery.title), gallery.wide ? " wide" : "", figures);
  }

  std::string write(const Bars& bars) {
    std::string html = "<figure class=\"bars\">\n<figcaption>" + escape_html(bars.title) + "<span class=\"legend\">";
    for (const auto& [color, name] : bars.legend)
      html += fmt::format("<span><i style=\"background:{}\"></i>{}</span> ", escape_html(color), escape_html(name));
    html += "</span></figcaption>\n<ul>\n";
    for (const Bars::Row& row : bars.rows) html += write_row(bars, row);
    return html + "</ul>\n</figure>\n";
  }

  /// The drawing is 1000 units wide and stretched to the page.
  static std::string write_row(const Bars& bars, const Bars::Row& row) {
    const std::string label = escape_html(row.label);
    if (row.segments.empty()) return fmt::format("<li><span>{}</span></li>\n", label);
    const auto place = [&](double value) {
      return std::lround(1000.0 * std::clamp((value - bars.low) / (bars.high - bars.low), 0.0, 1.0));
    };
    std::string html = fmt::format(
        "<li><span>{0}</span><svg viewBox=\"0 0 1000 24\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{0} · "
        "{2}\"><title>{2}</title>"
        "<rect class=\"track\" x=\"0\" y=\"4\" width=\"1000\" height=\"16\"></rect>"
        "<rect class=\"zero\" x=\"{1}\" y=\"0\" width=\"2\" height=\"24\"></rect>",
        label, place(0.0) - 1, escape_html(row.words));
    for (const Bars::Segment& segment : row.segments)
      html += fmt::format("<rect x=\"{}\" y=\"4\" width=\"{}\" height=\"16\" fill=\"{}\"></rect>", place(segment.begin),
                          place(segment.end) - place(segment.begin), escape_html(segment.color));
    return html + fmt::format("<rect class=\"net\" x=\"{}\" y=\"0\" width=\"3\" height=\"24\"></rect></svg></li>\n",
                              place(row.net) - 1);
  }

  std::string write(const Chart& chart) { return write(ChartChoice{chart.id, {}, {chart}}); }

  std::string write(const ChartChoice& choice) {
    if (choice.charts.empty()) return {};
    charts_.add(choice);
    return fmt::format(
        "<figure class=\"chart\" id=\"{}\">\n<div class=\"controls\"></div>\n<div class=\"holder\">"
        "<noscript>A script draws the chart \"{}\" here.</noscript></div>\n</figure>\n",
        escape_html(choice.id), escape_html(choice.charts.front().title));
  }

  std::string write(const Details& details) {
    return fmt::format("<details><summary>{}</summary>\n{}</details>\n", escape_html(details.summary),
                       write(details.blocks));
  }

  std::string write(const Mount& mount) {
    return fmt::format("<div class=\"{}\">{}</div>\n", escape_html(mount.name), write(mount.blocks));
  }

  static std::string write_lead(const std::string& lead) {
    return lead.empty() ? std::string() : "<p>" + escape_html(lead) + "</p>\n";
  }

  const std::filesystem::path& dir_;  ///< of the page
  ChartPacker charts_;
};

constexpr std::string_view kSiblingsBegin = "<nav class=\"siblings\">", kSiblingsEnd = "</nav>\n";

std::string write_siblings(const std::vector<Link>& siblings) {
  std::string html(kSiblingsBegin);
  for (const Link& sibling : siblings) html += html_link(sibling) + " ";
  return html.append(kSiblingsEnd);
}

std::string write_contents(const Page& page) {
  std::string sections;
  for (const Section& section : page.sections)
    if (!section.heading.empty() && !section.id.empty())
      sections += fmt::format("<a href=\"#{}\">{}</a> ", escape_html(section.id), escape_html(section.heading));
  return sections.empty() ? sections : "<nav aria-label=\"On this page\">" + sections + "</nav>\n";
}

std::string write_section(const Section& section, HtmlWriter& writer) {
  std::string html = "<section";
  if (!section.id.empty()) html += fmt::format(" id=\"{}\"", escape_html(section.id));
  html += section.warns ? " class=\"warns\">\n" : ">\n";
  if (!section.heading.empty()) html += fmt::format("<h2>{}</h2>\n", escape_html(section.heading));
  return html + writer.write(section.blocks) + "</section>\n";
}

}  // namespace

std::string replace_siblings(std::string html, const std::vector<Link>& siblings) {
  const std::size_t begin = html.find(kSiblingsBegin), end = html.find(kSiblingsEnd, begin);
  if (begin != std::string::npos && end != std::string::npos)
    html.replace(begin, end + kSiblingsEnd.size() - begin, write_siblings(siblings));
  return html;
}

std::string write_html(const Page& page, const std::filesystem::path& dir) {
  HtmlWriter writer(dir);
  std::string html = html_head(page.of.empty() ? page.title : page.title + ": " + page.of) +
                     fmt::format("<body>\n<main>\n<h1>{}</h1>\n", escape_html(page.title)) +
                     write_siblings(page.siblings);
  const bool begins = !page.sections.empty() && page.sections.front().heading.empty();  // with what it is about
  if (begins) html += write_section(page.sections.front(), writer);
  html += write_contents(page);
  for (std::size_t i = begins ? 1 : 0; i < page.sections.size(); ++i) html += write_section(page.sections[i], writer);
  html += "</main>\n";
  if (!page.data.is_null())
    html.append(html_data("run", records::dump_line(page.data))).append(html_script(run_script()));
  if (!writer.charts().is_empty())
    html.append(html_data("charts", writer.charts().write())).append(html_script(chart_script()));
  return html.append("<i id=\"read\"></i>\n</body>\n</html>\n");
}

}  // namespace shadowbench::document
