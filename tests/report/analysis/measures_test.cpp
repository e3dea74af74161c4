#include "report/analysis/measures.h"

#include <gmock/gmock.h>

#include <cmath>

#include "reference/metrics/error_stats.h"

namespace shadowbench::analysis {
namespace {

TEST(Measures, ErrorsDiffer_BeyondTheLargerStandardError_NotTheSumOfBoth) {
  EXPECT_FALSE(is_clearly_less_error({0.2, 0.199, 0.201}, {0.201, 0.2, 0.202}));
  EXPECT_TRUE(is_clearly_less_error({0.2, 0.199, 0.201}, {0.2015, 0.2005, 0.2025}));
}

/// Both move by 0.01 from group to group, and their difference by a hundredth of that.
TEST(Measures, ErrorsOfTheSamePhases_DifferByWhatTheirDifferencesSay) {
  const Estimate a{0.2, 0.18, 0.22, {0.19, 0.2, 0.2, 0.21}}, b{0.201, 0.18, 0.222, {0.1911, 0.2009, 0.201, 0.211}};
  EXPECT_TRUE(is_clearly_less_error(a, b));
  EXPECT_FALSE(is_clearly_less_error(b, a));
  EXPECT_FALSE(is_clearly_less_error(a, a));
  const Estimate gap = subtract(b, a);
  EXPECT_NEAR(gap.value, 0.001, 1e-12);
  EXPECT_NEAR(gap.high - gap.value, metrics::find_student_t(4) * std::sqrt(2e-8 / 3.0 / 4.0), 1e-9);
  Estimate other = b;
  other.replicates.pop_back();
  EXPECT_FALSE(is_clearly_less_error(a, other)) << "of other phases, and then within both intervals";
}

}  // namespace

}  // namespace shadowbench::analysis
