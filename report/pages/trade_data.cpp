#include "report/pages/trade_data.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/analysis/front_words.h"
#include "report/analysis/summary.h"
#include "report/files/file_name.h"
#include "report/page/plot_style.h"
#include "report/pages/trade_plots.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::pages {
namespace {

using nlohmann::json;

json estimate_json(const analysis::Estimate& estimate) {
  return json::array({estimate.value, estimate.low, estimate.high});
}

json measured_json(const analysis::Measured& measured) {
  return measured.estimate ? estimate_json(*measured.estimate) : json();
}

json axis_json(const page::PlotAxis& axis) {
  json ticks = json::array();
  for (const auto& [value, label] : axis.ticks) ticks.push_back(json::array({value, label}));
  return {{"log", axis.log}, {"low", axis.low}, {"high", axis.high}, {"ticks", ticks}};
}

template <class Measures>
json measures_json(const Measures& measures, const records::GlRecord& gl) {
  json list = json::array();
  for (const analysis::Measure& each : measures) {
    list.push_back({{"id", each.id},
                    {"name", each.name},
                    {"axis", analysis::name_axis(each, gl)},
                    {"bytes", each.is_bytes},
                    {"unit", each.is_time ? records::time_unit(gl) : std::string()}});
  }
  return list;
}

json filters_json(const std::vector<std::string>& filters) {
  json list = json::array();
  for (std::size_t i = 0; i < filters.size(); ++i)
    list.push_back({{"id", filters[i]}, {"color", page::style_of(i).color}, {"shape", page::style_of(i).shape}});
  return list;
}

json url_json(const std::optional<std::string>& path) { return path ? json(files::encode_url_path(*path)) : json(); }

json pictures_json(const analysis::TradeConfiguration& configuration, const std::vector<records::CellRecord>& cells) {
  json list = json::array();
  for (const std::size_t i : configuration.cells) {
    list.push_back({{"scene", fmt::format("{} · {}", cells[i].scene, cells[i].view)},
                    {"picture", url_json(cells[i].images.picture)},
                    {"visibility", url_json(cells[i].images.visibility)}});
  }
  return list;
}

json configuration_json(const analysis::TradeConfiguration& configuration,
                        const std::vector<records::CellRecord>& cells) {
  json errors = json::array(), costs = json::array();
  for (const analysis::Measured& each : configuration.errors) errors.push_back(measured_json(each));
  for (const analysis::Measured& each : configuration.costs) costs.push_back(measured_json(each));
  return {{"filter", configuration.filter},
          {"params", records::describe_params(configuration.params)},
          {"map", configuration.map_size},
          {"label", configuration.label},
          {"errors", errors},
          {"costs", costs},
          {"pictures", pictures_json(configuration, cells)}};
}

const char* name_of(analysis::Standing standing) {
  return standing == analysis::Standing::kFront  ? "front"
         : standing == analysis::Standing::kTied ? "tied"
                                                 : "dominated";
}

json front_json(const analysis::TradeScope& scope, const analysis::TradeFront& front, const records::GlRecord& gl) {
  json places = json::array(), members = json::array();
  for (std::size_t i = 0; i < front.points.size(); ++i) {
    places.push_back(json::array({front.configurations[i], name_of(front.placements[i].standing),
                                  front.configurations[front.placements[i].by]}));
  }
  for (const std::size_t member : front.members) members.push_back(front.configurations[member]);
  return {{"places", places}, {"members", members}, {"words", analysis::describe_front(scope, front, gl)}};
}

json scope_json(const analysis::TradeScope& scope, const std::vector<records::CellRecord>& cells,
                const records::GlRecord& gl) {
  json configurations = json::array(), fronts = json::array(), error_axes = json::array(), cost_axes = json::array();
  for (const analysis::TradeConfiguration& each : scope.configurations)
    configurations.push_back(configuration_json(each, cells));
  for (std::size_t e = 0; e < analysis::kErrorMeasures; ++e) {
    error_axes.push_back(axis_json(choose_error_axis(scope, e)));
    fronts.push_back(json::array());
    for (std::size_t c = 0; c < analysis::kCostMeasures; ++c)
      fronts.back().push_back(front_json(scope, analysis::make_trade_front(scope, e, c), gl));
  }
  for (std::size_t c = 0; c < analysis::kCostMeasures; ++c) cost_axes.push_back(axis_json(choose_cost_axis(scope, c)));
  return {{"id", scope.id},   {"title", scope.title},    {"configurations", configurations},
          {"fronts", fronts}, {"errorAxes", error_axes}, {"costAxes", cost_axes}};
}

json curve_json(const analysis::RadiusCurve& curve, analysis::LightState light) {
  json points = json::array();
  for (const analysis::RadiusPoint& p : curve.points) {
    points.push_back({{"radius", p.radius_texels},
                      {"time", estimate_json(light == analysis::LightState::kStill ? p.still : p.moving)}});
  }
  return {{"filter", curve.filter}, {"label", curve.label}, {"prefiltered", curve.prefiltered}, {"points", points}};
}

json chart_json(const analysis::RadiusChart& chart, analysis::LightState light) {
  json curves = json::array(), crossings = json::array();
  std::vector<double> radii, times;
  for (const analysis::RadiusCurve& curve : chart.curves) {
    curves.push_back(curve_json(curve, light));
    for (const analysis::RadiusPoint& p : curve.points) {
      const analysis::Estimate& time = light == analysis::LightState::kStill ? p.still : p.moving;
      radii.push_back(p.radius_texels);
      times.insert(times.end(), {time.value, time.low, time.high});
    }
  }
  for (const analysis::CurveComparison& each : analysis::compare_curves(chart, light)) {
    for (const analysis::RadiusPoint& p : each.crossings) {
      crossings.push_back({{"radius", p.radius_texels},
                           {"time", p.still.value},
                           {"label", chart.curves[each.prefiltered].label + " × " + chart.curves[each.taps].label}});
    }
  }
  return {{"curves", curves},
          {"crossings", crossings},
          {"x", axis_json(page::choose_axis(radii, {}, page::TickKind::kNumber))},
          {"y", axis_json(page::choose_log_axis(times, {}))}};
}

}  // namespace

json make_trade_data(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                     const std::vector<analysis::TradeScope>& scopes,
                     const std::vector<analysis::RadiusChart>& charts) {
  json data{{"errors", measures_json(analysis::list_error_measures(), run.gl)},
            {"costs", measures_json(analysis::list_cost_measures(), run.gl)},
            {"filters", filters_json(analysis::list_filters(cells))},
            {"scopes", json::array()},
            {"charts", json::array()}};
  for (const analysis::TradeScope& scope : scopes) data["scopes"].push_back(scope_json(scope, cells, run.gl));
  for (const analysis::RadiusChart& chart : charts) {
    data["charts"].push_back({{"title", chart.title},
                              {"still", chart_json(chart, analysis::LightState::kStill)},
                              {"moving", chart_json(chart, analysis::LightState::kMoving)}});
  }
  return data;
}

std::string dump_for_script(const json& data) {
  std::string safe;
  for (const char c : records::dump_line(data)) {
    // In JSON these stand in strings only, where an escape means the same.
    if (c == '<' || c == '>' || c == '&')
      safe += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      safe += c;
  }
  return safe;
}

}  // namespace shadowbench::pages
