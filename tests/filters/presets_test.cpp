#include "filters/presets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "base/error.h"
#include "filters/catalogue.h"

namespace shadowbench::filters {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const Catalogue& filters_of_program() {
  static const Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  return catalogue;
}

std::vector<std::string> labels_of(const std::string& text) {
  std::vector<std::string> labels;
  for (const FilterRequest& request : filters_of_program().parse_requests(text)) labels.push_back(request.label());
  return labels;
}

std::vector<std::string> presets_of(const FilterRequest& request) {
  std::vector<std::string> names;
  for (const Preset& preset : request.presets) names.push_back(preset.name);
  return names;
}

Error error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  return {ErrorKind::kLimit, "no error"};
}

TEST(ShippedPresets, AreFiltersOfOurs_WithSourceAndVersion) {
  const std::vector<Preset> presets = filters_of_program().presets();
  ASSERT_GE(presets.size(), 12u);
  for (const Preset& preset : presets) {
    const auto requests = filters_of_program().parse_requests("@" + preset.name);
    ASSERT_EQ(requests.size(), 1u) << preset.name << " is the beginning of another name";
    EXPECT_THAT(presets_of(requests.front()), ElementsAre(preset.name));
    for (const std::string& source : preset.sources) EXPECT_THAT(source, StartsWith("https://")) << preset.name;
    EXPECT_THAT(preset.differs, EndsWith(".")) << preset.name << ": whole sentences";
    // A release is a number; otherwise every file that was read stands with its commit.
    if (preset.version.find("addresses") == std::string::npos) continue;
    for (const std::string& source : preset.sources)
      EXPECT_THAT(source, ::testing::ContainsRegex("/blob/[0-9a-f]{40}/")) << preset.name;
  }
}

TEST(Presets, StandAmongFilters_ABeginningForAll) {
  EXPECT_THAT(labels_of("none,@unity-hdrp,vsm:radius=2"),
              ElementsAre("none", "tent5x5", "tent7x7", "pcss (rotation=interleaved-gradient, search_taps=32, taps=16)",
                          "vsm (radius=2)"));
  EXPECT_THAT(labels_of("@three.js"),
              ElementsAre("poisson (pattern=vogel, radius=1, rotation=interleaved-gradient, taps=5)"));
  EXPECT_THAT(labels_of("@unity-hdrp-medium"), ElementsAre("tent7x7"));
  EXPECT_EQ(labels_of("@unity"), labels_of("@unity-hdrp"));
}

TEST(Presets, OfOneFilter_AreOneRequest) {
  for (const char* text :
       {"@playcanvas,@filament", "castano3,@playcanvas,@filament", "@playcanvas,@filament,castano3"}) {
    const auto requests = filters_of_program().parse_requests(text);
    ASSERT_EQ(requests.size(), 1u) << text;
    EXPECT_THAT(presets_of(requests.front()), ElementsAre("playcanvas", "filament")) << text;
  }
  EXPECT_EQ(filters_of_program().parse_requests("castano3,castano3").size(), 2u)
      << "what is named twice is told, as ever";
  EXPECT_TRUE(filters_of_program().parse_requests("castano3").front().presets.empty());
}

TEST(Presets, SayWhatTheyLack_AndTheEnginesBias) {
  const Preset preset = choose_presets(filters_of_program().presets(), "playcanvas").front();
  EXPECT_EQ(write_bias_options(preset), "--bias polygon-offset:factor=0.5,units=0.5 --bias constant:depth=1e-4");
  const std::string text = describe_preset(preset);
  for (const std::string& part : {std::string("@playcanvas is castano3"), preset.differs, preset.bias,
                                  "but this does: " + write_bias_options(preset)})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_THAT(describe_preset(choose_presets(filters_of_program().presets(), "godot").front()),
              EndsWith("nor can --bias"));
}

