// The run that measures both sides beside the window: what it gives, how it fails, and that it leaves nothing.

#include <signal.h>

#include <chrono>
#include <thread>

#include "harness/view/side_measurement.h"
#include "harness/view/workbench.h"
#include "report/records/format.h"
#include "tests/harness/view/view_fixture.h"

namespace shadowbench::test {
namespace {

namespace fs = std::filesystem;
using State = view::SideMeasurement::State;

double now_ms() {
  return 1e-6 * static_cast<double>(std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1));
}

class SideMeasurementTest : public ViewTest {
 protected:
  void SetUp() override {
    ViewTest::SetUp();
    setenv("TMPDIR", folder().c_str(), 1);
  }

  void TearDown() override {
    unsetenv("TMPDIR");
    ViewTest::TearDown();
  }

  view::ViewState make_state(const std::string& scene, const std::string& left, const std::string& right) const {
    options::RunOptions options = make_options();
    options.gpus = gpu::choose_gpus(gpu::load_gpus(options.resources.gpus), {"navi21"});
    view::ViewState state = view::make_view_state(options, scene, sides(left, right));
    change(state, [](view::ViewSettings& settings) { settings.cameras[0].position_ws.x += 0.0123f; });
    return state;
  }

  /// One that a child of the child measures for long, silently.
  view::ViewState make_endless_state() const {
    view::ViewState state = make_state("cubes", "none", "tent3x3");
    const std::string file = user_filter("endless.glsl");
    change(state, [&](view::ViewSettings& settings) { settings.sides[0].filter = request("endless", file); });
    return state;
  }

  /// Waits for the end of what runs, two minutes at most; what it says meanwhile is noted.
  State finish(std::vector<std::string>* said = nullptr) {
    State now = State::kRunning;
    const auto is_over = [&] {
      now = measurement_.poll();
      if (said && (said->empty() || said->back() != measurement_.text())) said->push_back(measurement_.text());
      return now != State::kRunning;
    };
    EXPECT_TRUE(wait_until(is_over, 12000)) << measurement_.text();
    return now;
  }

  void expect_nothing_left() const {
    expect_no_process();
    for (const auto& entry : fs::directory_iterator(folder()))
      EXPECT_THAT(entry.path().string(), Not(HasSubstr("shadowbench-view"))) << "left by the measurement";
  }

  /// The texels of the map under a pixel that the window shows, over those that count.
  static double find_median_texels(const view::ViewState& state, const view::MeasuredSides& sides) {
    view::Stage stage(shared_renderer(), state.scene);
    stage.draw(state, view::Changes::all());
    std::vector<float> texels = stage.texels_per_pixel(state).texels;
    for (std::size_t i = texels.size(); i-- > 0;)
      if (sides.truth_mask.texels[i] == 0.0f || texels[i] == 0.0f)
        texels.erase(texels.begin() + static_cast<std::ptrdiff_t>(i));
    std::ranges::sort(texels);
    return static_cast<double>(texels.at(texels.size() / 2));
  }

  static void expect_sum(const view::MeasuredSides& sides, const measure::MeasuredCell& cell) {
    ASSERT_EQ(cell.error_parts.size(), records::list_error_parts().size());
    std::size_t counted = 0;
    for (std::size_t i = 0; i < sides.truth.texels.size(); ++i) {
      if (sides.truth_mask.texels[i] == 0.0f) continue;
      ++counted;
      double sum = 0.0;
      for (const images::Image& part : cell.error_parts)
        if (!part.empty()) sum += static_cast<double>(part.texels[i]);
      ASSERT_NEAR(sum, static_cast<double>(cell.visibility.texels[i] - sides.truth.texels[i]), 1e-6) << i;
    }
    EXPECT_GT(counted, 10000u);
  }

