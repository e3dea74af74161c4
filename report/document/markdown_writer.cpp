#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "base/files.h"
#include "base/text.h"
#include "report/document/blocks.h"
#include "report/document/markdown.h"

namespace shadowbench::document {
namespace {

std::string write_link(const std::string& path, const std::string& text) {
  return fmt::format("[{}]({})", escape_markdown(text), encode_url_path(path));
}

std::string write_list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += "- " + escape_markdown(item) + "\n";
  return text.empty() ? text : text + "\n";
}

std::string write_blocks(const std::vector<Block>& blocks);

std::string write_block(const Facts& facts) {
  std::string text;
  for (const auto& [name, value] : facts.items)
    text += fmt::format("- **{}**: {}\n", escape_markdown(name), escape_markdown(value));
  return text + "\n";
}

std::string write_block(const Sentences& sentences) {
  return (sentences.lead.empty() ? "" : escape_markdown(sentences.lead) + "\n\n") + write_list(sentences.items);
}

std::string write_block(const Paragraph& paragraph) { return escape_markdown(paragraph.text) + "\n\n"; }

std::string write_block(const Heading& heading) { return "#### " + escape_markdown(heading.text) + "\n\n"; }

std::string write_block(const Links& links) {
  std::string text = escape_markdown(links.lead);
  for (std::size_t i = 0; i < links.items.size(); ++i)
    text += (i > 0 ? ", " : text.empty() ? "" : " ") + write_link(links.items[i].path, links.items[i].text);
  return text + "\n\n";
}

std::string write_block(const Table& table) {
  records::TextTable shown = table.table;
  for (std::size_t r = 0; r < shown.rows.size(); ++r)
    for (std::size_t i = 0; i < shown.rows[r].size(); ++i) shown.rows[r][i] = table.text_at(r, i);
  return (table.caption.empty() ? "" : escape_markdown(table.caption) + ":\n\n") + write_markdown_table(shown);
}

std::string write_block(const Gallery& gallery) {
  Links links{gallery.title.empty() ? "Picture:" : gallery.title + ":", {}};
  for (const Picture& picture : gallery.pictures) links.items.push_back({picture.path, picture.caption});
  return links.items.empty() ? std::string() : write_block(links);
}

std::string write_block(const Bars& bars) {
  std::vector<std::string> labels;
  for (const Bars::Row& row : bars.rows)
    labels.push_back(row.words.empty() ? row.label : row.label + " · " + row.words);
  return write_block(Sentences{bars.title, labels});
}

std::string write_block(const Chart& chart) {
  return fmt::format("The HTML page draws {}: {} over {}.\n\n", escape_markdown(chart.title),
                     escape_markdown(chart.y_name), escape_markdown(chart.x_name));
}

std::string write_block(const ChartChoice& choice) {
  std::vector<std::string> labels;
  for (const ChartChoice::Selector& selector : choice.selectors) labels.push_back(escape_markdown(selector.label));
  return fmt::format("The HTML page draws {} charts here, one for every {}.\n\n", choice.charts.size(),
                     fmt::join(labels, " and "));
}

std::string write_block(const Details& details) {
  return fmt::format("### {}\n\n{}", escape_markdown(details.summary), write_blocks(details.blocks));
}

std::string write_block(const Mount& mount) { return write_blocks(mount.blocks); }

std::string write_blocks(const std::vector<Block>& blocks) {
  std::string text;
  for (const Block& block : blocks) text += std::visit([](const auto& each) { return write_block(each); }, block);
  return text;
}

}  // namespace

std::string escape_markdown(std::string_view text) {
  const auto is_word = [&](std::size_t i) {
    return i < text.size() && std::isalnum(static_cast<unsigned char>(text[i]));
  };
  std::string escaped;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n' || c == '\r') {
      escaped += ' ';
      continue;
    }
    // An underscore within a word means nothing to Markdown.
    const bool harmless = c == '_' && i > 0 && is_word(i - 1) && is_word(i + 1);
    if (!harmless && std::string_view("\\`*_[]<>|#~").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

bool is_number_like(std::string_view field) {
  if (!field.empty() && (field[0] == '-' || field[0] == '+')) field.remove_prefix(1);
  return !field.empty() && std::isdigit(static_cast<unsigned char>(field[0]));
}

std::size_t count_shown(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

std::string wrap(std::string_view paragraph, std::size_t columns, std::size_t indent, std::size_t begin) {
  std::string text;
  std::size_t column = begin;
  for (const std::string& word : split_list(paragraph, " ")) {
    const std::size_t width = count_shown(word);
    if (!text.empty() && column + 1 + width > columns) {
      text += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!text.empty()) {
      text += ' ';
      ++column;
    }
    text += word;
    column += width;
  }
  return text;
}

std::string write_markdown_table(const records::TextTable& table) {
  std::vector<std::vector<std::string>> rows = {table.header};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  std::vector<std::size_t> widths(table.header.size(), 3);
  for (auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = escape_markdown(row[i]);
      widths[i] = std::max(widths[i], count_shown(row[i]));
    }
  }
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i < widths.size(); ++i)
      text += fmt::format("| {}{:{}}", rows[r][i], "", widths[i] - count_shown(rows[r][i]) + 1);
    text += "|\n";
    if (r > 0) continue;
    for (const std::size_t width : widths) text += fmt::format("|{:-<{}}", "", width + 2);
    text += "|\n";
  }
  return text + "\n";
}

std::string write_markdown(const Page& page) {
  std::string text = fmt::format("# {}\n\n", escape_markdown(page.title));
  if (!page.siblings.empty()) text += write_block(Links{"Other pages:", page.siblings});
  for (const Section& section : page.sections) {
    if (!section.heading.empty()) text += fmt::format("## {}\n\n", escape_markdown(section.heading));
    text += write_blocks(section.blocks);
  }
  return make_visible(text);
}

}  // namespace shadowbench::document
