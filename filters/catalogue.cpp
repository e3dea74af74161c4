#include "filters/catalogue.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <tuple>

#include "base/error.h"
#include "base/text.h"
#include "base/toml.h"
#include "filters/filter_spec.h"
#include "filters/front_matter.h"
#include "filters/glsl_words.h"
#include "filters/kernel.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

constexpr std::string_view kAll = "all", kTeaching = "teaching", kWidth = "width";
constexpr char kPresetMark = '@';

/// A report's pictures are named for filters, and the first of these names is its own; the others name many filters.
constexpr std::string_view kReservedIds[] = {"truth", kAll, kTeaching};

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

std::string suggest(const std::string& name, const std::vector<std::string>& known) {
  return known.empty() ? "; it has none" : did_you_mean_or_known(name, known);
}

std::string list_choices(const ParamSpec& param) {
  std::vector<std::string> names;
  for (const ParamValue& choice : param.choices) names.push_back(to_string(choice));
  return fmt::format("{}", fmt::join(names, ", "));
}

double parse_param(const FilterSpec& spec, const ParamSpec& param, const std::string& text) {
  const std::optional<double> value = parse_number(text);
  if (!value) fail(fmt::format("{}:{}='{}' is not a finite number", spec.id, param.name, text));
  if (param.integer && *value != std::floor(*value))
    fail(fmt::format("{}:{}={} must be a whole number", spec.id, param.name, text));
  return *value;
}

void check_range(const FilterSpec& spec, const ParamSpec& param, double value) {
  if (value >= *param.min && value <= *param.max) return;
  fail(fmt::format("{}:{}={} is out of range: choose {} .. {}{}", spec.id, param.name, value, *param.min, *param.max,
                   param.unit.empty() ? "" : " " + param.unit));
}

void assign_value(FilterRequest& request, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos)
    fail(fmt::format("'{}' after '{}:' must be PARAM=VALUE", assignment, request.spec.id));
  const std::string name = assignment.substr(0, equals);
  if (request.set_by_user.contains(name) || (asks_for_width(request.spec, name) && !request.width.empty()))
    fail(fmt::format("{}: '{}' is given twice", request.spec.id, name));
  if (asks_for_width(request.spec, name)) {
    request.width = assignment.substr(equals + 1);
    return;
  }
  request.values[name] = parse_value(request.spec, name, assignment.substr(equals + 1));
  request.set_by_user.insert(name);
}

/// Puts the radius in place of the width that was asked for; that of a light is not known yet.
void apply_width(FilterRequest& request) {
  if (request.width.empty() || !request.presets.empty()) return;  // of a preset it was put there
  const std::string& name = require_width_param(request.spec, request.values, request.width);
  if (request.set_by_user.contains(name))
    fail(fmt::format("{} sets '{}' and 'width', which says the same: leave one out", request.spec.id, name));
  if (request.width == kLightWidth) return;
  request.values[name] = solve_radius(request.spec, request.values, request.width);
  request.set_by_user.insert(name);
}

/// Makes one request of those that are the same, where a preset is among them.
std::vector<FilterRequest> merge_presets(std::vector<FilterRequest> requests) {
  std::vector<FilterRequest> merged;
  for (FilterRequest& request : requests) {
    const auto same = std::ranges::find_if(merged, [&](const auto& other) { return is_same(request, other); });
    if (same == merged.end() || (same->presets.empty() && request.presets.empty()))
      merged.push_back(std::move(request));
    else
      same->presets.insert(same->presets.end(), request.presets.begin(), request.presets.end());
  }
  return merged;
}

/// What a filter computes with: its file without ids, titles, sources, claims, what is said of parameters, and
/// comments, with every run of blanks as one.
FilterSpec strip(FilterSpec spec) {
  for (std::string* text : {&spec.id, &spec.path, &spec.title, &spec.source, &spec.copy_of, &spec.front_matter})
    text->clear();
  for (ParamSpec& param : spec.params) param.unit = param.text = {};
  for (PassSpec& pass : spec.passes) pass.line = 1;
  spec.samples_line = 1;
  spec.claims.clear();
  spec.teaching = false;
  spec.body_first_line = 1;
  spec.body = squeeze_blanks(blank_comments(spec.body));
  return spec;
}

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

