#include "harness/submit/cell_costs.h"

#include <gtest/gtest.h>

namespace shadowbench::submit {
namespace {

records::CellRecord make_cell(const std::string& filter, double radius_texels, std::optional<double> measured_s) {
  records::CellRecord cell;
  cell.filter = filter;
  cell.kernel_radius_texels = radius_texels;
  cell.width = 1000;
  cell.height = 950;
  cell.measured_s = measured_s;
  return cell;
}

TEST(CellCosts, OfAFilter_FollowItsKernelsWidth) {
  const CellCosts costs({make_cell("wide", 1, 1.0), make_cell("wide", 5, 3.0), make_cell("wide", 5, 5.0),
                         make_cell("narrow", 1, 0.5), make_cell("untimed", 1, std::nullopt)});
  EXPECT_DOUBLE_EQ(costs.expect_s(make_cell("wide", 1, {})), 1.0);
  EXPECT_DOUBLE_EQ(costs.expect_s(make_cell("wide", 5, {})), 4.0) << "the mean of both";
  EXPECT_DOUBLE_EQ(costs.expect_s(make_cell("wide", 3, {})), 2.5);
  EXPECT_DOUBLE_EQ(costs.expect_s(make_cell("wide", 9, {})), 4.0) << "nobody knows beyond the widest";
  EXPECT_DOUBLE_EQ(costs.expect_s(make_cell("narrow", 7, {})), 0.5);
  EXPECT_DOUBLE_EQ(costs.expect_s(make_cell("unknown", 1, {})), (1.0 + 3.0 + 5.0 + 0.5) / 4);
}

TEST(CellCosts, GrowWithThePicture) {
  const CellCosts costs({make_cell("any", 1, 2.0)});
  records::CellRecord larger = make_cell("any", 1, {});
  larger.height = 1950;
  EXPECT_DOUBLE_EQ(costs.expect_s(larger), 4.0);
}

TEST(CellCosts, OfNothingKnown_AreAllAlike) {
  const CellCosts costs({make_cell("any", 1, std::nullopt)});
  EXPECT_TRUE(costs.is_empty());
  EXPECT_DOUBLE_EQ(costs.expect_s(make_cell("any", 3, {})), costs.expect_s(make_cell("other", 1, {})));
}

}  // namespace
}  // namespace shadowbench::submit
