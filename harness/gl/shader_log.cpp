#include "harness/gl/shader_log.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>
#include <regex>

#include "harness/gl/shader_source.h"

namespace shadowbench::gl {
namespace {

struct Complaint {
  std::string where;  ///< "file:line"
  std::string text;   ///< from the word error or warning on
  bool error = false;
};

// Each has three groups: index into the files, line, text.
const std::array<std::regex, 3>& get_forms() {
  static const std::array<std::regex, 3> forms = {
      std::regex(R"(^(\d+):(\d+)\(\d+\):\s*(.*)$)"),  // Mesa      2:14(5): error: x
      std::regex(R"(^(\d+)\((\d+)\)\s*:\s*(.*)$)"),   // NVIDIA    2(14) : error C1008: x
      std::regex(R"(^(?=ERROR|WARNING)(?:ERROR|WARNING):\s*(\d+):(\d+):\s*(.*)$)")};  // others    ERROR: 2:14: x
  return forms;
}

bool contains_error(std::string_view line) {
  return line.find("error") != std::string_view::npos || line.starts_with("ERROR");
}

std::optional<int> parse_number(const std::string& digits) {
  int number = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return parsed.ec == std::errc() ? std::optional(number) : std::nullopt;
}

// Takes the file from the line number, or from the driver's index where the number says nothing.
std::optional<std::string> locate(std::optional<int> index, std::optional<int> line,
                                  const std::vector<std::string>& files) {
  if (!index || !line) return std::nullopt;
  const auto file = static_cast<std::size_t>(*line >= kLinesPerFile ? *line / kLinesPerFile : *index);
  if (file >= files.size()) return std::nullopt;
  return fmt::format("{}:{}", files[file], *line % kLinesPerFile);
}

std::optional<Complaint> parse_line(const std::string& line, const std::vector<std::string>& files) {
  for (const auto& form : get_forms()) {
    std::smatch match;
    if (!std::regex_match(line, match, form)) continue;
    const auto where = locate(parse_number(match[1].str()), parse_number(match[2].str()), files);
    if (!where) return std::nullopt;
    const std::string text = match[3].str();
    const bool error = line.starts_with("ERROR") || text.starts_with("error") || text.starts_with("fatal error");
    return Complaint{*where, text, error};
  }
  return std::nullopt;
}

// "error: x" without the word, which the caller's sentence has already.
std::string strip_error_word(const std::string& text) {
  constexpr std::string_view kWord = "error: ";
  return text.starts_with(kWord) ? text.substr(kWord.size()) : text;
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
    const bool first_error = result.message.empty() && (complaint ? complaint->error : contains_error(line));
    if (first_error) {
      result.where = complaint ? complaint->where : "";
      result.message = complaint ? strip_error_word(complaint->text) : line;
    } else {
      others += complaint ? fmt::format("\n{}: {}", complaint->where, complaint->text) : "\n" + line;
    }
  }
  result.message += others;
  if (result.message.starts_with('\n')) result.message.erase(0, 1);
  return result;
}

}  // namespace shadowbench::gl
