#include "harness/run/until_different.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/measure/phases.h"
#include "harness/measure/scene_measurement.h"
#include "harness/run/run_experiment.h"
#include "reference/metrics/error_stats.h"
#include "report/analysis/differences.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

/// Of Student's t, as find_student_t() has 0.985 for one look.
constexpr double kBelowOfEachLook = 0.994;

analysis::CellChoice choose(const filters::FilterRequest& request) {
  records::CellRecord asked;
  asked.params = measure::record_params(request.values);
  if (const std::string* name = request.param_by_light()) asked.kernel.by_light = *name;
  return [id = request.spec.id, params = records::named_params(asked)](const records::CellRecord& cell) {
    return cell.filter == id && records::named_params(cell) == params;
  };
}

/// The interval of one of several looks.
analysis::Estimate widen(const analysis::Estimate& gap, std::size_t groups) {
  const double reach =
      (gap.high - gap.value) * metrics::find_student_t(groups, kBelowOfEachLook) / metrics::find_student_t(groups);
  return {gap.value, gap.value - reach, gap.value + reach};
}

}  // namespace

std::string run_until_different(options::RunOptions options, options::Progress& progress) {
  const filters::FilterRequest &a = options.until_different.front(), &b = options.until_different.back();
  for (options.phases = std::max(options.phases, 8);;
       options.phases = std::min(2 * options.phases, options::kMostAveraged)) {
    run_experiment(options, progress);
    const auto cells = records::read_results(options.out / "results.json").cells;
    const auto gap = analysis::find_difference(cells, choose(a), choose(b));
    if (!gap) return fmt::format("{} and {} cannot be compared: no place has an RMSE of both", a.label(), b.label());
    const auto phases = static_cast<std::size_t>(options.phases);
    const analysis::Estimate known = widen(*gap, phases / measure::count_phases_of_group(phases));
    const bool differs = known.low > 0.0 || known.high < 0.0;
    if (!differs && options.phases < options::kMostAveraged) {
      progress.note(fmt::format("{} phases do not tell {} and {} apart", options.phases, a.label(), b.label()));
      continue;
    }
    const auto number = [](double value) { return records::format_number(value); };
    return fmt::format("the RMSE of {} less that of {} is {} [{}, {}] with {} phases, {}", a.label(), b.label(),
                       number(known.value), number(known.low), number(known.high), options.phases,
                       differs ? "so that they differ" : "the most there are: they are not told apart");
  }
}

}  // namespace shadowbench::run
