#include "report/records/csv_tables.h"

#include <gmock/gmock.h>

#include "reference/metrics/metric_table.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::records {
namespace {

using ::testing::Each;
using ::testing::SizeIs;

// Reads CSV by RFC 4180: what a spreadsheet would see.
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quoted && text.compare(i, 2, "\"\"") == 0) {
      rows.back().back() += text[++i];
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (!quoted && text[i] == ',') {
      rows.back().emplace_back();
    } else if (!quoted && text.compare(i, 2, "\r\n") == 0) {
      rows.push_back({""});
      ++i;
    } else {
      rows.back().back() += text[i];
    }
  }
  rows.pop_back();
  return rows;
}

std::string field(const std::vector<std::vector<std::string>>& rows, std::size_t row, const std::string& column) {
  const auto found = std::find(rows[0].begin(), rows[0].end(), column);
  EXPECT_NE(found, rows[0].end()) << column;
  return rows.at(row).at(static_cast<std::size_t>(found - rows[0].begin()));
}

TEST(TimingsCsv, EveryRow_HasEveryColumn) {
  CellRecord failed;
  failed.scene = "a \"scene\",\r\nwith everything";
  failed.status = CellStatus::kCrashed;
  failed.message = "signal 11, \"segfault\"";
  const auto rows = parse_csv(make_csv(CsvTable::kTimings, make_run(), {make_cell("cubes", "vsm", 4.5), failed}));
  ASSERT_THAT(rows, SizeIs(3));
  EXPECT_THAT(rows, Each(SizeIs(list_csv_columns(CsvTable::kTimings).size())));
  EXPECT_EQ(field(rows, 2, "scene"), failed.scene);
  EXPECT_EQ(field(rows, 2, "message"), failed.message);
  EXPECT_EQ(field(rows, 2, "lookup_median_ms"), "");
}

TEST(TimingsCsv, Formulas_AreDefused_AndNumbersAreNot) {
  for (const std::string text : {"=cmd", "=1+1", "+cmd", "+1+1", "-cmd", "-1+1", "@SUM(A1)", "\tx"})
    EXPECT_EQ(quote_csv(text), "'" + text);
  EXPECT_EQ(quote_csv("=a,b"), "\"'=a,b\"");
  EXPECT_EQ(quote_csv("\r=a"), "\"'\r=a\"");
  for (const std::string text : {"-1", "-0.5", "-1e-05", "-inf", "1", "a=b", ""}) EXPECT_EQ(quote_csv(text), text);
}

TEST(TimingsCsv, OnlyFieldsThatNeedIt_AreQuoted) {
  EXPECT_EQ(quote_csv("a b; c"), "a b; c");
  EXPECT_EQ(quote_csv("a,b"), "\"a,b\"");
  EXPECT_EQ(quote_csv("a\"b"), "\"a\"\"b\"");
  EXPECT_EQ(quote_csv("a\nb"), "\"a\nb\"");
  EXPECT_EQ(quote_csv("a\rb"), "\"a\rb\"");
}

TEST(TimingsCsv, Fields_HoldTheirColumnsValues) {
  CellRecord cell = make_cell("cubes", "vsm", 4.5);
  cell.time_ms.prefilter = Quartiles{12.5, 12.25, 12.75, 8};
  cell.range = {"repeat", true, false};
  cell.ratio_to_none.static_light = Ratio{1.5, {1.25, 1.75}};
  cell.ratio_to_none.moving = Ratio{2.5, {2.25, 2.75}};
  const auto rows = parse_csv(make_csv(CsvTable::kTimings, make_run(), {cell}));
  EXPECT_EQ(field(rows, 1, "clock"), "CPU time (software rasteriser)");
  EXPECT_EQ(field(rows, 1, "machine"), "");
  EXPECT_EQ(field(rows, 1, "params"), R"({"radius":4,"store":"rg32f"})");
  EXPECT_EQ(field(rows, 1, "lookup_median_ms"), "4.5");
  EXPECT_EQ(field(rows, 1, "border"), "repeat");
  EXPECT_EQ(field(rows, 1, "far_test"), "on");
  EXPECT_EQ(field(rows, 1, "behind_test"), "off");
  EXPECT_EQ(field(rows, 1, "prefilter_q1_ms"), "12.25");
  EXPECT_EQ(field(rows, 1, "prefilter_n"), "8");
  EXPECT_EQ(field(rows, 1, "map_q3_ms"), "3.75");
  EXPECT_EQ(field(rows, 1, "ratio_lookup_median"), "1.125");
  EXPECT_EQ(field(rows, 1, "ratio_static_low"), "1.25");
  EXPECT_EQ(field(rows, 1, "ratio_moving_high"), "2.75");
  EXPECT_EQ(field(rows, 1, "map_bytes"), "4194304");
  EXPECT_EQ(field(rows, 1, "key"), cell.key);
}

