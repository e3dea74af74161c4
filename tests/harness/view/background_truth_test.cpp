#include "harness/view/background_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "base/error.h"

namespace shadowbench::view {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// What all threads of this process have computed, seconds.
double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A wall of two triangles in 2 x 2 m, half a metre above the floor.
std::vector<truth::OccluderMesh> list_roof() {
  truth::OccluderMesh roof;
  roof.positions = {{-1.0f, 0.5f, -1.0f}, {1.0f, 0.5f, -1.0f}, {-1.0f, 0.5f, 1.0f}, {1.0f, 0.5f, 1.0f}};
  roof.indices = {0, 1, 2, 2, 1, 3};
  return {roof};
}

/// A floor of 4 x 4 m seen from straight above, through the roof; with some background, and some pixels that are turned
/// away from every light above.
std::shared_ptr<measure::ViewSurfaces> make_floor(int width, int height) {
  auto surfaces = std::make_shared<measure::ViewSurfaces>();
  surfaces->positions = images::Image(width, height, 4);
  surfaces->normals = images::Image(width, height, 4);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float across = (static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                  down = (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
      const bool is_background = across > 0.9f, is_turned_away = (x + y) % 7 == 0;
      std::copy_n(std::array{4.0f * across - 2.0f, 0.0f, 4.0f * down - 2.0f, is_background ? 0.0f : 1.0f}.begin(), 4,
                  surfaces->positions.at(x, y));
      std::copy_n(std::array{0.0f, is_turned_away ? -1.0f : 1.0f, 0.0f, 0.0f}.begin(), 4, surfaces->normals.at(x, y));
    }
  }
  return surfaces;
}

scene::Light make_sun_from(float x, float diameter_deg) {
  scene::Light light;
  light.kind = scene::Sun{glm::normalize(glm::vec3(-x, -1.0f, 0.0f)), diameter_deg};
  return light;
}

/// A light as large as the sky: every pixel takes its time, and all of them at least some seconds.
TruthJob make_long_job() { return {make_floor(960, 540), make_sun_from(0.1f, 120.0f)}; }
TruthJob make_short_job() { return {make_floor(200, 130), make_sun_from(0.1f, 20.0f)}; }

class Background : public ::testing::Test {
 protected:
  using Shown = BackgroundTruth::Shown;

  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Takes what there is to show until `is_enough` of it.
  std::vector<Shown> take_until(const std::function<bool(const Shown&)>& is_enough) {
    std::vector<Shown> all;
    for (const auto begin = Clock::now(); seconds_since(begin) < 120.0;) {
      if (std::optional<Shown> shown = background_.take()) {
        all.push_back(std::move(*shown));
        if (is_enough(all.back())) return all;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "nothing of that kind was shown";
    return all;
  }
  std::vector<Shown> take_all() {
    return take_until([](const Shown& shown) { return shown.truth || !shown.error.empty(); });
  }
  void take_first_picture() {
    take_until([](const Shown& shown) { return !shown.visibility.empty(); });
  }

  /// What a run finds for the same job, without a cache.
  static measure::SceneTruth trace_as_a_run(const TruthJob& job) {
    truth::TruthCache none({}, {});
    truth::CachedTracer tracer(&list_roof, none, 1);
    return measure::trace_scene(tracer, job.light, measure::make_view_receivers(*job.surfaces, job.light));
  }

  static void expect_equal(const measure::SceneTruth& a, const measure::SceneTruth& b) {
    EXPECT_EQ(a.absent, b.absent);
    EXPECT_EQ(a.area.texels, b.area.texels);
    EXPECT_EQ(a.hard.texels, b.hard.texels);
    EXPECT_EQ(a.mask, b.mask);
    EXPECT_EQ(a.rays.area.standard_error, b.rays.area.standard_error);
    EXPECT_EQ(a.rays.area.unanimous, b.rays.area.unanimous);
    EXPECT_EQ(a.rays.area.rays, b.rays.area.rays);
    EXPECT_EQ(a.rays.first_blockers_ws, b.rays.first_blockers_ws);
    EXPECT_EQ(a.standard_error, b.standard_error);
    EXPECT_EQ(a.unanimous, b.unanimous);
  }

  long count_kept() const {
    std::error_code none;
    const auto is_truth = [](const auto& entry) { return entry.path().extension() == ".truth"; };
    return std::ranges::count_if(std::filesystem::directory_iterator(folder_, none), is_truth);
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("shadowbench.background." + std::to_string(getpid()));
  std::function<void()> before_listing_ = [] {};
  truth::TruthCache cache_{folder_, [](const std::string& message) { ADD_FAILURE() << message; }};
  BackgroundTruth background_{[this] {
                                before_listing_();
                                return list_roof();
                              },
                              cache_, 1};
};

TEST_F(Background, FinishedTruth_IsThatOfARun_BitForBit) {
  const TruthJob job = make_short_job();
  background_.start(job);
  const Shown last = take_all().back();
  ASSERT_TRUE(last.truth);
  EXPECT_EQ(last.part, 1.0);
  EXPECT_EQ(last.error, "");
  EXPECT_EQ(last.visibility.texels, last.truth->area.texels);
  expect_equal(*last.truth, trace_as_a_run(job));
  EXPECT_FALSE(background_.take()) << "nothing has changed since";
}

/// The cache of a run serves the window, and that of the window a run.
TEST_F(Background, ASecondTime_ComesFromTheCache) {
  background_.start(make_short_job());
  const Shown first = take_all().back();
  EXPECT_EQ(count_kept(), 1);
  background_.start(make_short_job());
  const std::vector<Shown> second = take_all();
  EXPECT_EQ(second.size(), 1u) << "a picture was traced before";
  expect_equal(*second.back().truth, *first.truth);
  background_.stop();
  truth::TruthCache cache(folder_, {});
  truth::CachedTracer tracer(&list_roof, cache, 1);
  const TruthJob job = make_short_job();
  expect_equal(measure::trace_scene(tracer, job.light, measure::make_view_receivers(*job.surfaces, job.light)),
               *first.truth);
  EXPECT_EQ(cache.loaded(), 1);
}

/// How far the visibility of a picture is from the truths of the same square of 8 pixels, less five standard errors of
/// 64 rays that fell by chance; the farthest of all pixels that count.
double find_excess(const images::Image& shown, const measure::SceneTruth& truth) {
  constexpr int kSide = 8;
  const int width = shown.width, height = shown.height;
  double excess = -1.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto at = [&](int column, int row) { return static_cast<std::size_t>(row * width + column); };
      if (!truth.mask[at(x, y)]) {
        EXPECT_EQ(shown.texels[at(x, y)], truth.area.texels[at(x, y)]) << "not traced, and different";
        continue;
      }
      const double value = static_cast<double>(shown.texels[at(x, y)]);
      double nearest = 2.0;
      for (int row = y / kSide * kSide; row < std::min(y / kSide * kSide + kSide, height); ++row) {
        for (int column = x / kSide * kSide; column < std::min(x / kSide * kSide + kSide, width); ++column) {
          if (!truth.mask[at(column, row)]) continue;
          const double other = static_cast<double>(truth.area.texels[at(column, row)]);
          const double of_rays = std::sqrt(other * (1.0 - other) / 64.0);
          nearest = std::min(nearest, std::abs(value - other) - 5.0 * of_rays);
        }
      }
      excess = std::max(excess, nearest);
    }
  }
  return excess;
}

TEST_F(Background, PicturesComeBeforeTheTruth_AndAreCloseToIt) {
  TruthJob job = make_long_job();
  job.surfaces = make_floor(320, 203);
  const auto begin = Clock::now();
  background_.start(job);
  const std::vector<Shown> all = take_all();
  ASSERT_GE(all.size(), 3u);
  // Every 8th, 4th, 2nd pixel, every pixel, every pixel with all its rays, and the truth: at once. Else tiles, each
  // tenth of a second.
  EXPECT_LE(static_cast<double>(all.size()), 6.0 + seconds_since(begin) / 0.1) << "tiles are shown too often";
  double part = 0.0;
  const measure::SceneTruth& truth = *all.back().truth;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    ASSERT_FALSE(all[i].visibility.empty());
    EXPECT_FALSE(all[i].truth);
    EXPECT_GE(all[i].part, part - 0.01) << "roughly";
    EXPECT_LE(find_excess(all[i].visibility, truth), 0.0) << "picture " << i;
    part = all[i].part;
  }
  EXPECT_LT(all.front().part, 0.3) << "the first picture comes early";
  EXPECT_NE(all.front().visibility.texels, truth.area.texels);
}

TEST_F(Background, Restart_DropsWhatIsTraced) {
  background_.start(make_long_job());
  take_first_picture();
  const TruthJob job = make_short_job();
  background_.start(job);
  const std::vector<Shown> all = take_all();
  for (const Shown& shown : all)
    if (!shown.visibility.empty()) ASSERT_EQ(shown.visibility.width, 200) << "a picture of the old job";
  expect_equal(*all.back().truth, trace_as_a_run(job));
  EXPECT_EQ(count_kept(), 1) << "what was dropped is in the cache";
}

TEST_F(Background, OfManyRestarts_TheLastCounts) {
  TruthJob job = make_short_job();
  for (int i = 0; i < 50; ++i) {
    job.light = make_sun_from(0.01f * static_cast<float>(i), 20.0f);
    background_.start(job);
    std::this_thread::sleep_for(std::chrono::milliseconds(i % 5));
  }
  expect_equal(*take_all().back().truth, trace_as_a_run(job));
}

TEST_F(Background, Stop_EndsAllWorkAtOnce_AndForgets) {
  background_.start(make_long_job());
  take_first_picture();
  background_.stop();
  EXPECT_FALSE(background_.take());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const double before = processor_time();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LT(processor_time() - before, 0.03);
  EXPECT_FALSE(background_.take());
  EXPECT_EQ(count_kept(), 0);
  background_.start(make_short_job());
  EXPECT_TRUE(take_all().back().truth);
}

TEST_F(Background, IsDestroyedWhileItTraces) {
  auto another = std::make_unique<BackgroundTruth>(&list_roof, cache_, 2);
  another->start(make_long_job());
  while (!another->take()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const auto begin = Clock::now();
  another.reset();
  EXPECT_LT(seconds_since(begin), 1.0);
}

TEST_F(Background, Failures_AreReported_AndTheNextJobIsTraced) {
  const std::vector<std::pair<std::function<void()>, std::string>> failures = {
      {[] { throw Error(ErrorKind::kInput, "the scene is gone"); }, "the scene is gone"},
      {[] { throw std::bad_alloc(); }, "the memory is too small"}};
  for (const auto& [fail, message] : failures) {
    before_listing_ = fail;
    background_.start(make_short_job());
    const Shown shown = take_all().back();
    EXPECT_THAT(shown.error, ::testing::HasSubstr(message));
    EXPECT_FALSE(shown.truth);
  }
  before_listing_ = [] {};
  background_.start(make_short_job());
  const Shown shown = take_all().back();
  EXPECT_TRUE(shown.truth);
  EXPECT_EQ(shown.error, "");
}

TEST_F(Background, TracesWhereNobodyElseWantsTheProcessor) {
  std::atomic<int> policy = -1;
  before_listing_ = [&] { policy = sched_getscheduler(0); };
  background_.start(make_short_job());
  take_all();
  EXPECT_EQ(policy, SCHED_IDLE);
  EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
}

TEST_F(Background, WhereNoSurfaceFacesTheLight_SaysSo) {
  TruthJob job = make_short_job();
  job.light.kind = scene::Sun{{1.0f, 0.0f, 0.0f}, 1.0f};
  background_.start(job);
  const Shown shown = take_all().back();
  ASSERT_TRUE(shown.truth);
  EXPECT_THAT(shown.truth->absent, ::testing::HasSubstr("no surface in view faces the light"));
  EXPECT_TRUE(shown.visibility.empty());
}

TEST_F(Background, TexelsPerPixel_ComeFirst) {
  TruthJob job = make_short_job();
  scene::Camera camera;
  camera.position_ws = {0.0f, 5.0f, 0.0f};
  camera.forward_ws = {0.0f, -1.0f, 0.0f};
  camera.up_ws = {0.0f, 0.0f, -1.0f};
  camera.orthographic_height_m = 4.0f;
  scene::LightFrustum frustum;
  frustum.width_ws = 8.0;
  frustum.texel_size_ws = 8.0 / 64;
  frustum.direction_ws = {0.0f, -1.0f, 0.0f};
  frustum.light_from_world = glm::dmat4(glm::dmat3(1, 0, 0, 0, 0, 1, 0, -1, 0));
  job.map = {camera, {{frustum}}, images::Image(64, 64, 1)};
  background_.start(job);
  const std::vector<Shown> all = take_all();
  const measure::MapCoverage expected = measure::measure_coverage(
      measure::make_view_receivers(*job.surfaces, job.light), camera, job.map->layers, job.map->linear_depth);
  ASSERT_TRUE(all.front().coverage);
  EXPECT_EQ(all.front().coverage->density.texels, expected.density.texels);
  EXPECT_GT(std::ranges::max(expected.density.texels), 0.0f);
  EXPECT_FALSE(all.front().truth);
  EXPECT_TRUE(all.back().coverage && all.back().truth);
  job.map.reset();
  background_.start(job);
  EXPECT_FALSE(take_all().back().coverage);
}

}  // namespace
}  // namespace shadowbench::view
