#include "harness/cli/arguments.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "filters/base/error.h"
#include "harness/scene/load.h"

namespace shadowbench::cli {
namespace {

double parse_angle(const std::string& text, const char* name, double limit_deg) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= limit_deg))
    fail(fmt::format("--light: the {} '{}' must be a number of degrees, {} .. {}", name, text, -limit_deg, limit_deg));
  return value;
}

}  // namespace

void fail(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

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

void require_distinct(const std::vector<filters::FilterRequest>& requests) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const filters::FilterRequest &a = requests[i], &b = requests[j];
      if (a.spec.id == b.spec.id && a.values == b.values)
        fail(fmt::format("--filters names '{}' twice: '{}' has the same parameters", a.label(), b.label()));
    }
  }
}

options::LightAngles parse_light(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos)
    fail(fmt::format("--light: '{}' must be AZIMUTH,ELEVATION in degrees, such as 120,35", text));
  return {parse_angle(text.substr(0, comma), "azimuth", 360.0), parse_angle(text.substr(comma + 1), "elevation", 90.0)};
}

std::vector<std::string> list_builtin_scenes(const options::Resources& resources) {
  std::vector<std::string> names;
  for (const scene::SceneInfo& info : scene::list_scenes(resources.scenes)) names.push_back(info.name);
  return names;
}

std::filesystem::path find_results(const std::filesystem::path& run) {
  if (std::filesystem::is_directory(run)) return run / "results.json";
  if (std::filesystem::exists(run)) return run;
  throw Error(ErrorKind::kInput,
              "there is no such folder or file; give a run's folder (its --out), or its results.json", run.string());
}

std::filesystem::path choose_cache(const std::string& folder, bool no_cache) {
  if (no_cache) return {};
  return folder.empty() ? options::default_cache_folder() : std::filesystem::path(folder);
}

}  // namespace shadowbench::cli
