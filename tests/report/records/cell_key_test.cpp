#include "report/records/cell_key.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "report/files/file_name.h"
#include "synthetic.h"

// Short names say what differs, and no more.

namespace shadowbench::records {
namespace {

TEST(CellKey, Hash_EqualsPublishedValuesOfFnv1a) {
  EXPECT_EQ(files::hash_text(""), 0xcbf29ce484222325U);
  EXPECT_EQ(files::hash_text("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(files::hash_text("foobar"), 0x85944171f73967e8U);
}

TEST(CellKey, OrderOfKeysAndWayOfWritingNumbers_DoNotMatter) {
  const auto a = nlohmann::json::parse(R"({"x": 4, "y": {"b": 1e-5, "a": true}})");
  const auto b = nlohmann::json::parse(R"({ "y":{"a":true,"b":0.00001}, "x": 4.0 })");
  EXPECT_EQ(cell_key(a), cell_key(b));
}

TEST(CellKey, ARadiusByTheLight_IsNamedByTheLight) {
  CellRecord cell = make_cell("cubes", "vsm", 1.0);
  cell.params["radius"] = 4.0;
  const std::string told = cell_key(cell);
  cell.kernel.by_light = "radius";
  const std::string by_light = cell_key(cell);
  EXPECT_NE(told, by_light);
  cell.params["radius"] = 9.0;
  EXPECT_EQ(cell_key(cell), by_light) << "scene, light and map decide it, and are in the key";
}

TEST(CellKey, EverySetting_ChangesTheKey) {
  const std::vector<std::function<void(CellRecord&)>> changes = {
      [](CellRecord& c) { c.scene += "x"; },
      [](CellRecord& c) { c.view += "x"; },
      [](CellRecord& c) { c.filter += "x"; },
      [](CellRecord& c) { c.params["radius"] = 5.0; },
      [](CellRecord& c) { c.params["store"] = std::string("rg16f"); },
      [](CellRecord& c) { c.params["more"] = true; },
      [](CellRecord& c) { c.map_size = 2048; },
      [](CellRecord& c) { c.map_format += "x"; },
      [](CellRecord& c) { c.fit = "view"; },
      [](CellRecord& c) { c.light = "120,35"; },
      [](CellRecord& c) { c.bias.constant.depth = 1e-4; },
      [](CellRecord& c) { c.bias.plane_texels = 1.0; },
      [](CellRecord& c) { c.bias.plane_kernels = 1.0; },
      [](CellRecord& c) { c.bias.normal_offset.texels = 1.0; },
      [](CellRecord& c) { c.bias.receiver_plane = true; },
      [](CellRecord& c) { c.bias.front_cull = true; },
      [](CellRecord& c) { c.range.border = "repeat"; },
      [](CellRecord& c) { c.range.far_test = false; },
      [](CellRecord& c) { c.range.behind_test = false; },
      [](CellRecord& c) { c.width = 540; },
      [](CellRecord& c) { c.height = 960; },
  };
  std::set<std::string> keys{make_cell("cubes", "vsm", 4.0).key};
  for (const auto& change : changes) {
    CellRecord cell = make_cell("cubes", "vsm", 4.0);
    change(cell);
    keys.insert(cell_key(cell));
  }
  EXPECT_EQ(keys.size(), changes.size() + 1);
}

TEST(CellKey, Results_DoNotChangeTheKey) {
  EXPECT_EQ(make_cell("cubes", "vsm", 4.0).key, make_cell("cubes", "vsm", 5.0).key);
}

TEST(CellKey, OnlySixteenHexadecimalDigits_AreAKey) {
  EXPECT_TRUE(is_cell_key(make_cell("cubes", "vsm", 4.0).key));
  EXPECT_FALSE(is_cell_key("../../../../etc/x"));
  EXPECT_FALSE(is_cell_key("0123456789ABCDEF"));
  EXPECT_FALSE(is_cell_key(""));
}

}  // namespace

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
