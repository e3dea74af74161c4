#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "filters/kernel.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/terminal.h"
#include "report/analysis/advice.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cells.h"
#include "report/analysis/measures.h"
#include "report/pages/advice_text.h"
#include "report/records/gpu_times.h"
#include "report/records/json_io.h"

namespace shadowbench::cli {
namespace {

using analysis::AdviceRequest;

struct AdviseArguments {
  std::string run;
  std::vector<std::optional<std::string>> limits =
      std::vector<std::optional<std::string>>(analysis::limit_table().size());
  std::string property;
  std::vector<std::string> scenes;
  std::string size;
  std::string width_class;
  std::string light_motion = "moving";
  std::string cheapest;
  std::string times;
  bool json = false;
};

double parse_limit(const std::string& text, const char* option) {
  if (const std::optional<double> value = parse_number(text); value && *value >= 0.0) return *value;
  fail(fmt::format("{}: '{}' must be a number, 0 or more", option, text));
}

const std::map<std::string, analysis::LightMotion> kLightMotions = {{"moving", analysis::LightMotion::kMoving},
                                                                    {"static", analysis::LightMotion::kStatic}};
constexpr const char* kGpuPrefix = "gpu:";

analysis::CostKind parse_cost(const std::string& text) {
  using Cost = analysis::CostKind;
  static const std::map<std::string, Cost::Kind> kCosts = {
      {"time", Cost::kTime}, {"bytes", Cost::kBytes}, {"fetches", Cost::kFetches}};
  if (text.starts_with(kGpuPrefix)) return {Cost::kGpu, text.substr(std::strlen(kGpuPrefix))};
  const auto found = kCosts.find(text);
  if (found == kCosts.end()) fail(fmt::format("--cheapest: '{}' must be one of time, bytes, fetches, gpu:NAME", text));
  return found->second;
}

AdviceRequest make_request(const AdviseArguments& arguments) {
  AdviceRequest request;
  for (std::size_t i = 0; i < arguments.limits.size(); ++i) {
    const analysis::Quantity& spec = analysis::limit_table()[i];
    if (arguments.limits[i]) request.demands.push_back({&spec, parse_limit(*arguments.limits[i], spec.option.c_str())});
  }
  if (!arguments.property.empty()) request.demands.emplace_back();
  request.light = kLightMotions.at(arguments.light_motion);
  if (!arguments.cheapest.empty()) request.cheapest = parse_cost(arguments.cheapest);
  request.scenes = arguments.scenes;
  request.width_class = arguments.width_class;
  if (!arguments.size.empty()) request.size = parse_picture_size(arguments.size);
  return request;
}

/// Unless another is asked for, the cost is the one that the run's page begins with, or the time of the GPU whose times
/// are given. Milliseconds are limited as they are told: a frame's time or its estimate.
void choose_cost(AdviceRequest& request, const AdviseArguments& arguments,
                 const std::vector<records::CellRecord>& cells) {
  const analysis::CostKind usual =
      arguments.times.empty() ? analysis::choose_cost(cells) : analysis::CostKind(analysis::CostKind::kTime);
  if (arguments.cheapest.empty()) request.cheapest = usual;
  const analysis::CostKind& frame = request.cheapest.is_of_frame() ? request.cheapest : usual;
  if (frame.kind != analysis::CostKind::kGpu) return;
  for (analysis::Demand& demand : request.demands)
    if (demand.spec == &analysis::cost_spec(analysis::CostKind::kTime)) demand.spec = &analysis::cost_spec(frame);
}

int advise(const AdviseArguments& arguments) {
  AdviceRequest request = make_request(arguments);
  records::Results results = records::read_results(find_results(arguments.run));
  if (!arguments.times.empty()) records::apply_gpu_times(results, records::read_gpu_times(arguments.times));
  if (auto withheld = analysis::withhold_mixed_times(results.cells)) results.cells = std::move(*withheld);
  choose_cost(request, arguments, results.cells);
  const analysis::Advice advice = analysis::advise(results.cells, request);
  if (arguments.json) {
    const auto json = pages::make_advice_json(results.run, advice);
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    print("{}", pages::make_advice_text(results.run, advice));
  }
  if (advice.keeping.empty()) throw Error(ErrorKind::kLimit, analysis::describe_failure(advice));
  return 0;
}

}  // namespace

Command make_advise_command() {
  Command command{"advise", "Recommend filters of a run, within your limits"};
  command.about =
      "Prints three answers: fast, the cheapest; best, the least mean RMSE; balanced, the knee between them. The rest "
      "is about the fast one.\nA configuration is a filter with its parameters, map, image size and bias. Its worst "
      "scene must keep each limit; --max-ms holds for each view. Its cost is the mean over all views: map, prefilter "
      "and lookup under a moving light, the lookup alone under a static one. Without a limit on an error or a fault, "
      "configurations not clearly better than 'none' are left out.\nA configuration that was not measured on every "
      "scene, did not finish, or lacks a limited value is left out. A fault with too few receivers in a scene is "
      "judged on the other scenes. Times from different machines are never compared: estimates, fetches or bytes take "
      "their place.\nExit code 1: nothing keeps the limits; the message names what comes closest.";
  auto a = std::make_shared<AdviseArguments>();
  command.add("RUN", &a->run, "a run's folder, or its results.json").names(ValueKind::kFile).require();
  for (std::size_t i = 0; i < a->limits.size(); ++i) {
    const analysis::Quantity& spec = analysis::limit_table()[i];
    command.add(spec.option, &a->limits[i], spec.meaning);
  }
  command.add("--requires", &a->property, "what the filter must claim and the run confirm")
      .one_of({analysis::kContactHardening});
  command.add("--scene", &a->scenes, "judge on this scene; repeatable (default all of the run)")
      .names(ValueKind::kScene);
  command.add("--size", &a->size, "judge images of WxH pixels (default all of the run)");
  command.add("--class", &a->width_class, "judge kernels of this width class (default any)")
      .one_of(filters::list_width_names());
  command.add("--light-motion", &a->light_motion, "whether every frame pays for map and prefilter")
      .one_of({"moving", "static"});
  command.add("--cheapest", &a->cheapest,
              "cost to minimise: time, bytes, fetches, or gpu:NAME, an estimate of the run (default time; without a "
              "GPU, the first estimate)");
  command.add("--times", &a->times, "gpu-times.json saved by the report's page: judge by that GPU's times")
      .names(ValueKind::kFile);
  add_json_option(command, a->json);
  command.action = [a](const CommandLine&) { return advise(*a); };
  return command;
}

}  // namespace shadowbench::cli
