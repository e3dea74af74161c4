#include "harness/gpu/facts_request.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "harness/gpu/null_device.h"
#include "report/records/json_values.h"

namespace shadowbench::gpu {
namespace {

using nlohmann::json;

/// Changes whenever facts of the same shader are counted differently.
constexpr int kFactsVersion = 1;

std::string dump(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace) + "\n"; }

/// Facts follow from the driver, the family, the shader and its target, and are kept under their names.
std::filesystem::path cached_file(const FactsRequest& request, const std::string& driver, const PassSource& pass) {
  ContentHash hash;
  hash.add(fmt::format("{}\n{}\n{}\n{}\n{}", kFactsVersion, driver, request.family, pass.format, pass.fragment.text));
  return request.cache / "gpu" / (hash.name() + ".json");
}

/// What cannot be read was damaged, and is made again.
std::optional<records::ShaderFacts> read_cached(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  std::ifstream stream(file);
  const json written = json::parse(stream, nullptr, false);
  try {
    return records::read_value<records::ShaderFacts>(written);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void write_cached(const std::filesystem::path& file, const records::ShaderFacts& facts) {
  try {
    write_text_file(file, dump(records::value_json(facts)));
  } catch (const Error&) {
    // A full disk costs time in the next run, and nothing in this one.
  }
}

FactsRequest read_request(const std::filesystem::path& file) {
  try {
    std::ifstream stream(file);
    const json written = json::parse(stream);
    FactsRequest request{written.at("family"), std::filesystem::path(written.at("cache").get<std::string>()), {}};
    for (const json& pass : written.at("passes"))
      request.passes.push_back(
          {{pass.at("text"), pass.at("files").get<std::vector<std::string>>()}, pass.at("format")});
    return request;
  } catch (const json::exception& error) {
    throw Error(ErrorKind::kInput, fmt::format("this is no list of passes to compile: {}", error.what()),
                file.string());
  }
}

json to_json(const FactsAnswer& answer) {
  return answer.refused.empty() ? json{{"facts", records::value_json(answer.facts)}}
                                : json{{"refused", answer.refused}};
}

FactsAnswer answer(NullDevice& device, const FactsRequest& request, const PassSource& pass) {
  const std::filesystem::path file = cached_file(request, device.driver(), pass);
  if (!request.cache.empty())
    if (const auto cached = read_cached(file)) return {*cached, ""};
  try {
    const records::ShaderFacts facts = device.compile(pass.fragment, pass.format);
    if (!request.cache.empty()) write_cached(file, facts);
    return {facts, ""};
  } catch (const Error& error) {
    return {{}, error.what()};
  }
}

}  // namespace

void write_request(const std::filesystem::path& file, const FactsRequest& request) {
  json written = {{"family", request.family}, {"cache", request.cache.string()}, {"passes", json::array()}};
  for (const PassSource& pass : request.passes)
    written["passes"].push_back(
        {{"text", pass.fragment.text}, {"files", pass.fragment.files}, {"format", pass.format}});
  write_text_file(file, dump(written));
}

void answer_request(const std::filesystem::path& request_file, const std::filesystem::path& answers) {
  const FactsRequest request = read_request(request_file);
  NullDevice device(request.family);
  std::ofstream stream(answers, std::ios::app);
  for (const PassSource& pass : request.passes)
    if (!(stream << dump(to_json(answer(device, request, pass))) << std::flush))
      throw Error(ErrorKind::kOutput, "the file cannot be written; check the free space", answers.string());
}

std::vector<FactsAnswer> read_answers(const std::filesystem::path& answers) {
  std::vector<FactsAnswer> read;
  std::ifstream stream(answers);
  for (std::string line; std::getline(stream, line);) {
    const json written = json::parse(line, nullptr, false);
    if (!written.is_object()) break;  // the process ended while it wrote
    if (written.contains("refused"))
      read.push_back({{}, written.at("refused")});
    else
      read.push_back({records::read_value<records::ShaderFacts>(written.at("facts")), ""});
  }
  return read;
}

}  // namespace shadowbench::gpu
