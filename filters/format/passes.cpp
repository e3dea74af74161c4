#include "filters/format/passes.h"

#include <fmt/format.h>

#include <algorithm>

#include "filters/format/glsl_words.h"
#include "filters/store_format.h"

namespace shadowbench::filters {
namespace {

constexpr std::size_t kMostPasses = 6;  // as many texture units are free

std::string read_store(const FrontMatterReader& reader, const toml::table& table) {
  std::string store = reader.text(table, "store", true);
  const std::vector<std::string>& known = pass_formats();
  if (std::find(known.begin(), known.end(), store) == known.end())
    reader.fail_unknown(table.get("store"), "store", store, known);
  return store;
}

PassSpec read_pass(const FrontMatterReader& reader, const std::string& name, const toml::table& table,
                   std::string_view code) {
  reader.check_keys(table, {"store", "steps", "size", "anisotropy"}, fmt::format("[pass.{}]", name));
  PassSpec pass;
  pass.name = name;
  pass.line = reader.line_of(&table);
  pass.store = read_store(reader, table);
  pass.steps = reader.choose<PassSteps>(table, "steps",
                                        {{"once", PassSteps::kOnce},
                                         {"axes", PassSteps::kAxes},
                                         {"prefix", PassSteps::kPrefix},
                                         {"levels", PassSteps::kLevels}});
  pass.half = reader.choose<bool>(table, "size", {{"full", false}, {"half", true}});
  pass.anisotropy = static_cast<int>(reader.whole(table, "anisotropy", 1, 16));
  if (pass.anisotropy > 1 && (pass.steps != PassSteps::kLevels || pass.is_integer()))
    reader.fail(table.get("anisotropy"), "'anisotropy' needs steps = \"levels\" and a store that is no integer");
  if (!has_function(code, pass.texel_type(), name))
    reader.fail(&table,
                fmt::format("the GLSL lacks '{} {}(PassInput p)', which writes this map", pass.texel_type(), name));
  return pass;
}

}  // namespace

void read_passes(const FrontMatterReader& reader, const toml::table& root, std::string_view code,
                 std::vector<std::string> taken, FilterSpec& spec) {
  taken.insert(taken.end(), {"depth", "map", "stored", "compare", "compare_nearest", "encode", "visibility"});
  for (const auto& [name, table] : reader.named_tables(root, "pass", taken))
    spec.passes.push_back(read_pass(reader, name, *table, code));
  if (spec.passes.size() > kMostPasses)
    reader.fail(root.get("pass"),
                fmt::format("{} passes are declared; {} are the most", spec.passes.size(), kMostPasses));
}

}  // namespace shadowbench::filters