TEST(TimingsCsv, ClockAndMachine_AreTheCellsOwn) {
  CellRecord cell = make_cell("cubes", "vsm", 4.5);
  cell.machine = {"A CPU", 3, "A GPU", false, TimerKind::kTimerQuery};
  const auto rows = parse_csv(make_csv(CsvTable::kTimings, make_run(), {cell}));
  EXPECT_EQ(field(rows, 1, "clock"), "GPU time (timer query)");
  EXPECT_EQ(field(rows, 1, "machine"), "A CPU, 3 cores, A GPU, GPU time (timer query)");
}

TEST(TimingsCsv, Numbers_ReadBackAsTheSameDoubles) {
  const double value = 0.1 + 0.2;
  CellRecord cell = make_cell("cubes", "vsm", value);
  const auto rows = parse_csv(make_csv(CsvTable::kTimings, make_run(), {cell}));
  EXPECT_EQ(std::stod(field(rows, 1, "lookup_median_ms")), value);
}

TEST(AccuracyCsv, HoldsTheErrors_AndEmptyFieldsWhereThereAreNone) {
  CellRecord scored = make_cell("cubes", "vsm", 4.5);
  scored.error.rmse = 0.25;
  scored.error.mean = -0.125;
  scored.truth.se = 0.0009765625;
  const auto rows = parse_csv(make_csv(CsvTable::kAccuracy, make_run(), {scored, make_cell("cubes", "none", 1.0)}));
  ASSERT_THAT(rows, SizeIs(3));
  EXPECT_THAT(rows, Each(SizeIs(list_csv_columns(CsvTable::kAccuracy).size())));
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin());
  };
  EXPECT_EQ(rows[1][column("rmse")], "0.25");
  EXPECT_EQ(rows[1][column("mean")], "-0.125");
  EXPECT_EQ(rows[1][column("truth_se")], "0.0009765625");
  EXPECT_EQ(rows[1][column("max")], "");
}

// The column of a record's field: "error.rmse" is rmse, "truth.se" is truth_se, "attribution.model.rms" is model_rms.
std::string column_of(std::string path) {
  for (const char* group : {"error.", "coverage.", "artefact.", "attribution.", "stability."})
    if (path.rfind(group, 0) == 0) path.erase(0, std::string(group).size());
  std::replace(path.begin(), path.end(), '.', '_');
  return path;
}

TEST(AccuracyCsv, EveryFieldOfTheRecord_HasItsColumnAndItsMeaning) {
  std::vector<std::string> names;
  for (const CsvColumn& column : list_csv_columns(CsvTable::kAccuracy)) {
    EXPECT_FALSE(column.meaning.empty()) << column.name;
    EXPECT_THAT(names, ::testing::Not(::testing::Contains(column.name)));
    names.push_back(column.name);
  }
  for (const metrics::Metric& metric : metrics::metric_table()) {
    const bool elsewhere = metric.group() == "cost" || metric.group() == "map_scale";
    if (!elsewhere) EXPECT_THAT(names, ::testing::Contains(column_of(std::string(metric.path))));
  }
}

}  // namespace
}  // namespace shadowbench::records
