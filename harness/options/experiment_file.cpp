#include "harness/options/experiment_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "base/toml.h"
#include "filters/kernel.h"
#include "harness/options/run_options.h"

namespace shadowbench::options {
namespace {

constexpr double kMostCombinations = 100'000.0;
constexpr int kMostSteps = 10'000;

class ExperimentReader {
 public:
  explicit ExperimentReader(const std::filesystem::path& file)
      : folder_(file.parent_path()), root_(read_toml(file, "the experiment")) {}

  Experiment read() {
    std::vector<RunOption> known = list_run_options();
    std::erase_if(known, [](const RunOption& option) { return option.decides == Decides::kWay; });
    std::vector<std::string> keys;
    for (const RunOption& option : known) keys.push_back(option.key());
    root_.require_known_keys(keys, {"title", "filter", "engine"});
    Experiment experiment;
    experiment.title = root_.string("title", std::string());
    for (const RunOption& option : known)
      if (const auto value = root_.find(option.key())) experiment.settings.push_back(read_setting(option, *value));
    if (const auto filter = root_.find("filter"); filter && filter->as_table(""))
      throw filter->error("'filter' must be tables, each headed [[filter]]");
    for (const TomlTable& table : root_.tables("filter")) experiment.filters.push_back(read_filter(table));
    for (const TomlTable& table : root_.tables("engine")) {
      table.require_known_keys({"name", "command"});
      const std::string name = table.string("name");
      if (std::ranges::count(experiment.engines, name, &Engine::name) > 0)
        throw table.error("name", fmt::format("two [[engine]] are called '{}': their rows would be one", name));
      experiment.engines.push_back({name, table.string("command"), folder_});
    }
    if (root_.has("filters") && !experiment.filters.empty())
      throw root_.error("filters", "'filters' and [[filter]] both name filters: keep one of them");
    return experiment;
  }

 private:
  std::filesystem::path folder_;
  TomlTable root_;

  /// Writes one value as it stands on a command line.
  static std::string read_value(const TomlValue& value) {
    if (const auto text = value.as<std::string>()) return *text;
    if (const auto whole = value.as<std::int64_t>()) return fmt::format("{}", *whole);
    if (const auto number = value.as<double>()) return fmt::format("{}", *number);
    if (const auto flag = value.as<bool>()) return *flag ? "true" : "false";
    throw value.error(fmt::format("'{}' must be a text, a number, true or false, or a list of such", value.key()));
  }

  static std::vector<std::string> read_values(const TomlValue& value) {
    std::vector<std::string> values;
    for (const TomlValue& each : value.as_list().value_or(std::vector{value})) values.push_back(read_value(each));
    if (!values.empty()) return values;
    throw value.error(
        fmt::format("'{}' is an empty list: nothing would be run; name a value, or leave the key out", value.key()));
  }

  /// A file named in an experiment lies beside it.
  std::string resolve(const std::string& name) const {
    const std::filesystem::path path(name);
    return path.has_extension() && path.is_relative() ? (folder_ / path).string() : name;
  }

  ExperimentSetting read_setting(const RunOption& option, const TomlValue& value) const {
    ExperimentSetting setting{option.name, read_values(value), value.where()};
    if (value.key() != "scene" && value.key() != "filter_file") return setting;
    for (std::string& each : setting.values) each = resolve(each);
    return setting;
  }

  static SweptFilter read_filter(const TomlTable& table) {
    SweptFilter filter{table.string("id"), {}, table.where()};
    for (const TomlValue& each : table.entries())
      if (each.key() != "id") filter.params.push_back(read_param(each));
    return filter;
  }

