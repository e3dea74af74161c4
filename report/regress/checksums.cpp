#include "report/regress/checksums.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <sstream>

#include "base/atomic_file.h"
#include "base/input_file.h"
#include "base/temporary_files.h"

namespace shadowbench::regress {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 64;

/// Gives nothing for what cannot be read as a file.
std::string hash_file(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return "";  // a pipe would never open
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return "";
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  std::array<char, 65536> piece;
  while (stream.read(piece.data(), piece.size()), stream.gcount() > 0)
    EVP_DigestUpdate(context.get(), piece.data(), static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) return "";
  std::array<unsigned char, kDigits / 2> sum;
  EVP_DigestFinal_ex(context.get(), sum.data(), nullptr);
  std::string digits;
  for (const unsigned char byte : sum) digits += fmt::format("{:02x}", byte);
  return digits;
}

std::string make_list(const Checksums& checksums) {
  std::string text;
  for (const auto& [path, sum] : checksums) text += fmt::format("{}  {}\n", sum, path);
  return text;
}

std::string read_list(const fs::path& folder) {
  require_plain_file(folder / kChecksumFile, 64 * kMebibyte);
  std::stringstream text;
  text << std::ifstream(folder / kChecksumFile, std::ios::binary).rdbuf();
  return text.str();
}

Checksums parse_list(const std::string& text) {
  Checksums checksums;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.size() > kDigits + 2) checksums[line.substr(kDigits + 2)] = line.substr(0, kDigits);
  return checksums;
}

}  // namespace

Checksums compute_checksums(const fs::path& folder) {
  Checksums checksums;
  std::error_code error;
  for (const char* name : {"baseline.toml", "accepted.md"})
    if (fs::exists(folder / name, error)) checksums[name] = hash_file(folder / name);
  for (const fs::directory_entry& scene : fs::directory_iterator(folder, error)) {
    if (!scene.is_directory(error)) continue;
    for (const fs::path& file : fs::directory_iterator(scene, error))
      if ((file.extension() == ".json" || file.extension() == ".exr") && !is_temporary(file))
        checksums[file.lexically_relative(folder).generic_string()] = hash_file(file);
  }
  return checksums;
}

Checksums read_checksums(const fs::path& folder) { return parse_list(read_list(folder)); }

void write_checksums(const fs::path& folder, const Checksums& checksums) {
  write_text_file(folder / kChecksumFile, make_list(checksums));
}

Damage find_damage(const fs::path& folder) {
  const Checksums found = compute_checksums(folder);
  std::error_code error;
  const bool has_list = fs::is_regular_file(folder / kChecksumFile, error);
  if (!has_list && found.empty()) return {};
  if (!has_list)
    return {{kChecksumFile, "is missing: a program of an older version made this, or accepting it was stopped"}};
  const std::string text = read_list(folder);
  const Checksums listed = parse_list(text);
  Damage damage;
  for (const auto& [path, sum] : listed) {
    const auto file = found.find(path);
    if (file == found.end())
      damage[path] = "is missing";
    else if (file->second != sum)
      damage[path] = file->second.empty() ? "cannot be read as a file" : "has changed since it was accepted";
  }
  for (const auto& [path, sum] : found)
    if (!listed.contains(path)) damage[path] = fmt::format("is not listed in {}", kChecksumFile);
  if (damage.empty() && text != make_list(found)) damage[kChecksumFile] = "has changed since it was written";
  return damage;
}

}  // namespace shadowbench::regress
