#include "report/regress/junit.h"

#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

namespace shadowbench::regress {
namespace {

/// Replaces what XML cannot hold and file names can: control characters, and bytes that are not UTF-8.
std::string clean(const std::string& text) {
  using nlohmann::json;
  const auto valid = json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
  std::string cleaned;
  for (const char c : valid) cleaned += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? '?' : c;
  return cleaned;
}

void add_case(pugi::xml_node suite, const Comparison& comparison) {
  pugi::xml_node entry = suite.append_child("testcase");
  entry.append_attribute("classname") = clean(comparison.scene + "." + comparison.view).c_str();
  entry.append_attribute("name") = clean(comparison.label + " (" + comparison.settings + ")").c_str();
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
    for (const Comparison* comparison : comparisons) failures += comparison->failed() ? 1 : 0;
    suite.append_attribute("failures") = failures;
    for (const Comparison* comparison : comparisons) add_case(suite, *comparison);
  }
  std::ostringstream text;
  document.save(text, " ");
  return text.str();
}

}  // namespace shadowbench::regress
