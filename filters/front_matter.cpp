#include "filters/front_matter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/files.h"
#include "base/text.h"
#include "base/toml.h"
#include "filters/glsl_words.h"
#include "filters/random.h"
#include "filters/store_format.h"

namespace shadowbench::filters {
namespace {

constexpr std::string_view kOpen = "/*+++";
constexpr std::string_view kClose = "+++*/";
constexpr double kMostDiskPoints = 4096.0;
constexpr std::size_t kMostPasses = 6;  // as many texture units are free
constexpr int kMostScreenSteps = 8;

int count_lines(std::string_view text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

/// The tables `[key.NAME]` in the order of the file, each with its name as key: the author's order is the one that
/// people read. A name must be one that GLSL takes, and not among those taken, to which it is added.
std::vector<TomlTable> read_named_tables(const TomlTable& root, const std::string& key,
                                         std::vector<std::string>& taken) {
  std::vector<TomlTable> found;
  const auto outer = root.find(key);
  if (!outer) return found;
  const auto none = [&] { return fmt::format("'{0}' must hold tables: [{0}.NAME]", key); };
  const auto named = outer->as_table(key);
  if (!named) throw outer->error(none());
  for (const TomlValue& each : named->entries()) {
    auto table = each.as_table(fmt::format("[{}.{}]", key, each.key()));
    if (!table) throw each.error(none());
    found.push_back(*std::move(table));
  }
  std::ranges::sort(found, {}, &TomlTable::line);
  for (const TomlTable& table : found) {
    if (!is_identifier(table.key()))
      throw table.error(fmt::format("{}: '{}' cannot be a name in GLSL", table.title(), table.key()));
    if (std::ranges::find(taken, table.key()) != taken.end())
      throw table.error(
          fmt::format("{}: '{}' is the name of something else; choose another", table.title(), table.key()));
    taken.push_back(table.key());
  }
  return found;
}

ParamValue read_value(const TomlValue& value) {
  if (const auto flag = value.as<bool>()) return *flag;
  if (const auto text = value.as<std::string>()) return *text;
  if (const auto number = value.as<double>(); number && std::isfinite(*number)) return *number;
  throw value.must_be("a finite number, a string, true or false");
}

void check_default(const TomlValue& given, const ParamSpec& param) {
  if (!param.choices.empty()) {
    for (const ParamValue& choice : param.choices)
      if (choice.index() != param.default_value.index())
        throw given.error(fmt::format("the default of '{}' and its choices are of different types", param.name));
    if (std::find(param.choices.begin(), param.choices.end(), param.default_value) == param.choices.end())
      throw given.error(fmt::format("the default of '{}' is not one of its choices", param.name));
    return;
  }
  const auto* value = std::get_if<double>(&param.default_value);
  if (!value) {
    if (std::holds_alternative<std::string>(param.default_value))
      throw given.error(fmt::format("'{}' is a text and needs 'choices'", param.name));
    return;
  }
  if (!param.min || !param.max)
    throw given.error(fmt::format("'{}' is a number and needs 'min' and 'max'", param.name));
  if (*param.min > *param.max)
    throw given.error(fmt::format("'{}' has min {} above max {}", param.name, *param.min, *param.max));
  if (*value < *param.min || *value > *param.max) {
    throw given.error(
        fmt::format("the default of '{}' is {}, outside {} .. {}", param.name, *value, *param.min, *param.max));
  }
}

ParamSpec read_param(const TomlTable& table) {
  table.require_known_keys(front_matter_keys().at("param"));
  const auto given = table.find("default");
  if (!given) throw table.error(fmt::format("{} lacks 'default'", table.title()));
  ParamSpec param;
  param.name = table.key();
  param.default_value = read_value(*given);
  param.integer = given->as<std::int64_t>().has_value();
  if (table.has("min")) param.min = table.number("min", kFinite);
  if (table.has("max")) param.max = table.number("max", kFinite);
  param.unit = table.string("unit", "");
  param.text = table.string("text");
  if (const auto choices = table.find("choices")) {
    const auto list = choices->as_list();
    if (!list) throw choices->must_be("a list");
    for (const TomlValue& each : *list) param.choices.push_back(read_value(each));
  }
  param.is_const = table.boolean("const", false) || std::holds_alternative<std::string>(param.default_value);
  check_default(*given, param);
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

void read_texts_param(const TomlTable& root, FilterSpec& spec, const std::string& name,
                      const std::vector<std::string>& known, const char* text) {
  const std::vector<std::string> values = root.strings(name, std::vector<std::string>());
  for (const std::string& value : values)
    if (std::find(known.begin(), known.end(), value) == known.end()) throw root.unknown(name, value, known);
  add_list_param(spec, name, {values.begin(), values.end()}, text);
}

void read_samples(const TomlTable& root, FilterSpec& spec) {
  const auto given = root.find("samples");
  if (!given) return;
  spec.samples_line = given->line();
  std::vector<ParamValue> values;
  for (const TomlValue& each : given->as_list().value_or(std::vector{*given})) {
    const auto count = each.as<std::int64_t>();
    if (!count || *count < 1 || *count > 16 || !std::has_single_bit(static_cast<std::uint64_t>(*count)))
      throw each.error("'samples' must be 1, 2, 4, 8 or 16, or a list of such numbers");
    values.emplace_back(static_cast<double>(*count));
  }
  if (values.empty()) throw given->error("'samples' is an empty list");
  add_list_param(spec, "samples", std::move(values), "samples of depth a texel; encode() is asked for each");
}

/// The numeric parameter that a key names; empty without the key.
std::string read_param_name(const TomlTable& root, const FilterSpec& spec, const std::string& key) {
  const std::string name = root.string(key, "");
  const ParamSpec* param = spec.find_param(name);
  if (!name.empty() && (!param || !std::holds_alternative<double>(param->default_value)))
    throw root.error(key, fmt::format("'{}' names '{}', which is not a numeric parameter", key, name));
  return name;
}

std::variant<double, std::string> read_number_or_param(const TomlTable& root, const FilterSpec& spec,
                                                       const std::string& key,
                                                       std::variant<double, std::string> fallback) {
  const auto given = root.find(key);
  if (!given) return fallback;
  if (!given->as<std::string>().value_or("").empty()) return read_param_name(root, spec, key);
  const double value = given->number(kFinite);
  if (value < 0.0) throw given->error(fmt::format("'{}' must not be negative", key));
  return value;
}

/// A filter that says how texels combine asks for the Gaussian prefilter; its radius is the kernel's.
void read_prefilter(const TomlTable& root, FilterSpec& spec) {
  if (!root.has("combine")) return;
  const auto* name = std::get_if<std::string>(&spec.radius_texels);
  const ParamSpec* param = name ? spec.find_param(*name) : nullptr;
  const bool whole = param
                         ? param->integer
                         : std::holds_alternative<double>(spec.radius_texels) &&
                               std::floor(std::get<double>(spec.radius_texels)) == std::get<double>(spec.radius_texels);
  const Ends ends = param ? ends_of(*param) : Ends{0.0, name ? 0.0 : std::get<double>(spec.radius_texels)};
  if (!whole || ends.largest > kMaxPrefilterRadius || ends.smallest < 0.0) {
    throw root.error("combine", fmt::format("'combine' asks for the prefilter, whose radius is 'radius_texels': "
                                            "that must be a whole number, or an integer parameter, within 0 .. {}",
                                            kMaxPrefilterRadius));
  }
  spec.has_prefilter = true;
}

/// What the encoded map holds: `--stability` and warnings judge its numbers by that.
void read_stored(const TomlTable& root, FilterSpec& spec) {
  spec.holds_moments = root.boolean("moments", false);
  spec.exponent = read_param_name(root, spec, "exponent");
  spec.variance_floor = read_param_name(root, spec, "variance_floor");
  if (!spec.variance_floor.empty() && !spec.holds_moments)
    throw root.error("variance_floor", "'variance_floor' needs 'moments = true': only moments have a variance");
  if (!spec.holds_moments) return;
  for (const std::string& store : root.strings("store", std::vector<std::string>())) {
    if (store_channels(store) >= 2) continue;
    throw root.error(
        "moments",
        fmt::format("'moments' takes channels in pairs, a mean and the mean of its square, and the store '{}' has one",
                    store));
  }
}

/// One of the patterns, or a parameter whose choices are all patterns.
std::string read_pattern(const TomlTable& table, const FilterSpec& spec) {
  const std::string name = table.string("pattern", disk_patterns().front());
  const auto is_pattern = [](const ParamValue& value) {
    return std::ranges::find(disk_patterns(), to_string(value)) != disk_patterns().end();
  };
  const ParamSpec* param = spec.find_param(name);
  if (param ? param->choices.empty() || !std::ranges::all_of(param->choices, is_pattern) : !is_pattern(name)) {
    throw table.error("pattern", fmt::format("'pattern' is '{}', which is neither of {} nor a parameter that "
                                             "chooses among them",
                                             name, fmt::join(disk_patterns(), ", ")));
  }
  return name;
}

DiskTable read_disk(const TomlTable& table, const FilterSpec& spec) {
  table.require_known_keys(front_matter_keys().at("disk"));
  DiskTable disk;
  disk.name = table.key();
  disk.count = table.string("count");
  const ParamSpec* param = spec.find_param(disk.count);
  if (!param || !param->integer || !param->is_const)
    throw table.error("count", fmt::format("'count' names '{}', which is not a const integer parameter", disk.count));
  if (const double most = ends_of(*param).largest; most > kMostDiskPoints) {
    throw table.error("count", fmt::format("'count' names '{}', which may be up to {}: at most {} points are made",
                                           disk.count, most, kMostDiskPoints));
  }
  disk.seed = static_cast<unsigned>(table.whole("seed", {0, std::numeric_limits<unsigned>::max()}, 1));
  disk.pattern = read_pattern(table, spec);
  return disk;
}

/// Gives the names that the file took.
std::vector<std::string> read_root(const TomlTable& root, FilterSpec& spec) {
  std::vector<std::string> names;
  root.require_known_keys(front_matter_keys().at(""));
  spec.title = root.string("title");
  spec.source = root.string("source");
  spec.kind = parse_name<FilterKind>(root.choice("kind", list_names<FilterKind>()), "kind");
  spec.claims = root.strings("claims", std::vector<std::string>());
  spec.teaching = root.boolean("teaching", false);
  for (const TomlTable& table : read_named_tables(root, "param", names)) spec.params.push_back(read_param(table));
  read_texts_param(root, spec, "store", encode_formats(), "format of the encoded map");
  read_texts_param(root, spec, "combine", {"linear", "log"},
                   "how the prefilter adds texels; log: log-sum-exp, read with the nearest texel");
  read_texts_param(root, spec, "sample", {"linear", "nearest"}, "how the encoded map is read");
  read_samples(root, spec);
  spec.radius_texels = read_number_or_param(root, spec, "radius_texels", 0.0);
  spec.bias_texels = read_number_or_param(root, spec, "bias_texels", spec.radius_texels);
  read_prefilter(root, spec);
  read_stored(root, spec);
  spec.bound_at_zero = read_param_name(root, spec, "bound_at_zero");
  if (!spec.bound_at_zero.empty() && spec.kind != FilterKind::kBound)
    throw root.error("bound_at_zero", "'bound_at_zero' needs 'kind = \"bound\"'");
  for (const TomlTable& table : read_named_tables(root, "disk", names)) spec.disks.push_back(read_disk(table, spec));
  if (const auto kernel = root.find("kernel")) spec.kernel = read_kernel(*kernel, spec);
  return names;
}

PassSpec read_pass(const TomlTable& table, std::string_view code) {
  table.require_known_keys(front_matter_keys().at("pass"));
  PassSpec pass;
  pass.name = table.key();
  pass.line = table.line();
  pass.store = table.choice("store", pass_formats());
  pass.steps = table.choose<PassSteps>("steps",
                                       {{"once", PassSteps::kOnce},
                                        {"axes", PassSteps::kAxes},
                                        {"prefix", PassSteps::kPrefix},
                                        {"levels", PassSteps::kLevels}},
                                       "once");
  pass.half = table.choose<bool>("size", {{"full", false}, {"half", true}}, "full");
  pass.anisotropy = table.integer("anisotropy", {1, 16}, 1);
  if (pass.anisotropy > 1 && (pass.steps != PassSteps::kLevels || pass.is_integer()))
    throw table.error("anisotropy", "'anisotropy' needs steps = \"levels\" and a store that is no integer");
  if (!has_function(code, pass.texel_type(), pass.name))
    throw table.error(
        fmt::format("the GLSL lacks '{} {}(PassInput p)', which writes this map", pass.texel_type(), pass.name));
  return pass;
}

/// Reads the tables `[pass.NAME]`, in the order of the file. `code` is the filter's GLSL without comments, and `taken`
/// has the names of its parameters and tables of points.
void read_passes(const TomlTable& root, std::string_view code, std::vector<std::string> taken, FilterSpec& spec) {
  taken.insert(taken.end(), {"depth", "map", "stored", "compare", "compare_nearest", "encode", "visibility"});
  for (const TomlTable& table : read_named_tables(root, "pass", taken)) spec.passes.push_back(read_pass(table, code));
  if (spec.passes.size() > kMostPasses)
    throw root.error("pass", fmt::format("{} passes are declared; {} are the most", spec.passes.size(), kMostPasses));
}

/// Reads the tables `[screen.NAME]`, as read_passes().
void read_screens(const TomlTable& root, std::string_view code, std::vector<std::string> taken, FilterSpec& spec) {
  const ParamSpec* chosen = spec.find_param("screen");
  taken.insert(taken.end(), {"encode", "visibility"});
  for (const PassSpec& pass : spec.passes) taken.push_back(pass.name);
  for (const TomlTable& table : read_named_tables(root, "screen", taken)) {
    table.require_known_keys(front_matter_keys().at("screen"));
    ScreenSpec screen{.name = table.key(), .line = table.line()};
    screen.reach = read_number_or_param(table, spec, "reach", 0.0);
    const auto* name = std::get_if<std::string>(&screen.reach);
    const ParamSpec* param = name ? spec.find_param(*name) : nullptr;
    const Ends ends = param ? ends_of(*param) : Ends{0.0, std::get<double>(screen.reach)};
    if (ends.smallest < 0.0 || ends.largest > kMaxScreenReach || std::floor(ends.largest) != ends.largest ||
        (param && !param->integer))
      throw table.error("reach", fmt::format("'reach' must be a whole number of pixels within 0 .. {}, or a "
                                             "whole-numbered parameter within them",
                                             kMaxScreenReach));
    screen.steps = table.integer("steps", {1, kMostScreenSteps}, 1);
    if (!has_function(code, "vec2", screen.name))
      throw table.error(fmt::format("the GLSL lacks 'vec2 {}(ScreenInput s)', which this pass draws", screen.name));
    if (chosen && std::ranges::find(chosen->choices, ParamValue(screen.name)) == chosen->choices.end())
      throw table.error(
          fmt::format("the parameter 'screen' has no choice '{}', so that this pass is never drawn", screen.name));
    spec.screens.push_back(screen);
  }
}

void inspect_body(const TomlTable& root, const std::vector<std::string>& names, FilterSpec& spec) {
  const std::string code = blank_comments(spec.body);
  read_passes(root, code, names, spec);
  read_screens(root, code, names, spec);
  spec.has_encode = has_function(code, "vec4", "encode");
  for (const char* sampler : {"map_depth", "map_compare", "map_compare_nearest", "map_stored"})
    spec.uses_samplers = spec.uses_samplers || has_word(code, sampler);
  for (const PassSpec& pass : spec.passes)
    spec.uses_samplers = spec.uses_samplers || has_word(code, "map_" + pass.name);
  spec.reads_unwritten = !spec.has_encode && (has_word(code, "fetch_map") || has_word(code, "map_stored"));
  if (!has_function(code, "float", "visibility")) throw root.error("the GLSL lacks 'float visibility(Receiver r)'");
  const bool stores = root.has("store");
  if (stores && !spec.has_encode)
    throw root.error("store", "'store' is given, but the GLSL lacks 'vec4 encode(EncodeInput e)'");
  if (!stores && spec.has_encode)
    throw root.error("the GLSL has encode(), but the front matter lacks 'store', the format it writes");
  for (const char* key : {"combine", "sample"})
    if (root.has(key) && !stores)
      throw root.error(key, fmt::format("'{}' needs 'store': a depth map is not prefiltered", key));
  for (const char* key : {"moments", "exponent", "samples"})
    if (root.has(key) && !stores)
      throw root.error(key, fmt::format("'{}' says what is stored, and needs 'store'", key));
}

constexpr double kWidestRadius = kMaxPrefilterRadius;
constexpr double kMostTaps = 2.0 * kWidestRadius + 1.0;  // along an axis
constexpr double kWeightsSlack = 1e-6;                   // of the sum

/// A shape with what its size may be.
struct DeclaredShape {
  const char* name;
  KernelShape shape;
  Ends size;  ///< texels
  bool whole;
};

constexpr DeclaredShape kShapes[] = {{"tent", KernelShape::kTent, {0.5, kWidestRadius}, false},
                                     {"box", KernelShape::kBox, {1.0, kMostTaps}, true},
                                     {"disk", KernelShape::kDisk, {0.0, kWidestRadius}, false},
                                     {"gaussian", KernelShape::kGaussian, {0.0, kWidestRadius}, true}};

const DeclaredShape& find_shape(const TomlValue& value, const std::string& name) {
  std::vector<std::string> known;
  for (const DeclaredShape& each : kShapes) {
    if (each.name == name) return each;
    known.emplace_back(each.name);
  }
  throw value.error(
      fmt::format("'kernel' has the shape '{}', which is unknown{}", name, did_you_mean_or_known(name, known)));
}

/// "tent:2": a shape, and its size as a number or a parameter's name.
void read_shape(const TomlValue& value, const FilterSpec& spec, DeclaredKernel& kernel) {
  const auto text = value.as<std::string>();
  const std::size_t colon = text ? text->find(':') : std::string::npos;
  if (colon == std::string::npos)
    throw value.error("a kernel's shape must be a text such as \"tent:2\" or \"disk:radius\"");
  const DeclaredShape& shape = find_shape(value, text->substr(0, colon));
  const std::string size = text->substr(colon + 1);
  kernel.shape = shape.shape;
  const std::optional<double> number = parse_number(size);
  const ParamSpec* param = spec.find_param(size);
  if (!number && (!param || !std::holds_alternative<double>(param->default_value)))
    throw value.error(fmt::format("'kernel' names '{}', which is neither a number nor a numeric parameter", size));
  const Ends ends = number ? Ends{*number, *number} : ends_of(*param);
  const bool is_whole = number ? *number == std::floor(*number) : param->integer;
  if (!(ends.smallest >= shape.size.smallest && ends.largest <= shape.size.largest) || (shape.whole && !is_whole)) {
    throw value.error(fmt::format("the size of a {} must {} within {} .. {} texels, and '{}' is not", shape.name,
                                  shape.whole ? "be a whole number" : "lie", shape.size.smallest, shape.size.largest,
                                  size));
  }
  if (number)
    kernel.size = *number;
  else
    kernel.size = size;
}

/// Whole numbers are shares of their sum; others must sum to 1 themselves.
std::vector<double> read_weights(const TomlValue& value) {
  const auto list = value.as_list();
  if (!list || list->empty() || static_cast<double>(list->size()) > kMostTaps)
    throw value.error(fmt::format("'weights' must be a list of 1 .. {} numbers", kMostTaps));
  std::vector<double> weights;
  bool are_shares = true;
  for (const TomlValue& item : *list) {
    const auto weight = item.as<double>();
    if (!weight || !std::isfinite(*weight) || *weight < 0.0)
      throw item.error("'weights' must hold finite numbers of 0 or more");
    weights.push_back(*weight);
    are_shares = are_shares && item.as<std::int64_t>();
  }
  if (!std::equal(weights.begin(), weights.end(), weights.rbegin()))
    throw value.error("'weights' must be symmetric about the receiver");
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (are_shares ? sum == 0.0 : std::abs(sum - 1.0) > kWeightsSlack)
    throw value.error(fmt::format("'weights' sum to {}, not to 1; whole numbers are divided by their sum", sum));
  for (double& weight : weights) weight /= sum;
  return weights;
}

Kernel make_taps(const std::vector<double>& weights, Reconstruction reconstruction) {
  const double middle = 0.5 * (static_cast<double>(weights.size()) - 1.0);
  std::vector<Kernel::Atom> atoms;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] > 0.0) atoms.push_back({static_cast<double>(i) - middle, weights[i]});
  return Kernel::make_grid(std::move(atoms), reconstruction);
}

}  // namespace

const std::map<std::string, std::vector<std::string>>& front_matter_keys() {
  static const std::map<std::string, std::vector<std::string>> keys = {
      {"", {"title",         "source",        "kind",        "store",    "combine", "sample",   "samples",
            "claims",        "radius_texels", "bias_texels", "teaching", "moments", "exponent", "variance_floor",
            "bound_at_zero", "param",         "disk",        "kernel",   "pass",    "screen"}},
      {"param", {"default", "min", "max", "choices", "unit", "text", "const"}},
      {"disk", {"count", "seed", "pattern"}},
      {"pass", {"store", "steps", "size", "anisotropy"}},
      {"screen", {"reach", "steps"}},
      {"kernel", {"shape", "weights", "read"}}};
  return keys;
}

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
  const TomlTable root(std::string_view(text).substr(begin, close - begin), "the front matter",
                       {spec.path, first_line, ErrorKind::kFilter});
  const std::vector<std::string> names = read_root(root, spec);
  spec.front_matter = text.substr(begin, close - begin);
  spec.body = text.substr(close + kClose.size());
  spec.body_first_line = 1 + count_lines(std::string_view(text).substr(0, close));
  inspect_body(root, names, spec);
  return spec;
}

