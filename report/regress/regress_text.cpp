#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

#include "base/text.h"
#include "report/pages/write_page.h"
#include "report/regress/regress.h"

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
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
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

/// Names a cell: "cubes vsm (view main, map 512, 256 x 144)".
std::string name_cell(const Comparison& comparison) {
  return fmt::format("{} {} ({})", comparison.scene, comparison.label, comparison.settings);
}

/// What differs in a cell, and what was not compared.
std::vector<std::string> describe_differences(const Comparison& comparison) {
  if (comparison.outcome == Outcome::kBroken) return split_list(comparison.findings.front().text, "\n");
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < std::min(comparison.findings.size(), kMostFindings); ++i)
    sentences.push_back(comparison.findings[i].text);
  if (comparison.findings.size() > kMostFindings)
    sentences.push_back(fmt::format("and {} more numbers", comparison.findings.size() - kMostFindings));
  for (const std::string& note : comparison.notes) sentences.push_back("note: " + note);
  return sentences;
}

/// How to accept what differs, or what was accepted; empty where neither is to be said.
std::string describe_ending(const RegressReport& report) {
  if (report.is_new || report.count(Outcome::kBroken) > 0) return "";
  if (!report.options.accept) return report.failed() > 0 ? "if this is meant: " + report.accept_command : "";
  if (report.accepted.empty()) return "nothing to accept";
  return fmt::format("accepted: {} changes of {}", report.accepted.size(), report.options.baseline.string());
}

/// "new baseline of 12 cells and the truth of 2 views: expected"
std::string describe_new_baseline(const RegressReport& report) {
  const auto is_truth = [](const Comparison& each) { return each.accepted && each.filter == kTruthName; };
  const auto accepted = std::ranges::count(report.comparisons, true, &Comparison::accepted);
  const auto truths = std::ranges::count_if(report.comparisons, is_truth);
  const auto count = [](std::ptrdiff_t number, const char* what) {
    return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
  };
  return fmt::format("new baseline of {}{}: {}", count(accepted - truths, "cell"),
                     truths > 0 ? " and the truth of " + count(truths, "view") : "", report.options.baseline.string());
}

/// Says in a line how many cells are as they were, and how many are not: "49 compared: 48 same, 1 less accurate".
std::string describe_counts(const RegressReport& report) {
  if (report.is_new) return describe_new_baseline(report);
  if (const int broken = report.count(Outcome::kBroken))
    return fmt::format("nothing was measured, because {}",
                       broken == 1 ? "a filter has a mistake" : fmt::format("{} filters have mistakes", broken));
  std::string text = fmt::format("{} compared: {} same", report.comparisons.size(), report.count(Outcome::kSame));
  for (const Outcome outcome : kOutcomes)
    if (const int count = report.count(outcome)) text += fmt::format(", {} {}", count, name_of(outcome));
  return text;
}

/// Names the worst cell and what is wrong with it, in a line. Requires one that failed.
std::string describe_worst(const RegressReport& report) {
  const Comparison& worst = *std::ranges::find_if(report.comparisons, &Comparison::failed);
  return fmt::format("{} is {}: {}", name_cell(worst), name_of(worst.outcome), worst.findings.front().text);
}

/// A cell that differs, for the text: in a line where that is brief, else with all that was found.
std::string describe_told(const Comparison& comparison, const RegressOptions& options) {
  if (comparison.outcome == Outcome::kBroken) return comparison.findings.front().text + "\n";
  const std::string head = fmt::format("{}: {}", name_of(comparison.outcome), name_cell(comparison));
  if (options.brief) return fmt::format("{}: {}\n", head, comparison.findings.front().text);
  std::string text = head + "\n";
  for (const std::string& sentence : describe_differences(comparison)) text += fmt::format("  {}\n", sentence);
  if (comparison.picture) text += fmt::format("  picture: {}\n", (options.out / *comparison.picture).string());
  return text;
}

document::Section make_cell_section(const Comparison& comparison, std::size_t place) {
  document::Section section{
      fmt::format("cell-{}", place),
      fmt::format("{}: {}", name_of(comparison.outcome), name_cell(comparison)),
      {document::Sentences{comparison.accepted ? "Accepted." : "", describe_differences(comparison)}}};
  if (comparison.picture)
    section.blocks.emplace_back(document::Gallery{
        {}, {{*comparison.picture, "Expected, actual, and their difference: " + name_cell(comparison)}}});
  return section;
}

/// By how many times its limit the worst error or difference of pixels of a cell moved; nothing where none did.
std::string describe_excess(const Comparison& comparison) {
  double most = 0.0;
  for (const Finding& finding : comparison.findings)
    if ((finding.expected && finding.metric.starts_with("error.")) || finding.metric.starts_with("visibility."))
      if (finding.actual && finding.limit > 0.0)
        most = std::max(most, std::abs(*finding.actual - finding.expected.value_or(0.0)) / *finding.limit);
  return most > 0.0 ? fmt::format(", {:.3g} x its limit", most) : "";
}

document::Section make_answer(const RegressReport& report) {
  std::string text = describe_counts(report) + ".";
  if (report.failed() > 0 && report.count(Outcome::kBroken) == 0) text += " Worst: " + describe_worst(report) + ".";
  document::Table table{"The worst cell of each scene and filter", {{"scene"}, {}}};
  for (const Comparison& each : report.comparisons)  // the worst first
    table.judge(each.scene, each.filter, name_of(each.outcome) + (each.accepted ? ", accepted" : describe_excess(each)),
                each.failed()    ? document::Grade::kBad
                : each.differs() ? document::Grade::kNear
                                 : document::Grade::kGood);
  return {"answer", "", {document::Paragraph{std::move(text)}, std::move(table)}};
}

