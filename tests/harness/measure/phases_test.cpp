#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "harness/measure/scene_measurement.h"
#include "reference/metrics/error_stats.h"

namespace shadowbench::measure {
namespace {

TEST(Phases, EachAxisIsStratified_AndTheFirstIsNotMoved) {
  for (int count = 1; count <= 64; ++count) {
    const std::vector<glm::dvec2> shifts = list_phase_shifts(count);
    ASSERT_EQ(shifts.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(shifts.front(), glm::dvec2(0.0));
    std::set<long> parts[2];
    for (const glm::dvec2& shift : shifts) {
      for (const int axis : {0, 1}) {
        EXPECT_GE(shift[axis], -0.5);
        EXPECT_LT(shift[axis], 0.5);
        parts[axis].insert(std::lround((shift[axis] + 1.0) * count) % count);
      }
    }
    EXPECT_EQ(parts[0].size(), shifts.size()) << count;
    EXPECT_EQ(parts[1].size(), shifts.size()) << count;
  }
}

TEST(Phases, FourAreNotOnOneLine) {
  const std::vector<glm::dvec2> shifts = list_phase_shifts(4);
  std::set<double> sums, differences;
  for (const glm::dvec2& shift : shifts) {
    sums.insert(std::fmod(shift.x + shift.y + 2.0, 1.0));
    differences.insert(std::fmod(shift.x - shift.y + 2.0, 1.0));
  }
  EXPECT_GE(sums.size(), 3u) << "an edge along a diagonal of the map would look the same in all phases";
  EXPECT_GE(differences.size(), 3u);
}

TEST(MeanInterval, IsStudents) {
  EXPECT_FALSE(metrics::find_mean_interval(std::vector{1.0}));
  const auto interval = metrics::find_mean_interval(std::vector{1.0, 2.0, 3.0, 4.0});
  ASSERT_TRUE(interval);
  EXPECT_DOUBLE_EQ(interval->mean, 2.5);
  EXPECT_NEAR(interval->high - 2.5, 3.1824463 * std::sqrt(2.0 * 5.0 / 3.0 / 4.0), 1e-6);  // t of 3 degrees, 97.5 %
  EXPECT_NEAR(2.5 - interval->low, interval->high - 2.5, 1e-12);
}

}  // namespace
}  // namespace shadowbench::measure
