// The table of a run's options: what is told is what is read, written, and read again.

#include "harness/options/run_options.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <map>

#include "base/error.h"
#include "harness/options/experiment_file.h"
#include "tests/test_files.h"

namespace shadowbench::options {
namespace {

using ::testing::HasSubstr;

/// Tells an option what the words of a command line or an experiment say.
void tell(RunOption& option, const std::vector<std::string>& texts) {
  std::visit(
      [&](auto& told) {
        using Value = std::remove_cvref_t<decltype(told)>;
        if constexpr (std::is_same_v<Value, std::vector<std::string>>)
          told = texts;
        else if constexpr (std::is_same_v<Value, std::string>)
          for (told.clear(); const std::string& text : texts) told += (told.empty() ? "" : ",") + text;
        else if constexpr (std::is_same_v<Value, bool>)
          told = texts.front() == "true";
        else
          told = static_cast<Value>(std::stod(texts.front()));
      },
      option.told);
}

/// Something else than the default, of every key that is read and written here.
const std::map<std::string, std::vector<std::string>>& list_others() {
  static const std::map<std::string, std::vector<std::string>> others = {{"scene", {"cubes", "edge"}},
                                                                         {"ground", {"true"}},
                                                                         {"equal_bytes", {"true"}},
                                                                         {"map_size", {"256,512"}},
                                                                         {"pad_texels", {"12.5"}},
                                                                         {"view", {"007"}},
                                                                         {"light_name", {"sun", "it's \"one\""}},
                                                                         {"size", {"64x36,32x18"}},
                                                                         {"map_format", {"d16"}},
                                                                         {"reversed_depth", {"true"}},
                                                                         {"perspective_depth", {"30.5"}},
                                                                         {"blend_casters", {"dither"}},
                                                                         {"fit", {"view", "sphere"}},
                                                                         {"snap", {"on"}},
                                                                         {"light", {"60,30.5"}},
                                                                         {"border", {"edge"}},
                                                                         {"far_test", {"off"}},
                                                                         {"behind_test", {"off"}},
                                                                         {"border_page", {"true"}},
                                                                         {"filter_file", {"mine.glsl"}},
                                                                         {"width", {"soft"}},
                                                                         {"bias", {"constant:depth=0.0001"}},
                                                                         {"rounds", {"7"}},
                                                                         {"phases", {"2"}},
                                                                         {"frames", {"8"}},
                                                                         {"precision", {"0.5"}},
                                                                         {"budget", {"0.1"}},
                                                                         {"gpu", {"none"}},
                                                                         {"seed", {"4294967295"}},
                                                                         {"cell_timeout", {"3"}},
                                                                         {"truth", {"false"}},
                                                                         {"attribution", {"false"}},
                                                                         {"truth_weight", {"cosine"}},
                                                                         {"stability", {"true"}},
                                                                         {"uncertainty", {"true"}},
                                                                         {"all_parts", {"true"}}};
  return others;
}

class RunOptionsTest : public ::testing::Test {
 protected:
  RunOptions read(const std::vector<RunOption>& all) const {
    RunOptions options;
    options.resources = find_resources();
    read_run_options(all, options);
    return options;
  }

  /// The same options, by way of an experiment file.
  RunOptions write_and_read(const RunOptions& options) const {
    const auto file = folder_.write("e.toml", write_experiment(options));
    std::vector<RunOption> all = list_run_options();
    for (const ExperimentSetting& setting : read_experiment(file).settings)
      tell(*std::ranges::find(all, setting.option, &RunOption::name), setting.values);
    return read(all);
  }

 private:
  TestFolder folder_;
};

TEST_F(RunOptionsTest, WhatIsTold_IsRead_AndWritten_AndReadAgain) {
  std::vector<RunOption> all = list_run_options();
  for (RunOption& option : all)
    if (const auto other = list_others().find(option.key()); other != list_others().end()) tell(option, other->second);
  const RunOptions told = read(all), again = write_and_read(told), usual = read(list_run_options());
  for (const RunOption& option : all) {
    if (option.decides == Decides::kWay || !option.write) continue;
    SCOPED_TRACE(option.name);
    ASSERT_TRUE(list_others().contains(option.key())) << "a new option needs a row in this test";
    EXPECT_NE(option.write(told), option.write(usual));
    if (option.key() != "scene" && option.key() != "filter_file")  // paths are relative to the experiment
      EXPECT_EQ(list_texts(option.write(again)), list_texts(option.write(told)));
  }
}

TEST_F(RunOptionsTest, Defaults_AreThoseOfTheOptions_AndNeedNotBeWritten) {
  const RunOptions usual = read(list_run_options());
  for (const RunOption& option : list_run_options())
    if (option.decides != Decides::kWay && option.write) EXPECT_EQ(option.write(usual), option.told) << option.name;
  const std::string written = write_experiment(usual);
  for (const char* kept : {"map_size = 1024\n", "size = '960x540'\n", "snap = 'off'\n", "fit = 'tight'\n"})
    EXPECT_THAT(written, HasSubstr(kept)) << "which cells there are is said in any case";
  for (const char* left_out : {"truth", "rounds", "gpu", "ground", "light"})
    EXPECT_THAT(written, ::testing::Not(HasSubstr(left_out)));
}

TEST(CheckRunOptions, ABorderPageWithoutGrids_IsRefused) {
  RunOptions options;
  options.border_page = true;
  EXPECT_NO_THROW(check_run_options(options));
  options.grids = false;
  EXPECT_THROW(check_run_options(options), Error);
}

TEST_F(RunOptionsTest, AShard_IsEveryNthCell) {
  std::vector<RunOption> all = list_run_options();
  find_told<std::string>(all, "--shard") = "2/3";
  const Part part = read(all).part;
  EXPECT_EQ(part.shard, 2);
  EXPECT_EQ(part.shards, 3);
  EXPECT_EQ(Part().shards, 1);
}

}  // namespace
}  // namespace shadowbench::options