  static SweptParam read_param(const TomlValue& value) {
    const std::string& name = value.key();
    const auto table = value.as_table(name);
    if (!table) return {name, {}, false, 0, read_values(value)};
    table->require_known_keys({"linear", "log", "count"});
    SweptParam param;
    param.name = name;
    param.logarithmic = table->has("log");
    if (param.logarithmic == table->has("linear"))
      throw value.error(fmt::format("'{}' needs 'linear' or 'log', one of them: the range's two ends", name));
    const glm::dvec2 ends = table->vec2(param.logarithmic ? "log" : "linear", kAnyNumber);
    if (param.logarithmic && !(std::min(ends.x, ends.y) > 0.0))
      throw value.error(fmt::format("'{}': the ends of a logarithmic range must be more than 0", name));
    param.range = {ends.x, ends.y};
    param.count = table->integer("count", {2, kMostSteps});
    return param;
  }
};

std::vector<double> spread(const SweptParam& param) {
  const auto curve = [&](double x) { return param.logarithmic ? std::log(x) : x; };
  const double from = curve(param.range[0]), to = curve(param.range[1]);
  std::vector<double> values{param.range[0]};
  for (int i = 1; i + 1 < param.count; ++i) {
    const double x = from + (to - from) * i / (param.count - 1);
    values.push_back(param.logarithmic ? std::exp(x) : x);
  }
  values.push_back(param.range[1]);
  return values;
}

/// Writes the values of a parameter, each once.
std::vector<std::string> list_values(const SweptParam& param, const filters::ParamSpec* spec) {
  std::vector<std::string> all = param.values;
  if (!param.range.empty())
    for (const double value : spread(param))
      all.push_back(fmt::format("{}", spec && spec->integer ? std::round(value) : value));
  std::vector<std::string> distinct;
  std::set<std::string> seen;
  for (const std::string& value : all)
    if (seen.insert(value).second) distinct.push_back(value);
  return distinct;
}

/// Counts the combinations of a filter's values; stops where there are too many.
double count_combinations(const SweptFilter& filter, const filters::FilterSpec& spec) {
  double combinations = 1.0;
  for (const SweptParam& param : filter.params) {
    if (combinations > kMostCombinations) break;
    combinations *= static_cast<double>(list_values(param, spec.find_param(param.name)).size());
  }
  return combinations;
}

/// Throws where the filters up to this one have more combinations than a run takes.
void require_few(double combinations, const SweptFilter& filter) {
  if (combinations <= kMostCombinations) return;
  throw Error(ErrorKind::kUsage, fmt::format("with the parameters of '{}' there are more than {:.0f} combinations, and "
                                             "a run takes {:.0f} at most; name fewer values",
                                             filter.id, kMostCombinations, kMostCombinations));
}

/// Refuses a wrong value here, where its line in the file is still known.
void check_values(const SweptFilter& filter, const filters::Catalogue& catalogue) {
  const filters::FilterSpec& spec = catalogue.find(filter.id);
  for (const SweptParam& param : filter.params)
    for (const std::string& value : list_values(param, spec.find_param(param.name)))
      if (!filters::asks_for_width(spec, param.name))
        filters::parse_value(spec, param.name, value);
      else if (value == filters::kLightWidth)
        filters::require_width_param(spec, filters::default_values(spec), value);
      else
        filters::solve_radius(spec, filters::default_values(spec), value);
}

/// Lists every combination of one filter's values, as `--filters` takes it.
std::vector<std::string> combine(const SweptFilter& filter, const filters::Catalogue& catalogue) {
  const filters::FilterSpec& spec = catalogue.find(filter.id);
  std::vector<std::string> requests{filter.id};
  char separator = ':';
  for (const SweptParam& param : filter.params) {
    const std::vector<std::string> values = list_values(param, spec.find_param(param.name));
    std::vector<std::string> longer;
    for (const std::string& request : requests)
      for (const std::string& value : values)
        longer.push_back(fmt::format("{}{}{}={}", request, separator, param.name, value));
    requests = std::move(longer);
    separator = ',';
  }
  return requests;
}

/// Whether an experiment says it: what is not the default, and which cells there are in any case, as far as it is text.
bool is_said(const RunOption& option, const Told& told) {
  const bool is_text =
      std::holds_alternative<std::string>(told) || std::holds_alternative<std::vector<std::string>>(told);
  return told != option.told || (option.decides == Decides::kCells && is_text && told != Told(std::string()));
}

/// Adds a value that is read as this text again: a number or a flag where it can be one.
void push(toml::array& values, const std::string& text) {
  double number = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  if (fmt::format("{}", number) == text)
    values.push_back(number);
  else if (text == "true" || text == "false")
    values.push_back(text == "true");
  else
    values.push_back(text);
}

void insert(toml::table& table, const std::string& key, const std::vector<std::string>& texts) {
  toml::array values;
  for (const std::string& text : texts)
    if (!text.empty()) push(values, text);
  if (values.size() == 1)
    table.insert(key, values.front());
  else if (!values.empty())
    table.insert(key, values);
}

}  // namespace

std::filesystem::path find_experiment(const std::filesystem::path& folder, const std::string& name) {
  if (std::filesystem::path(name).extension() == ".toml") return name;
  std::vector<std::string> known;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".toml") known.push_back(entry.path().stem().string());
  std::ranges::sort(known);
  if (std::ranges::count(known, name) > 0) return folder / (name + ".toml");
  const std::optional<std::string> nearest = nearest_name(name, known);
  throw Error(
      ErrorKind::kUsage,
      fmt::format(
          "unknown experiment '{}'{}; a file of your own ends in .toml, and an option takes one value each time", name,
          nearest ? fmt::format("; did you mean '{}'?", *nearest)
                  : fmt::format(": there are {}", fmt::join(known, ", "))));
}

Experiment read_experiment(const std::filesystem::path& file) { return ExperimentReader(file).read(); }

std::string write_experiment(const RunOptions& options) {
  toml::table table;
  if (!options.title.empty()) table.insert("title", options.title);
  for (const RunOption& option : list_run_options())
    if (option.decides != Decides::kWay && option.write && is_said(option, option.write(options)))
      insert(table, option.key(), list_texts(option.write(options)));
  toml::array filters;
  for (const filters::FilterRequest& request : options.filters) {
    toml::table filter{{"id", request.spec.id}};
    for (const std::string& name : request.set_by_user)
      std::visit([&](const auto& each) { filter.insert(name, each); }, request.values.at(name));
    if (request.param_by_light()) filter.insert("width", filters::kLightWidth);
    filters.push_back(std::move(filter));
  }
  if (!filters.empty()) table.insert("filter", std::move(filters));
  return write_toml(table);
}

std::string expand_filters(const Experiment& experiment, const filters::Catalogue& catalogue) {
  std::vector<std::string> all;
  double combinations = 0.0;
  for (const SweptFilter& filter : experiment.filters) {
    try {
      combinations += count_combinations(filter, catalogue.find(filter.id));
      require_few(combinations, filter);
      check_values(filter, catalogue);
      for (std::string& request : combine(filter, catalogue)) all.push_back(std::move(request));
    } catch (const Error& error) {
      throw Error(ErrorKind::kInput, error.message(), filter.where);
    }
  }
  return fmt::format("{}", fmt::join(all, ","));
}

}  // namespace shadowbench::options
