#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/advice.h"
#include "report/analysis/measures.h"
#include "report/records/bias_record.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// Lists the costs of a frame that a reader may ask for, the light moving and static; the page begins with the first,
/// which `advise` takes without an option.
std::vector<analysis::Quantity> list_cost_choices(const records::RunRecord& run,
                                                  const std::vector<records::CellRecord>& cells);

/// An error for the scripts: its value, how far it may be off, and its groups of phases; null where there is none.
nlohmann::json describe_error(const std::optional<analysis::Estimate>& error);

/// The part of a cell's picture that is looked at first, about the tile where it differs most from the truth: left,
/// top, width, height, pixels. All of it where nobody knows where.
std::array<double, 4> choose_part(const records::CellRecord& cell);

/// What cells cost on the mean; null where one has no value.
nlohmann::json describe_cost(const std::vector<const records::CellRecord*>& cells, const analysis::Quantity& choice);

/// What was compared, in a line: "5 scenes · map 1024² · 960 × 540 · 8 filters."
std::string describe_setting(const std::vector<records::CellRecord>& cells);

/// What a sweep of the bias recommends for a configuration, for each of its scenes that was swept; empty where none
/// was.
std::string describe_biases(const analysis::Configuration& configuration, const std::vector<records::BiasCell>& biases);

/// What the script of the answer judges by, for all scenes and for each by itself: per configuration its costs, its
/// worst values, its RMSE over the places, and whether it is better than `none`; and what advise() says without limits
/// for every cost and class of width. Scripts compare worst values with the limits that the reader moves, and judge
/// nothing else. `cells`: all of the run, of which `configurations` are.
nlohmann::json make_answer_data(const std::vector<records::CellRecord>& cells,
                                const std::vector<analysis::Configuration>& configurations,
                                const std::vector<std::string>& classes,
                                const std::vector<analysis::Quantity>& choices);

/// The scenes that the answer has by themselves: all, or none where there is one, or where the run is too large.
std::vector<std::string> list_answered_scenes(const std::vector<records::CellRecord>& cells);

/// What the scripts of a run's page read: measures with their definitions, places, configurations with their costs and
/// their worst values, per cell its values and its pictures, and what advise() says without limits for every light and
/// class of width: scripts compare worst values with the limits that the reader moves, and judge nothing else. `biases`
/// are what a sweep of the bias recommends. A value that does not exist is null.
nlohmann::json make_run_data(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                             const std::vector<records::BiasCell>& biases = {});

}  // namespace shadowbench::pages
