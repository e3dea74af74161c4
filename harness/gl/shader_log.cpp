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

/// What a line says by itself.
struct LogLine {
  int index = 0;
  int line = 0;
  std::size_t text_at = 0;
};

// Widths keep the numbers inside an int; a blank matches any blanks, or none.
std::optional<LogLine> read_log_line(const std::string& line) {
  LogLine read;
  int end = 0;
  // Mesa      2:14(5): error: x
  if (std::sscanf(line.c_str(), "%9d:%9d(%*9d): %n", &read.index, &read.line, &end) != 2 || end == 0) {
    constexpr std::array kForms = {
        "%9d(%9d) : %n",         // NVIDIA    2(14) : error C1008: x
        "ERROR: %9d:%9d: %n",    // others    ERROR: 2:14: x
        "WARNING: %9d:%9d: %n",  //
    };
    for (const char* form : kForms) {
      read = {};
      if (std::sscanf(line.c_str(), form, &read.index, &read.line, &end) == 2 && end > 0) break;
      end = 0;
    }
  }
  read.text_at = static_cast<std::size_t>(end);
  return end > 0 ? std::optional(read) : std::nullopt;
}

// Takes the file from the line number, or from the driver's index where the number says nothing.
std::optional<std::size_t> find_file(const LogLine& log_line, const std::vector<std::string>& files) {
  if (log_line.index < 0 || log_line.line < 0) return std::nullopt;
  const auto file =
      static_cast<std::size_t>(log_line.line >= kLinesPerFile ? log_line.line / kLinesPerFile : log_line.index);
  return file < files.size() ? std::optional(file) : std::nullopt;
}

/// A line with its place; as it is where it has none. `text` begins with the word error or warning still.
Complaint parse_line(const std::string& line, const std::vector<std::string>& files) {
  const auto log_line = read_log_line(line);
  const auto file = log_line ? find_file(*log_line, files) : std::nullopt;
  if (!file) return {.text = line, .is_error = line.find("error") != std::string::npos || line.starts_with("ERROR")};
  Complaint complaint{files[*file], log_line->line % kLinesPerFile, line.substr(log_line->text_at)};
  const std::string& text = complaint.text;
  complaint.is_error = line.starts_with("ERROR") || text.starts_with("error") || text.starts_with("fatal error") ||
                       text.starts_with("preprocessor error");
  return complaint;
}

}  // namespace

std::string Complaint::where() const { return file.empty() ? "" : fmt::format("{}:{}", file, line); }

ShaderLog translate_log(std::string_view log, const std::vector<std::string>& files) {
  ShaderLog result;
  std::string others;
  while (!log.empty()) {
    const std::size_t end = log.find('\n');
    std::string line(log.substr(0, end));
    log.remove_prefix(end == std::string_view::npos ? log.size() : end + 1);
    while (!line.empty() && (line.back() == '\r' || line.back() == '\0' || line.back() == ' ')) line.pop_back();
    if (line.empty()) continue;
    Complaint complaint = parse_line(line, files);
    const std::string told = complaint.text;
    if (!complaint.file.empty() && told.starts_with(kErrorWord)) complaint.text.erase(0, kErrorWord.size());
    if (result.message.empty() && complaint.is_error) {
      result.where = complaint.where();
      result.message = complaint.text;
    } else {
      others += complaint.file.empty() ? "\n" + line : fmt::format("\n{}: {}", complaint.where(), told);
    }
    result.complaints.push_back(std::move(complaint));
  }
  result.message += others;
  if (result.message.starts_with('\n')) result.message.erase(0, 1);
  return result;
}

}  // namespace shadowbench::gl