std::string FilterRequest::label() const {
  std::vector<std::string> shown;
  for (const std::string& name : set_by_user) shown.push_back(fmt::format("{}={}", name, to_string(values.at(name))));
  if (param_by_light() && !is_run_width) shown.push_back(fmt::format("width={}", kLightWidth));
  return shown.empty() ? spec.id : fmt::format("{} ({})", spec.id, fmt::join(shown, ", "));
}

const std::string* FilterRequest::param_by_light() const {
  return width == kLightWidth && presets.empty() ? find_width_param(spec, values) : nullptr;
}

void FilterRequest::take_light_width(double sigma_texels) {
  light_sigma_texels = sigma_texels;
  const std::string* name = param_by_light();
  if (!name) return;
  values[*name] = find_nearest_radius(spec, values, sigma_texels);
}

void refuse_light_widths(const std::vector<FilterRequest>& requests) {
  for (const FilterRequest& request : requests)
    if (request.width == kLightWidth)
      fail(fmt::format("{}:width={}: only 'run' asks the scene's light; give a class ({}) or texels", request.spec.id,
                       kLightWidth, describe_classes()));
}

void set_widths(std::vector<FilterRequest>& requests, const std::string& width) {
  for (FilterRequest& request : requests) {
    const auto* name = std::get_if<std::string>(&request.spec.radius_texels);
    if (!request.width.empty() || (name && request.set_by_user.contains(*name) && request.presets.empty())) continue;
    const bool is_free = request.presets.empty() && find_width_param(request.spec, request.values);
    if (is_free || width == kLightWidth) request.width = width;
    request.is_run_width = !request.width.empty();
    if (is_free) apply_width(request);
  }
}

ParamValues default_values(const FilterSpec& spec) {
  ParamValues values;
  for (const ParamSpec& param : spec.params) values[param.name] = param.default_value;
  return values;
}

bool asks_for_width(const FilterSpec& spec, const std::string& name) {
  return name == kWidth && !spec.find_param(name);
}

ParamValue parse_value(const FilterSpec& spec, const std::string& name, const std::string& text) {
  const ParamSpec* param = spec.find_param(name);
  if (!param) {
    std::vector<std::string> known;
    for (const ParamSpec& each : spec.params) known.push_back(each.name);
    fail(fmt::format("filter '{}' has no parameter '{}'{}", spec.id, name, suggest(name, known)));
  }
  if (std::holds_alternative<bool>(param->default_value)) {
    if (text != "true" && text != "false") fail(fmt::format("{}:{}='{}' must be true or false", spec.id, name, text));
    return text == "true";
  }
  const bool numeric = std::holds_alternative<double>(param->default_value);
  const ParamValue value = numeric ? ParamValue(parse_param(spec, *param, text)) : ParamValue(text);
  if (!param->choices.empty()) {
    if (std::find(param->choices.begin(), param->choices.end(), value) != param->choices.end()) return value;
    fail(fmt::format("{}:{}={} is not among its choices: {}", spec.id, name, text, list_choices(*param)));
  }
  check_range(spec, *param, std::get<double>(value));
  return value;
}

bool is_same(const FilterRequest& a, const FilterRequest& b) {
  const bool is_by_light = a.param_by_light() != nullptr;
  return a.spec.id == b.spec.id && a.values == b.values && is_by_light == (b.param_by_light() != nullptr);
}

Catalogue::Catalogue(const std::filesystem::path& folder) : folder_(folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".glsl") filters_.push_back(load_filter(entry.path()));
  if (filters_.empty()) {
    throw Error(ErrorKind::kFilter, "no filters (*.glsl) in this folder: set SHADOWBENCH_ROOT to the project's folder",
                folder.string());
  }
  // Comparison filters first, narrow before wide: the order in which people learn them.
  const auto order = [](const FilterSpec& spec) {
    return std::tuple(spec.kind, radius_texels(spec, default_values(spec)), spec.id);
  };
  std::sort(filters_.begin(), filters_.end(),
            [&](const FilterSpec& a, const FilterSpec& b) { return order(a) < order(b); });
}

