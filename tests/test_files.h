#pragma once

// What nearly every test uses: matchers, standard headers, errors, and files in a folder of its own.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"

namespace shadowbench {

using ::testing::AllOf, ::testing::AnyOf, ::testing::Contains, ::testing::ContainsRegex, ::testing::Each;
using ::testing::ElementsAre, ::testing::EndsWith, ::testing::HasSubstr, ::testing::IsEmpty, ::testing::MatchesRegex;
using ::testing::Not, ::testing::Pair, ::testing::Property, ::testing::SizeIs, ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

/// The Error that an action throws; one of kind kLimit, "no error", where it throws none.
template <typename Action>
Error error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  return {ErrorKind::kLimit, "no error"};
}

/// What GoogleTest shows of an Error.
inline void PrintTo(const Error& error, std::ostream* out) {
  *out << error.what() << " (exit code " << static_cast<int>(error.kind()) << ")";
}

/// An Error of a kind whose text, "PLACE: MESSAGE", has all these words.
template <typename... Words>
auto is_error(ErrorKind kind, const Words&... words) {
  return AllOf(Property("kind", &Error::kind, kind), Property("what", &Error::what, AllOf(HasSubstr(words)...)));
}

/// Does an action while no file may grow beyond so many bytes, which stands for a full disk.
template <typename Action>
auto with_file_limit(rlim_t bytes, const Action& action) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{bytes, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const auto result = action();
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  return result;
}

inline std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// A folder of the test's own, removed with it.
class TestFolder {
 public:
  TestFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "shadowbench_test_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  std::string read(const std::string& name) const { return read_text(path_ / name); }

 private:
  std::filesystem::path path_;
};

}  // namespace shadowbench
