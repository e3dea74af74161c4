// What is seen of a trace while it goes on, and how it is stopped.

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "reference/truth/cached_tracer.h"
#include "tests/reference/truth/shapes.h"

namespace shadowbench::truth {
namespace {

constexpr int kColumns = 75, kRows = 42;  // the last tiles are cut off

/// A floor under a roof's edge, with pixels that do not count in a pattern that no square of 8 is without.
ReceiverImage make_floor_below_an_edge() {
  ReceiverImage image = make_line(-0.5, 0.5, kColumns, kRows);
  for (std::size_t i = 0; i < image.points.size(); i += 5) image.points[i].counts = false;
  return image;
}

Occluders make_edge() {
  const OccluderMesh roof = make_sheet(-2.0, 0.0, -2.0, 2.0, 1.0);
  return Occluders(std::span(&roof, 1));
}

AreaLight make_wide_sun() { return AreaLight::make_sun({0.1, 1.0, 0.0}, 20.0); }

void expect_equal(const TracedVisibility& a, const TracedVisibility& b) {
  EXPECT_EQ(a.visibility, b.visibility);
  EXPECT_EQ(a.standard_error, b.standard_error);
  EXPECT_EQ(a.unanimous, b.unanimous);
  EXPECT_EQ(a.rays, b.rays);
}

/// Copies every tile into the picture of its turn: one for each side of the squares, and one with its edges.
class Watcher {
 public:
  std::vector<std::vector<float>> pictures;

  TraceSettings settings(int coarsest) {
    TraceSettings settings;
    settings.coarsest = coarsest;
    settings.on_tile = [this](const TracedTile& tile) { copy(tile); };
    return settings;
  }

 private:
  std::mutex mutex_;
  std::vector<int> turns_ = std::vector<int>(kColumns * kRows, 0);

  void copy(const TracedTile& tile) {
    const std::scoped_lock lock(mutex_);
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        const auto i = static_cast<std::size_t>(y * kColumns + x), turn = static_cast<std::size_t>(turns_[i]++);
        if (pictures.size() <= turn) pictures.resize(turn + 1, std::vector<float>(kColumns * kRows, -1.0f));
        pictures[turn][i] = tile.visibility[i];
      }
    }
  }
};

TEST(TracingProgress, LookingOn_ChangesNothing) {
  const Occluders occluders = make_edge();
  const TracedVisibility plain = trace_area(occluders, make_floor_below_an_edge(), make_wide_sun(), {});
  for (const int coarsest : {1, 2, 8, 16}) {
    Watcher watcher;
    const TracedVisibility watched =
        trace_area(occluders, make_floor_below_an_edge(), make_wide_sun(), watcher.settings(coarsest));
    expect_equal(watched, plain);
    EXPECT_EQ(watcher.pictures.size(), std::bit_width(static_cast<unsigned>(coarsest)) + 1u) << coarsest;
    for (const std::vector<float>& picture : watcher.pictures)
      EXPECT_EQ(std::ranges::count(picture, -1.0f), 0) << "a tile is missing";
    EXPECT_EQ(watcher.pictures.back(), plain.visibility);
  }
}

/// A square of a coarse picture has the visibility of its first pixel that counts, as its first rays see it; the
/// picture of the smallest squares holds what the first rays of every pixel see.
TEST(TracingProgress, CoarsePictures_ShowTheFirstRaysOfOnePixelOfEachSquare) {
  const Occluders occluders = make_edge();
  const ReceiverImage receivers = make_floor_below_an_edge();
  Watcher watcher;
  trace_area(occluders, receivers, make_wide_sun(), watcher.settings(8));
  ASSERT_EQ(watcher.pictures.size(), 5u);
  const std::vector<float>& first_rays = watcher.pictures[3];
  std::size_t differ = 0;
  for (std::size_t picture = 0; picture < 3; ++picture) {
    const int side = 8 >> picture;
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kColumns; ++x) {
        const auto at = [&](int column, int row) { return static_cast<std::size_t>(row * kColumns + column); };
        if (!receivers.points[at(x, y)].counts) continue;
        const int left = x / side * side, top = y / side * side;
        std::optional<std::size_t> first;
        for (int row = top; row < top + side && !first; ++row)
          for (int column = left; column < left + side && !first; ++column)
            if (receivers.points[at(column, row)].counts) first = at(column, row);
        ASSERT_EQ(watcher.pictures[picture][at(x, y)], first_rays[*first]) << side << " " << x << " " << y;
        differ += first_rays[*first] != first_rays[at(x, y)];
      }
    }
  }
  EXPECT_GT(differ, 500u) << "all pixels see the same: nothing is tested";
}

