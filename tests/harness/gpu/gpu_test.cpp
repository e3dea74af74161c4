// The descriptions of GPUs: what comes with the program, and what is refused.

#include "harness/gpu/gpu.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/test_files.h"

namespace shadowbench::gpu {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path kShipped = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "data" / "gpus";

/// The message of the error that loading `text` ends in.
std::string load_error(const std::string& text) {
  const TestFolder folder;
  return error_of([&] { load_gpu(folder.write("a.toml", text)); }).what();
}

std::string replace(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Gpus, EveryShippedOneNamesASourceForEveryNumber) {
  const std::vector<Gpu> gpus = load_gpus(kShipped);
  EXPECT_GE(gpus.size(), 2u);
  for (const Gpu& gpu : gpus)
    visit_constants(gpu, [&](const char* key, const Constant& constant) {
      EXPECT_GE(constant.source.size(), 20u) << gpu.name << " " << key;
    });
}

TEST(Gpus, AFileIsRefusedWithItsLine) {
  const std::string good = read_text(kShipped / "navi21.toml");
  EXPECT_EQ(load_error(good), "no error");
  EXPECT_THAT(load_error(replace(good, "[simds]", "[simd]")), HasSubstr("unknown key 'simd'"));
  EXPECT_THAT(load_error(replace(good, "value = 2015", "value = 0")), HasSubstr(":9: "));
  EXPECT_THAT(load_error(replace(good, "value = 2015", "")), HasSubstr("value"));
  EXPECT_THAT(load_error(replace(good, "value = 0.5", "value = 1.5")), HasSubstr("0.001 to 1"));
  EXPECT_THAT(load_error(replace(good, "value = 128\nsource = \"AMD, RDNA", "value = 96\nsource = \"AMD, RDNA")),
              HasSubstr("'value' is 96; a line has a power of two"));
  EXPECT_THAT(load_error(good.substr(0, good.find("[memory_gb_s]"))), HasSubstr("the table [memory_gb_s] is missing"));
}

TEST(Gpus, AreChosenByName) {
  const std::vector<Gpu> all = load_gpus(kShipped);
  const auto refusal = [&](const std::vector<std::string>& names) {
    try {
      choose_gpus(all, names);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      return std::string(error.what());
    }
    return std::string("chosen");
  };
  EXPECT_TRUE(choose_gpus(all, {"none"}).empty());
  EXPECT_EQ(choose_gpus(all, {"vega10", "navi21"}).front().name, "vega10");
  EXPECT_THAT(refusal({"navi12"}), HasSubstr("'navi12' is no GPU that is described; did you mean 'navi"));
  EXPECT_THAT(refusal({"rtx3080"}), HasSubstr(kOtherGpus));
  EXPECT_THAT(refusal({"navi21", "navi21"}), HasSubstr("named twice"));
  EXPECT_THAT(refusal({"navi21", "none"}), HasSubstr("'none' stands alone"));
}

}  // namespace
}  // namespace shadowbench::gpu
