#include "report/images/attribution_bar.h"

#include <gmock/gmock.h>

#include "report/images/color_values.h"
#include "report/images/text.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {

using namespace records;
namespace {

constexpr Rect kBox{10, 20, 400, 30};

// Lightness L* of a display colour. Source: IEC 61966-2-1, CIE 1976.
double lightness(const images::Rgb& color) {
  double y = 0.0;
  const double weights[] = {0.2126, 0.7152, 0.0722};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = static_cast<double>(color[i]);
    y += weights[i] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
}

TEST(ErrorParts, Colours_DifferInLightnessAloneAndFromTheHeatMaps) {
  const auto& parts = records::list_error_parts();
  for (std::size_t i = 0; i < metrics::kErrorParts; ++i) {
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(std::abs(lightness(parts[i].color) - lightness(parts[j].color)), 15.0) << i << " " << j;
    for (const float end : {-1.0f, 1.0f}) {
      const images::Rgb heat = map_diverging(end, 1.0f);
      const double distance =
          std::hypot(parts[i].color[0] - heat[0], parts[i].color[1] - heat[1], parts[i].color[2] - heat[2]);
      EXPECT_GT(distance, 0.35) << i;
    }
  }
}

TEST(ErrorParts, Percentages_HaveNoNegativeZero) {
  EXPECT_EQ(records::format_share(-0.001), "0 %");
  EXPECT_EQ(records::format_share(-0.12), "-12 %");
  EXPECT_EQ(records::format_share(0.714), "71 %");
  EXPECT_EQ(records::format_rate(0.0423), "4.23 %");
}

TEST(ErrorParts, ReasonForNoAttribution_IsTheCells) {
  records::CellRecord cell = make_cell("cubes", "mine", 1.0);
  EXPECT_EQ(records::explain_no_attribution(cell), "no truth in this run");
  cell.absent["attribution"] = "no model";
  EXPECT_EQ(records::explain_no_attribution(cell), "no model");
  cell.absent = {};
  EXPECT_EQ(records::explain_no_attribution(cell), "not measured");
}

TEST(AttributionBar, OfASuspectCell_IsNone_SinceItWouldSetTheScale) {
  records::CellRecord cell = make_attributed_cell("mine", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.status = records::CellStatus::kSuspect;
  EXPECT_FALSE(make_attribution_bar(cell));
  EXPECT_EQ(records::explain_no_attribution(cell), "the filter is suspect");
}

TEST(AttributionBar, Lengths_AreSharesOfTheRmseAndSumToIt) {
  const auto bar = make_attribution_bar(make_attributed_cell("vsm", 0.04, {0.0, 0.75, -0.25, 0.5}));
  ASSERT_TRUE(bar);
  EXPECT_THAT(bar->lengths, ::testing::ElementsAre(0.0, 0.03, -0.01, 0.02));
  EXPECT_DOUBLE_EQ(bar->net(), 0.04);
}

TEST(AttributionBar, WithoutRmseOrAnyShare_ThereIsNone) {
  records::CellRecord cell = make_attributed_cell("vsm", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.attribution.model.share.reset();
  EXPECT_FALSE(make_attribution_bar(cell));
  cell = make_attributed_cell("vsm", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.error.rmse.reset();
  EXPECT_FALSE(make_attribution_bar(cell));
}

TEST(AttributionBar, WithoutANumericPart_IsDrawn_AndSaysSo) {
  records::CellRecord cell = make_attributed_cell("mine", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.attribution.numeric = {};
  EXPECT_DOUBLE_EQ(make_attribution_bar(cell).value().net(), 0.04);
  EXPECT_EQ(records::describe_shares(*records::list_shares(cell)),
            "numeric and estimator 75 %, discretisation -25 %, model 50 %");
}

TEST(AttributionBar, Label_NamesTheTwoLargestAndNoneBelowOnePercent) {
  EXPECT_EQ(label_bar({{0.0, 0.71, 0.09, 0.2}}), "estimator 71 %, model 20 %");
  EXPECT_EQ(label_bar({{0.0, 0.1, -0.4, 1.3}}), "model 130 %, discretisation -40 %");
  EXPECT_EQ(label_bar({{0.005, 0.0, 0.0, 0.995}}), "model 100 %");
  EXPECT_EQ(label_bar({}), "");
}

TEST(AttributionBar, NegativePartsGoLeftOfZero_PositiveOnesRight) {
  const auto segments = stack_segments({{0.25, -0.5, 0.75, -0.125}});
  ASSERT_EQ(segments.size(), 4u);
  EXPECT_DOUBLE_EQ(segments[0].begin, 0.0);
  EXPECT_DOUBLE_EQ(segments[0].end, 0.25);
  EXPECT_DOUBLE_EQ(segments[1].begin, -0.5);
  EXPECT_DOUBLE_EQ(segments[1].end, 0.0);
  EXPECT_DOUBLE_EQ(segments[2].begin, 0.25);
  EXPECT_DOUBLE_EQ(segments[2].end, 1.0);
  EXPECT_DOUBLE_EQ(segments[3].begin, -0.625);
  EXPECT_DOUBLE_EQ(segments[3].end, -0.5);
}

TEST(BarScale, HoldsAllBarsOnARoundLength) {
  const BarScale scale = choose_bar_scale({{{0.0, 0.03, -0.004, 0.01}}, {{0.0, 0.01, 0.0, -0.013}}});
  EXPECT_DOUBLE_EQ(scale.below, 0.013);
  EXPECT_DOUBLE_EQ(scale.length, 0.06);
  EXPECT_DOUBLE_EQ(choose_bar_scale({{}}).length, 0.001);
}

TEST(PlaceBar, Lengths_AreInPixelsOfTheScale) {
  const BarPlace bar = place_bar({{0.0, 0.5, -0.25, 0.25}}, {0.5, 2.0}, kBox, 3);
  EXPECT_EQ(bar.tile, 3u);
  EXPECT_EQ(bar.zero_line.x, 110);
  EXPECT_EQ(bar.net_tick.x + bar.net_tick.width / 2, 210);
  ASSERT_EQ(bar.segments.size(), 3u);
  const int expected[3][2] = {{110, 100}, {60, 50}, {210, 50}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(bar.segments[i].box.x, expected[i][0]);
    EXPECT_EQ(bar.segments[i].box.width, expected[i][1]);
    EXPECT_EQ(bar.segments[i].part, i + 1);
  }
}

TEST(PlaceBar, Everything_LiesInTheBox) {
  for (const double below : {0.0, 0.3, 1.0}) {
    const BarPlace bar = place_bar({{0.0, -below, 0.0, 1.0}}, {below, below + 1.0}, kBox, 0);
    for (const Rect& r : {bar.track, bar.zero_line, bar.net_tick}) {
      EXPECT_GE(r.x, kBox.x);
      EXPECT_LE(r.x + r.width, kBox.x + kBox.width);
    }
    for (const SegmentBox& segment : bar.segments) {
      EXPECT_GE(segment.box.x, kBox.x);
      EXPECT_LE(segment.box.x + segment.box.width, kBox.x + kBox.width);
    }
  }
}

TEST(PlaceBar, TickStandsOutAboveAndBelowTheParts) {
  const BarPlace bar = place_bar({{0.0, 1.0, 0.0, 0.0}}, {0.0, 1.0}, kBox, 0);
  EXPECT_LT(bar.net_tick.y, bar.segments[0].box.y);
  EXPECT_GT(bar.net_tick.y + bar.net_tick.height, bar.segments[0].box.y + bar.segments[0].box.height);
}

}  // namespace
}  // namespace shadowbench::images
