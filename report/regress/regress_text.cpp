#include "report/regress/regress_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

namespace shadowbench::regress {
namespace {

using nlohmann::ordered_json;

constexpr std::array kOutcomes = {Outcome::kUnreadable,   Outcome::kMissing, Outcome::kExtra,
                                  Outcome::kLessAccurate, Outcome::kChanged, Outcome::kSlower};
constexpr std::size_t kMostFindings = 8;

std::string quote_word(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) || std::string("_-./:=,+@%").find(static_cast<char>(c)) != std::string::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) {
    if (c == '\'') quoted += "'\\'";
    quoted += c;
  }
  quoted += '\'';
  return quoted;
}

ordered_json optional_json(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json to_json(const PixelChange& change) {
  return {{"compared", change.compared},
          {"changed", change.changed},
          {"share", change.share()},
          {"max", change.max},
          {"max_at", {change.max_x, change.max_y}},
          {"mean", change.mean},
          {"rms", change.rms},
          {"excused_flips", change.excused_flips},
          {"excused_rounding", change.excused_rounding},
          {"excused_changed", change.excused_changed}};
}

ordered_json to_json(const Comparison& comparison) {
  ordered_json document = {{"outcome", name_of(comparison.outcome)},
                           {"key", comparison.key},
                           {"scene", comparison.scene},
                           {"view", comparison.view},
                           {"filter", comparison.filter},
                           {"label", comparison.label},
                           {"settings", comparison.settings}};
  document["accepted"] = comparison.accepted;
  document["findings"] = ordered_json::array();
  for (const Finding& finding : comparison.findings) {
    document["findings"].push_back({{"metric", finding.metric},
                                    {"expected", optional_json(finding.expected)},
                                    {"actual", optional_json(finding.actual)},
                                    {"limit", optional_json(finding.limit)},
                                    {"text", finding.text}});
  }
  document["notes"] = comparison.notes;
  document["pixels"] = comparison.pixels ? to_json(*comparison.pixels) : ordered_json(nullptr);
  document["picture"] = comparison.picture ? ordered_json(*comparison.picture) : ordered_json(nullptr);
  return document;
}

}  // namespace

std::string name_cell(const Comparison& comparison) {
  return fmt::format("{} {} ({})", comparison.scene, comparison.label, comparison.settings);
}

std::vector<std::string> describe_differences(const Comparison& comparison) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < std::min(comparison.findings.size(), kMostFindings); ++i)
    sentences.push_back(comparison.findings[i].text);
  if (comparison.findings.size() > kMostFindings)
    sentences.push_back(fmt::format("and {} more numbers", comparison.findings.size() - kMostFindings));
  for (const std::string& note : comparison.notes) sentences.push_back("note: " + note);
  return sentences;
}

std::string describe_ending(const RegressReport& report) {
  if (!report.options.accept) return report.failed() > 0 ? "if this is meant: " + report.accept_command : "";
  if (report.accepted.empty()) return "nothing to accept";
  return fmt::format("accepted: {} changes of the baseline, logged in {}", report.accepted.size(),
                     (report.options.baseline / "accepted.md").string());
}

std::string make_accept_command(const RegressOptions& options) {
  std::string text;
  for (const std::string& word : options.command) text += quote_word(word) + ' ';
  return text + (options.accept ? "" : "--accept");
}

std::string describe_counts(const RegressReport& report) {
  std::string text = fmt::format("{} compared: {} same", report.comparisons.size(), report.count(Outcome::kSame));
  for (const Outcome outcome : kOutcomes)
    if (const int count = report.count(outcome)) text += fmt::format(", {} {}", count, name_of(outcome));
  return text;
}

std::string describe_worst(const RegressReport& report) {
  const Comparison& worst = *std::find_if(report.comparisons.begin(), report.comparisons.end(),
                                          [](const Comparison& each) { return each.failed(); });
  return fmt::format("{} is {}: {}", name_cell(worst), name_of(worst.outcome), worst.findings.front().text);
}

std::string describe_damage(const Damage& damage) {
  std::vector<std::string> named;
  for (const auto& [path, what] : damage)
    if (named.size() < kMostFindings) named.push_back(path + " " + what);
  if (damage.size() > named.size()) named.push_back(fmt::format("{} more files", damage.size() - named.size()));
  return fmt::format("{}", fmt::join(named, ", "));
}

std::string make_regress_text(const RegressReport& report) {
  std::string text;
  for (const auto& [path, what] : report.damaged) text += fmt::format("damaged: {} {}\n", path, what);
  std::size_t listed = 0;
  for (const Comparison& comparison : report.comparisons) {
    if (!comparison.differs()) continue;
    if (++listed > kMostListed) continue;
    text += fmt::format("{}: {}\n", name_of(comparison.outcome), name_cell(comparison));
    for (const std::string& sentence : describe_differences(comparison)) text += fmt::format("  {}\n", sentence);
    if (comparison.picture) text += fmt::format("  picture: {}\n", (report.options.out / *comparison.picture).string());
  }
  if (listed > kMostListed)
    text += fmt::format("and {} more cells: see {}\n", listed - kMostListed,
                        (report.options.out / "regress.json").string());
  text += describe_counts(report) + "\n";
  if (const std::string ending = describe_ending(report); !ending.empty()) text += ending + "\n";
  return text;
}

std::string make_regress_json(const RegressReport& report) {
  ordered_json document = {{"run", report.options.run.string()},    {"baseline", report.options.baseline.string()},
                           {"compared", report.comparisons.size()}, {"failed", report.failed()},
                           {"summary", describe_counts(report)},    {"accept_command", report.accept_command}};
  document["accepted"] = report.accepted;
  document["damaged"] = report.damaged;
  document["cells"] = ordered_json::array();
  for (const Comparison& comparison : report.comparisons) document["cells"].push_back(to_json(comparison));
  return document.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace shadowbench::regress
