#include "filters/format/passes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "filters/format/glsl_words.h"
#include "filters/store_format.h"

namespace shadowbench::filters {
namespace {

constexpr std::size_t kMostPasses = 6;  // as many texture units are free

/// Finds the value of a key among those there are; the first without the key.
template <class Value>
Value choose(const FrontMatterReader& reader, const toml::table& table, const std::string& key,
             const std::vector<std::pair<std::string, Value>>& known) {
  const std::string name = reader.text(table, key, false);
  if (name.empty()) return known.front().second;
  std::vector<std::string> names;
  for (const auto& [each, value] : known) {
    if (each == name) return value;
    names.push_back(each);
  }
  reader.fail(table.get(key), fmt::format("{} '{}' is unknown; known: {}", key, name, fmt::join(names, ", ")));
}

std::string read_store(const FrontMatterReader& reader, const toml::table& table) {
  std::string store = reader.text(table, "store", true);
  const std::vector<std::string>& known = pass_formats();
  if (std::find(known.begin(), known.end(), store) == known.end())
    reader.fail(table.get("store"), fmt::format("store '{}' is unknown; known: {}", store, fmt::join(known, ", ")));
  return store;
}

PassSpec read_pass(const FrontMatterReader& reader, const std::string& name, const toml::node& node,
                   std::string_view code) {
  const toml::table* table = node.as_table();
  if (!table) reader.fail(&node, "'pass' must hold tables: [pass.NAME]");
  if (!is_identifier(name) || name == "depth" || name == "map")
    reader.fail(&node, fmt::format("'{}' cannot be the name of a pass: its GLSL function is called so, and "
                                   "'depth' and 'map' are taken",
                                   name));
  reader.check_keys(*table, {"store", "steps", "size", "anisotropy"}, fmt::format("[pass.{}]", name));
  PassSpec pass;
  pass.name = name;
  pass.line = reader.line_of(&node);
  pass.store = read_store(reader, *table);
  pass.steps = choose<PassSteps>(reader, *table, "steps",
                                 {{"once", PassSteps::kOnce},
                                  {"axes", PassSteps::kAxes},
                                  {"prefix", PassSteps::kPrefix},
                                  {"levels", PassSteps::kLevels}});
  pass.half = choose<bool>(reader, *table, "size", {{"full", false}, {"half", true}});
  const double anisotropy = reader.finite(*table, "anisotropy").value_or(1.0);
  if (anisotropy < 1.0 || anisotropy > 16.0)
    reader.fail(table->get("anisotropy"), "'anisotropy' must be within 1 .. 16");
  pass.anisotropy = static_cast<int>(anisotropy);
  if (pass.anisotropy > 1 && (pass.steps != PassSteps::kLevels || pass.is_integer()))
    reader.fail(table->get("anisotropy"), "'anisotropy' needs steps = \"levels\" and a store that is no integer");
  if (!has_function(code, pass.texel_type(), name))
    reader.fail(table,
                fmt::format("the GLSL lacks '{} {}(PassInput p)', which writes this map", pass.texel_type(), name));
  return pass;
}

}  // namespace

void read_passes(const FrontMatterReader& reader, const toml::table& root, std::string_view code, FilterSpec& spec) {
  const toml::node* node = root.get("pass");
  if (!node) return;
  if (!node->as_table()) reader.fail(node, "'pass' must hold tables: [pass.NAME]");
  for (const auto& [name, value] : in_order_of_file(*node->as_table()))
    spec.passes.push_back(read_pass(reader, name, *value, code));
  if (spec.passes.size() > kMostPasses)
    reader.fail(node, fmt::format("{} passes are declared; {} are the most", spec.passes.size(), kMostPasses));
}

}  // namespace shadowbench::filters
