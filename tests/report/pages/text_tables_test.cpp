#include <gmock/gmock.h>

#include "report/pages/tables.h"
#include "report/records/format.h"
#include "report/records/text_table.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::pages {

using namespace records;
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

std::string field(const records::TextTable& table, std::size_t row, const std::string& column) {
  const auto found = std::find(table.header.begin(), table.header.end(), column);
  EXPECT_NE(found, table.header.end()) << column;
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.header.begin()));
}

records::CellRecord make_empty() {
  records::CellRecord empty;
  empty.filter = "mine";
  return empty;
}

TEST(CostTable, Rows_AreAsLongAsTheHeader) {
  const records::TextTable table =
      make_cost_table({"cubes", {make_cell("cubes", "vsm", 4.0), make_empty()}}, make_run().gl);
  EXPECT_THAT(table.rows, Each(SizeIs(table.header.size())));
  EXPECT_THAT(table.header, Contains("lookup, ms (CPU), median [quartiles]"));
  EXPECT_THAT(table.rows[0], Contains("4 [3.92, 4.08]"));
  EXPECT_THAT(table.rows[1], Not(Contains(HasSubstr("nan"))));
}

TEST(AccuracyTable, HoldsErrorsPartsAndArtefacts) {
  records::CellRecord cell = make_attributed_cell("vsm", 0.04, {0.001, 0.71, 0.089, 0.2});
  cell.artefact.acne = 0.0;
  cell.artefact.leak = 0.0421;
  cell.artefact.contact_gap = 0.00012;
  cell.artefact.noise = 0.5;
  cell.rmse_ci95 = records::Interval{0.03, 0.05};
  const records::TextTable table = make_accuracy_table({"cubes", {cell}});
  EXPECT_EQ(field(table, 0, "RMSE to the area truth [95 % over phases]"), "0.04 [0.03, 0.05]");
  EXPECT_EQ(field(table, 0, "kernel width (class)"), "0.65 texels (medium)");
  EXPECT_EQ(field(table, 0, "mean signed error"), "-0.005");
  EXPECT_EQ(field(table, 0, "RMSE to the kernel truth, first phase"), "0.02");
  EXPECT_EQ(field(table, 0, "dominating part, first phase"), "estimator 71 %");
  EXPECT_EQ(field(table, 0, "acne, first phase"), "0 %");
  EXPECT_EQ(field(table, 0, "leak, first phase"), "4.21 %");
  EXPECT_EQ(field(table, 0, "contact gap, first phase"), "0.012 %");
  EXPECT_EQ(field(table, 0, "noise, first phase"), "50 %");
  EXPECT_EQ(field(table, 0, "share of numeric / estimator / discretisation / model, first phase"),
            "0 % / 71 % / 9 % / 20 %");
}

TEST(AccuracyTable, WhatDoesNotExist_IsADash) {
  const records::TextTable table = make_accuracy_table({"cubes", {make_empty(), make_empty()}});
  ASSERT_THAT(table.rows, Each(SizeIs(table.header.size())));
  for (std::size_t i = 1; i < table.header.size(); ++i)
    EXPECT_EQ(table.rows[0][i], records::kNothing) << table.header[i];
}

TEST(AccuracyTable, DominatingPart_IsNamedOnlyWhereOneDoes) {
  const records::TextTable table = make_accuracy_table({"cubes",
                                                        {make_attributed_cell("a", 0.04, {0.0, 0.5, 0.1, 0.4}),
                                                         make_attributed_cell("b", 0.0005, {0.0, 0.9, 0.1, 0.0})}});
  EXPECT_EQ(field(table, 0, "dominating part, first phase"), "none");
  EXPECT_EQ(field(table, 1, "dominating part, first phase"), "none: within the truth's own error");
}

}  // namespace
}  // namespace shadowbench::pages
