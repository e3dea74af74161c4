#include <gmock/gmock.h>

#include "report/analysis/findings.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

records::CellRecord make_stable_cell() {
  records::CellRecord cell = make_cell("cubes", "odd", 4.0);
  cell.params = {{"k", 20.0}, {"store", std::string("r16f")}};
  cell.map_size = 100;
  cell.stability = {0, 0, 0, 1e-7, 2.5, 11.08, 0.001, 0.0001, 0.0, 0, 0};
  return cell;
}

TEST(StabilityWords, NothingBreaks_NothingIsSaid) {
  EXPECT_THAT(describe_stability({"cubes", {make_stable_cell(), make_cell("cubes", "none", 1.0)}}), IsEmpty());
  EXPECT_EQ(caption_texels(make_cell("cubes", "none", 1.0)), "");
  EXPECT_EQ(caption_bound(make_stable_cell()), "kept at every receiver");
  EXPECT_THAT(caption_texels(make_stable_cell()),
              AllOf(HasSubstr("r16f holds numbers up to 65504 (e^11.09)"), HasSubstr("2.5 left"),
                    HasSubstr("safe up to an exponent of 11.08")));
}

TEST(StabilityWords, Overflow_NamesLimitAndSafeValue) {
  records::CellRecord cell = make_stable_cell();
  cell.stability.overflow_texels = 290;
  cell.stability.nan_texels = 10;
  cell.stability.headroom.reset();
  const auto sentences = describe_stability({"cubes", {cell}});
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(sentences[0],
            "odd: 3 % of its map's texels overflowed: r16f holds numbers up to 65504 (e^11.09); an "
            "exponent "
            "of 11.08 is safe here.");
}

TEST(StabilityWords, EveryTrouble_HasItsSentence) {
  records::CellRecord cell = make_stable_cell();
  cell.stability.negative_variance_texels = 5000;
  cell.stability.lowest_variance = -7.2e-4;
  cell.stability.half_difference_max = 0.25;
  cell.stability.half_difference_rms = 0.0125;
  cell.stability.bound_shortfall_max = 0.125;
  cell.stability.bound_violations = 7;
  cell.stability.bound_exact_violations = 8;
  const auto sentences = describe_stability({"cubes", {cell}});
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_THAT(sentences[0],
              HasSubstr("the variance of 50 % of its map's texels is below 0 before the clamp, down to -0.00072"));
  EXPECT_THAT(sentences[1], HasSubstr("visibility is up to 0.25 off that of the 32-bit store (RMS 0.0125)"));
  EXPECT_THAT(sentences[2], AllOf(HasSubstr("by up to 0.125; at 7 receivers by more than rounding explains"),
                                  HasSubstr("at 8 in exact arithmetic")));
}

}  // namespace
}  // namespace shadowbench::analysis
