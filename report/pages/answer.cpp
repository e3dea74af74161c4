#include "report/pages/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/analysis/advice_words.h"
#include "report/analysis/summary.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

constexpr const char* kRmse = "error.rmse";
constexpr double kAllowance = 1.25;  // of the least RMSE

/// The largest RMSE of a configuration; nothing where a cell has none or is not ok.
std::optional<double> find_worst(const analysis::Configuration& configuration) {
  double worst = 0.0;
  for (const records::CellRecord* cell : configuration.cells) {
    if (!cell->error.rmse || cell->status != records::CellStatus::kOk) return std::nullopt;
    worst = std::max(worst, *cell->error.rmse);
  }
  return worst;
}

double round_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::stod(fmt::format("{:.2g}", std::ceil(value / unit) * unit));
}

std::string describe_limits(const analysis::Advice& advice, const analysis::Candidate& best) {
  std::string text;
  for (std::size_t i = 0; i < advice.request.demands.size(); ++i) {
    const analysis::Verdict& verdict = best.verdicts[i];
    text += fmt::format("; {} at worst, on {}, where {} is the limit",
                        analysis::format_kept(*verdict.worst, advice.request.demands[i].most),
                        analysis::describe_place(analysis::place_of(*verdict.where), advice.places),
                        records::format_number(advice.request.demands[i].most));
  }
  return text;
}

page::Sentences describe_choice(const records::RunRecord& run, const analysis::Advice& advice) {
  const analysis::Candidate& best = advice.keeping.front();
  const bool has_limits = !advice.request.demands.empty();
  page::Sentences answer{fmt::format("{}: {} a frame with a moving light.", best.configuration.label,
                                     analysis::format_cost(best.cost.mean, advice.request.cheapest, run.gl)),
                         {}};
  answer.items.push_back(fmt::format("Why: the {} of {}{}{}.", analysis::describe_choice(advice), advice.keeping.size(),
                                     has_limits ? " that keep the limits" : " that can be judged",
                                     describe_limits(advice, best)));
  if (advice.keeping.size() > 1)
    answer.items.push_back(fmt::format("Runner-up: {}, {}.", advice.keeping[1].configuration.label,
                                       analysis::describe_runner_up(advice, run.gl)));
  return answer;
}

}  // namespace

analysis::AdviceRequest choose_request(const std::vector<records::CellRecord>& cells) {
  std::vector<const records::CellRecord*> all;
  for (const records::CellRecord& cell : cells)
    if (!cell.teaching.value_or(false)) all.push_back(&cell);
  std::optional<double> least;
  const std::size_t places = analysis::list_places(all).size();
  for (const analysis::Configuration& configuration : analysis::list_configurations(all))
    if (const auto worst = find_worst(configuration); worst && configuration.cells.size() == places)
      least = std::min(least.value_or(*worst), *worst);
  analysis::AdviceRequest request;
  const auto spec = std::ranges::find(analysis::limit_table(), kRmse, &analysis::LimitSpec::field);
  if (least) request.demands.push_back({&*spec, *least > 0.0 ? round_up(kAllowance * *least) : 0.0, {}});
  return request;
}

page::Section make_answer_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                  const analysis::AdviceRequest& request) {
  page::Section section{"answer", "Which filter?", {}};
  const bool can_advise =
      std::ranges::any_of(cells, [](const records::CellRecord& cell) { return !cell.teaching.value_or(false); });
  if (!can_advise) {
    section.blocks = {page::Paragraph{
        cells.empty() ? "The run holds no cell." : "The run has filters for teaching alone, which are not advised."}};
    return section;
  }
  const analysis::Advice advice = analysis::advise(cells, request);
  page::Mount mount{"answer", {}};
  if (advice.keeping.empty())
    mount.blocks.emplace_back(page::Paragraph{fmt::format("Nothing fits: {}.", analysis::describe_failure(advice))});
  else
    mount.blocks.emplace_back(describe_choice(run, advice));
  page::Sentences notes{{}, analysis::list_run_notes(advice, run.gl)};
  if (!request.demands.empty())
    notes.items.insert(notes.items.begin(),
                       "The limit to begin with is a quarter above the least RMSE that a filter keeps to on every "
                       "scene: move it to yours.");
  mount.blocks.emplace_back(std::move(notes));
  section.blocks.emplace_back(std::move(mount));
  return section;
}

}  // namespace shadowbench::pages
