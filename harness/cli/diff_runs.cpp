#include "harness/cli/diff_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "filters/base/error.h"
#include "harness/cli/arguments.h"
#include "report/analysis/repeat.h"
#include "report/analysis/summary.h"
#include "report/records/format.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

namespace shadowbench::cli {
namespace {

using analysis::RatioApart;
using records::CellRecord;

constexpr std::size_t kMostNamed = 10;

const std::optional<records::Ratio>& ratio_of(const CellRecord& cell, const std::string& name) {
  const records::RatioRecord& ratios = cell.ratio_to_none;
  return name == "lookup" ? ratios.lookup : name == "moving" ? ratios.moving : ratios.static_map;
}

std::string describe(const RatioApart& apart) {
  const CellRecord& cell = *apart.a;
  return fmt::format("{} ({}), {}{}, map {}, picture {} x {}: {} {} against {}", cell.scene, cell.view, cell.filter,
                     cell.params.empty() ? "" : " (" + records::describe_params(cell.params) + ")", cell.map_size,
                     cell.width, cell.height, apart.ratio, records::format_ratio(ratio_of(cell, apart.ratio)),
                     records::format_ratio(ratio_of(*apart.b, apart.ratio)));
}

void print_text(const analysis::RepeatComparison& found) {
  fmt::print("cells        {} in both\n", *found.record.cells);
  fmt::print("overlapping  {} of {} 95 % intervals of ratios to none\n", *found.record.overlapping, *found.record.of);
  if (!found.apart.empty()) fmt::print("apart, the widest gap first:\n");
  for (std::size_t i = 0; i < std::min(found.apart.size(), kMostNamed); ++i)
    fmt::print("  {}\n", describe(found.apart[i]));
  if (found.apart.size() > kMostNamed) fmt::print("  and {} more\n", found.apart.size() - kMostNamed);
}

void print_json(const analysis::RepeatComparison& found) {
  nlohmann::ordered_json json = {
      {"cells", *found.record.cells}, {"overlapping", *found.record.overlapping}, {"of", *found.record.of}};
  json["apart"] = nlohmann::ordered_json::array();
  for (const RatioApart& apart : found.apart) {
    json["apart"].push_back({{"key", apart.a->key},
                             {"scene", apart.a->scene},
                             {"view", apart.a->view},
                             {"filter", apart.a->filter},
                             {"ratio", apart.ratio},
                             {"a", records::value_json(*ratio_of(*apart.a, apart.ratio))},
                             {"b", records::value_json(*ratio_of(*apart.b, apart.ratio))},
                             {"gap", apart.gap}});
  }
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

/// Warns where more than chance may have changed the times.
void warn_of_differences(const records::RunRecord& a, const records::RunRecord& b) {
  const auto warn = [](const char* what, const std::string& x, const std::string& y) {
    if (x != y) fmt::print(stderr, "warning: the runs differ in {}: {}, and {}\n", what, x, y);
  };
  const auto machine = [](const records::RunRecord& run) {
    return fmt::format("{} with {} cores", run.machine.cpu, run.machine.cores);
  };
  warn("their machine", machine(a), machine(b));
  warn("their OpenGL", a.gl.renderer, b.gl.renderer);
  warn("the program's commit", a.commit, b.commit);
}

}  // namespace

bool is_run(const std::filesystem::path& argument) {
  std::error_code ignored;
  return std::filesystem::is_directory(argument, ignored) || argument.extension() == ".json";
}

int diff_runs(const std::filesystem::path& a, const std::filesystem::path& b, bool json) {
  const records::Results first = records::read_results(find_results(a)),
                         second = records::read_results(find_results(b));
  const analysis::RepeatComparison found = analysis::compare_times(first.cells, second.cells);
  if (found.record.of == 0) {
    throw Error(
        ErrorKind::kInput,
        fmt::format(
            "the two runs have {} cells in common, and no ratio to none to compare: run the same experiment twice",
            *found.record.cells),
        fmt::format("{} and {}", a.string(), b.string()));
  }
  warn_of_differences(first.run, second.run);
  if (json)
    print_json(found);
  else
    print_text(found);
  if (found.apart.empty()) return 0;
  throw Error(ErrorKind::kLimit, fmt::format("{}; widest apart: {}", analysis::describe_overlap(found.record),
                                             describe(found.apart.front())));
}

}  // namespace shadowbench::cli
