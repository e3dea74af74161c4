#include "harness/gpu/facts_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

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

/// The number of a block in "BB12", wherever it stands first in a text.
std::optional<int> find_block(std::string_view text) {
  const std::size_t at = text.find("BB");
  int block = 0;
  if (at == std::string_view::npos) return std::nullopt;
  const auto [end, error] = std::from_chars(text.data() + at + 2, text.data() + text.size(), block);
  return error == std::errc() ? std::optional(block) : std::nullopt;
}

/// Whether a mnemonic such as "image_sample_c_lz" has a part.
bool has_part(std::string_view mnemonic, std::string_view part) {
  for (std::size_t at = mnemonic.find('_'); at != std::string_view::npos; at = mnemonic.find('_', at + 1))
    if (mnemonic.substr(at + 1, mnemonic.find('_', at + 1) - at - 1) == part) return true;
  return false;
}

void count_read(std::string_view mnemonic, records::ShaderFacts& facts) {
  if (mnemonic.starts_with("image_load"))
    ++facts.loads;
  else if (mnemonic.starts_with("image_gather4"))
    ++facts.gathers;
  else if (mnemonic.starts_with("image_sample"))
    ++(has_part(mnemonic, "c") ? facts.compares : facts.samples);
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

void count_reads(std::string_view listing, records::ShaderFacts& facts) {
  facts.samples = facts.compares = facts.gathers = facts.loads = facts.loops = 0;
  std::set<int> heads;  // of loops: several branches may lead back to one
  int block = 0;
  while (!listing.empty()) {
    const std::string_view line = listing.substr(0, listing.find('\n'));
    listing.remove_prefix(std::min(line.size() + 1, listing.size()));
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) continue;
    if (line.starts_with("/*") && line.find("loop-header") != line.npos) heads.insert(block);
    if (begin == 0) {
      if (!line.starts_with("/*")) block = find_block(line).value_or(block);
      continue;
    }
    const std::size_t equals = line.find(" = "), word = equals == line.npos ? begin : equals + 3;
    const std::string_view mnemonic = line.substr(word, line.find_first_of(" \t", word) - word);
    count_read(mnemonic, facts);
    const auto target = find_block(line);
    const bool is_branch = mnemonic.starts_with("s_branch") || mnemonic.starts_with("s_cbranch");
    if (is_branch && target && *target <= block) heads.insert(*target);
  }
  facts.loops = static_cast<int>(heads.size());
}

}  // namespace shadowbench::gpu
