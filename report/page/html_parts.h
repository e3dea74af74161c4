#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/records/text_table.h"

namespace shadowbench::page {

// The pieces that pages are made of. All escape their texts; paths are relative to the page.

/// Escapes a text for HTML, in elements and in quoted attributes; bytes that are not UTF-8 become U+FFFD.
std::string escape_html(std::string_view text);

/// Makes everything before the body; `style` is CSS.
std::string html_head(const std::string& title, std::string_view style);

/// Makes a link to a file.
std::string link(const std::string& path, const std::string& text);

/// Makes a picture that links to itself, with a caption; `style` is a class.
std::string figure(const std::string& path, const std::string& caption, std::string_view style);

/// Makes a list of names with what each is.
std::string html_facts(const std::vector<std::pair<std::string, std::string>>& facts);

/// Makes a list of sentences.
std::string html_list(const std::vector<std::string>& items);

/// Makes a table that scrolls where the page is narrow; `style` is a class.
std::string html_table(const records::TextTable& table, const std::string& name, std::string_view style);

}  // namespace shadowbench::page
