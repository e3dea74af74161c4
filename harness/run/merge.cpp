#include "harness/run/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "base/folder_lock.h"
#include "harness/live/frame_file.h"
#include "report/analysis/findings.h"
#include "report/pages/write_page.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

struct ShardRun {
  std::filesystem::path folder;
  records::Results results;
};

std::vector<ShardRun> read_shards(const std::vector<std::filesystem::path>& folders) {
  std::vector<ShardRun> shards;
  for (const std::filesystem::path& folder : folders)
    shards.push_back({folder, records::read_results(folder / "results.json")});
  std::sort(shards.begin(), shards.end(), [](const ShardRun& a, const ShardRun& b) {
    return a.results.run.experiment.shard < b.results.run.experiment.shard;
  });
  return shards;
}

/// How many cells a shard of an experiment holds: every `shards`-th from its own on.
std::size_t count_cells(const records::ExperimentRecord& experiment) {
  const int first = experiment.shard - 1;
  return first < experiment.cells ? static_cast<std::size_t>((experiment.cells - first - 1) / experiment.shards + 1)
                                  : 0;
}

void require_same(const ShardRun& first, const ShardRun& other) {
  const records::ExperimentRecord &a = first.results.run.experiment, &b = other.results.run.experiment;
  if (a.settings == b.settings && a.shards == b.shards) return;
  throw Error(
      ErrorKind::kInput,
      fmt::format("this is no shard of the experiment in {}: scenes, filters, settings or program differ, or it "
                  "is one of {} shards and not of {}",
                  first.folder.string(), b.shards, a.shards),
      other.folder.string());
}

void require_complete(const std::vector<ShardRun>& shards) {
  const int count = shards.front().results.run.experiment.shards;
  for (std::size_t i = 0; i < shards.size(); ++i) {
    const records::ExperimentRecord& own = shards[i].results.run.experiment;
    if (i > 0 && own.shard == shards[i - 1].results.run.experiment.shard) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("{} and {} are both shard {}/{}: name one of them", shards[i - 1].folder.string(),
                              shards[i].folder.string(), own.shard, count));
    }
    if (own.shard != static_cast<int>(i) + 1) break;
    if (shards[i].results.cells.size() == count_cells(own)) continue;
    throw Error(ErrorKind::kInput,
                fmt::format("it holds {} cells, and shard {}/{} of {} cells has {}; run it again",
                            shards[i].results.cells.size(), own.shard, count, own.cells, count_cells(own)),
                shards[i].folder.string());
  }
  for (int shard = 1; shard <= count; ++shard) {
    const auto is_it = [&](const ShardRun& each) { return each.results.run.experiment.shard == shard; };
    if (std::any_of(shards.begin(), shards.end(), is_it)) continue;
    throw Error(ErrorKind::kUsage,
                fmt::format("shard {}/{} is missing: run it with --shard {}/{}, and name its folder too", shard, count,
                            shard, count));
  }
}

/// Whether the folder holds a report, or a cell of something else than what is merged.
bool is_taken(const std::filesystem::path& out, const std::set<std::string>& keys) {
  std::error_code error;
  if (std::filesystem::exists(out / "results.json", error)) return true;
  std::filesystem::directory_iterator entry(out / "cells", error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
    if (!keys.contains(entry->path().stem().string())) return true;
  return false;
}

/// Refuses a folder with other results in it; what an unfinished merge of the same shards left there may stay.
void require_free(const std::filesystem::path& out, const std::vector<ShardRun>& shards) {
  std::set<std::string> keys;
  for (const ShardRun& shard : shards)
    for (const records::CellRecord& cell : shard.results.cells) keys.insert(cell.key);
  if (!is_taken(out, keys)) return;
  throw Error(ErrorKind::kUsage, "--out: there is a report in this folder already; choose an empty or new one",
              out.string());
}

}  // namespace

records::RunRecord join_runs(const std::vector<records::RunRecord>& runs) {
  records::RunRecord whole = runs.front();
  whole.experiment.shard = whole.experiment.shards = 1;
  for (const records::RunRecord& run : std::span(runs).subspan(1)) {
    whole.work.shader_variants_compiled += run.work.shader_variants_compiled;
    whole.work.passes_run += run.work.passes_run;
    whole.work.passes_skipped += run.work.passes_skipped;
    whole.work.truths_traced += run.work.truths_traced;
    whole.work.truths_cached += run.work.truths_cached;
    whole.work.timed_s += run.work.timed_s;
    whole.work.elapsed_s += run.work.elapsed_s;
    if (run.work.attribution_s)
      whole.work.attribution_s = whole.work.attribution_s.value_or(0.0) + *run.work.attribution_s;
    for (const records::SceneRecord& scene : run.scenes)
      if (std::ranges::count(whole.scenes, scene.name, &records::SceneRecord::name) == 0) whole.scenes.push_back(scene);
    for (const std::string& warning : run.warnings)
      if (std::ranges::count(whole.warnings, warning) == 0) whole.warnings.push_back(warning);
  }
  // Files were named from where each run was started; a built-in scene is named as it is called.
  for (records::SceneRecord& scene : whole.scenes)
    if (!scene.view_words.empty() && !scene.name.starts_with(scene.view_words.front())) scene.view_words.clear();
  for (auto& [id, file] : whole.filter_files) file.reset();
  return whole;
}

void merge_runs(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& out, bool force) {
  if (folders.empty()) throw Error(ErrorKind::kUsage, "merge: name the report folders of all shards");
  const std::vector<ShardRun> shards = read_shards(folders);
  for (const ShardRun& shard : shards) require_same(shards.front(), shard);
  require_complete(shards);
  for (const ShardRun& shard : shards) require_no_links(shard.folder, ErrorKind::kInput);
  const FolderLock lock(out, force);
  require_free(out, shards);
  std::vector<std::string> keys;
  std::set<std::string> copied;  // cells of one view share its truth's pictures
  for (int i = 0; i < shards.front().results.run.experiment.cells; ++i) {
    const ShardRun& shard = shards[static_cast<std::size_t>(i) % shards.size()];
    const records::CellRecord& cell = shard.results.cells[static_cast<std::size_t>(i) / shards.size()];
    for (const std::string& file : records::list_files(cell))
      if (copied.insert(file).second) copy_whole_file(shard.folder / file, out / file);
    copy_whole_file(records::cell_path(shard.folder, cell.key), records::cell_path(out, cell.key));
    keys.push_back(cell.key);
  }
  for (const ShardRun& shard : shards) live::copy_frames(shard.folder, out);
  std::vector<records::RunRecord> runs;
  for (const ShardRun& shard : shards) {
    runs.push_back(shard.results.run);
    std::erase(runs.back().warnings, analysis::warn_of_mixed_machines(shard.results.cells));  // the whole has its own
  }
  pages::write_report(out, join_runs(runs), keys);
}

void rewrite_report(const std::filesystem::path& report) {
  const records::Results results = records::read_results(report / "results.json");
  const FolderLock lock(report);
  std::vector<std::string> keys;
  for (const records::CellRecord& cell : results.cells) keys.push_back(cell.key);
  pages::write_report(report, results.run, keys);
}

}  // namespace shadowbench::run
