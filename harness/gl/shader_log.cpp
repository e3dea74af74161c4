#include "harness/gl/shader_log.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <optional>

#include "harness/gl/shader_source.h"

namespace shadowbench::gl {
namespace {

constexpr std::string_view kErrorWord = "error: ";  ///< which the caller's sentence has already

struct Complaint {
  std::string where;  ///< "file:line"
  std::string text;   ///< from the word error or warning on
  bool error = false;
};

/// What a line says by itself.
struct Place {
  int index = 0;
  int line = 0;
  std::size_t text_at = 0;
};

std::optional<Place> find_place(const std::string& line) {
  // Widths keep the numbers inside an int; a blank matches any blanks, or none.
  constexpr std::array kForms = {
      "%9d:%9d(%*9d): %n",     // Mesa      2:14(5): error: x
      "%9d(%9d) : %n",         // NVIDIA    2(14) : error C1008: x
      "ERROR: %9d:%9d: %n",    // others    ERROR: 2:14: x
      "WARNING: %9d:%9d: %n",  //
  };
  for (const char* form : kForms) {
    Place place;
    int end = 0;
    if (std::sscanf(line.c_str(), form, &place.index, &place.line, &end) != 2 || end == 0) continue;
    place.text_at = static_cast<std::size_t>(end);
    return place;
  }
  return std::nullopt;
}

// Takes the file from the line number, or from the driver's index where the number says nothing.
std::optional<std::string> locate(const Place& place, const std::vector<std::string>& files) {
  if (place.index < 0 || place.line < 0) return std::nullopt;
  const auto file = static_cast<std::size_t>(place.line >= kLinesPerFile ? place.line / kLinesPerFile : place.index);
  if (file >= files.size()) return std::nullopt;
  return fmt::format("{}:{}", files[file], place.line % kLinesPerFile);
}

std::optional<Complaint> parse_line(const std::string& line, const std::vector<std::string>& files) {
  const auto place = find_place(line);
  const auto where = place ? locate(*place, files) : std::nullopt;
  if (!where) return std::nullopt;
  const std::string text = line.substr(place->text_at);
  const bool error = line.starts_with("ERROR") || text.starts_with("error") || text.starts_with("fatal error");
  return Complaint{*where, text, error};
}

}  // namespace

ShaderLog translate_log(std::string_view log, const std::vector<std::string>& files) {
  ShaderLog result;
  std::string others;
  while (!log.empty()) {
    const std::size_t end = log.find('\n');
    std::string line(log.substr(0, end));
    log.remove_prefix(end == std::string_view::npos ? log.size() : end + 1);
    while (!line.empty() && (line.back() == '\r' || line.back() == '\0' || line.back() == ' ')) line.pop_back();
    if (line.empty()) continue;
    const auto complaint = parse_line(line, files);
    const bool first_error =
        result.message.empty() &&
        (complaint ? complaint->error : (line.find("error") != std::string::npos || line.starts_with("ERROR")));
    if (first_error) {
      result.where = complaint ? complaint->where : "";
      result.message = complaint ? complaint->text : line;
      if (complaint && complaint->text.starts_with(kErrorWord)) result.message.erase(0, kErrorWord.size());
    } else {
      others += complaint ? fmt::format("\n{}: {}", complaint->where, complaint->text) : "\n" + line;
    }
  }
  result.message += others;
  if (result.message.starts_with('\n')) result.message.erase(0, 1);
  return result;
}

}  // namespace shadowbench::gl
