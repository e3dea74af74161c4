#pragma once

#include <string>
#include <vector>

#include "report/regress/regress.h"

namespace shadowbench::regress {

/// How many cells that differ are described one by one; the others are counted, or listed in a table.
inline constexpr std::size_t kMostListed = 20;

/// Names a cell: "cubes vsm (view main, map 512, 256 x 144)".
std::string name_cell(const Comparison& comparison);

/// What differs in a cell, and what was not compared.
std::vector<std::string> describe_differences(const Comparison& comparison);

/// How to accept what differs, or what was accepted; empty where neither is to be said.
std::string describe_ending(const RegressReport& report);

/// The command that accepts what differs, as it would be typed.
std::string make_accept_command(const RegressOptions& options);

/// Says in a line how many cells are as they were, and how many are not: "49 compared: 48 same, 1 less accurate".
std::string describe_counts(const RegressReport& report);

/// Names the worst cell and what is wrong with it, in a line. Requires one that failed.
std::string describe_worst(const RegressReport& report);

/// Names damaged files and what is wrong with them, in a line.
std::string describe_damage(const Damage& damage);

/// Says for people what differs, the worst first, and how to accept it.
std::string make_regress_text(const RegressReport& report);

/// Makes regress.json: the same for programs.
std::string make_regress_json(const RegressReport& report);

}  // namespace shadowbench::regress
