// Short names say what differs, and no more.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/records/cell_key.h"

namespace shadowbench::records {
namespace {

using ::testing::ElementsAre;

CellRecord make_named(const char* filter, const char* fit = "tight", int map_size = 1024, ParamMap params = {}) {
  CellRecord cell;
  cell.filter = filter;
  cell.fit = fit;
  cell.map_size = map_size;
  cell.params = std::move(params);
  return cell;
}

std::vector<std::string> list_names(const std::vector<CellRecord>& cells) {
  std::vector<const CellRecord*> pointers;
  for (const CellRecord& cell : cells) pointers.push_back(&cell);
  const CellNames names(pointers);
  std::vector<std::string> all;
  for (const CellRecord& cell : cells) all.push_back(names.name(cell));
  return all;
}

constexpr const char* kPractical = "cascades:count=4,split=0.5,blend=0.1,depths=all";

TEST(CellNames, SayWhatDiffers) {
  EXPECT_THAT(list_names({make_named("none"), make_named("vsm", "tight", 1024, {{"radius", 4.0}})}),
              ElementsAre("none", "vsm"));
  EXPECT_THAT(list_names({make_named("vsm", "tight", 1024, {{"radius", 4.0}, {"store", std::string("rg32f")}}),
                          make_named("vsm", "tight", 1024, {{"radius", 8.0}, {"store", std::string("rg32f")}})}),
              ElementsAre("vsm (radius 4)", "vsm (radius 8)"));
  EXPECT_THAT(
      list_names({make_named("pcf2x2"), make_named("pcf2x2", kPractical), make_named("pcf2x2", kPractical, 512)}),
      ElementsAre("pcf2x2, map 1024, tight fit", "pcf2x2, map 1024, 4 cascades", "pcf2x2, map 512, 4 cascades"));
}

TEST(CellNames, OfCascades_NameTheValuesInWhichTheyDiffer) {
  EXPECT_THAT(
      list_names({make_named("none", kPractical), make_named("none", "cascades:count=4,split=1,blend=0.1,depths=all"),
                  make_named("none", "view")}),
      ElementsAre("none, 4 cascades, split 0.5", "none, 4 cascades, split 1", "none, view fit"));
  EXPECT_THAT(list_names({make_named("none", "view"), make_named("none", "view snapped")}),
              ElementsAre("none, view fit", "none, view fit snapped"));
}

TEST(CellNames, NameTheBiasTheLightAndTheBorder) {
  CellRecord biased = make_named("none"), lit = biased, edged = biased;
  biased.bias.midpoint = true;
  EXPECT_THAT(list_names({biased, make_named("none")}), ElementsAre("none, bias: midpoint map", "none, bias: none"));
  lit.light = "96,30";
  EXPECT_THAT(list_names({lit, make_named("none")}), ElementsAre("none, light at 96,30", "none, light of the scene"));
  edged.range.border = "edge";
  EXPECT_THAT(list_names({edged, make_named("none")}), ElementsAre("none, outside the map: edge", "none"));
}

}  // namespace
}  // namespace shadowbench::records
