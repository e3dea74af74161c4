#include "harness/options/option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "base/error.h"

namespace shadowbench::options {
namespace {

double parse_angle(const std::string& text, const char* name, double limit_deg) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= limit_deg))
    fail(fmt::format("--light: the {} '{}' must be a number of degrees, {} .. {}", name, text, -limit_deg, limit_deg));
  return value;
}

}  // namespace

std::string Option::value_name() const {
  if (!value.empty()) return value;
  if (!choices.empty()) return fmt::format("{}", fmt::join(choices, "|"));
  switch (kind) {
    case ValueKind::kFile: return "FILE";
    case ValueKind::kFolder: return "FOLDER";
    case ValueKind::kScene: return "SCENE";
    case ValueKind::kFilters: return "FILTERS";
    default: break;
  }
  const bool number = std::holds_alternative<std::uint32_t*>(variable) || std::holds_alternative<double*>(variable) ||
                      std::holds_alternative<std::optional<double>*>(variable);
  return number ? "N" : "TEXT";
}

std::string Option::default_value() const {
  if (const auto* text = std::get_if<std::string*>(&variable)) return **text;
  if (const auto* number = std::get_if<double*>(&variable)) return fmt::format("{:g}", **number);
  if (const auto* number = std::get_if<std::uint32_t*>(&variable)) return fmt::format("{}", **number);
  return {};
}

void fail(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

void require_in_range(const char* option, double value, double more_than, double most, const char* unit) {
  if (value > more_than && value <= most) return;
  fail(fmt::format("{}: {} is out of range: choose more than {:g}, at most {:g}{}", option, value, more_than, most,
                   unit));
}

int parse_count(const std::string& text, const char* option) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1)
    fail(fmt::format("{}: '{}' must be a whole number, 1 or more", option, text));
  return value;
}

std::pair<int, int> parse_picture_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos) fail(fmt::format("--size: '{}' must be WIDTHxHEIGHT, such as 960x540", text));
  return {parse_count(text.substr(0, cross), "--size"), parse_count(text.substr(cross + 1), "--size")};
}

scene::SkyAngles parse_light(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos)
    fail(fmt::format("--light: '{}' must be AZIMUTH,ELEVATION in degrees, such as 120,35", text));
  return {parse_angle(text.substr(0, comma), "azimuth", 360.0), parse_angle(text.substr(comma + 1), "elevation", 90.0)};
}

}  // namespace shadowbench::options
