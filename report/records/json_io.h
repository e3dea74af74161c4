#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "filters/filter_spec.h"
#include "report/records/records.h"

namespace shadowbench::records {

/// Writes a cell as JSON. A value that is missing or not finite is null, and `absent` in the JSON says why.
nlohmann::json to_json(const CellRecord& cell);

/// Writes a run's head as JSON, without its cells.
nlohmann::json to_json(const RunRecord& run);

/// Reads a cell; `where` names its file in messages. Throws Error(kInput) where a field is missing or holds another
/// type, the key is none, or a picture's path leaves the report's folder.
CellRecord cell_from_json(const nlohmann::json& json, const std::string& where);

/// Reads a run's head; `where` names its file in messages.
/// Throws Error(kInput) where a field is missing or holds another type, or the shard is none of the shards.
RunRecord run_from_json(const nlohmann::json& json, const std::string& where);

/// Returns where a cell's file lies in a report folder: cells/<key>.json. Requires a key.
std::filesystem::path cell_path(const std::filesystem::path& dir, const std::string& key);

/// Writes one finished cell into a report folder, whole or not at all. Requires cell.key.
/// Throws Error(kOutput).
void write_cell(const std::filesystem::path& dir, const CellRecord& cell);

/// Reads one cell of a report folder.
/// Throws Error(kInput) where the file is missing, cut off or of another schema version.
CellRecord read_cell(const std::filesystem::path& dir, const std::string& key);

/// Lists the files of the report folder that a cell names.
std::vector<std::string> list_files(const CellRecord& cell);

/// Reads several, in this order. Throws likewise.
std::vector<CellRecord> read_cells(const std::filesystem::path& dir, const std::vector<std::string>& keys);

/// Writes results.json, with the cells in this order, and results.schema.json beside it.
/// Throws Error(kOutput). Cost: memory of the JSON of one cell at a time.
void write_results(const std::filesystem::path& dir, const RunRecord& run, const std::vector<CellRecord>& cells);

/// A whole results.json.
struct Results {
  RunRecord run;
  std::vector<CellRecord> cells;
};

/// Reads a results.json.
/// Throws Error(kInput) where the file is missing, cut off or of another schema version.
Results read_results(const std::filesystem::path& file);

/// The JSON Schema (draft 2020-12) of results.json, with every metric of the table; cell files follow its
/// `$defs/cell_file`.
std::string results_schema();

/// Lists the metrics of the table for people: path, unit, range, direction and definition of each.
std::string make_metric_text();

/// Lists them as a JSON array.
std::string make_metric_json();

/// Leaves in a run's folder, as filter_mistakes.json, why the run measured nothing; none: takes that away again.
/// Throws Error(kOutput).
void write_filter_mistakes(const std::filesystem::path& folder, const std::vector<filters::FilterMistake>& mistakes);

/// Reads what was left there; none where nothing was. Throws Error(kInput) for a file that is none of ours.
std::vector<filters::FilterMistake> read_filter_mistakes(const std::filesystem::path& folder);

}  // namespace shadowbench::records