FilterSpec load_filter(const std::filesystem::path& path) {
  const std::vector<unsigned char> bytes = read_file_bytes(path, 4 * kMebibyte, ErrorKind::kFilter);
  if (!is_identifier(path.stem().string())) {
    throw Error(
        ErrorKind::kFilter,
        fmt::format("'{}' cannot be a filter's id: rename the file to letters, digits and '_'", path.stem().string()),
        path.string());
  }
  return parse_filter({bytes.begin(), bytes.end()}, path);
}

DeclaredKernel read_kernel(const TomlValue& value, const FilterSpec& spec) {
  DeclaredKernel kernel;
  const auto table = value.as_table("'kernel'");
  if (!table) {
    read_shape(value, spec, kernel);
    return kernel;
  }
  table->require_known_keys(front_matter_keys().at("kernel"));
  if (table->has("shape") == table->has("weights")) throw table->error("'kernel' needs either 'shape' or 'weights'");
  if (const auto weights = table->find("weights"))
    kernel.weights = read_weights(*weights);
  else
    read_shape(*table->find("shape"), spec, kernel);
  kernel.reads_nearest = table->choose<bool>("read", {{"bilinear", false}, {"nearest", true}}, "bilinear");
  if (table->has("read") && (kernel.shape == KernelShape::kTent || kernel.shape == KernelShape::kDisk))
    throw table->error("read", "'read' is for taps at whole texels: a box, a gaussian, or weights");
  return kernel;
}

Kernel make_kernel(const DeclaredKernel& declared, const ParamValues& values) {
  const Reconstruction read = declared.reads_nearest ? Reconstruction::kNearest : Reconstruction::kBilinear;
  if (declared.shape == KernelShape::kWeights) return make_taps(declared.weights, read);
  const double size = number_or_param(declared.size, values);
  switch (declared.shape) {
    case KernelShape::kTent: return Kernel::make_triangle(size);
    case KernelShape::kDisk: return Kernel::make_disk(size);
    case KernelShape::kGaussian: return Kernel::make_gaussian(static_cast<int>(size), read);
    default: return Kernel::make_box(static_cast<int>(size), read);
  }
}

}  // namespace shadowbench::filters
