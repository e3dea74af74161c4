#include "report/pages/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/advice_words.h"
#include "report/analysis/trade_measures.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

constexpr const char* kRmse = "error.rmse";
constexpr double kAllowance = 1.25;  // of the least RMSE
constexpr std::size_t kWidened = 3;  // configurations keep a limit that would be kept by one

bool can_advise(const std::vector<records::CellRecord>& cells) {
  return std::ranges::any_of(
      cells, [](const records::CellRecord& cell) { return !cell.teaching.value_or(false); });
}

std::string describe_margin(const analysis::Advice& advice, const analysis::Candidate& best) {
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

document::Sentences describe_choice(const records::RunRecord& run, const analysis::Advice& advice) {
  const analysis::Candidate& best = advice.keeping.front();
  const bool has_limits = !advice.request.demands.empty();
  document::Sentences answer{fmt::format("{}: {}{}.", best.configuration.label,
                                         analysis::format_cost(best.cost.mean, advice.request.cheapest, run.gl),
                                         advice.request.cheapest.is_of_frame() ? " a frame with a moving light" : ""),
                             {}};
  answer.items.push_back(fmt::format("Why: the {} of {}{}{}.", analysis::describe_choice(advice), advice.keeping.size(),
                                     has_limits ? " that keep the limits" : " that can be judged",
                                     describe_margin(advice, best)));
  if (advice.keeping.size() > 1)
    answer.items.push_back(fmt::format("Runner-up: {}, {}.", advice.keeping[1].configuration.label,
                                       analysis::describe_runner_up(advice, run.gl)));
  return answer;
}

/// The GPU whose estimates decide at first: where a software rasteriser drew everything, since its times say nothing of
/// a GPU, the first of which there is an estimate.
std::optional<std::string> choose_gpu(const std::vector<records::CellRecord>& cells) {
  const auto is_of_cpu = [](const records::CellRecord& cell) { return cell.machine && cell.machine->software; };
  if (!std::ranges::all_of(cells, is_of_cpu)) return std::nullopt;
  for (const std::string& gpu : analysis::list_gpus(analysis::point_to(cells)))
    if (std::ranges::any_of(cells, [&](const auto& cell) { return cell.gpu && cell.gpu->at(gpu).estimate; }))
      return gpu;
  return std::nullopt;
}

}  // namespace

analysis::AdviceRequest choose_request(const std::vector<records::CellRecord>& cells) {
  analysis::AdviceRequest request;
  if (!can_advise(cells)) return request;
  if (const auto gpu = choose_gpu(cells)) request.cheapest = {analysis::CostKind::kGpu, *gpu};
  const auto spec = std::ranges::find(analysis::limit_table(), kRmse, &analysis::LimitSpec::field);
  request.demands.push_back({&*spec, std::numeric_limits<double>::infinity(), {}});
  const std::vector<analysis::Candidate> judged = analysis::advise(cells, request).keeping;
  if (judged.empty()) {
    request.demands.clear();
    return request;
  }
  std::vector<double> worst;
  for (const analysis::Candidate& each : judged) worst.push_back(*each.verdicts.front().worst);
  std::ranges::sort(worst);
  double most = kAllowance * worst.front();
  // Of one that keeps it there is nothing to choose, and a limit that all keep is none.
  if (worst.size() > 2 && worst[1] > most) most = worst[std::min(kWidened, worst.size() - 1) - 1];
  request.demands.front().most = std::stod(analysis::format_limit(most));
  return request;
}

document::Section make_answer_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                      const analysis::AdviceRequest& request) {
  document::Section section{"answer", "Which filter?", {}};
  if (!can_advise(cells)) {
    section.blocks = {document::Paragraph{
        cells.empty() ? "The run holds no cell." : "The run has filters for teaching alone, which are not advised."}};
    return section;
  }
  const analysis::Advice advice = analysis::advise(cells, request);
  document::Mount mount{"answer", {}};
  if (advice.keeping.empty())
    mount.blocks.emplace_back(
        document::Paragraph{fmt::format("Nothing fits: {}.", analysis::describe_failure(advice))});
  else
    mount.blocks.emplace_back(describe_choice(run, advice));
  document::Sentences notes{{}, analysis::list_run_notes(advice, run.gl)};
  if (request.cheapest.kind == analysis::CostKind::kGpu)
    notes.items.push_back(fmt::format(
        "A software rasteriser drew the run, so that its times say nothing of a GPU: the costs are estimates "
        "for {}, which was not there. Choose another under Cost, or this CPU's times.",
        request.cheapest.gpu));
  if (!request.demands.empty())
    notes.items.insert(notes.items.begin(),
                       "The limit to begin with is a quarter above the least RMSE that a filter keeps to on every "
                       "scene, or as much as three filters keep to: move it to yours.");
  mount.blocks.emplace_back(std::move(notes));
  section.blocks.emplace_back(std::move(mount));
  return section;
}

}  // namespace shadowbench::pages
