#include "harness/tune/tuning.h"

#include <stdexcept>
#include <tuple>

#include "harness/options/options.h"
#include "harness/scene/complete.h"
#include "harness/scene/load.h"
#include "harness/tune/tune_filters.h"
#include "harness/tune/tune_scene.h"
#include "tests/filters/filtered.h"
#include "tests/test_files.h"

namespace shadowbench::tune {
namespace {

SearchedParam make_param(double min, double max, double default_value, bool integer = false) {
  return {"p", min, max, default_value, integer};
}

/// What a search drew, beside what it found.
struct Watched {
  SearchResult result;
  std::vector<Evaluation> drawn;
};

Watched search(const std::vector<SearchedParam>& params, const Objective& objective, int budget = 80) {
  Watched watched;
  SearchSettings settings;
  settings.budget = budget;
  settings.on_evaluation = [&](const Evaluation& evaluation) { watched.drawn.push_back(evaluation); };
  watched.result = search_parameters({params.begin(), params.end()}, settings, objective);
  return watched;
}

TEST(ParamScale, IsLogarithmic_WhereTheRangeSpansTwoDecades) {
  const ParamScale log(make_param(1.0, 10000.0, 10.0)), linear(make_param(1.0, 99.0, 10.0));
  EXPECT_EQ(log.name(), "log");
  EXPECT_NEAR(log.to_value(0.5), 100.0, 1e-9);
  EXPECT_EQ(linear.name(), "linear");
  EXPECT_NEAR(linear.to_value(0.5), 50.0, 1e-9);
}

TEST(ParamScale, FromZero_TinyDefaultLiesInTheMiddle) {
  const ParamScale scale(make_param(0.0, 0.1, 1e-5));
  EXPECT_NEAR(scale.to_unit(1e-5), 0.5, 0.01);
  EXPECT_EQ(scale.to_value(0.0), 0.0);
  EXPECT_EQ(scale.to_value(1.0), 0.1);
  EXPECT_LT(scale.to_value(0.25), 1e-6);
}

TEST(ParamScale, OfEveryFilter_ReachesBothEndsAndTurnsBack) {
  int scales = 0;
  for (const filters::FilterRequest& request : filters::built_in().parse_requests("")) {
    for (const SearchedParam& param : list_searched_params(request)) {
      SCOPED_TRACE(request.spec.id + ":" + param.name);
      const ParamScale scale(param);
      EXPECT_EQ(scale.to_value(0.0), param.min);
      EXPECT_EQ(scale.to_value(1.0), param.max);
      EXPECT_EQ(scale.to_value(scale.to_unit(param.default_value)), param.default_value);
      EXPECT_NEAR(scale.measure_share(param.min, param.max), 1.0, 1e-12);
      for (double unit = 0.0; unit < 1.0; unit += 0.03) EXPECT_LE(scale.to_value(unit), scale.to_value(unit + 0.03));
      ++scales;
    }
  }
  EXPECT_GE(scales, 6);
}

TEST(ParamScale, Values_AreWholeOrOfFourDigits) {
  EXPECT_EQ(ParamScale(make_param(0.0, 10.0, 5.0, true)).to_value(0.333), 3.0);
  EXPECT_EQ(ParamScale(make_param(0.0, 1.0, 0.5)).to_value(1.0 / 3.0), 0.3333);
}

TEST(SearchParameters, FindsTheMinimum_OfWholeLogarithmicAndLinearNumbers) {
  const auto bowl = [](const std::vector<double>& v) {
    return 0.01 * std::pow(v[0] - 13.0, 2.0) + 0.1 * std::pow(std::log10(v[1]) + 3.0, 2.0) + std::pow(v[2] - 0.3, 2.0);
  };
  const Watched found =
      search({make_param(0.0, 64.0, 4.0, true), make_param(1e-6, 1.0, 0.5), make_param(0.0, 1.0, 0.9)}, bowl, 150);
  EXPECT_EQ(found.result.best[0], 13.0);
  EXPECT_NEAR(std::log10(found.result.best[1]), -3.0, 0.1);
  EXPECT_NEAR(found.result.best[2], 0.3, 0.02);
}

/// The default lies in a valley of its own, the deeper one is elsewhere.
TEST(SearchParameters, LeavesALocalMinimum) {
  const auto valleys = [](const std::vector<double>& v) {
    return 1.0 - std::exp(-std::pow((v[0] - 0.8) / 0.1, 2.0)) - 0.5 * std::exp(-std::pow((v[0] - 0.2) / 0.2, 2.0));
  };
  const Watched found = search({make_param(0.0, 1.0, 0.2)}, valleys, 40);
  EXPECT_NEAR(found.result.best[0], 0.8, 0.01);
  const auto by_search = [](const Evaluation& e) { return e.stage != "range" && std::abs(e.values[0] - 0.8) < 0.01; };
  EXPECT_TRUE(std::any_of(found.drawn.begin(), found.drawn.end(), by_search));
}

TEST(SearchParameters, IsNeverWorseThanTheDefault) {
  const double hidden = 0.123456789;  // not of four digits: no step of the search comes there
  const Watched found = search({make_param(0.0, 1.0, hidden)},
                               [&](const std::vector<double>& v) { return std::sqrt(std::abs(v[0] - hidden)); });
  EXPECT_EQ(found.result.best[0], hidden);
  EXPECT_EQ(found.result.default_error, found.result.best_error);
}

TEST(SearchParameters, KeepsTheBudget_AndDrawsNoSettingTwice) {
  const auto bowl = [](const std::vector<double>& v) {
    return 1.0 + std::pow(v[0] - 3.0, 2.0) + std::pow(v[1] - 0.4, 2.0);
  };
  for (const int budget : {1, 2, 7, 30}) {
    const Watched found = search({make_param(0.0, 20.0, 10.0, true), make_param(0.0, 1.0, 0.0)}, bowl, budget);
    int searched = 0;
    std::set<std::vector<double>> settings;
    for (const Evaluation& evaluation : found.drawn) {
      searched += evaluation.stage != "range" ? 1 : 0;
      EXPECT_TRUE(settings.insert(evaluation.values).second);
    }
    EXPECT_LE(searched, budget);
    EXPECT_EQ(found.result.search_evaluations, searched);
    EXPECT_EQ(found.result.evaluations, static_cast<int>(found.drawn.size()));
    EXPECT_EQ(found.drawn.front().stage, "default");
  }
}

/// A few whole numbers are soon all known: the search ends.
TEST(SearchParameters, EndsWhereAllSettingsAreDrawn) {
  const Watched found = search(
      {make_param(0.0, 3.0, 1.0, true)}, [](const std::vector<double>& v) { return 3.0 - v[0]; }, 1000);
  EXPECT_EQ(found.result.best[0], 3.0);
  EXPECT_EQ(found.drawn.size(), 4u);
}

TEST(SearchParameters, IsDeterministic) {
  const auto waves = [](const std::vector<double>& v) { return 2.0 + std::sin(9.0 * v[0]) * std::cos(7.0 * v[1]); };
  const std::vector<SearchedParam> params = {make_param(0.0, 1.0, 0.5), make_param(0.0, 1.0, 0.5)};
  const Watched a = search(params, waves), b = search(params, waves);
  ASSERT_EQ(a.drawn.size(), b.drawn.size());
  for (std::size_t i = 0; i < a.drawn.size(); ++i) EXPECT_EQ(a.drawn[i].values, b.drawn[i].values);
}

TEST(SearchParameters, PassesOnWhatTheObjectiveThrows) {
  int calls = 0;
  const auto breaks = [&](const std::vector<double>&) -> double {
    if (++calls == 5) throw std::domain_error("broken");
    return 1.0;
  };
  EXPECT_THROW(search({make_param(0.0, 1.0, 0.5)}, breaks), std::domain_error);
}

/// 1 + (u - 1/2)^2 <= 1.1 for |u - 1/2| <= sqrt(0.1).
TEST(GoodRange, HasTheWidthOfTheClosedForm_OnALinearScale) {
  const Watched found =
      search({make_param(0.0, 1.0, 0.5)}, [](const std::vector<double>& v) { return 1.0 + std::pow(v[0] - 0.5, 2.0); });
  const GoodRange& range = found.result.ranges.front();
  ASSERT_EQ(range.intervals.size(), 1u);
  EXPECT_NEAR(range.intervals[0].low, 0.5 - std::sqrt(0.1), 1.0 / 256.0);
  EXPECT_NEAR(range.intervals[0].high, 0.5 + std::sqrt(0.1), 1.0 / 256.0);
  EXPECT_NEAR(range.share, 2.0 * std::sqrt(0.1), 2.0 / 256.0);
  EXPECT_FALSE(range.no_effect);
}

TEST(GoodRange, HasTheWidthOfTheClosedForm_OnALogarithmicScale) {
  const Watched found = search({make_param(0.01, 1e4, 10.0)}, [](const std::vector<double>& v) {
    return 1.0 + std::pow(std::log10(v[0]) - 1.0, 2.0);
  });
  const GoodRange& range = found.result.ranges.front();
  EXPECT_NEAR(std::log10(range.intervals.at(0).low), 1.0 - std::sqrt(0.1), 6.0 / 256.0);
  EXPECT_NEAR(std::log10(range.intervals.at(0).high), 1.0 + std::sqrt(0.1), 6.0 / 256.0);
  EXPECT_NEAR(range.share, 2.0 * std::sqrt(0.1) / 6.0, 2.0 / 256.0);
}

/// 1 + (n - 7)^2 / 25 <= 1.1 for n = 6, 7, 8: three of a hundred steps.
TEST(GoodRange, OfWholeNumbers_IsExact) {
  const Watched found = search({make_param(0.0, 100.0, 50.0, true)},
                               [](const std::vector<double>& v) { return 1.0 + 0.04 * std::pow(v[0] - 7.0, 2.0); });
  const GoodRange& range = found.result.ranges.front();
  ASSERT_EQ(range.intervals.size(), 1u);
  EXPECT_EQ(range.intervals[0].low, 6.0);
  EXPECT_EQ(range.intervals[0].high, 8.0);
  EXPECT_NEAR(range.share, 0.03, 1e-12);
}

TEST(GoodRange, WithAHole_HasTwoIntervals) {
  const auto valleys = [](const std::vector<double>& v) {
    return 1.0 + 4.0 * std::min(std::pow(v[0] - 0.25, 2.0), std::pow(v[0] - 0.75, 2.0));
  };
  const GoodRange range = search({make_param(0.0, 1.0, 0.5)}, valleys).result.ranges.front();
  ASSERT_EQ(range.intervals.size(), 2u);
  EXPECT_NEAR(range.intervals[0].high, 0.25 + std::sqrt(0.025), 1.0 / 256.0);
  EXPECT_NEAR(range.intervals[1].low, 0.75 - std::sqrt(0.025), 1.0 / 256.0);
  EXPECT_NEAR(range.share, 4.0 * std::sqrt(0.025), 4.0 / 256.0);
}

TEST(GoodRange, OfAParameterThatIsNotUsed_IsAllOfIt) {
  const Watched found = search({make_param(0.0, 1.0, 0.5), make_param(0.0, 0.1, 1e-5)},
                               [](const std::vector<double>& v) { return 1.0 + v[0]; });
  EXPECT_FALSE(found.result.ranges[0].no_effect);
  EXPECT_TRUE(found.result.ranges[1].no_effect);
  EXPECT_NEAR(found.result.ranges[1].share, 1.0, 1e-12);
}

/// With a budget of 1 only the default is drawn; the scan then meets the valley, which becomes the best.
TEST(GoodRange, ThatMeetsSomethingBetter_MovesTheBest) {
  const Watched found = search(
      {make_param(0.0, 1.0, 0.9)}, [](const std::vector<double>& v) { return 0.1 + std::abs(v[0] - 0.25); }, 1);
  EXPECT_NEAR(found.result.best[0], 0.25, 1e-9);
  EXPECT_LE(found.result.ranges[0].intervals.at(0).low, 0.25);
  EXPECT_NEAR(found.result.ranges[0].share, 0.02, 2.0 / 256.0);
  EXPECT_EQ(found.result.search_evaluations, 1);
}

TEST(TunePadding, IsWhatTheWidestKernelNeeds_UpToA64thOfTheMap) {
  EXPECT_EQ(choose_tune_padding(4.0, 1024), 5.0);
  EXPECT_EQ(choose_tune_padding(64.0, 1024), 16.0);
  EXPECT_EQ(choose_tune_padding(64.0, 64), 4.0);
  EXPECT_EQ(find_widest_kernel(filters::built_in().parse_requests("vsm,esm:radius=3")), 64.0);
  EXPECT_EQ(find_widest_kernel(filters::built_in().parse_requests("esm:radius=3")), 3.0);
}

TEST(SearchedParams, AreNumbersWithARange_NeitherConstNorSet) {
  const auto names = [&](const std::string& text) {
    std::string joined;
    for (const SearchedParam& param : list_searched_params(filters::request_of(text))) joined += param.name + " ";
    return joined;
  };
  EXPECT_EQ(names("none"), "");
  EXPECT_EQ(names("poisson"), "radius ");  // taps are const, rotation is a text
  EXPECT_EQ(names("esm:c=20"), "radius ");
  EXPECT_EQ(names("esm:store=r16f"), "radius c ");
}

TEST(SearchedParams, OfCascades_AreWhatTheUserDidNotSet) {
  const auto names = [](const std::string& fit, const std::set<std::string>& fixed) {
    std::string joined;
    for (const SearchedParam& param : list_searched_params(scene::parse_fit_rule(fit), fixed))
      joined += param.name + " ";
    return joined;
  };
  EXPECT_EQ(names("view", {}), "");
  EXPECT_EQ(names("cascades", {}), "split blend ");
  EXPECT_EQ(names("cascades:count=3,split=0.8", {"count", "split"}), "blend ");
  EXPECT_EQ(names("cascades:splits=5/20", {"splits"}), "blend ");
}

scene::Scene load_scene(const std::string& name) {
  return scene::load(name, {.scenes_folder = options::find_resources().scenes});
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::length(a - b), tolerance);
}

TEST(TuneViews, UnseenOnes_AreNoneOfTheTrainingOnes) {
  std::set<std::tuple<double, double>> views;
  int training = 0;
  bool other_light = false;
  for (const TuneView& view : tune_views()) {
    EXPECT_TRUE(views.emplace(view.camera_turn_deg, view.light_turn_deg).second) << view.name();
    training += view.training ? 1 : 0;
    other_light = other_light || (!view.training && view.light_turn_deg != 0.0);
  }
  EXPECT_GE(training, 3);
  EXPECT_GT(static_cast<int>(views.size()), training);
  EXPECT_TRUE(other_light);
}

TEST(TuneViews, Words_NameEveryView) {
  EXPECT_EQ(describe_tune_views(true), "camera -20, as it is, camera +20");
  EXPECT_EQ(describe_tune_views(false), "camera -30, camera -10, camera +10, camera +30, light -15, light +15");
}

TEST(TurnCamera, KeepsHeightAndDistance_AndStillLooksAtThePivot) {
  for (const char* name : {"cubes", "stack", "fence", "ball", "steps"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = load_scene(name);
    const scene::Camera& camera = scene.cameras.front();
    const glm::vec3 pivot = find_pivot(scene, camera);
    const float distance = glm::length(pivot - camera.position_ws);
    expect_near(camera.position_ws + distance * camera.forward_ws, pivot, 1e-4f);
    for (const double degrees : {-30.0, 20.0, 90.0}) {
      const scene::Camera turned = turn_camera(camera, pivot, degrees);
      EXPECT_FLOAT_EQ(turned.position_ws.y, camera.position_ws.y);
      expect_near(turned.position_ws + distance * turned.forward_ws, pivot, 1e-4f);
      EXPECT_NEAR(glm::dot(turned.forward_ws, turned.up_ws), glm::dot(camera.forward_ws, camera.up_ws), 1e-5f);
    }
  }
}

TEST(TurnCamera, TurnsAsAnAzimuthGrows) {
  scene::Camera camera;
  camera.position_ws = {0.0f, 2.0f, 5.0f};
  camera.forward_ws = {0.0f, 0.0f, -1.0f};
  const scene::Camera turned = turn_camera(camera, {0.0f, 1.0f, 0.0f}, 90.0);
  expect_near(turned.position_ws, {5.0f, 2.0f, 0.0f});
  expect_near(turned.forward_ws, {-1.0f, 0.0f, 0.0f});
}

TEST(FindPivot, WithTheSceneBehindTheCamera_IsItsMiddle) {
  scene::Scene scene = load_scene("cubes");
  scene::Camera camera = scene.cameras.front();
  camera.forward_ws = -camera.forward_ws;
  const scene::Bounds bounds = scene.bounds();
  expect_near(find_pivot(scene, camera), 0.5f * (bounds.min + bounds.max));
}

TEST(FindPivot, OfACameraWithinTheScene_IsItsOwnPlace) {
  const scene::Scene scene = load_scene("avenue");
  const scene::Camera& camera = scene.cameras.front();
  expect_near(find_pivot(scene, camera), camera.position_ws);
}

TEST(MakeTuneScene, TurnsTheLightInAzimuth_AndNamesItsCameras) {
  scene::Scene scene = load_scene("cubes");
  scene.light.kind = scene::Sun{glm::vec3(scene::light_direction(70.0, 40.0))};
  const scene::Scene turned = turn_scene(scene, {{10.0, 15.0, false}, {0.0, 15.0, false}});
  expect_near(-scene::to_light(turned.light, {}), glm::vec3(scene::light_direction(85.0, 40.0)));
  ASSERT_EQ(turned.cameras.size(), 2u);
  EXPECT_EQ(turned.cameras[0].name, "camera +10 light +15");
  expect_near(turned.cameras[1].position_ws, scene.cameras.front().position_ws);
  EXPECT_EQ(turned.meshes.size(), scene.meshes.size());
}

/// The view as it is, is the scene's own to the bit: its truth is that of 'run'.
TEST(MakeTuneScene, WithoutATurn_ChangesNothing) {
  const scene::Scene scene = load_scene("fence");
  const scene::Scene same = turn_scene(scene, {{0.0, 0.0, true}});
  EXPECT_EQ(same.cameras.front().position_ws, scene.cameras.front().position_ws);
  EXPECT_EQ(same.cameras.front().forward_ws, scene.cameras.front().forward_ws);
  EXPECT_EQ(scene::to_light(same.light, {}), scene::to_light(scene.light, {}));
}

class TunedParameters : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const { return folder_.write("tuned.json", text); }

  /// A file with these entries as its filters.
  std::filesystem::path write_filters(const std::string& filters) const {
    return write(R"({"schema_version": 2, "metric": "rmse", "map_size": 1024, "filters": [)" + filters + "]}");
  }

  /// A file with what was found of one filter.
  std::filesystem::path write_found(const std::string& params, const std::string& id = "vsm") const {
    return write_filters(fmt::format(R"({{"id": "{}", "fit": "tight", "params": {}}})", id, params));
  }

  /// The values of the first request after the file was applied.
  filters::FilterRequest apply(const std::string& requests, const std::filesystem::path& file) {
    auto parsed = filters::built_in().parse_requests(requests);
    notes_ = apply_tuned(parsed, filters::built_in(), file, {1024}, {{}});
    return parsed.front();
  }

  void expect_refusal(const std::filesystem::path& file, const std::string& words) {
    EXPECT_THAT(error_of([&] { apply("vsm", file); }), is_error(ErrorKind::kInput, words, "tuned.json")) << words;
  }

  TestFolder folder_;
  std::vector<std::string> notes_;
};

TEST_F(TunedParameters, AreTaken_AndShownByTheLabel) {
  const auto file = write_found(R"({"radius": 2, "min_variance": 1e-6, "store": "rg32f"})");
  const filters::FilterRequest request = apply("vsm", file);
  EXPECT_EQ(filters::number(request.values, "radius"), 2.0);
  EXPECT_EQ(filters::number(request.values, "min_variance"), 1e-6);
  EXPECT_EQ(filters::number(request.values, "bleed_reduction"), 0.3);  // not in the file
  EXPECT_EQ(request.label(), "vsm (min_variance=1e-06, radius=2)");
  EXPECT_TRUE(notes_.empty());
}

TEST_F(TunedParameters, YieldToTheCommandLine) {
  const filters::FilterRequest request = apply("vsm:radius=9", write_found(R"({"radius": 2, "min_variance": 1e-6})"));
  EXPECT_EQ(filters::number(request.values, "radius"), 9.0);
  EXPECT_EQ(filters::number(request.values, "min_variance"), 1e-6);
}

TEST_F(TunedParameters, TakeThePlaceOfAWidthsRadius) {
  const filters::FilterRequest request = apply("vsm:width=medium", write_found(R"({"radius": 2})"));
  EXPECT_EQ(filters::number(request.values, "radius"), 2.0);
  EXPECT_EQ(request.label(), "vsm (radius=2)");
}

TEST_F(TunedParameters, LeaveAPresetTheParametersOfItsEngine) {
  const auto file = write_found(R"({"bail": "agree"})", "poisson");
  EXPECT_EQ(apply("@godot", file).values, filters::request_of("@godot").values);
  EXPECT_TRUE(notes_.empty());
  EXPECT_EQ(filters::text_or(apply("poisson", file).values, "bail", ""), "agree");
}

TEST_F(TunedParameters, OfOtherFilters_LeaveTheDefaults_WithANote) {
  const filters::FilterRequest request = apply("esm,none", write_found(R"({"radius": 2})"));
  EXPECT_EQ(request.values, filters::default_values(request.spec));
  ASSERT_EQ(notes_.size(), 1u);  // 'none' has no parameters: nothing to say
  EXPECT_THAT(notes_.front(), HasSubstr("no parameters for esm"));
}

TEST_F(TunedParameters, OfAnotherMapSize_AreTakenWithANote) {
  auto requests = filters::built_in().parse_requests("vsm");
  const auto notes = apply_tuned(requests, filters::built_in(), write_found(R"({"radius": 2})"), {512, 1024}, {{}});
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes.front(), HasSubstr("1024 texels, this run draws 512"));
}

