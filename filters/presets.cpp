#include "filters/presets.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/toml.h"

namespace shadowbench::filters {
namespace {

std::string read_text(const TomlTable& table, const char* key) {
  std::string text = table.string(key);
  if (text.empty()) throw table.error(key, fmt::format("'{}' is empty; say it, as the other presets do", key));
  return text;
}

Preset read_preset(const TomlTable& table) {
  table.require_known_keys({"name", "title", "filter", "bias", "bias_options", "differs", "source", "version"});
  Preset preset{read_text(table, "name"),
                read_text(table, "title"),
                read_text(table, "filter"),
                read_text(table, "bias"),
                table.strings("bias_options", std::vector<std::string>()),
                read_text(table, "differs"),
                table.strings("source"),
                read_text(table, "version"),
                table.where()};
  if (preset.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.-") != std::string::npos)
    throw table.error("name", fmt::format("'{}' cannot be a preset's name: lower-case letters, digits, '.' and '-' can",
                                          preset.name));
  if (preset.filter.find('@') != std::string::npos)
    throw table.error("filter", fmt::format("'{}' is a preset; name a filter with its parameters", preset.filter));
  if (preset.sources.empty()) throw table.error("source", "'source' is empty; give the address of what was read");
  return preset;
}

}  // namespace

std::vector<Preset> load_presets(const std::filesystem::path& file) {
  const TomlTable root = read_toml(file, "the file of presets");
  root.require_known_keys({"preset"});
  std::vector<Preset> presets;
  for (const TomlTable& table : root.tables("preset")) {
    Preset preset = read_preset(table);
    if (std::ranges::count(presets, preset.name, &Preset::name) > 0)
      throw table.error("name", fmt::format("two presets are called '{}'; rename one", preset.name));
    presets.push_back(std::move(preset));
  }
  return presets;
}

std::vector<Preset> choose_presets(const std::vector<Preset>& all, const std::string& name) {
  std::vector<std::string> known;
  std::vector<Preset> begun;
  for (const Preset& preset : all) {
    if (preset.name == name) return {preset};
    if (preset.name.starts_with(name + "-")) begun.push_back(preset);
    known.push_back(preset.name);
  }
  if (begun.empty())
    throw Error(ErrorKind::kUsage, fmt::format("unknown preset '@{}'{}", name, did_you_mean_or_known(name, known)));
  return begun;
}

std::string write_bias_options(const Preset& preset) {
  std::string options;
  for (const std::string& text : preset.bias_options)
    options += fmt::format("{}--bias {}", options.empty() ? "" : " ", text);
  return options;
}

std::string describe_preset(const Preset& preset) {
  const std::string options = write_bias_options(preset);
  return fmt::format("@{} is {}. {} The engine's bias is {}; no preset sets it, {}", preset.name, preset.filter,
                     preset.differs, preset.bias, options.empty() ? "nor can --bias" : "but this does: " + options);
}

}  // namespace shadowbench::filters
