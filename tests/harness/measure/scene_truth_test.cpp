#include "harness/measure/scene_truth.h"

#include "harness/measure/scene_measurement.h"
#include "harness/measure/view_receivers.h"
#include "harness/scene/mesh_tools.h"
#include "reference/metrics/error_stats.h"
#include "reference/metrics/metric_table.h"
#include "reference/truth/occluders.h"
#include "tests/filters/filtered.h"
#include "tests/test_files.h"

namespace shadowbench::measure {
namespace {

scene::Scene make_floor_of(float size_m) {
  scene::Scene scene;
  scene.name = "land";
  scene.meshes = {scene::make_plane(glm::vec2(size_m), 1)};
  return scene;
}

/// A map of 8 m and 512 texels.
TEST(WideScene, IsToldWhereRaysStartATenthOfATexelOffSurfaces) {
  constexpr double kTexel_m = 8.0 / 512.0;
  for (const float size : {8.0f, 100.0f, 1000.0f}) EXPECT_EQ(describe_wide_scene(make_floor_of(size), kTexel_m), "");
  EXPECT_THAT(describe_wide_scene(make_floor_of(20e3f), kTexel_m),
              AllOf(HasSubstr("land: the scene is too wide"), HasSubstr(" 0.0191 m off"), HasSubstr(" is 0.0156 m")));
  const float widest = 2.0f * static_cast<float>(0.1 * kTexel_m) / (2.0f * truth::origin_offset(0.5f, 0.5f));
  EXPECT_EQ(describe_wide_scene(make_floor_of(0.99f * widest), kTexel_m), "");
  EXPECT_NE(describe_wide_scene(make_floor_of(1.01f * widest), kTexel_m), "");
}

/// A map of the whole scene is never that fine.
TEST(WideScene, UnderAMapOfAllOfIt_IsNone) {
  constexpr float kSize_m = 1e6f;
  EXPECT_EQ(describe_wide_scene(make_floor_of(kSize_m), double{kSize_m} / 16384.0), "");
}

TEST(Phases, ASingleOneIsNotMoved_AndNoneIsMovedByMoreThanHalfATexel) {
  EXPECT_EQ(list_phase_shifts(1, 7).front(), glm::dvec2(0.0));
  for (int count = 1; count <= 64; ++count) {
    const std::vector<glm::dvec2> shifts = list_phase_shifts(count, 1);
    ASSERT_EQ(shifts.size(), static_cast<std::size_t>(count));
    for (const glm::dvec2& shift : shifts) {
      for (const int axis : {0, 1}) {
        EXPECT_GE(shift[axis], -0.5);
        EXPECT_LT(shift[axis], 0.5);
      }
    }
  }
}

TEST(Phases, FromEightOn_TwoOfAGroupAreHalfATexelApart) {
  for (const std::size_t count : {8u, 10u, 64u}) {
    ASSERT_EQ(count_phases_of_group(count), 2u);
    const std::vector<glm::dvec2> shifts = list_phase_shifts(static_cast<int>(count), 3);
    for (std::size_t i = 0; i < count; i += 2)
      for (const int axis : {0, 1})
        EXPECT_NEAR(std::abs(shifts[i][axis] - shifts[i + 1][axis]), 0.5, 1e-12) << count << " " << i;
  }
  for (const std::size_t count : {1u, 2u, 4u, 7u, 9u}) EXPECT_EQ(count_phases_of_group(count), 1u);
}

TEST(Phases, MoreOfThem_BeginWithTheSame_AndOtherSeedsGiveOthers) {
  const std::vector<glm::dvec2> eight = list_phase_shifts(8, 1), many = list_phase_shifts(64, 1),
                                other = list_phase_shifts(8, 2);
  for (std::size_t i = 0; i < eight.size(); ++i) EXPECT_EQ(eight[i], many[i]);
  for (std::size_t i = 0; i < eight.size(); ++i) EXPECT_NE(eight[i], other[i]);
}

/// Groups begin anywhere, the first as any other: over many seeds, each quarter of a texel along each axis as often as
/// the others.
TEST(Phases, GroupsBeginAnywhere) {
  constexpr int kSeeds = 1000;
  for (const std::size_t group : {0u, 2u}) {
    int counts[2][4] = {};
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const glm::dvec2 shift = list_phase_shifts(4, seed)[group];
      for (const int axis : {0, 1}) ++counts[axis][static_cast<int>(4.0 * (shift[axis] + 0.5))];
    }
    for (const auto& axis : counts)
      for (const int count : axis) EXPECT_NEAR(count, kSeeds / 4, 60) << group;
  }
}

TEST(Phases, BelowEight_FlickerIsAbsent) {
  const metrics::Change change{0.01, 0.002};
  records::CellRecord few, enough;
  note_errors(few, std::vector<metrics::ErrorStats>(4), 1);
  note_flicker(few, change);
  EXPECT_FALSE(few.error.flicker);
  EXPECT_FALSE(few.flicker_ci95);
  EXPECT_NE(few.absent.at("error.flicker"), "");
  EXPECT_NE(few.absent.at("error.flicker_ci95"), "");
  note_errors(enough, std::vector<metrics::ErrorStats>(8), 2);
  note_flicker(enough, change);
  EXPECT_EQ(enough.error.flicker, 0.01);
  EXPECT_TRUE(enough.absent.empty());
}

TEST(Phases, FlickerOfAStep_NeedsNoOthers_AndHasNoInterval) {
  records::CellRecord record;
  note_step(record, metrics::Change{0.01});
  EXPECT_EQ(record.error.flicker, 0.01);
  EXPECT_NE(record.absent.at("error.flicker_ci95"), "");
  note_step(record, std::nullopt);
  EXPECT_NE(record.absent.at("error.flicker"), "");
}

TEST(Phases, EveryErrorOfTheTable_IsItsMeanOverThem_AndTheLargestIsTheLargest) {
  std::vector<metrics::ErrorStats> phases(4);
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.statistic) phases[0].*metric.statistic = 8.0;
  records::CellRecord record;
  note_errors(record, phases, 1);
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.statistic) EXPECT_EQ(metric.read(record), metric.path == "error.max" ? 8.0 : 2.0) << metric.path;
  EXPECT_EQ(record.phases, 4);
}

