// Every lesson shows the fault that it names, by its metric, and reads the map where it lies.

#include <chrono>
#include <thread>

#include "harness/view/lessons.h"
#include "harness/view/side_measurement.h"
#include "harness/view/stage.h"
#include "reference/metrics/error_stats.h"
#include "tests/harness/view/view_fixture.h"

namespace shadowbench::test {
namespace {

using State = view::SideMeasurement::State;

class LessonsTest : public ViewTest {
 protected:
  static filters::Catalogue& catalogue() {
    static filters::Catalogue all(options::find_resources().filters);
    return all;
  }

  static view::Lesson find(const std::string& title) {
    for (view::Lesson& lesson : view::read_lessons(options::find_resources().lessons))
      if (lesson.title == title) return lesson;
    ADD_FAILURE() << "there is no lesson '" << title << "'";
    return {};
  }

  view::ViewState make_state(const view::Lesson& lesson, bool instead = false, int width = 480) const {
    view::ViewState state = view::make_lesson_state(lesson, make_options(width, width * 9 / 16), catalogue());
    if (instead) change(state, [&](view::ViewSettings& settings) { set_shared(settings, lesson.instead); });
    state.options.attribution = false;
    return state;
  }

  /// What the window measures of a state, in a run of its own.
  static view::MeasuredSides measure(const view::ViewState& state) {
    view::SideMeasurement measurement(SHADOWBENCH_PROGRAM);
    measurement.start(state);
    for (int i = 0; i < 12000 && measurement.poll() == State::kRunning; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(measurement.poll(), State::kFinished) << measurement.text();
    return measurement.results();
  }

  static const records::CellRecord& record(const view::MeasuredSides& sides, std::size_t side) {
    return sides.find_side(side)->record;
  }

  static glm::ivec2 find_pixel(const view::ViewState& state, const glm::vec3& point_ws) {
    return glm::ivec2(find_place(state, point_ws) * glm::vec2(state.options.width, state.options.height));
  }

  static void expect_lit_where_the_map_is_read(const view::Lesson& lesson, const view::ViewState& state,
                                               const view::MeasuredSides& sides, float more_than) {
    const glm::ivec2 pixel = find_pixel(state, lesson.reading.place_ws);
    EXPECT_EQ(*sides.truth.at(pixel.x, pixel.y), 0.0f);
    EXPECT_GT(*sides.find_side(lesson.reading.side)->visibility.at(pixel.x, pixel.y), more_than);
  }
};

TEST_F(LessonsTest, Each_ReadsTheMapForAReceiverThatIsSeen) {
  const auto lessons = view::read_lessons(options::find_resources().lessons);
  EXPECT_EQ(lessons.size(), 5u);
  for (const view::Lesson& lesson : lessons) {
    SCOPED_TRACE(lesson.title);
    const view::ViewState state = make_state(lesson);
    view::Stage stage(renderer(), state.scene);
    stage.draw(state, view::Changes::all());
    const auto seen = stage.find_surface(find_pixel(state, lesson.reading.place_ws));
    ASSERT_TRUE(seen);
    EXPECT_LT(glm::distance(glm::vec3(*seen), lesson.reading.place_ws), 0.05f) << "something stands before it";
    ASSERT_NE(stage.passes(lesson.reading.side), nullptr);
    EXPECT_EQ(lesson.reading.content > 0, stage.passes(lesson.reading.side)->encoded_format().has_value());
  }
}

TEST_F(LessonsTest, LightLeaks_AreOfOneSide_AndWhereTheMapIsRead) {
  const view::Lesson lesson = find("Light leaks of VSM");
  const view::ViewState state = make_state(lesson);
  const view::MeasuredSides sides = measure(state);
  EXPECT_GT(*record(sides, 0).artefact.leak, 0.3);
  EXPECT_LT(*record(sides, 1).artefact.leak, 0.05);
  expect_lit_where_the_map_is_read(lesson, state, sides, 0.2f);
}

/// How wide the penumbra of the post's shadow is, so far from its foot: metres in which visibility is between the two.
double measure_penumbra_m(const view::ViewState& state, const images::Image& visibility, float away_m) {
  const glm::vec3 foot_ws(1.75f, 0.0f, -0.85f);  // in ball.toml
  const glm::vec3 along = -scene::to_light(state.scene.light, foot_ws),
                  ahead = glm::normalize(along * glm::vec3(1, 0, 1));
  const glm::vec3 across(ahead.z, 0.0f, -ahead.x);
  constexpr int kSteps = 1200;
  constexpr float kReach_m = 0.6f;
  int between = 0;
  for (int i = 0; i < kSteps; ++i) {
    const float aside_m = kReach_m * (2.0f * static_cast<float>(i) / kSteps - 1.0f);
    const glm::vec2 at = find_place(state, foot_ws + away_m * ahead + aside_m * across);
    const glm::ivec2 pixel(at * glm::vec2(visibility.width, visibility.height));
    const float value = *visibility.at(pixel.x, pixel.y);
    between += value > 0.1f && value < 0.9f;
  }
  return 2.0 * static_cast<double>(kReach_m) * between / kSteps;
}

TEST_F(LessonsTest, Penumbra_GrowsWithTheDistanceOfItsCaster_OnlyWithPcss) {
  const view::ViewState state = make_state(find("PCSS hardens at contacts"));
  const view::MeasuredSides sides = measure(state);
  const auto width = [&](std::size_t side, float away_m) {
    return measure_penumbra_m(state, sides.find_side(side)->visibility, away_m);
  };
  const float near_m = 0.5f, far_m = 2.5f;
  std::printf("left %.3f .. %.3f m, right %.3f .. %.3f m; RMSE %.4f, %.4f\n", width(0, near_m), width(0, far_m),
              width(1, near_m), width(1, far_m), *record(sides, 0).error.rmse, *record(sides, 1).error.rmse);
  EXPECT_GT(width(1, far_m), 2.0 * width(1, near_m));
  EXPECT_LT(width(0, far_m), 1.3 * width(0, near_m));
  EXPECT_LT(width(1, near_m), 0.5 * width(0, near_m));
  EXPECT_LT(*record(sides, 1).error.rmse, 0.5 * *record(sides, 0).error.rmse);
}

TEST_F(LessonsTest, AcneWithoutBias_BecomesAContactGapWithMuch) {
  const view::Lesson lesson = find("Acne against contact gap");
  const auto faults = [&](bool instead) { return record(measure(make_state(lesson, instead, 960)), 0).artefact; };
  const auto without = faults(false), with = faults(true);
  ASSERT_TRUE(without.acne && with.acne && without.contact_gap && with.contact_gap) << "too few receivers";
  std::printf("acne %.3f, %.3f; contact gap %.3f, %.3f\n", *without.acne, *with.acne, *without.contact_gap,
              *with.contact_gap);
  EXPECT_GT(*without.acne, 0.3);
  EXPECT_LT(*without.contact_gap, 0.05);
  EXPECT_LT(*with.acne, 0.05);
  EXPECT_GT(*with.contact_gap, 0.5);
}

TEST_F(LessonsTest, EsmOverflows_AndLightsWhatIsDark) {
  const view::Lesson lesson = find("ESM overflows");
  const view::ViewState state = make_state(lesson);
  const view::MeasuredSides sides = measure(state);
  EXPECT_GT(*record(sides, 0).stability.overflow_texels, 10000);
  EXPECT_EQ(record(sides, 1).stability.overflow_texels.value_or(0), 0);
  EXPECT_GT(*record(sides, 0).artefact.leak, 0.3);
  EXPECT_LT(*record(sides, 1).artefact.leak, 0.05);
  expect_lit_where_the_map_is_read(lesson, state, sides, 0.99f);
}

class SeamsTest : public LessonsTest {
 protected:
  /// How far visibility jumps from one row to the next where both show the ground and a cascade ends between them: the
  /// mean over all such places. The cascades are those of the first state that is asked for.
  double measure_step(const view::ViewState& state) {
    view::Stage stage(renderer(), state.scene);
    stage.draw(state, view::Changes::all());
    if (ends_m_.empty())
      for (const scene::LightFrustum& layer : stage.light_map().layers)
        ends_m_.push_back(std::get<scene::ViewSlice>(layer.share).end_m);
    const images::Image places = render::read_image(stage.gbuffer().position(), 4);
    const images::Image shown = render::read_image(stage.visibility(0, {0, state.options.width}), 1);
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y + 1 < shown.height; ++y)
      for (int x = 0; x < shown.width; ++x) {
        const float *far = places.at(x, y), *near = places.at(x, y + 1);
        if (!is_ground(far) || !is_ground(near) || !has_seam(near[3], far[3])) continue;
        sum += static_cast<double>(std::abs(*shown.at(x, y) - *shown.at(x, y + 1)));
        ++count;
      }
    EXPECT_GT(count, 300);
    return sum / count;
  }

 private:
  std::vector<double> ends_m_;

  static bool is_ground(const float* place) { return place[3] > 0.0f && std::abs(place[1]) < 1e-3f; }

  /// Behind the last cascade there is none.
  bool has_seam(float near_m, float far_m) const {
    return std::any_of(
        ends_m_.begin(), ends_m_.end() - 1,
        [&](double end_m) { return static_cast<double>(near_m) < end_m && end_m <= static_cast<double>(far_m); });
  }
};

TEST_F(SeamsTest, Step_IsGoneWithABlend) {
  const view::Lesson lesson = find("Seams of cascades");
  const double without = measure_step(make_state(lesson)), with = measure_step(make_state(lesson, true));
  std::printf("step %.4f without a blend, %.4f with one\n", without, with);
  EXPECT_GT(without, 0.05);
  EXPECT_LT(with, 0.5 * without);
}

}  // namespace
}  // namespace shadowbench::test
