#include <gmock/gmock.h>

#include "report/analysis/cells.h"
#include "report/analysis/findings.h"
#include "report/analysis/trade.h"
#include "trade_cells.h"

namespace shadowbench::analysis {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

records::CellRecord make_light_cell(const SweepCell& from, double asked) {
  records::CellRecord cell = make_sweep_cell(from);
  cell.kernel.width_class = "light";
  cell.kernel.light_texels = asked;
  if (from.filter != "none") cell.kernel.by_light = "radius";
  cell.key = records::cell_key(cell);
  return cell;
}

/// On `ball` the filter is as wide as it should be and better than none, on `cubes` as narrow as it can and worse.
std::vector<records::CellRecord> make_cells() {
  std::vector<records::CellRecord> cells = {
      make_light_cell({.scene = "ball", .rmse = 0.1}, 4.0),
      make_light_cell({.scene = "ball", .filter = "vsm", .radius = 4.0, .rmse = 0.05}, 4.0),
      make_light_cell({.scene = "cubes", .rmse = 0.1}, 0.2),
      make_light_cell({.scene = "cubes", .filter = "vsm", .radius = 0.4, .rmse = 0.2}, 0.2)};
  cells[3].attribution.numeric.share = 0.1;
  cells[3].attribution.estimator.share = 0.6;
  cells[3].attribution.discretisation.share = 0.2;
  cells[3].attribution.model.share = 0.1;
  return cells;
}

TEST(LightWidths, OneFilter_IsOneConfigurationOnAllScenes) {
  const auto cells = make_cells();
  const auto configurations = list_configurations(point_to(cells));
  ASSERT_THAT(configurations, SizeIs(2));
  EXPECT_EQ(configurations[1].name, "vsm");
  EXPECT_EQ(describe_kernel(configurations[1]), "0.4 .. 4 texels (light)");
  const auto scopes = make_trade_scopes(cells);
  ASSERT_THAT(scopes, SizeIs(3));
  EXPECT_THAT(scopes[0].configurations, SizeIs(2));
  EXPECT_EQ(scopes[0].incomplete, 0u);
  EXPECT_EQ(scopes[0].configurations[1].sigma_texels, std::nullopt) << "it has two widths";
  EXPECT_EQ(name_class(scopes[0].configurations[0].width_class), "light") << "none is compared with them";
}

TEST(LightWidths, AreTold_WithWhatCannotBeSoNarrow_AndWhatIsWorseThanNone) {
  const auto sentences = describe_light_widths(make_cells());
  ASSERT_THAT(sentences, SizeIs(3));
  EXPECT_THAT(sentences[0], HasSubstr("4 on ball, 0.2 on cubes"));
  EXPECT_THAT(sentences[1], AllOf(HasSubstr("vsm on cubes 0.4 for 0.2"), Not(HasSubstr("ball"))));
  EXPECT_THAT(sentences[2], AllOf(HasSubstr("vsm on cubes (60 % estimator"), Not(HasSubstr("ball"))));
}

TEST(LightWidths, WithoutOne_NothingIsTold) {
  EXPECT_THAT(describe_light_widths(make_crossing_cells("cubes")), IsEmpty());
}

}  // namespace
}  // namespace shadowbench::analysis
