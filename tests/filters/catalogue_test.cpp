#include "filters/catalogue.h"

#include "filters/kernel.h"
#include "filters/model.h"
#include "tests/filters/filtered.h"
#include "tests/test_files.h"

namespace shadowbench::filters {
namespace {

using ::testing::IsSupersetOf;

void expect_usage_error(const std::string& text, const std::string& words) {
  EXPECT_THAT(error_of([&] { built_in().parse_requests(text); }), is_error(ErrorKind::kUsage, words)) << text;
}

TEST(Catalogue, EveryBuiltInFilter_HasAModelAndASource) {
  for (const FilterSpec& spec : built_in().filters()) {
    EXPECT_NE(find_model(spec), nullptr) << spec.id;
    EXPECT_FALSE(spec.source.empty()) << spec.id;
  }
  EXPECT_EQ(built_in().filters().front().id, "none");
}

TEST(Catalogue, EveryModel_HasItsFilter) {
  for (const auto& [id, model] : model_table()) EXPECT_NO_THROW(built_in().find(id)) << id;
}

std::vector<std::string> ids_of(const std::string& text) {
  std::vector<std::string> ids;
  for (const FilterRequest& request : built_in().parse_requests(text)) ids.push_back(request.spec.id);
  return ids;
}

TEST(Requests, AllAreThoseThatAreNotForTeaching_Empty_AsksForThem) {
  EXPECT_THAT(ids_of("teaching"), UnorderedElementsAre("box3x3", "teach4x4", "teach_evsm"));
  EXPECT_EQ(ids_of(""), ids_of("all"));
  EXPECT_THAT(ids_of("all"), IsSupersetOf({"none", "box4x4", "vsm"}));
  EXPECT_EQ(ids_of("all,teaching").size(), built_in().filters().size());
  EXPECT_THAT(ids_of("teach4x4"), ElementsAre("teach4x4")) << "named, it is drawn";
}

TEST(Requests, AWidth_IsItsRadius) {
  const auto requests = built_in().parse_requests("vsm:width=medium,bleed_reduction=0.2,poisson:width=1.2");
  ASSERT_EQ(requests.size(), 2u);
  EXPECT_EQ(requests[0].label(), "vsm (bleed_reduction=0.2, radius=1)");
  EXPECT_EQ(requests[0].width, "medium");
  EXPECT_EQ(requests[1].label(), "poisson (radius=2.257)");
}

TEST(Requests, AWidth_CountsWithTheOtherParameters) {
  // Read with the nearest texel, a kernel is narrower: 0.54 texels with a radius of 1, 1.00 with 2.
  for (const char* text : {"esm:width=0.78,combine=log", "esm:combine=log,width=0.78"})
    EXPECT_EQ(number(request_of(text).values, "radius"), 2.0) << text;
  EXPECT_EQ(number(request_of("esm:width=0.78").values, "radius"), 1.0);
}

TEST(Requests, ParametersBelongToTheFilterBefore) {
  const auto requests = built_in().parse_requests("none,vsm:radius=8,min_variance=1e-4,esm:combine=log");
  ASSERT_EQ(requests.size(), 3u);
  EXPECT_EQ(number(requests[1].values, "radius"), 8.0);
  EXPECT_EQ(number(requests[1].values, "min_variance"), 1e-4);
  EXPECT_EQ(number(requests[1].values, "bleed_reduction"), 0.3);
  EXPECT_EQ(requests[1].label(), "vsm (min_variance=0.0001, radius=8)");
  EXPECT_EQ(text_or(requests[2].values, "combine", ""), "log");
  EXPECT_THAT(requests[1].set_by_user, ElementsAre("min_variance", "radius"));
}

TEST(Requests, Mistakes_AreNamed) {
  expect_usage_error("pcf2x3", "did you mean 'pcf2x2'");
  expect_usage_error("vsm:radus=3", "did you mean 'radius'");
  expect_usage_error("vsm:radius=65", "0 .. 64 texels");
  expect_usage_error("vsm:radius=2.5", "whole number");
  expect_usage_error("vsm:radius=inf", "finite");
  expect_usage_error("vsm:radius=3x", "finite");
  expect_usage_error("vsm:radius", "PARAM=VALUE");
  expect_usage_error("radius=3", "before any filter");
  expect_usage_error("none,,vsm", "empty filter name");
  expect_usage_error("none:radius=3", "no parameter 'radius'");
  expect_usage_error("esm:combine=logs", "linear, log");
  expect_usage_error("vsm:width=40", "choose a class (sharp, medium, soft, light) or 0.408 .. 28.3 texels");
  expect_usage_error("vsm:width=0.2", "0.408 .. 28.3 texels");
  expect_usage_error("vsm:width=-1", "0.408 .. 28.3 texels");
  expect_usage_error("vsm:width=nan", "no number of texels");
  expect_usage_error("vsm:width=medum", "did you mean 'medium'");
  expect_usage_error("tent3x3:width=medium", "no radius that a width could set; its kernel is 0.645 texels wide");
  expect_usage_error("vsm:radius=2,width=soft", "sets 'radius' and 'width'");
}

TEST(SetWidths, ReachWhatWasToldNoneAndHasAChoice) {
  const std::string text = "none,vsm,vsm:radius=6,esm:width=medium,@godot,pcss";
  std::vector<FilterRequest> soft = built_in().parse_requests(text), light = soft;
  const FilterRequest preset = soft[4];
  set_widths(soft, "soft");
  EXPECT_EQ(number(soft[1].values, "radius"), 3.0);
  EXPECT_EQ(number(soft[2].values, "radius"), 6.0);
  EXPECT_EQ(number(soft[3].values, "radius"), 1.0);
  EXPECT_EQ(soft[4].values, preset.values);

  set_widths(light, std::string(kLightWidth));
  for (FilterRequest& each : light) each.take_light_width(5.0);
  const auto is_of_light = [](const FilterRequest& each) { return each.width == kLightWidth; };
  EXPECT_EQ(number(light[1].values, "radius"), 11.0);
  EXPECT_EQ(*light[1].param_by_light(), "radius");
  EXPECT_EQ(number(light[2].values, "radius"), 6.0);
  EXPECT_FALSE(is_of_light(light[2]));
  EXPECT_EQ(number(light[3].values, "radius"), 1.0);
  EXPECT_EQ(light[4].values, preset.values);
  for (const std::size_t fixed : {0u, 4u, 5u}) {
    EXPECT_TRUE(is_of_light(light[fixed])) << fixed;
    EXPECT_EQ(light[fixed].param_by_light(), nullptr) << fixed;
  }
}

TEST(SetWidths, OneByTheLight_IsNotTheFilterWithThatRadius) {
  const auto requests = built_in().parse_requests("vsm,vsm:width=light");
  EXPECT_EQ(requests[0].values, requests[1].values) << "the light is not asked yet";
  EXPECT_FALSE(is_same(requests[0], requests[1]));
}

TEST(UserFile, WithATakenId_IsRefused) {
  Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  EXPECT_THROW(catalogue.add_user_file(SHADOWBENCH_SOURCE_DIR "/filters/vsm.glsl"), Error);
}

TEST(UserFile, NamedAsAWordWithAMeaning_IsRefused) {
  const TestFolder folder;
  for (const char* name : {"truth.glsl", "all.glsl", "teaching.glsl"}) {
    std::filesystem::copy_file(SHADOWBENCH_SOURCE_DIR "/filters/none.glsl", folder.path() / name);
    Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
    EXPECT_THROW(catalogue.add_user_file(folder.path() / name), Error) << name;
  }
}

TEST(UserFile, HasNoWidth) {
  Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  catalogue.add_user_file(SHADOWBENCH_SOURCE_DIR "/tests/user_filters/nine_compares.glsl");
  const FilterRequest request = catalogue.parse_requests("nine_compares").front();
  EXPECT_EQ(find_kernel_sigma(request.spec, request.values), std::nullopt);
}

std::vector<std::string> labels_of(const std::string& text) {
  std::vector<std::string> labels;
  for (const FilterRequest& request : built_in().parse_requests(text)) labels.push_back(request.label());
  return labels;
}

std::vector<std::string> presets_of(const FilterRequest& request) {
  std::vector<std::string> names;
  for (const Preset& preset : request.presets) names.push_back(preset.name);
  return names;
}

TEST(ShippedPresets, AreFiltersOfOurs_WithSourceAndVersion) {
  const std::vector<Preset> presets = built_in().presets();
  ASSERT_GE(presets.size(), 12u);
  for (const Preset& preset : presets) {
    const auto requests = built_in().parse_requests("@" + preset.name);
    ASSERT_EQ(requests.size(), 1u) << preset.name << " is the beginning of another name";
    EXPECT_THAT(presets_of(requests.front()), ElementsAre(preset.name));
    for (const std::string& source : preset.sources) EXPECT_THAT(source, StartsWith("https://")) << preset.name;
    EXPECT_THAT(preset.differs, EndsWith(".")) << preset.name << ": whole sentences";
    // A release is a number; otherwise every file that was read stands with its commit.
    if (preset.version.find("addresses") == std::string::npos) continue;
    for (const std::string& source : preset.sources)
      EXPECT_THAT(source, ContainsRegex("/blob/[0-9a-f]{40}/")) << preset.name;
  }
}

TEST(Presets, StandAmongFilters_ABeginningForAll) {
  EXPECT_THAT(labels_of("none,@unity-hdrp,vsm:radius=2"),
              ElementsAre("none", "tent5x5", "tent7x7", "pcss (rotation=interleaved-gradient, search_taps=32, taps=16)",
                          "vsm (radius=2)"));
  EXPECT_THAT(labels_of("@three.js"),
              ElementsAre("poisson (pattern=vogel, radius=1, rotation=interleaved-gradient, taps=5)"));
  EXPECT_THAT(labels_of("@unity-hdrp-medium"), ElementsAre("tent7x7"));
  EXPECT_THAT(labels_of("@unity"), ElementsAre("tent5x5", "tent7x7", StartsWith("pcss"), "tent3x3"));
}

TEST(Presets, OfOneFilter_AreOneRequest) {
  for (const char* text :
       {"@playcanvas,@filament", "castano3,@playcanvas,@filament", "@playcanvas,@filament,castano3"}) {
    const auto requests = built_in().parse_requests(text);
    ASSERT_EQ(requests.size(), 1u) << text;
    EXPECT_THAT(presets_of(requests.front()), ElementsAre("playcanvas", "filament")) << text;
  }
  EXPECT_EQ(built_in().parse_requests("castano3,castano3").size(), 2u) << "what is named twice is told, as ever";
  EXPECT_TRUE(request_of("castano3").presets.empty());
}

TEST(Presets, SayWhatTheyLack_AndTheEnginesBias) {
  const Preset preset = choose_presets(built_in().presets(), "playcanvas").front();
  EXPECT_EQ(write_bias_options(preset), "--bias polygon-offset:factor=0.5,units=0.5 --bias constant:depth=1e-4");
  const std::string text = describe_preset(preset);
  for (const std::string& part : {std::string("@playcanvas is castano3"), preset.differs, preset.bias,
                                  "but this does: " + write_bias_options(preset)})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_THAT(describe_preset(choose_presets(built_in().presets(), "godot").front()), EndsWith("nor can --bias"));
}

TEST(Presets, Mistakes_AreNamed) {
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
    for (const char* name : {"none.glsl", "vsm.glsl"})
      std::filesystem::copy_file(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "filters" / name, folder() / name);
  }

  /// What asking for the preset 'p' answers where its file is this.
  Error ask(const std::string& text) const {
    folder_.write("presets.toml", text);
    return error_of([&] { Catalogue(folder()).parse_requests("none,@p"); });
  }
  std::filesystem::path file() const { return folder() / "presets.toml"; }
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  TestFolder folder_;
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
    EXPECT_THAT(ask(text), is_error(ErrorKind::kInput, file().string() + ":" + std::to_string(line) + ": ", words))
        << text;
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