TEST(MeanInterval, IsStudents) {
  EXPECT_FALSE(metrics::find_mean_interval(std::vector{1.0}));
  const auto interval = metrics::find_mean_interval(std::vector{1.0, 2.0, 3.0, 4.0});
  ASSERT_TRUE(interval);
  EXPECT_DOUBLE_EQ(interval->mean, 2.5);
  EXPECT_NEAR(interval->high - 2.5, 3.8960 * std::sqrt(5.0 / 3.0 / 4.0), 1e-4);  // t of 3 degrees, 98.5 %
  EXPECT_NEAR(2.5 - interval->low, interval->high - 2.5, 1e-12);
}

// A filter whose visibility is the same everywhere is suspect, by a truth made by hand.

/// Checks a constant image of 400 receivers, half of them blocked; the others see `area` of the light, and `ratio` of
/// what is above their own plane.
records::CellStatus judge(float area, float ratio) {
  SceneTruth truth;
  truth.mask.assign(400, 1);
  truth.area = truth.ratio = images::Image(20, 20, 1);
  std::fill_n(truth.area.texels.begin(), 200, area);
  std::fill_n(truth.ratio.texels.begin(), 200, ratio);
  MeasuredCell cell;
  cell.visibility = images::Image(20, 20, 1);
  check_against_truth(cell, truth);
  return cell.record.status;
}

TEST(AConstant, IsSuspect_WhereReceiversAreWhollyLit) {
  EXPECT_EQ(judge(1.0f, 1.0f), records::CellStatus::kSuspect);
  EXPECT_EQ(judge(0.7f, 1.0f), records::CellStatus::kSuspect) << "their own plane hides the rest of the light";
  EXPECT_EQ(judge(0.7f, 0.9f), records::CellStatus::kOk) << "a penumbra";
}

// Scalar models over a view: rows are turned, excused receivers are counted.

constexpr int kImageWidth = 3, kImageHeight = 4;

filters::Receiver make_receiver(int x, int y, float depth) {
  filters::Receiver r;
  r.uv = {0.55f, 0.45f};
  r.depth = r.depth_unbiased = depth;
  r.pixel = {x, y};
  return r;
}

using Receivers = std::vector<filters::Receiver>;

ModelLayer make_grey_layer(const Receivers& receivers) { return {{4, std::vector<float>(16, 0.5f)}, receivers}; }

constexpr ModelView kView{kImageWidth, kImageHeight};

ModelImages evaluate(const std::vector<ModelLayer>& layers) {
  return evaluate_model(filters::request_of("none"), layers, kView);
}

std::vector<double> compare(const std::vector<ModelLayer>& layers) {
  return compare_kernel(filters::Kernel::make_point(filters::Reconstruction::kNearest), layers, kView);
}

TEST(ModelImages, HaveTheirTopRowFirst_AndAreLitWhereThereIsNoReceiver) {
  // GL counts rows from below: (2, 0) is the last pixel of the image, (0, 3) its first.
  const std::vector<filters::Receiver> blocked = {make_receiver(2, 0, 0.75f), make_receiver(0, 3, 0.75f),
                                                  make_receiver(1, 2, 0.25f)};
  const ModelImages images = evaluate({make_grey_layer(blocked)});
  std::vector<double> expected(kImageWidth * kImageHeight, 1.0);
  expected.front() = expected.back() = 0.0;
  EXPECT_EQ(images.model, expected);
  EXPECT_EQ(compare({make_grey_layer(blocked)}), expected);
  EXPECT_EQ(images.excused, 0);
}

TEST(ModelImages, CountWhatIsExcused) {
  const std::vector<filters::Receiver> receivers = {make_receiver(0, 0, 0.5f), make_receiver(1, 0, 0.25f),
                                                    make_receiver(2, 0, 0.5f)};
  EXPECT_EQ(evaluate({make_grey_layer(receivers)}).excused, 2) << "ties";
}

TEST(ModelImages, AddWhatLayersMakeOfTheirShares) {
  const auto share = [](float of, float depth) {
    filters::Receiver r = make_receiver(1, 1, depth);
    r.layer_share = of;
    return make_grey_layer({r});
  };
  constexpr std::size_t kPixel = 2 * kImageWidth + 1;
  const std::vector<ModelLayer> layers = {share(0.25f, 0.75f), share(0.75f, 0.25f)};
  EXPECT_EQ(evaluate(layers).model[kPixel], 0.75);
  EXPECT_EQ(compare(layers)[kPixel], 0.75);
  EXPECT_EQ(evaluate({share(0.25f, 0.75f), share(0.75f, 0.75f)}).model[kPixel], 0.0);
}

}  // namespace
}  // namespace shadowbench::measure
