// Stands in for libFuzzer where a target is built without it: gives the target every file of the folders named.
// A target that throws, crashes, or takes longer than kMostSeconds over one file fails.

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

constexpr unsigned kMostSeconds = 20;
constexpr rlim_t kMostBytes = rlim_t{1} << 30;

std::vector<fs::path> list_files(int count, char** folders) {
  std::vector<fs::path> files;
  for (int i = 0; i < count; ++i)
    for (const fs::directory_entry& entry : fs::directory_iterator(folders[i])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void replay(const fs::path& file) {
  std::printf("%s\n", file.c_str());
  std::fflush(stdout);
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(stream), {});
  ::alarm(kMostSeconds);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  ::alarm(0);
}

/// The sanitizers reserve terabytes of addresses: there, memory has no limit.
void limit_memory() {
#if !defined(__SANITIZE_ADDRESS__)
  const rlimit limit{kMostBytes, kMostBytes};
  ::setrlimit(RLIMIT_AS, &limit);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  limit_memory();
  try {
    const std::vector<fs::path> files = list_files(argc - 1, argv + 1);
    for (const fs::path& file : files) replay(file);
    std::printf("%zu files\n", files.size());
    return files.empty() ? 1 : 0;
  } catch (const std::exception& problem) {
    std::printf("it threw: %s\n", problem.what());
    return 1;
  }
}
