#include "report/records/cell_key.h"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "report/files/file_name.h"
#include "synthetic.h"

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
}  // namespace shadowbench::records