TEST_F(TunedParameters, OfAnotherFit_AreTakenWithANote) {
  auto requests = filters::built_in().parse_requests("vsm");
  const auto file = write_filters(R"({"id": "vsm", "params": {"radius": 2}, "fit": "view"})");
  EXPECT_THAT(apply_tuned(requests, filters::built_in(), file, {1024}, {{}}),
              ElementsAre(HasSubstr("tuned for vsm (radius=2) under --fit view, which this run does not draw")));
  EXPECT_THAT(apply_tuned(requests, filters::built_in(), file, {1024}, {{}, {scene::FitMode::kView, {}}}), IsEmpty());
}

TEST_F(TunedParameters, BadFiles_AreRefusedWithTheField) {
  expect_refusal(folder_.path() / "no" / "tuned.json", "cannot be opened");
  expect_refusal(write(""), "not complete JSON");
  expect_refusal(write(R"({"schema_version": 2, "met)"), "cut off");
  expect_refusal(write("[]"), "'schema_version' is missing");
  expect_refusal(write("{}"), "'schema_version' is missing");
  expect_refusal(write(R"({"schema_version": 1})"), "schema_version is 1, and this program reads 2");
  expect_refusal(write(R"({"schema_version": 2, "metric": "rmse", "map_size": "big", "filters": []})"),
                 "'map_size' holds \"big\"");
  expect_refusal(write(R"({"schema_version": 2, "metric": "rmse", "map_size": 64, "filters": {}})"),
                 "'filters' must be a list");
  expect_refusal(write_found(R"({})", "vsn"), "filters[0].id: unknown filter 'vsn'; did you mean 'vsm'?");
  expect_refusal(write_filters(R"({"id": "vsm"})"), "'filters[0].params' is missing");
  expect_refusal(write_found(R"({"radios": 2})"),
                 "filters[0].params.radios: filter 'vsm' has no parameter 'radios'; did you mean 'radius'?");
  expect_refusal(write_found(R"({"radius": 65})"), "filters[0].params.radius: vsm:radius=65 is out of range");
  expect_refusal(write_found(R"({"radius": 2.5})"), "must be a whole number");
  expect_refusal(write_found(R"({"radius": "wide"})"),
                 "filters[0].params.radius: vsm:radius='wide' is not a finite number");
  expect_refusal(write_found(R"({"radius": [2]})"), "'filters[0].params' holds {\"radius\":[2]}");
  expect_refusal(write_found(R"({"store": "rgb"})"), "filters[0].params.store");
  expect_refusal(
      write_filters(R"({"id": "vsm", "fit": "tight", "params": {}}, {"id": "vsm", "fit": "tight", "params": {}})"),
      "filters[1].id names 'vsm' a second time");
  expect_refusal(
      write_filters(
          R"({"id": "none", "fit": "tight", "params": {}}, {"id": "esm", "fit": "tight", "params": {"c": 0}})"),
      "filters[1].params.c");  // though not requested
}

}  // namespace
}  // namespace shadowbench::tune
