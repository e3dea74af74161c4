#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "report/document/blocks.h"
#include "report/records/json_io.h"
#include "report/regress/comparison.h"

namespace shadowbench::regress {

/// Which cells are compared; an empty list: all.
struct Selection {
  std::vector<std::string> filters;
  std::vector<std::string> scenes;

  bool holds(const std::string& scene, const std::string& filter) const;
};

/// Everything that `shadowbench regress` is told.
struct RegressOptions {
  std::filesystem::path run;  ///< a run's report folder
  std::filesystem::path baseline;
  std::filesystem::path out;  ///< gets regress.html, .md, .json and the pictures
  bool force = false;         ///< write there even where it holds what this program did not write
  Selection selection;
  bool accept = false;          ///< what differs becomes the baseline
  bool remove_missing = false;  ///< with `accept`: cells that the run lacks leave the baseline
  bool brief = false;           ///< the text is for a log: a line for each of the worst cells, and no more than ten
  std::optional<std::filesystem::path> junit;
  std::vector<std::string> command;  ///< the command line, to be given again with --accept
};

/// What a comparison found, the worst first.
struct RegressReport {
  std::vector<Comparison> comparisons;
  bool is_new = false;                ///< there was no cell in the baseline, and the run's become it
  std::vector<std::string> accepted;  ///< what became of the baseline, one line each
  std::string accept_command;         ///< what would accept the differences
  RegressOptions options;

  int count(Outcome outcome) const;
  int failed() const;
  /// Whether a cell is one to speak of: it differs, and is none of those that a new baseline is made of.
  bool is_told(const Comparison& comparison) const { return is_new ? comparison.failed() : comparison.differs(); }
};

/// What the command line shows of it.
struct RegressOutcome {
  std::string text;
  std::string json;
  std::string failure;                 ///< one line; empty where nothing is left that differs
  ErrorKind kind = ErrorKind::kLimit;  ///< of the failure: kFilter where the run's filters have mistakes
};

/// Compares a run with its baseline, or reports the mistakes in filters' files that ended the run, and writes
/// regress.html, .md, .json, a picture of each cell that moved, and what else was asked for. Throws Error(kInput) where
/// run or tolerances cannot be read, where nothing is to be accepted and there is no baseline, or for a name that is
/// chosen and nowhere found; Error(kOutput), also where another process accepts
/// into the same baseline. Cost: memory of one image file of the run, of one of the baseline, and of all that is
/// accepted.
RegressOutcome run_regress(const RegressOptions& options);

/// How many cells that differ are described one by one; the others are counted, or listed in a table.
inline constexpr std::size_t kMostListed = 20, kMostListedBriefly = 5;

/// The command that accepts what differs, as it would be typed.
std::string make_accept_command(const RegressOptions& options);

/// Says for people what differs, the worst first, and how to accept it.
std::string make_regress_text(const RegressReport& report);

/// Makes regress.json: the same for programs.
std::string make_regress_json(const RegressReport& report);

/// Sums a comparison up. A difference that was accepted is no failure; one that could not be accepted is.
std::string describe_failure(const RegressReport& report);

/// Makes the page of `shadowbench regress`: what differs, the worst first, with its pictures, and how to accept it.
document::Page make_regress_page(const RegressReport& report);

/// Writes a comparison as JUnit XML, which build servers show: a suite per scene, a case per cell.
/// Source: the subset of the format that the readers of Jenkins and GitLab share.
std::string make_junit(const RegressReport& report);

}  // namespace shadowbench::regress
