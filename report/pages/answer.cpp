#include "report/pages/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/advice.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cells.h"
#include "report/analysis/measures.h"
#include "report/pages/run_data.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

constexpr std::array kPicks = {analysis::kFast, analysis::kBalanced, analysis::kBest};

bool can_advise(const std::vector<records::CellRecord>& cells) {
  return std::ranges::any_of(cells, records::is_advised);
}

std::string describe_pick(const analysis::Advice& advice, const analysis::Pick& pick, const records::GlRecord& gl,
                          bool in_full) {
  const analysis::Candidate& candidate = advice.keeping[pick.index];
  std::string text = candidate.configuration.name;
  if (in_full) text += ": " + analysis::format_cost(candidate.cost.mean, advice.request.cheapest, gl);
  if (candidate.rmse) text += fmt::format(", RMSE {}", records::format_number(candidate.rmse->value));
  return in_full ? fmt::format("{}; {}", text, pick.why) : text;
}

/// A row of what `say` says of each pick. One that is both fast and best stands under both.
std::vector<std::string> make_row(std::string head, const analysis::Advice& advice, const auto& say) {
  std::vector<std::string> row = {std::move(head)};
  row.resize(1 + kPicks.size(), records::kNothing);
  for (const analysis::Pick& pick : analysis::list_picks(advice))
    for (std::size_t i = 0; i < kPicks.size(); ++i)
      if (std::ranges::count(pick.names, kPicks[i]) > 0) row[1 + i] = say(pick);
  return row;
}

document::Table make_table(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                           const analysis::Advice& advice, const std::vector<records::BiasCell>& biases) {
  document::Table table{"", {{"", "Fast", "Balanced", "Best"}, {}}};
  const std::vector<std::string> scenes = list_answered_scenes(cells);
  const auto add = [&](const std::string& head, const analysis::Advice& own, bool in_full) {
    table.table.rows.push_back(
        make_row(head, own, [&](const analysis::Pick& pick) { return describe_pick(own, pick, run.gl, in_full); }));
  };
  add(scenes.empty() ? advice.places.front().scene : "all scenes", advice, true);
  for (const std::string& scene : scenes) {
    if (std::ranges::count(advice.places, scene, &analysis::Place::scene) == 0) {
      const auto left_out =
          std::ranges::find(advice.left_out, scene, [](const auto& each) { return each.place.scene; });
      table.table.rows.push_back({scene, analysis::describe_state(left_out->state), "", ""});
      continue;
    }
    analysis::AdviceRequest request = advice.request;
    request.scenes = {scene};
    const analysis::Advice own = analysis::advise(cells, request);
    if (!own.keeping.empty()) add(scene, own, false);
  }
  const auto bias_of = [&](const analysis::Pick& pick) {
    const std::string bias = describe_biases(advice.keeping[pick.index].configuration, biases);
    return bias.empty() ? std::string(records::kNothing) : bias;
  };
  const std::vector<std::string> row = make_row("bias to ship", advice, bias_of);
  if (std::ranges::count(row, records::kNothing) < std::ssize(kPicks)) table.table.rows.push_back(row);
  return table;
}

/// The cell whose picture differs most from the truth's; null where none has both.
const records::CellRecord* find_worst_picture(const analysis::Configuration& configuration) {
  const records::CellRecord* worst = nullptr;
  for (const records::CellRecord* cell : configuration.cells)
    if (cell->images.picture && cell->images.truth_picture && cell->images.hardest && cell->error.flip &&
        (!worst || *cell->error.flip > *worst->error.flip))
      worst = cell;
  return worst;
}

/// The first sheet of the grid with the largest error, behind what each scene's answer is.
std::optional<document::Gallery> make_grid_picture(const std::vector<records::CellRecord>& cells) {
  const records::CellRecord* worst = nullptr;
  for (const records::CellRecord& cell : cells)
    if (cell.images.grid && (!worst || cell.error.rmse.value_or(0.0) > worst->error.rmse.value_or(0.0))) worst = &cell;
  if (!worst) return std::nullopt;
  return document::Gallery{"", {{*worst->images.grid, "filters on " + worst->scene + " by their error"}}};
}

}  // namespace

analysis::AdviceRequest choose_request(const std::vector<records::CellRecord>& cells) {
  analysis::AdviceRequest request;
  request.cheapest = analysis::choose_cost(cells);
  return request;
}

void with_first_advice(const std::vector<records::CellRecord>& measured,
                       const std::function<void(const analysis::Advice&)>& use) {
  const auto withheld = analysis::withhold_mixed_times(measured);
  const std::vector<records::CellRecord>& cells = withheld ? *withheld : measured;
  if (!can_advise(cells)) return;
  const analysis::Advice advice = analysis::advise(cells, choose_request(cells));
  if (!advice.keeping.empty()) use(advice);
}

std::vector<FirstPicture> list_first_pictures(const std::vector<records::CellRecord>& measured) {
  std::vector<FirstPicture> pictures;
  with_first_advice(measured, [&](const analysis::Advice& advice) {
    for (const analysis::Pick& pick : analysis::list_picks(advice))
      if (const auto* cell = find_worst_picture(advice.keeping[pick.index].configuration))
        pictures.push_back({cell->key, choose_part(*cell)});
  });
  return pictures;
}

document::Section make_answer_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                      const analysis::AdviceRequest& request,
                                      const std::vector<records::BiasCell>& biases) {
  document::Section section{"answer", "", {}};
  if (!can_advise(cells)) {
    section.blocks = {document::Paragraph{
        cells.empty() ? "The run holds no cell." : "The run has filters for teaching alone, which are not advised."}};
    return section;
  }
  const analysis::Advice advice = analysis::advise(cells, request);
  document::Mount mount{"answer", {}};
  if (advice.keeping.empty()) {
    mount.blocks.emplace_back(
        document::Paragraph{fmt::format("Nothing fits: {}.", analysis::describe_failure(advice))});
  } else {
    mount.blocks.emplace_back(document::Paragraph{analysis::describe_choice(advice)});
    if (const std::string judged = analysis::describe_judged_lights(advice); !judged.empty())
      mount.blocks.emplace_back(document::Paragraph{judged + "."});
    mount.blocks.emplace_back(document::Paragraph{describe_setting(cells), true});
    mount.blocks.emplace_back(make_table(run, cells, advice, biases));
  }
  if (auto grid = make_grid_picture(cells)) mount.blocks.emplace_back(std::move(*grid));
  mount.blocks.emplace_back(document::Paragraph{analysis::describe_cost(advice), true});
  mount.blocks.emplace_back(document::Sentences{{}, analysis::list_advice_notes(advice, run.gl)});
  section.blocks.emplace_back(std::move(mount));
  return section;
}

}  // namespace shadowbench::pages
