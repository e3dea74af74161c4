#include "report/records/csv.h"

#include <charconv>

namespace shadowbench::records {

namespace {

bool is_number(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return end == text.data() + text.size() && error != std::errc::invalid_argument;
}

/// Source: OWASP, CSV Injection.
bool is_formula(std::string_view text) { return text.find_first_of("=+-@\t\r\n") == 0 && !is_number(text); }

}  // namespace

std::string quote_csv(std::string_view text) {
  const std::string apostrophe = is_formula(text) ? "'" : "";
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return apostrophe + std::string(text);
  std::string quoted = "\"" + apostrophe;
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace shadowbench::records
