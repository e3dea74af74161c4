#include "report/page/html_parts.h"

#include <fmt/format.h>

#include "report/files/file_name.h"
#include "report/records/json_values.h"
#include "report/records/text_table.h"

namespace shadowbench::page {
namespace {

std::string html_row(const std::vector<std::string>& fields, std::string_view element) {
  std::string text = "<tr>";
  for (const std::string& field : fields) text += fmt::format("<{0}>{1}</{0}>", element, escape_html(field));
  return text + "</tr>\n";
}

}  // namespace

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

std::string html_head(const std::string& title, std::string_view style) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n</head>\n",
      escape_html(title), style);
}

std::string link(const std::string& path, const std::string& text) {
  return fmt::format("<a href=\"{}\">{}</a>", files::encode_url_path(path), escape_html(text));
}

std::string figure(const std::string& path, const std::string& caption, std::string_view style) {
  return fmt::format(
      "<figure class=\"{2}\"><a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\" loading=\"lazy\"></a>"
      "<figcaption>{1}</figcaption></figure>\n",
      files::encode_url_path(path), escape_html(caption), style);
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

std::string html_table(const records::TextTable& table, const std::string& name, std::string_view style) {
  std::string text = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\">"
      "<table class=\"{2}\">\n<caption>{0}</caption>\n"
      "<thead>{1}</thead>\n<tbody>\n",
      escape_html(name), html_row(table.header, "th"), style);
  for (const auto& row : table.rows) text += html_row(row, "td");
  return text + "</tbody></table></div>\n";
}

}  // namespace shadowbench::page
