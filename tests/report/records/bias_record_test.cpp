// What `bias` recommends, as a report's folder keeps it.

#include "report/records/bias_record.h"

#include <sys/stat.h>

#include "tests/test_files.h"

namespace shadowbench::records {
namespace {

TEST(BiasSweep, Csv_HasARowPerAmount_AbsentIsEmpty) {
  BiasSweepRecord sweep{"sun"};
  sweep.cells.resize(2);
  for (BiasCell& cell : sweep.cells) cell.scene = "steps";
  BiasCell &amount = sweep.cells[0], &fixed = sweep.cells[1];
  amount.mode = "constant";
  amount.key = "depth";
  amount.filter = "poisson (taps 8, radius 2)";
  amount.factor = amount.setting = 0.5;
  amount.lift_depth = 0.005;
  amount.acne = 0.25;
  fixed.mode = "midpoint";
  fixed.filter = "none";
  fixed.acne = 0.125;
  EXPECT_THAT(make_bias_csv({sweep}),
              EndsWith("\r\nsteps,,0,constant,depth,\"poisson (taps 8, radius 2)\",0.5,0.5,0.005,,,0.25,\r\n"
                       "steps,,0,midpoint,,none,,,,,,0.125,\r\n"));
}

TEST(BiasToShip, IsReadFromTheReportsFolder_AsItWasWritten) {
  const ScratchFolder report(
      make_temporary_folder_path(std::filesystem::temp_directory_path() / "shadowbench", "bias"));
  std::vector<std::string> warnings;
  EXPECT_TRUE(read_recommended_biases(report.path(), warnings).empty());
  std::filesystem::create_directories(report.path() / "bias");
  const auto write = [&](const std::string& text) { std::ofstream(report.path() / "bias" / "bias.json") << text; };
  const BiasCell ship{.scene = "city.sun",
                      .light = "sun",
                      .view = "main",
                      .map_size = 512,
                      .fit = "tight",
                      .filter = "vsm (radius=6)",
                      .id = "vsm",
                      .params = {{"radius", 6.0}, {"store", "rg32f"}},
                      .mode = {},
                      .key = {},
                      .bias = "plane:texels=1"};
  write(make_bias_json({ship}));
  const auto read = read_recommended_biases(report.path(), warnings);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(make_bias_json(read), make_bias_json({ship}));
  EXPECT_TRUE(warnings.empty());
  CellRecord cell;
  cell.scene = "city.sun";
  cell.map_size = 512;
  cell.fit = "tight";
  cell.filter = "vsm";
  cell.params = ship.params;
  EXPECT_TRUE(read[0].is_of(cell));
  cell.fit = "cascades";
  EXPECT_FALSE(read[0].is_of(cell));
  cell.fit = "tight";
  cell.params["radius"] = 5.0;
  EXPECT_FALSE(read[0].is_of(cell));
  for (const char* text : {"no JSON", "{}", R"({"schema": "shadowbench bias 3", "bias_to_ship": [{"scene": 3}]})"}) {
    warnings.clear();
    write(text);
    EXPECT_TRUE(read_recommended_biases(report.path(), warnings).empty());
    EXPECT_EQ(warnings.size(), 1u) << text;
  }
  std::filesystem::remove(report.path() / "bias" / "bias.json");
  ASSERT_EQ(mkfifo((report.path() / "bias" / "bias.json").c_str(), 0600), 0);
  EXPECT_TRUE(read_recommended_biases(report.path(), warnings).empty()) << "and does not wait for a writer";
}

}  // namespace
}  // namespace shadowbench::records
