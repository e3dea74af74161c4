// A metric is one row: this program links the project with a table that has one more, and finds it everywhere.
#include "tests/report/added_metric/added_metric.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "report/analysis/measures.h"
#include "report/pages/tables.h"
#include "report/records/csv_tables.h"
#include "report/records/json_io.h"
#include "report/regress/tolerances.h"

namespace shadowbench {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr const char* kPath = "artefact.banding";

class AddedMetric : public ::testing::Test {
 protected:
  AddedMetric() { metrics::added_value = 0.125; }
  const records::CellRecord cell_;
};

TEST_F(AddedMetric, HasItsColumnInTheCsv) {
  const auto columns = list_csv_columns(records::CsvTable::kAccuracy);
  const auto column = std::ranges::find(columns, "banding", &records::CsvColumn::name);
  ASSERT_NE(column, columns.end());
  EXPECT_THAT(column->meaning, HasSubstr("those in a band"));
  EXPECT_THAT(make_csv(records::CsvTable::kAccuracy, {}, {cell_}), HasSubstr(",0.125,"));
}

TEST_F(AddedMetric, IsWrittenAndRead) {
  const nlohmann::json json = records::to_json(cell_);
  EXPECT_EQ(json.at("artefact").at("banding"), 0.125);
  metrics::added_value.reset();
  EXPECT_EQ(records::to_json(cell_).at("absent").at("artefact"), "not measured");
  nlohmann::json with_key = json;
  with_key["key"] = "0123456789abcdef";
  records::cell_from_json(with_key, "here");
  EXPECT_EQ(metrics::added_value, 0.125);
}

TEST_F(AddedMetric, IsInTheSchema) {
  const nlohmann::json schema = nlohmann::json::parse(records::results_schema());
  const nlohmann::json group = schema.at("$defs").at("cell").at("properties").at("artefact");
  EXPECT_EQ(group.at("properties").at("banding").at("maximum"), 1);
}

TEST_F(AddedMetric, IsListed) {
  EXPECT_THAT(records::make_metric_text(),
              HasSubstr("artefact.banding  share, 0 .. 1, less is better\n  of the receivers: those in a band\n"));
  EXPECT_EQ(nlohmann::json::parse(records::make_metric_json()).back().at("path"), kPath);
}

TEST_F(AddedMetric, IsOneThatDiffMeasures) { EXPECT_EQ(metrics::picture_metrics().back().path, kPath); }

TEST_F(AddedMetric, HasItsColumnInTheTableOfErrors) {
  const records::TextTable table = pages::make_accuracy_table({"cubes", {cell_}});
  EXPECT_THAT(table.header, Contains("banding"));
  EXPECT_THAT(table.rows.at(0), Contains("12.5 %"));
}

TEST_F(AddedMetric, HasItsTolerance) {
  EXPECT_THAT(regress::list_limited_metrics(), Contains(kPath));
  EXPECT_EQ(regress::Tolerances().find("vsm", kPath).limit, 0.01);
  EXPECT_EQ(regress::read_values(cell_).numbers.at(kPath), 0.125);
}

TEST_F(AddedMetric, MayBeLimited) {
  const auto limit = std::ranges::find(analysis::limit_table(), "--max-banding", &analysis::Quantity::option);
  ASSERT_NE(limit, analysis::limit_table().end());
  EXPECT_EQ(limit->read(cell_, analysis::LightMotion::kMoving), 0.125);
}

}  // namespace
}  // namespace shadowbench