TEST(Presets, Mistakes_AreNamed) {
  const auto expect_usage_error = [](const std::string& text, const std::string& words) {
    const Error error = error_of([&] { filters_of_program().parse_requests(text); });
    EXPECT_EQ(error.kind(), ErrorKind::kUsage) << text;
    EXPECT_THAT(error.message(), HasSubstr(words)) << text;
  };
  expect_usage_error("@godt", "unknown preset '@godt'; did you mean 'godot'?");
  expect_usage_error("none,@", "unknown preset '@'");
  expect_usage_error("@unreal", "known: three.js, babylon.js-none");
  expect_usage_error("@unit", "unknown preset '@unit'");
  expect_usage_error("@unity-hdrp-", "unknown preset '@unity-hdrp-'");
  expect_usage_error("@godot:radius=3", "'@godot:radius=3': a preset has the parameters of its engine");
  expect_usage_error("@godot,radius=3", "'radius=3': a preset has the parameters of its engine");
}

class PresetFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    for (const char* name : {"none.glsl", "vsm.glsl"})
      std::filesystem::copy_file(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "filters" / name, folder_ / name);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// What asking for the preset 'p' answers where its file is this.
  Error ask(const std::string& text) const {
    std::ofstream(file()) << text;
    return error_of([&] { Catalogue(folder_).parse_requests("none,@p"); });
  }
  std::filesystem::path file() const { return folder_ / "presets.toml"; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("shadowbench.presets." + std::to_string(getpid()));
};

const std::string kGood =
    "[[preset]]\nname = 'p'\ntitle = 't'\nfilter = 'vsm:radius=2'\nbias = '0'\ndiffers = 'Nothing.'\nsource = 's'\n"
    "version = '1'\n";

std::string change(const std::string& from, const std::string& to) {
  std::string text = kGood;
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(PresetFile, ThatIsRight_IsRead) { EXPECT_EQ(ask(kGood).message(), "no error"); }

TEST_F(PresetFile, Mistakes_AreTold_WithTheLine) {
  const auto expect_error = [&](const std::string& text, int line, const std::string& words) {
    const Error error = ask(text);
    EXPECT_EQ(error.kind(), ErrorKind::kInput) << text;
    EXPECT_EQ(error.where(), file().string() + ":" + std::to_string(line)) << text;
    EXPECT_THAT(error.message(), HasSubstr(words)) << text;
  };
  expect_error(change("vsm:radius", "vsm:radus"), 1, "the preset 'p': filter 'vsm' has no parameter 'radus'");
  expect_error(change("vsm:radius=2", "vsm:radius=65"), 1, "the preset 'p': vsm:radius=65 is out of range");
  expect_error(change("vsm:radius=2", "vms"), 1, "the preset 'p': unknown filter 'vms'; did you mean 'vsm'?");
  expect_error(change("vsm:radius=2", "none,vsm"), 1, "the preset 'p': 'none,vsm' is 2 filters, and must be one");
  expect_error(change("vsm:radius=2", "@p"), 4, "'@p' is a preset; name a filter");
  expect_error(change("version = '1'\n", ""), 1, "version");
  expect_error(change("'s'", "[]"), 7, "'source' is empty");
  expect_error(change("'Nothing.'", "''"), 6, "'differs' is empty");
  expect_error(change("differs", "difers"), 6, "did you mean 'differs'?");
  expect_error(change("'p'", "'P p'"), 2, "'P p' cannot be a preset's name");
  expect_error(kGood + kGood, 10, "two presets are called 'p'");
  expect_error(change("[[preset]]", "[[presets]]"), 1, "did you mean 'preset'?");
}

TEST_F(PresetFile, ThatIsMissing_MattersOnlyToWhoAsks) {
  EXPECT_NO_THROW(Catalogue(folder()).parse_requests("none,vsm"));
  EXPECT_EQ(error_of([&] { Catalogue(folder()).parse_requests("@p"); }).kind(), ErrorKind::kInput);
}

}  // namespace
}  // namespace shadowbench::filters
