#include "harness/tune/tuned_parameters.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "report/records/tuned_record.h"

namespace shadowbench::tune {
namespace {

/// Runs a check of the catalogue, whose complaints are then about a field of the file.
template <class Check>
decltype(auto) check_field(const std::filesystem::path& file, const std::string& field, const Check& check) {
  try {
    return check();
  } catch (const Error& error) {
    throw Error(ErrorKind::kInput, fmt::format("the field {}: {}", field, error.message()), file.string());
  }
}

filters::ParamValues read_values(const filters::FilterSpec& spec, const records::ParamMap& params,
                                 const std::filesystem::path& file, const std::string& field) {
  filters::ParamValues values;
  for (const auto& [name, param] : params) {
    filters::ParamValue value;
    std::visit([&value](const auto& held) { value = held; }, param);
    values[name] = check_field(file, field + "." + name, [&spec, &key = name, &value] {
      return filters::parse_value(spec, key, filters::to_string(value));
    });
  }
  return values;
}

void take_values(filters::FilterRequest& request, const filters::ParamValues& values) {
  const filters::ParamValues defaults = filters::default_values(request.spec);
  for (const auto& [name, value] : values) {
    const bool is_set = request.set_by_user.contains(name);
    // A radius that a width asked for is no wish for this very radius.
    const auto* radius = std::get_if<std::string>(&request.spec.radius_texels);
    const bool by_width = !request.width.empty() && radius && *radius == name;
    if (is_set && !by_width) continue;
    if (by_width) request.width.clear();
    request.values[name] = value;
    if (value != defaults.at(name)) request.set_by_user.insert(name);  // labels have it
  }
}

}  // namespace

std::vector<std::string> apply_tuned(std::vector<filters::FilterRequest>& requests, const filters::Catalogue& catalogue,
                                     const std::filesystem::path& file, const std::vector<int>& map_sizes,
                                     const std::vector<scene::FitRule>& fits) {
  const records::TunedSettings tuned = records::read_tuned_settings(file);
  std::map<std::string, filters::ParamValues> found;
  std::map<std::string, std::string> fit_of;
  for (std::size_t i = 0; i < tuned.filters.size(); ++i) {
    const records::TunedSettings::Filter& filter = tuned.filters[i];
    const std::string field = fmt::format("filters[{}]", i);
    const filters::FilterSpec& spec =
        check_field(file, field + ".id", [&]() -> const filters::FilterSpec& { return catalogue.find(filter.id); });
    fit_of[filter.id] = filter.fit;
    found[filter.id] = read_values(spec, filter.params, file, field + ".params");
  }
  std::vector<std::string> notes;
  const std::set<std::string> drawn = scene::describe_fits(fits);
  for (filters::FilterRequest& request : requests) {
    if (!request.presets.empty()) continue;  // what an engine ships has the engine's parameters, those unsaid too
    const auto values = found.find(request.spec.id);
    if (values != found.end()) {
      take_values(request, values->second);
      if (const std::string& fit = fit_of[request.spec.id]; !drawn.contains(fit))
        notes.push_back(fmt::format("{} was tuned for {} under --fit {}, which this run does not draw", file.string(),
                                    request.label(), fit));
    } else if (!request.spec.params.empty())
      notes.push_back(fmt::format("{} has no parameters for {}, which keeps its own", file.string(), request.label()));
  }
  for (const int map_size : map_sizes) {
    if (map_size == tuned.map_size) continue;
    notes.push_back(
        fmt::format("{} was tuned on maps of {} texels, this run draws {}: a radius in texels is another one in metres",
                    file.string(), tuned.map_size, map_size));
  }
  return notes;
}

}  // namespace shadowbench::tune
