#include "harness/gpu/machine_code.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

namespace shadowbench::gpu {
namespace {

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
