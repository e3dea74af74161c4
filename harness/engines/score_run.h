#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/engines/alignment.h"
#include "harness/engines/external_images.h"
#include "harness/measure/scene_assets.h"
#include "harness/options/experiment_file.h"
#include "harness/options/options.h"
#include "harness/run/run_plan.h"
#include "report/analysis/cells.h"
#include "report/records/json_io.h"

namespace shadowbench::engines {

/// One picture of another renderer, to become a row.
struct ScoreRequest {
  std::string name;   ///< of the row
  std::string scene;  ///< of the run; empty: its only one
  std::string view;   ///< of the scene; empty: its only one
  int map_size = 0;   ///< of the run's maps the one that it is filed under, texels; 0: the first
  ExternalFiles files;
  std::optional<std::filesystem::path> meta;  ///< a meta.json
  bool unaligned = false;                     ///< score what does not show our view all the same, and say so
};

/// Scores pictures of other renderers against the truth of a run, and makes them rows of its report.
class RunScorer {
 public:
  /// `options`: those of the run, whose folder is `options.out`. Throws Error(kInput) where that holds no run, and as
  /// run::make_plan().
  RunScorer(const options::RunOptions& options, options::Progress& progress);

  /// Scores one, and writes its cell and pictures. Returns its record, and what was found out about it.
  /// Throws Error(kUsage) for a name that a filter of the run has, or a scene or view that the run does not have;
  /// Error(kInput) for pictures that cannot be compared, or are found not to show our view.
  std::pair<records::CellRecord, std::vector<Finding>> score(const ScoreRequest& request);

  /// Throws Error(kUsage) for what score() does not take as a name.
  void check_name(const std::string& name) const;

  const std::filesystem::path& folder() const { return options_.out; }

  /// The scenes of the run with their views; and one of them to be drawn by others: <scene>.glb and scene.json.
  std::vector<analysis::Place> list_places() const;
  void export_place(const analysis::Place& place, const std::filesystem::path& folder);

  /// Writes the report, with the new rows.
  void finish();

 private:
  options::RunOptions options_;
  options::Progress& progress_;
  records::Results results_;
  measure::Renderer renderer_;
  truth::TruthCache cache_;
  run::RunPlan plan_;
  std::map<std::size_t, measure::SceneAssets> assets_;  ///< by planned scene
  std::vector<records::CellRecord> rows_;               ///< the new rows

  const run::PlannedTask& find_task(const std::string& scene, const std::string& view, const options::PictureSize& size,
                                    int map_size) const;
  void require_same_truth(const run::PlannedTask& task, const images::Image& area) const;
  measure::SceneAssets& assets_of(const run::PlannedTask& task);
  OwnView describe_own_view(const run::PlannedTask& task);
  images::Image shade(const run::PlannedTask& task, const images::Image& visibility);
  std::vector<const records::CellRecord*> list_peers(const records::CellRecord& cell) const;
  images::Image read_visibility(const records::CellRecord& cell) const;
  void attribute(measure::MeasuredCell& cell, const images::Image& map, const Meta& meta, const run::PlannedTask& task,
                 const measure::SceneTruth& truth) const;
  void compare_with_peers(records::CellRecord& cell, const images::Image& visibility,
                          const std::vector<std::uint8_t>& counts, const images::Image& truth) const;
  void keep(const records::CellRecord& cell);
  void insert(const records::CellRecord& cell);
};

/// Has renderers draw scenes of a run, and scores what they write. Each is a command of the shell that is given two
/// more words, a scene.json and the EXR file to write, and may leave a meta.json and a shadow_map.exr beside that.
///
/// `scene` and `view`: as in ScoreRequest, but that empty ones are all. A row that fails costs no other. Gives the
/// rows' records with what was found out. Throws Error(kInput) for the first failure, once the others are in the
/// report: a command that ends with another exit code than 0, is not done after `timeout_s`, or writes nothing.
std::vector<std::pair<records::CellRecord, std::vector<Finding>>> run_engines(
    RunScorer& scorer, const std::vector<options::Engine>& engines, const ScoreRequest& request, double timeout_s,
    options::Progress& progress);

}  // namespace shadowbench::engines
