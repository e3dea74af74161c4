#include "harness/options/experiment_file.h"

#include "harness/options/run_options.h"
#include "harness/render/bias.h"
#include "tests/filters/filtered.h"
#include "tests/test_files.h"

namespace shadowbench::options {
namespace {

class ExperimentFile : public ::testing::Test {
 protected:
  Experiment read(const std::string& text) const { return read_experiment(folder_.write("e.toml", text)); }
  std::string expand(const std::string& text) const { return expand_filters(read(text), filters::built_in()); }
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  TestFolder folder_;
};

TEST_F(ExperimentFile, KeysAreOptions_ListsAreSeveralValues) {
  const Experiment e =
      read("title = 'T'\nmap_size = [256, 512]\nsize = '64x36'\ngrids = false\nscene = ['cubes', 'my/a.glb']\n");
  EXPECT_EQ(e.title, "T");
  ASSERT_EQ(e.settings.size(), 4u);
  const auto values = [&](const std::string& option) {
    for (const ExperimentSetting& s : e.settings)
      if (s.option == option) return s.values;
    return std::vector<std::string>{"none"};
  };
  EXPECT_THAT(values("--map-size"), ElementsAre("256", "512"));
  EXPECT_THAT(values("--size"), ElementsAre("64x36"));
  EXPECT_THAT(values("--grids"), ElementsAre("false"));
  EXPECT_THAT(values("--scene"), ElementsAre("cubes", (folder() / "my/a.glb").string()));
  EXPECT_EQ(e.settings.front().where, (folder() / "e.toml").string() + ":5") << "the scene's";
}

TEST_F(ExperimentFile, FiltersAreTheProductOfTheirParameters) {
  EXPECT_EQ(
      expand("[[filter]]\nid = 'none'\n[[filter]]\nid = 'poisson'\nradius = [1.5, 2]\ntaps = [8, 16]\n"),
      "none,poisson:radius=1.5,taps=8,poisson:radius=1.5,taps=16,poisson:radius=2,taps=8,poisson:radius=2,taps=16");
}

TEST_F(ExperimentFile, RangesAreLinearOrLogarithmic_WholeNumbersAreRounded_AndStandOnce) {
  EXPECT_EQ(expand("[[filter]]\nid = 'vsm'\nradius = {linear = [1, 3], count = 5}\n"),
            "vsm:radius=1,vsm:radius=2,vsm:radius=3");
  EXPECT_EQ(expand("[[filter]]\nid = 'poisson'\nradius = {linear = [1, 2], count = 3}\n"),
            "poisson:radius=1,poisson:radius=1.5,poisson:radius=2");
  const std::string log = expand("[[filter]]\nid = 'esm'\nc = {log = [1, 100], count = 3}\n");
  EXPECT_THAT(log, HasSubstr("esm:c=1,esm:c=10"));
  EXPECT_THAT(log, HasSubstr(",esm:c=100"));
  EXPECT_EQ(
      expand("[[filter]]\nid = 'vsm'\nstore = ['rg32f', 'rg16f']\nmin_variance = {log = [1e-5, 1e-5], count = 2}\n"),
      "vsm:min_variance=1e-05,store=rg32f,vsm:min_variance=1e-05,store=rg16f");
}

TEST_F(ExperimentFile, AWidth_IsAParameterOfAFilterWithARadius) {
  EXPECT_EQ(expand("[[filter]]\nid = 'vsm'\nwidth = ['medium', 1.5]\n"), "vsm:width=medium,vsm:width=1.5");
}

TEST(WrittenExperiment, AsksTheLightAgain) {
  RunOptions options;
  options.filters = filters::built_in().parse_requests("vsm:width=light");
  options.filters.front().take_light_width(5.0);
  const std::string written = write_experiment(options);
  EXPECT_NE(written.find("width = 'light'"), std::string::npos) << written;
  EXPECT_EQ(written.find("radius"), std::string::npos) << written;
}

TEST_F(ExperimentFile, Mistakes_NameFileAndLine) {
  const std::vector<std::tuple<std::string, std::string, int>> cases = {
      {"map_sise = 3\n", "did you mean 'map_size'", 1},
      {"title = 'x'\nmap_size = []\n", "'map_size' is an empty list", 2},
      {"\nmap_size = [1, {a = 2}]\n", "'map_size' must be a text", 2},
      {"[filter]\nid = 'none'\n", "[[filter]]", 1},
      {"[[filter]]\nradius = 3\n", "id", 1},
      {"\n[[filter]]\nid = 'vsn'\n", "did you mean 'vsm'", 2},
      {"[[filter]]\nid = 'vsm'\nradios = 3\n", "did you mean 'radius'", 1},
      {"[[filter]]\nid = 'vsm'\nradius = 99\n", "out of range", 1},
      {"[[filter]]\nid = 'vsm'\nradius = {linear = [1, 2]}\n", "count", 3},
      {"[[filter]]\nid = 'vsm'\nradius = {linear = [1, 2], count = 1}\n", "count", 3},
      {"[[filter]]\nid = 'vsm'\nradius = {linear = [1, 2], log = [1, 2], count = 3}\n", "one of them", 3},
      {"[[filter]]\nid = 'vsm'\nradius = {count = 3}\n", "one of them", 3},
      {"[[filter]]\nid = 'esm'\nc = {log = [0, 2], count = 3}\n", "more than 0", 3},
      {"[[filter]]\nid = 'esm'\nc = {linear = [1, 2000], count = 10000}\nradius = {linear = [0, 64], count = 64}\n",
       "combinations, and a run takes 100000", 1},
      {"[[filter]]\nid = 'esm'\nc = {linear = [1, 2000], count = 10000}\nradius = [1, 2, 3, 4, 5, 6]\n"
       "[[filter]]\nid = 'esm'\nc = {linear = [1, 2000], count = 10000}\nradius = [1, 2, 3, 4, 5, 6]\n",
       "combinations, and a run takes 100000", 5},
      {"[[filter]]\nid = 'esm'\nc = {linear = [1, inf], count = 3}\n", "number", 3},
      {"map_size = = 3\n", "not valid TOML", 1},
      {"[[filter]]\nid = 'vsm'\nwidth = 40\n", "0.408 .. 28.3 texels", 1},
      {"[[filter]]\nid = 'none'\nwidth = 'soft'\n", "no radius that a width could set", 1},
      {"\nfilters = ['none']\n[[filter]]\nid = 'none'\n", "both name filters", 2},
  };
  for (const auto& [text, message, line] : cases) {
    SCOPED_TRACE(text);
    EXPECT_THAT(error_of([&] { expand(text); }),
                is_error(ErrorKind::kInput, "e.toml:" + std::to_string(line), message));
  }
}

TEST_F(ExperimentFile, Missing_IsSaid) {
  EXPECT_EQ(error_of([&] { read_experiment(folder() / "none.toml"); }).kind(), ErrorKind::kInput);
}

TEST_F(ExperimentFile, AreFoundByName_OrPath) {
  const std::filesystem::path shipped = SHADOWBENCH_SOURCE_DIR "/data/experiments";
  EXPECT_EQ(find_experiment(shipped, "quick"), shipped / "quick.toml");
  EXPECT_EQ(find_experiment(shipped, "my/own.toml"), "my/own.toml");
  EXPECT_THAT(error_of([&] { find_experiment(shipped, "quik"); }).what(), HasSubstr("did you mean 'quick'"));
  EXPECT_THAT(error_of([&] { find_experiment(shipped, "xyzzy12"); }).what(),
              HasSubstr("cascades, default, engines, golden, kinds, paraboloid, quick, sweep, widths"));
}

TEST(ShippedExperiments, EnginesListsEveryPreset_WithABiasThatWeHave) {
  const std::filesystem::path root(SHADOWBENCH_SOURCE_DIR);
  std::string told;
  for (const ExperimentSetting& setting : read_experiment(root / "data/experiments/engines.toml").settings)
    if (setting.option == "--filters")
      for (const std::string& each : setting.values) told += (told.empty() ? "" : ",") + each;
  std::vector<std::string> run, known;
  for (const filters::FilterRequest& request : filters::built_in().parse_requests(told))
    for (const filters::Preset& preset : request.presets) run.push_back(preset.name);
  for (const filters::Preset& preset : filters::built_in().presets()) {
    known.push_back(preset.name);
    if (!preset.bias_options.empty()) EXPECT_NO_THROW(render::parse_bias(preset.bias_options)) << preset.name;
  }
  EXPECT_THAT(run, ::testing::UnorderedElementsAreArray(known));
  EXPECT_EQ(filters::built_in().parse_requests(told).front().label(), "none");
}

// The table of a run's options: what is told is what is read, written, and read again.

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

/// Something else than the default, of every option of text that has no choices.
const std::map<std::string, std::vector<std::string>> kOthers = {{"scene", {"cubes", "edge"}},
                                                                 {"map_size", {"256,512"}},
                                                                 {"pad_texels", {"12.5"}},
                                                                 {"view", {"007"}},
                                                                 {"light_name", {"sun", "it's \"one\""}},
                                                                 {"size", {"64x36,32x18"}},
                                                                 {"map_format", {"d16"}},
                                                                 {"perspective_depth", {"30.5"}},
                                                                 {"fit", {"view", "sphere"}},
                                                                 {"light", {"60,30.5"}},
                                                                 {"filter_file", {"mine.glsl"}},
                                                                 {"width", {"soft"}},
                                                                 {"bias", {"constant:depth=0.0001"}},
                                                                 {"rounds", {"7"}},
                                                                 {"gpu", {"none"}},
                                                                 {"seed", {"4294967295"}},
                                                                 {"truth_weight", {"cosine"}}};

/// Tells an option something else: that of the table above, another of its choices, the opposite, or another number.
void tell_another(RunOption& option) {
  if (const auto other = kOthers.find(option.key()); other != kOthers.end()) return tell(option, other->second);
  const auto is_other = [&](const std::string& choice) { return option.told != Told(choice); };
  if (const auto other = std::ranges::find_if(option.choices, is_other); other != option.choices.end())
    return tell(option, {*other});
  if (auto* is_on = std::get_if<bool>(&option.told)) *is_on = !*is_on;
  if (auto* count = std::get_if<int>(&option.told)) ++*count;
  if (auto* count = std::get_if<std::uint32_t>(&option.told)) ++*count;
  if (auto* number = std::get_if<double>(&option.told)) *number /= 2;
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
    if (option.decides != Decides::kWay && option.write) tell_another(option);
  const RunOptions told = read(all), again = write_and_read(told), usual = read(list_run_options());
  for (const RunOption& option : all) {
    if (option.decides == Decides::kWay || !option.write) continue;
    SCOPED_TRACE(option.name);
    EXPECT_NE(option.write(told), option.write(usual)) << "a new option of text needs a row in this test";
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
    EXPECT_THAT(written, Not(HasSubstr(left_out)));
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
