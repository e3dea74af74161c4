// The page's script picks what advise() picks, in runs that nobody measured and under limits.

#include "report/analysis/advice.h"
#include "report/pages/run_data.h"
#include "tests/report/analysis/made_up_runs.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::pages {
namespace {

constexpr int kRuns = 300, kQuestions = 4;
constexpr double kNoises[] = {0.0, 0.001, 0.02};  ///< of groups of phases; 0: there are none

/// Adds what tells two cells apart: a key, seams, and, of some runs, what groups of phases found.
void finish(records::CellRecord& cell, std::size_t number, double noise_of_groups, std::mt19937& random) {
  cell.key = fmt::format("{:016x}", number);
  cell.artefact.seam = 0.01 * static_cast<double>(random() % 4);
  if (noise_of_groups <= 0.0 || !cell.error.rmse) return;
  std::normal_distribution<double> noise(0.0, noise_of_groups);
  double sum = 0.0;
  for (double& each : cell.rmse_replicates.emplace(4)) sum += each = std::max(1e-4, *cell.error.rmse + noise(random));
  cell.error.rmse = sum / 4.0;
}

/// What the page has of a run, what is asked of it, and what the program answers.
nlohmann::json ask(const nlohmann::json& data, const std::vector<records::CellRecord>& cells, std::mt19937& random,
                   bool is_limited) {
  analysis::AdviceRequest request;
  nlohmann::json limits = nlohmann::json::object();
  for (const auto& [field, step] : {std::pair{"error.rmse", 0.002}, {"artefact.leak", 0.01}, {"time_ms", 2.0}}) {
    if (!is_limited || random() % 2 == 0) continue;
    limits[field] = step * static_cast<double>(1 + random() % 50);
    request.demands.push_back({&analysis::limit_of(field), limits[field]});
  }
  const analysis::Advice advice = analysis::advise(cells, request);
  const auto index_of = [&](const analysis::Candidate& candidate) {
    for (const nlohmann::json& cell : data["cells"])
      if (cell["key"] == candidate.configuration.cells.front()->key) return cell["configuration"];
    return nlohmann::json();
  };
  nlohmann::json keeping = nlohmann::json::array(), picks = nlohmann::json::array();
  for (const analysis::Candidate& each : advice.keeping) keeping.push_back(index_of(each));
  if (!advice.keeping.empty())
    for (const analysis::Pick& pick : analysis::list_picks(advice))
      picks.push_back({{"names", pick.names}, {"index", index_of(advice.keeping[pick.index])}});
  return {{"limits", limits},
          {"keeping", keeping},
          {"failing", advice.failing.size()},
          {"beaten", advice.beaten.size()},
          {"picks", picks}};
}

TEST(PicksScript, AgreesWithTheProgram_InMadeUpRuns) {
  if (std::system("node --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "node is not installed";
  const TestFolder folder;
  std::mt19937 random(57);
  std::ofstream file(folder.path() / "runs.json");
  for (int i = 0; i < kRuns; ++i) {
    std::vector<records::CellRecord> cells = analysis::make_up_run(random);
    if (cells.empty()) continue;
    for (std::size_t k = 0; k < cells.size(); ++k) finish(cells[k], k, kNoises[i % std::ssize(kNoises)], random);
    nlohmann::json data = make_run_data(records::make_run(), cells, {});
    nlohmann::json questions = nlohmann::json::array();
    for (int k = 0; k < kQuestions; ++k) questions.push_back(ask(data, cells, random, k > 0));
    file << nlohmann::json{{"data", std::move(data)}, {"questions", std::move(questions)}}.dump() << "\n";
  }
  file.close();
  const std::string command =
      fmt::format("node {0}/tests/report/pages/picks_script.mjs {0}/report/document/picks.js {1}",
                  SHADOWBENCH_SOURCE_DIR, (folder.path() / "runs.json").string());
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace shadowbench::pages