/// Replaces what XML cannot hold and file names can: control characters, and bytes that are not UTF-8.
std::string clean(const std::string& text) {
  using nlohmann::json;
  const auto valid = json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
  std::string cleaned;
  for (const char c : valid) cleaned += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? '?' : c;
  return cleaned;
}

/// Seconds, as JUnit has them; nothing where they are not known.
void add_time(pugi::xml_node node, const std::optional<double>& seconds) {
  if (seconds) node.append_attribute("time") = fmt::format("{:.3f}", *seconds).c_str();
}

void add_case(pugi::xml_node suite, const Comparison& comparison) {
  pugi::xml_node entry = suite.append_child("testcase");
  const std::string view = comparison.view.empty() ? "" : "." + comparison.view;
  entry.append_attribute("classname") = clean(comparison.scene + view).c_str();
  entry.append_attribute("name") = clean(comparison.label + " (" + comparison.settings + ")").c_str();
  add_time(entry, comparison.measured_s);
  if (!comparison.failed()) return;
  pugi::xml_node failure = entry.append_child("failure");
  failure.append_attribute("type") = name_of(comparison.outcome).c_str();
  failure.append_attribute("message") = clean(comparison.findings.front().text).c_str();
  std::string text;
  for (const Finding& finding : comparison.findings) text += finding.text + "\n";
  if (comparison.picture) text += "picture: " + *comparison.picture + "\n";
  failure.append_child(pugi::node_pcdata).set_value(clean(text).c_str());
}

}  // namespace

std::string make_accept_command(const RegressOptions& options) {
  std::string text;
  for (const std::string& word : options.command) text += quote_word(word) + ' ';
  return text + (options.accept ? "" : "--accept");
}

std::string make_regress_text(const RegressReport& report) {
  std::string text;
  const std::size_t most = report.count(Outcome::kBroken) > 0 ? report.comparisons.size()
                           : report.options.brief             ? kMostListedBriefly
                                                              : kMostListed;
  std::size_t listed = 0;
  for (const Comparison& comparison : report.comparisons)
    if (report.is_told(comparison) && ++listed <= most) text += describe_told(comparison, report.options);
  if (listed > most)
    text += fmt::format("and {} more cells: see {}\n", listed - most, (report.options.out / "regress.json").string());
  text += describe_counts(report) + "\n";
  if (const std::string ending = describe_ending(report); !ending.empty()) text += ending + "\n";
  if (report.options.brief && !report.is_new)
    text += fmt::format("report: {}\n", (report.options.out / "regress.html").string());
  return text;
}

std::string make_regress_json(const RegressReport& report) {
  ordered_json document = {{"run", report.options.run.string()},    {"baseline", report.options.baseline.string()},
                           {"compared", report.comparisons.size()}, {"failed", report.failed()},
                           {"summary", describe_counts(report)},    {"accept_command", report.accept_command}};
  document["accepted"] = report.accepted;
  document["cells"] = ordered_json::array();
  for (const Comparison& comparison : report.comparisons) document["cells"].push_back(to_json(comparison));
  return document.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string describe_failure(const RegressReport& report) {
  if (report.failed() == 0) return "";
  if (report.count(Outcome::kBroken) > 0) {
    std::vector<std::string> files;
    for (const Comparison& each : report.comparisons) files.push_back(each.settings);
    return fmt::format("there is nothing to compare; mend {}, and run again", fmt::join(files, ", "));
  }
  if (report.options.accept)
    return fmt::format("{} could not be accepted; {}", report.failed(), describe_worst(report));
  return "the baseline is not met; the worst: " + describe_worst(report);
}

document::Page make_regress_page(const RegressReport& report) {
  document::Page page{"Comparison with the baseline", {make_answer(report)}, {}};
  if (const std::string ending = describe_ending(report); !ending.empty())
    page.sections.push_back({"accept", "", {document::Paragraph{ending}}, report.failed() > 0});
  std::size_t place = 0;
  for (const Comparison& comparison : report.comparisons)
    if (report.is_told(comparison) && ++place <= kMostListed)
      page.sections.push_back(make_cell_section(comparison, place));
  if (place > kMostListed)
    page.sections.push_back(
        {"rest",
         "",
         {document::Paragraph{fmt::format("{} more cells differ: see regress.json.", place - kMostListed)}}});
  page.sections.push_back({"data",
                           "",
                           {document::Details{"Settings and data",
                                              {document::Facts{{{"run", report.options.run.string()},
                                                                {"baseline", report.options.baseline.string()}}},
                                               pages::link_data({"regress.json"})}}}});
  return page;
}

std::string make_junit(const RegressReport& report) {
  std::map<std::string, std::vector<const Comparison*>> scenes;
  for (const Comparison& comparison : report.comparisons) scenes[comparison.scene].push_back(&comparison);
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("testsuites");
  root.append_attribute("name") = "shadowbench regress";
  root.append_attribute("tests") = static_cast<unsigned>(report.comparisons.size());
  root.append_attribute("failures") = report.failed();
  for (const auto& [scene, comparisons] : scenes) {
    pugi::xml_node suite = root.append_child("testsuite");
    suite.append_attribute("name") = clean(scene).c_str();
    suite.append_attribute("tests") = static_cast<unsigned>(comparisons.size());
    unsigned failures = 0;
    std::optional<double> seconds;
    for (const Comparison* comparison : comparisons) {
      failures += comparison->failed() ? 1 : 0;
      if (comparison->measured_s) seconds = seconds.value_or(0.0) + *comparison->measured_s;
    }
    suite.append_attribute("failures") = failures;
    add_time(suite, seconds);
    for (const Comparison* comparison : comparisons) add_case(suite, *comparison);
  }
  std::ostringstream text;
  document.save(text, " ");
  return text.str();
}

}  // namespace shadowbench::regress