std::vector<Preset> Catalogue::presets() const { return load_presets(folder_ / "presets.toml"); }

const FilterSpec& Catalogue::find(const std::string& id) const {
  std::vector<std::string> known;
  for (const FilterSpec& spec : filters_) {
    if (spec.id == id) return spec;
    known.push_back(spec.id);
  }
  fail(fmt::format("unknown filter '{}'{}", id, suggest(id, known)));
}

void Catalogue::add_user_file(const std::filesystem::path& path) {
  FilterSpec spec = load_filter(path);
  if (std::ranges::find(kReservedIds, spec.id) != std::end(kReservedIds))
    fail(fmt::format("filter id '{}' of {} has a meaning of its own: rename the file", spec.id, spec.path));
  for (const FilterSpec& known : filters_)
    if (known.id == spec.id)
      fail(fmt::format("filter id '{}' of {} is taken by {}: rename the file", spec.id, spec.path, known.path));
  for (const FilterSpec& known : filters_)
    if (find_model(known.id) && strip(known) == strip(spec)) spec.copy_of = known.id;
  user_ids_.push_back(spec.id);
  filters_.push_back(std::move(spec));
}

void Catalogue::add_user_files(const std::vector<std::string>& paths) {
  std::vector<FilterMistake> mistakes;
  for (const std::string& path : paths) {
    try {
      add_user_file(path);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kFilter) throw;
      mistakes.push_back({std::filesystem::path(path).stem().string(), path, error.what()});
    }
  }
  if (!mistakes.empty()) throw FilterErrors(std::move(mistakes));
}

FilterRequest Catalogue::make_request(const std::string& id) const {
  FilterRequest request;
  request.spec = find(id);
  request.values = default_values(request.spec);
  request.user_file = std::find(user_ids_.begin(), user_ids_.end(), id) != user_ids_.end();
  return request;
}

FilterRequest Catalogue::make_request(const Preset& preset) const {
  try {
    std::vector<FilterRequest> requests = parse_requests(preset.filter);
    if (requests.size() != 1) fail(fmt::format("'{}' is {} filters, and must be one", preset.filter, requests.size()));
    requests.front().presets = {preset};
    return requests.front();
  } catch (const Error& error) {
    throw Error(ErrorKind::kInput, fmt::format("the preset '{}': {}", preset.name, error.message()), preset.where);
  }
}

void Catalogue::add_requests(std::vector<FilterRequest>& requests, std::optional<std::vector<Preset>>& known,
                             const std::string& item) const {
  const std::size_t colon = item.find(':');
  const bool has_value = item.find('=') != std::string::npos;
  if (item == kAll || item == kTeaching) {
    for (const FilterSpec& spec : filters_)
      if (spec.teaching == (item == kTeaching)) requests.push_back(make_request(spec.id));
  } else if (item.starts_with(kPresetMark) && colon == std::string::npos && !has_value) {
    if (!known) known = presets();
    for (const Preset& preset : choose_presets(*known, item.substr(1))) requests.push_back(make_request(preset));
  } else if (item.starts_with(kPresetMark) ||
             (colon == std::string::npos && has_value && !requests.empty() && !requests.back().presets.empty())) {
    fail(
        fmt::format("'{}': a preset has the parameters of its engine; to change one, write its filter, which 'list "
                    "presets' shows",
                    item));
  } else if (colon == std::string::npos && has_value) {
    if (requests.empty()) fail(fmt::format("'{}' comes before any filter: write FILTER:PARAM=VALUE", item));
    assign_value(requests.back(), item);
  } else {
    requests.push_back(make_request(item.substr(0, colon)));
    if (colon != std::string::npos) assign_value(requests.back(), item.substr(colon + 1));
  }
}

std::vector<FilterRequest> Catalogue::parse_requests(const std::string& text) const {
  std::vector<FilterRequest> requests;
  std::optional<std::vector<Preset>> known;  // read for the first that is asked for
  for (const std::string& item : split_list(text.empty() ? std::string(kAll) : text)) {
    if (item.empty()) fail(fmt::format("empty filter name in '{}'", text));
    add_requests(requests, known, item);
  }
  for (FilterRequest& request : requests) apply_width(request);
  return merge_presets(std::move(requests));
}

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
