#include "filters/format/front_matter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "filters/base/error.h"
#include "filters/base/input_file.h"
#include "filters/base/toml_depth.h"
#include "filters/disk_points.h"
#include "filters/format/front_matter_reader.h"
#include "filters/format/glsl_words.h"
#include "filters/format/kernel_reader.h"
#include "filters/format/passes.h"
#include "filters/store_format.h"

namespace shadowbench::filters {
namespace {

constexpr std::string_view kOpen = "/*+++";
constexpr std::string_view kClose = "+++*/";
constexpr double kMostDiskPoints = 4096.0;

int count_lines(std::string_view text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

FilterKind read_kind(const FrontMatterReader& reader, const toml::table& root) {
  reader.text(root, "kind", true);
  std::vector<std::pair<std::string, FilterKind>> kinds;
  for (const FilterKind kind :
       {FilterKind::kComparison, FilterKind::kBound, FilterKind::kStochastic, FilterKind::kOther})
    kinds.emplace_back(to_string(kind), kind);
  return reader.choose<FilterKind>(root, "kind", kinds);
}

void check_default(const FrontMatterReader& reader, const toml::node& node, const ParamSpec& param) {
  if (!param.choices.empty()) {
    for (const ParamValue& choice : param.choices)
      if (choice.index() != param.default_value.index())
        reader.fail(&node, fmt::format("the default of '{}' and its choices are of different types", param.name));
    if (std::find(param.choices.begin(), param.choices.end(), param.default_value) == param.choices.end())
      reader.fail(&node, fmt::format("the default of '{}' is not one of its choices", param.name));
    return;
  }
  const auto* value = std::get_if<double>(&param.default_value);
  if (!value) {
    if (std::holds_alternative<std::string>(param.default_value))
      reader.fail(&node, fmt::format("'{}' is a text and needs 'choices'", param.name));
    return;
  }
  if (!param.min || !param.max)
    reader.fail(&node, fmt::format("'{}' is a number and needs 'min' and 'max'", param.name));
  if (*param.min > *param.max)
    reader.fail(&node, fmt::format("'{}' has min {} above max {}", param.name, *param.min, *param.max));
  if (*value < *param.min || *value > *param.max) {
    reader.fail(&node,
                fmt::format("the default of '{}' is {}, outside {} .. {}", param.name, *value, *param.min, *param.max));
  }
}

ParamSpec read_param(const FrontMatterReader& reader, const std::string& name, const toml::table& table) {
  reader.check_keys(table, {"default", "min", "max", "choices", "unit", "text", "const"},
                    fmt::format("[param.{}]", name));
  const toml::node* default_node = table.get("default");
  if (!default_node) reader.fail(&table, fmt::format("[param.{}] lacks 'default'", name));
  ParamSpec param;
  param.name = name;
  param.default_value = reader.value(*default_node, "'default'");
  param.integer = default_node->is_integer();
  param.min = reader.finite(table, "min");
  param.max = reader.finite(table, "max");
  param.unit = reader.text(table, "unit", false);
  param.text = reader.text(table, "text", true);
  if (const toml::node* choices = table.get("choices")) {
    if (!choices->as_array()) reader.fail(choices, "'choices' must be a list");
    for (const toml::node& item : *choices->as_array()) param.choices.push_back(reader.value(item, "a choice"));
  }
  param.is_const = reader.flag(table, "const") || std::holds_alternative<std::string>(param.default_value);
  check_default(reader, *default_node, param);
  return param;
}

/// Makes a parameter of a list, whose first value is the default.
void add_list_param(FilterSpec& spec, const std::string& name, std::vector<ParamValue> values, const char* text) {
  if (values.empty()) return;
  ParamSpec param;
  param.name = name;
  param.default_value = values.front();
  param.integer = std::holds_alternative<double>(values.front());
  param.choices = std::move(values);
  param.is_const = true;
  param.text = text;
  spec.params.push_back(param);
}

void read_texts_param(const FrontMatterReader& reader, const toml::table& root, FilterSpec& spec,
                      const std::string& name, const std::vector<std::string>& known, const char* text) {
  const std::vector<std::string> values = reader.texts(root, name);
  for (const std::string& value : values) {
    if (std::find(known.begin(), known.end(), value) != known.end()) continue;
    reader.fail_unknown(root.get(name), name, value, known);
  }
  add_list_param(spec, name, {values.begin(), values.end()}, text);
}

void read_samples(const FrontMatterReader& reader, const toml::table& root, FilterSpec& spec) {
  const toml::node* node = root.get("samples");
  if (!node) return;
  spec.samples_line = reader.line_of(node);
  std::vector<ParamValue> values;
  const auto take = [&](const toml::node& item) {
    const auto count = item.value_exact<std::int64_t>();
    if (!count || *count < 1 || *count > 16 || !std::has_single_bit(static_cast<std::uint64_t>(*count)))
      reader.fail(&item, "'samples' must be 1, 2, 4, 8 or 16, or a list of such numbers");
    values.emplace_back(static_cast<double>(*count));
  };
  if (const toml::array* list = node->as_array())
    for (const toml::node& item : *list) take(item);
  else
    take(*node);
  if (values.empty()) reader.fail(node, "'samples' is an empty list");
  add_list_param(spec, "samples", std::move(values), "samples of depth a texel; encode() is asked for each");
}

std::variant<double, std::string> read_number_or_param(const FrontMatterReader& reader, const toml::table& root,
                                                       const FilterSpec& spec, const std::string& key,
                                                       std::variant<double, std::string> fallback) {
  const toml::node* node = root.get(key);
  if (!node) return fallback;
  if (const auto name = node->value_exact<std::string>()) {
    const ParamSpec* param = spec.find_param(*name);
    if (!param || !std::holds_alternative<double>(param->default_value))
      reader.fail(node, fmt::format("'{}' names '{}', which is not a numeric parameter", key, *name));
    return *name;
  }
  const auto value = reader.finite(root, key);
  if (*value < 0.0) reader.fail(node, fmt::format("'{}' must not be negative", key));
  return *value;
}

/// A filter that says how texels combine asks for the Gaussian prefilter; its radius is the kernel's.
void read_prefilter(const FrontMatterReader& reader, const toml::table& root, FilterSpec& spec) {
  if (!root.contains("combine")) return;
  const auto* name = std::get_if<std::string>(&spec.radius_texels);
  const ParamSpec* param = name ? spec.find_param(*name) : nullptr;
  const bool whole = param
                         ? param->integer
                         : std::holds_alternative<double>(spec.radius_texels) &&
                               std::floor(std::get<double>(spec.radius_texels)) == std::get<double>(spec.radius_texels);
  const Ends ends = param ? ends_of(*param) : Ends{0.0, name ? 0.0 : std::get<double>(spec.radius_texels)};
  if (!whole || ends.largest > kMaxPrefilterRadius || ends.smallest < 0.0) {
    reader.fail(root.get("combine"), fmt::format("'combine' asks for the prefilter, whose radius is 'radius_texels': "
                                                 "that must be a whole number, or an integer parameter, within 0 .. {}",
                                                 kMaxPrefilterRadius));
  }
  spec.has_prefilter = true;
}

/// The numeric parameter that a key names; empty without the key.
std::string read_param_name(const FrontMatterReader& reader, const toml::table& root, const FilterSpec& spec,
                            const std::string& key) {
  const std::string name = reader.text(root, key, false);
  const ParamSpec* param = spec.find_param(name);
  if (!name.empty() && (!param || !std::holds_alternative<double>(param->default_value)))
    reader.fail(root.get(key), fmt::format("'{}' names '{}', which is not a numeric parameter", key, name));
  return name;
}

/// What the encoded map holds: `--stability` and warnings judge its numbers by that.
void read_stored(const FrontMatterReader& reader, const toml::table& root, FilterSpec& spec) {
  spec.holds_moments = reader.flag(root, "moments");
  spec.exponent = read_param_name(reader, root, spec, "exponent");
  spec.variance_floor = read_param_name(reader, root, spec, "variance_floor");
  if (!spec.variance_floor.empty() && !spec.holds_moments)
    reader.fail(root.get("variance_floor"), "'variance_floor' needs 'moments = true': only moments have a variance");
  if (!spec.holds_moments) return;
  for (const std::string& store : reader.texts(root, "store")) {
    if (store_channels(store) >= 2) continue;
    reader.fail(
        root.get("moments"),
        fmt::format("'moments' takes channels in pairs, a mean and the mean of its square, and the store '{}' has one",
                    store));
  }
}

/// One of the patterns, or a parameter whose choices are all patterns.
std::string read_pattern(const FrontMatterReader& reader, const toml::table& table, const FilterSpec& spec) {
  if (!table.contains("pattern")) return disk_patterns().front();
  const std::string name = reader.text(table, "pattern", true);
  const auto is_pattern = [](const ParamValue& value) {
    return std::ranges::find(disk_patterns(), to_string(value)) != disk_patterns().end();
  };
  const ParamSpec* param = spec.find_param(name);
  if (param ? param->choices.empty() || !std::ranges::all_of(param->choices, is_pattern) : !is_pattern(name)) {
    reader.fail(table.get("pattern"), fmt::format("'pattern' is '{}', which is neither of {} nor a parameter that "
                                                  "chooses among them",
                                                  name, fmt::join(disk_patterns(), ", ")));
  }
  return name;
}

DiskTable read_disk(const FrontMatterReader& reader, const std::string& name, const toml::table& table,
                    const FilterSpec& spec) {
  reader.check_keys(table, {"count", "seed", "pattern"}, fmt::format("[disk.{}]", name));
  DiskTable disk;
  disk.name = name;
  disk.count = reader.text(table, "count", true);
  const ParamSpec* param = spec.find_param(disk.count);
  if (!param || !param->integer || !param->is_const) {
    reader.fail(table.get("count"),
                fmt::format("'count' names '{}', which is not a const integer parameter", disk.count));
  }
  if (const double most = ends_of(*param).largest; most > kMostDiskPoints) {
    reader.fail(table.get("count"), fmt::format("'count' names '{}', which may be up to {}: at most {} points are made",
                                                disk.count, most, kMostDiskPoints));
  }
  disk.seed = reader.whole(table, "seed", 0, std::numeric_limits<unsigned>::max());
  disk.pattern = read_pattern(reader, table, spec);
  return disk;
}

/// Gives the names that the file took.
std::vector<std::string> read_root(const FrontMatterReader& reader, const toml::table& root, FilterSpec& spec) {
  std::vector<std::string> names;
  reader.check_keys(
      root,
      {"title", "source", "kind", "store", "combine", "sample", "samples", "claims", "radius_texels", "bias_texels",
       "teaching", "moments", "exponent", "variance_floor", "bound_at_zero", "param", "disk", "kernel", "pass"},
      "the front matter");
  spec.title = reader.text(root, "title", true);
  spec.source = reader.text(root, "source", true);
  spec.kind = read_kind(reader, root);
  spec.claims = reader.texts(root, "claims");
  spec.teaching = reader.flag(root, "teaching");
  for (const auto& [name, table] : reader.named_tables(root, "param", names))
    spec.params.push_back(read_param(reader, name, *table));
  read_texts_param(reader, root, spec, "store", encode_formats(), "format of the encoded map");
  read_texts_param(reader, root, spec, "combine", {"linear", "log"},
                   "how the prefilter adds texels; log: log-sum-exp, read with the nearest texel");
  read_texts_param(reader, root, spec, "sample", {"linear", "nearest"}, "how the encoded map is read");
  read_samples(reader, root, spec);
  spec.radius_texels = read_number_or_param(reader, root, spec, "radius_texels", 0.0);
  spec.bias_texels = read_number_or_param(reader, root, spec, "bias_texels", spec.radius_texels);
  read_prefilter(reader, root, spec);
  read_stored(reader, root, spec);
  spec.bound_at_zero = read_param_name(reader, root, spec, "bound_at_zero");
  if (!spec.bound_at_zero.empty() && spec.kind != FilterKind::kBound)
    reader.fail(root.get("bound_at_zero"), "'bound_at_zero' needs 'kind = \"bound\"'");
  for (const auto& [name, table] : reader.named_tables(root, "disk", names))
    spec.disks.push_back(read_disk(reader, name, *table, spec));
  if (const toml::node* kernel = root.get("kernel")) spec.kernel = read_kernel(reader, *kernel, spec);
  return names;
}

void inspect_body(const FrontMatterReader& reader, const toml::table& root, const std::vector<std::string>& names,
                  FilterSpec& spec) {
  const std::string code = strip_comments(spec.body);
  read_passes(reader, root, code, names, spec);
  spec.has_encode = has_function(code, "vec4", "encode");
  for (const char* sampler : {"map_depth", "map_compare", "map_compare_nearest", "map_stored"})
    spec.uses_samplers = spec.uses_samplers || has_word(code, sampler);
  for (const PassSpec& pass : spec.passes)
    spec.uses_samplers = spec.uses_samplers || has_word(code, "map_" + pass.name);
  spec.reads_unwritten = !spec.has_encode && (has_word(code, "fetch_map") || has_word(code, "map_stored"));
  if (!has_function(code, "float", "visibility")) reader.fail(nullptr, "the GLSL lacks 'float visibility(Receiver r)'");
  const bool stores = root.contains("store");
  if (stores && !spec.has_encode)
    reader.fail(root.get("store"), "'store' is given, but the GLSL lacks 'vec4 encode(EncodeInput e)'");
  if (!stores && spec.has_encode)
    reader.fail(nullptr, "the GLSL has encode(), but the front matter lacks 'store', the format it writes");
  for (const char* key : {"combine", "sample"})
    if (root.contains(key) && !stores)
      reader.fail(root.get(key), fmt::format("'{}' needs 'store': a depth map is not prefiltered", key));
  for (const char* key : {"moments", "exponent", "samples"})
    if (root.contains(key) && !stores)
      reader.fail(root.get(key), fmt::format("'{}' says what is stored, and needs 'store'", key));
}

}  // namespace

FilterSpec parse_filter(const std::string& text, const std::filesystem::path& path) {
  const std::size_t open = text.find(kOpen);
  const std::size_t close = open == std::string::npos ? open : text.find(kClose, open);
  if (close == std::string::npos || text.find_first_not_of(" \t\r\n\xEF\xBB\xBF") != open) {
    throw Error(ErrorKind::kFilter, "no front matter: the file must begin with /*+++, TOML, and +++*/",
                path.string() + ":1");
  }
  FilterSpec spec;
  spec.id = path.stem().string();
  spec.path = path.string();
  const std::size_t begin = open + kOpen.size();
  const int first_line = 1 + count_lines(std::string_view(text).substr(0, begin));
  const FrontMatterReader reader(spec.path, first_line);
  const std::string front_matter = text.substr(begin, close - begin);
  if (const int line = find_too_deep_key(front_matter); line > 0)
    reader.fail_at(line, fmt::format("a key has more than {} dots", kMostDots));
  toml::table root;
  try {
    root = toml::parse(front_matter);
  } catch (const toml::parse_error& error) {
    reader.fail_at(static_cast<int>(error.source().begin.line),
                   fmt::format("malformed front matter: {}", error.description()));
  }
  const std::vector<std::string> names = read_root(reader, root, spec);
  spec.body = text.substr(close + kClose.size());
  spec.body_first_line = 1 + count_lines(std::string_view(text).substr(0, close));
  inspect_body(reader, root, names, spec);
  return spec;
}

FilterSpec load_filter(const std::filesystem::path& path) {
  require_plain_file(path, 4 * kMebibyte, ErrorKind::kFilter);
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  if (file) text << file.rdbuf();
  if (!file || std::filesystem::is_directory(path))
    throw Error(ErrorKind::kFilter, "cannot read this filter file: check the path and its permissions", path.string());
  if (!is_identifier(path.stem().string())) {
    throw Error(
        ErrorKind::kFilter,
        fmt::format("'{}' cannot be a filter's id: rename the file to letters, digits and '_'", path.stem().string()),
        path.string());
  }
  return parse_filter(text.str(), path);
}

}  // namespace shadowbench::filters