TEST(TracingProgress, Parts_NeverFall) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  std::vector<double> parts;
  TraceSettings settings;
  settings.coarsest = 8;
  settings.on_part = [&](double part) { parts.push_back(part); };
  trace_area(make_edge(), make_floor_below_an_edge(), make_wide_sun(), settings);
  EXPECT_TRUE(std::ranges::is_sorted(parts));
  EXPECT_LT(parts.front(), 0.01);
  EXPECT_EQ(parts.back(), 1.0);
}

class WatchedTracer : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("shadowbench.stopped." + std::to_string(getpid()));
    receivers_.content = "receivers";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  ReceiverImage receivers_ = make_floor_below_an_edge();
  TruthCache cache_{folder_, [](const std::string& message) { FAIL() << message; }};
  CachedTracer tracer_{[] { return std::vector{make_sheet(-2.0, 0.0, -2.0, 2.0, 1.0)}; }, cache_, 1};
};

TEST_F(WatchedTracer, LeavesNothingInTheCache) {
  std::stop_source stop;
  std::atomic<int> tiles = 0;
  tracer_.heed(stop.get_token());
  tracer_.show(8, [&](const TracedTile&) {
    if (++tiles == 20) stop.request_stop();
  });
  EXPECT_THROW(tracer_.trace_view(receivers_, make_wide_sun()), TracingStopped);
  EXPECT_LT(tiles, 20 + 2 * static_cast<int>(std::thread::hardware_concurrency()))
      << "tiles were traced after the stop";
  EXPECT_FALSE(std::filesystem::exists(folder_));
  tracer_.heed({});
  expect_equal(tracer_.trace_view(receivers_, make_wide_sun()).area,
               trace_area(make_edge(), receivers_, make_wide_sun(), {}));
}

TEST_F(WatchedTracer, StopsSingleRaysToo) {
  const Occluders occluders = make_edge();
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(trace_hard(occluders, receivers_, make_wide_sun(), stop.get_token()), TracingStopped);
  EXPECT_THROW(trace_first_blockers(occluders, receivers_, make_wide_sun(), stop.get_token()), TracingStopped);
}

/// Lights of one shape share the points that rays go to, others do not.
TEST_F(WatchedTracer, OneTracer_SeesEveryShapeOfLight) {
  const glm::dvec3 centre(0.1, 3.0, 0.0), half_u(0.5, 0.0, 0.0), half_v(0.0, 0.0, 0.5);
  for (const AreaLight& light : {make_wide_sun(), AreaLight::make_rectangle(centre, half_u, half_v),
                                 AreaLight::make_disk(centre, {0.0, -1.0, 0.0}, 0.5), make_wide_sun()})
    expect_equal(tracer_.trace_view(receivers_, light).area, trace_area(make_edge(), receivers_, light, {}));
}

/// What was asked to stop between the area and the single rays is not kept without them.
TEST_F(WatchedTracer, StopAfterTheArea_LeavesNothingInTheCache) {
  std::stop_source stop;
  tracer_.heed(stop.get_token());
  tracer_.listen([&](double part) {
    if (part == 1.0) stop.request_stop();
  });
  EXPECT_THROW(tracer_.trace_view(receivers_, make_wide_sun()), TracingStopped);
  EXPECT_FALSE(std::filesystem::exists(folder_));
}

}  // namespace
}  // namespace shadowbench::truth