  view::SideMeasurement measurement_{SHADOWBENCH_PROGRAM};
};

TEST_F(SideMeasurementTest, Finished_HasBothSides_WithPartsThatAddUpToTheError) {
  const view::ViewState state = make_state("cubes", "vsm:radius=6", "tent3x3");
  EXPECT_EQ(measurement_.poll(), State::kIdle);
  measurement_.start(state);
  std::vector<std::string> said;
  ASSERT_EQ(finish(&said), State::kFinished) << measurement_.text();
  EXPECT_THAT(said, Contains(HasSubstr("attribution of tent3x3")));
  const view::MeasuredSides& sides = measurement_.results();
  for (std::size_t side = 0; side < view::kSides; ++side) {
    const measure::MeasuredCell* cell = sides.find_side(side);
    ASSERT_NE(cell, nullptr);
    EXPECT_EQ(cell->record.filter, state.sides[side].filter.spec.id);
    EXPECT_TRUE(cell->visibility.texels == draw(state, side).texels) << "what is measured is what is shown";
    EXPECT_GT(cell->record.error.rmse.value(), 0.0);
    EXPECT_FALSE(cell->record.gpu) << "the window shows no costs";
    expect_sum(sides, *cell);
  }
  EXPECT_FALSE(sides.find_side(0)->stability.variance.empty());
  EXPECT_TRUE(sides.find_side(1)->stability.variance.empty()) << "tent3x3 stores none";
  EXPECT_NEAR(find_median_texels(state, sides), sides.find_side(0)->record.coverage.texels_per_pixel.value(), 1e-3);
  const images::Image truth = sides.truth, mask = sides.truth_mask;
  measurement_.start(state, view::Measurand::kTruthAlone);
  ASSERT_EQ(finish(), State::kFinished) << measurement_.text();
  EXPECT_EQ(measurement_.results().find_side(0), nullptr);
  EXPECT_EQ(measurement_.results().truth.texels, truth.texels);
  EXPECT_EQ(measurement_.results().truth_mask.texels, mask.texels);
  expect_nothing_left();
}

TEST_F(SideMeasurementTest, StartedTwice_MeasuresTheSecond_WhateverTheFirstWasDoing) {
  const view::ViewState first = make_state("cubes", "vsm:radius=6", "tent3x3");
  view::ViewState second = first;
  change(second, [](view::ViewSettings& settings) {
    settings.sides[0].truth = true;
    settings.cameras[0].position_ws.y += 0.5f;
  });
  measurement_.start(first);
  ASSERT_TRUE(wait_until([&] { return measurement_.poll() != State::kRunning || measurement_.text() != "starting"; }));
  measurement_.start(second);
  ASSERT_TRUE(wait_until([&] { return !list_processes().empty(); }));
  EXPECT_EQ(list_processes().size(), 1u) << "the first is gone";
  EXPECT_EQ(getpriority(PRIO_PROCESS, static_cast<id_t>(std::stoi(list_processes().at(0)))), 19);
  ASSERT_EQ(finish(), State::kFinished) << measurement_.text();
  const view::MeasuredSides& sides = measurement_.results();
  EXPECT_EQ(sides.find_side(0), nullptr) << "it shows the truth";
  ASSERT_NE(sides.find_side(1), nullptr);
  EXPECT_TRUE(sides.find_side(1)->visibility.texels == draw(second, 1).texels);
  expect_sum(sides, *sides.find_side(1));
  measurement_.start(first);
  ASSERT_EQ(finish(), State::kFinished) << measurement_.text();
  EXPECT_TRUE(measurement_.results().find_side(0)->visibility.texels == draw(first, 0).texels);
}

TEST_F(SideMeasurementTest, NothingThatFacesTheLight_LeavesFieldsAbsentWithReasons) {
  view::ViewState state = make_state("edge", "none", "tent3x3");
  change(state, [](view::ViewSettings& settings) {
    settings.lights[0] = scene::turn_light(settings.lights[0], [](const glm::vec3&) { return glm::vec3(0, 1, 0); });
    settings.cameras[0].forward_ws = glm::vec3(0.0f, -1.0f, 0.0f);
  });
  measurement_.start(state);
  ASSERT_EQ(finish(), State::kFinished) << measurement_.text();
  EXPECT_TRUE(measurement_.results().truth.empty());
  EXPECT_THAT(measurement_.results().no_truth, HasSubstr("faces the light"));
  const measure::MeasuredCell& cell = *measurement_.results().find_side(0);
  EXPECT_FALSE(cell.record.error.rmse.has_value());
  EXPECT_FALSE(cell.record.absent.at("error").empty());
  EXPECT_TRUE(std::ranges::all_of(cell.error_parts, &images::Image::empty));
}

TEST_F(SideMeasurementTest, FilterWithBrokenGlsl_FailsWithItsFileAndLine) {
  view::ViewState state = make_state("cubes", "none", "tent3x3");
  const std::string file = user_filter("broken_glsl.glsl");
  change(state, [&](view::ViewSettings& settings) { settings.sides[0].filter = request("broken_glsl", file); });
  measurement_.start(state);
  EXPECT_EQ(finish(), State::kFailed);
  EXPECT_THAT(measurement_.text(), HasSubstr("broken_glsl.glsl:"));
  EXPECT_THAT(measurement_.text(), Not(HasSubstr("\n0.0 %"))) << "nothing of what it said before";
  expect_nothing_left();
  change(state, [&](view::ViewSettings& settings) { settings.sides[0].filter = request("none"); });
  measurement_.start(state);
  EXPECT_EQ(finish(), State::kFinished) << measurement_.text();
}

TEST_F(SideMeasurementTest, ProgramThatIsNotThere_Fails) {
  view::SideMeasurement none(folder() / "none");
  none.start(make_state("cubes", "none", "tent3x3"));
  EXPECT_TRUE(wait_until([&] { return none.poll() == State::kFailed; }));
  EXPECT_THAT(none.text(), HasSubstr("cannot be started"));
}

TEST_F(SideMeasurementTest, Cancelled_IsKilledWithItsChildren_WithinATenthOfASecond) {
  const view::ViewState state = make_endless_state();
  double fastest_ms = 1e9;
  for (int attempt = 0; attempt < 3; ++attempt) {  // another process may hold this one up
    measurement_.start(state);
    ASSERT_TRUE(wait_until([&] { return !list_processes("--worker").empty(); })) << "a child of the child";
    const double begin_ms = now_ms();
    measurement_.cancel();
    fastest_ms = std::min(fastest_ms, now_ms() - begin_ms);
    EXPECT_THAT(list_processes("/measured.toml"), IsEmpty()) << "the run itself, at once";
    EXPECT_EQ(measurement_.poll(), State::kIdle);
    expect_nothing_left();
  }
  EXPECT_LT(fastest_ms, 100.0);
}

TEST_F(SideMeasurementTest, CancelledWhileResultsAreRead_WaitsForNoMoreThanOneImage) {
  view::ViewState state = make_state("cubes", "vsm:radius=6", "tent3x3");
  change(state, [](view::ViewSettings& settings) { settings.options.width = 960, settings.options.height = 540; });
  measurement_.start(state);
  ASSERT_TRUE(wait_until([&] { return measurement_.poll(), measurement_.text() == "reading the results"; }));
  const double begin_ms = now_ms();
  measurement_.cancel();
  EXPECT_LT(now_ms() - begin_ms, 150.0) << "an image of many";
  expect_nothing_left();
}

TEST_F(SideMeasurementTest, NeitherStartNorPoll_HoldsUpTheWindow) {
  const view::ViewState state = make_state("cubes", "vsm:radius=2", "vsm:radius=6");
  std::vector<double> times_ms;
  const auto time = [&](const auto& work) {
    const double begin_ms = now_ms();
    work();
    times_ms.push_back(now_ms() - begin_ms);
  };
  time([&] { measurement_.start(state); });
  State now = State::kRunning;
  while (now == State::kRunning) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    time([&] { now = measurement_.poll(); });
  }
  ASSERT_EQ(now, State::kFinished) << measurement_.text();
  for (std::size_t side = 0; side < view::kSides; ++side)
    EXPECT_TRUE(measurement_.results().find_side(side)->visibility.texels == draw(state, side).texels) << side;
  std::ranges::sort(times_ms);
  EXPECT_LT(times_ms[times_ms.size() * 99 / 100], 50.0);
}

TEST_F(SideMeasurementTest, WindowThatIsKilled_LeavesNoProcess_AndItsFilesGoWithTheNext) {
  const view::ViewState state = make_endless_state();
  const pid_t window = fork();
  if (window == 0) {
    measurement_.start(state);
    for (;;) pause();
  }
  ASSERT_TRUE(wait_until([&] { return !list_processes("--worker").empty(); }));
  std::this_thread::sleep_for(
      std::chrono::milliseconds(1500));  // by now nobody writes, and a closed pipe would not end them
  EXPECT_EQ(list_processes().size(), 2u);
  kill(window, SIGKILL);
  waitpid(window, nullptr, 0);
  expect_no_process();
  measurement_.start(state);
  measurement_.cancel();
  expect_nothing_left();
}

}  // namespace
}  // namespace shadowbench::test
