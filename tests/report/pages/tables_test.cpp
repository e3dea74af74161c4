#include "report/pages/tables.h"

#include <gmock/gmock.h>

#include "report/page/markdown.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::pages {

using namespace records;
namespace {

using ::testing::HasSubstr;

TEST(SummaryMd, HoldsTheRunTheTablesAndTheReasons) {
  records::RunRecord run = make_run();
  run.warnings = {"something is odd"};
  const std::string summary = make_summary(run, {make_cell("cubes", "vsm", 4.5), make_cell("stack", "vsm", 4.5)});
  for (const char* text : {"Some CPU", "llvmpipe", "All times are CPU time (software rasteriser)", "## cubes",
                           "## stack", "| vsm |", "something is odd", "error: no truth in this run (2 of 2 cells)",
                           "`lookup_median_ms`: filtered lookup", "Debian GNU/Linux 12", "40 passes run"})
    EXPECT_THAT(summary, HasSubstr(text));
}

TEST(SummaryMd, Names_CannotBreakTheTable) {
  EXPECT_EQ(page::escape_markdown("a|b\n<c> `d` *e* [f]_g"), "a\\|b \\<c\\> \\`d\\` \\*e\\* \\[f\\]\\_g");
  records::CellRecord cell = make_cell("a|b", "x|y", 4.0);
  cell.message = "line 1\nline 2 | 3";
  cell.status = records::CellStatus::kError;
  EXPECT_THAT(make_summary(make_run(), {cell}), HasSubstr("| x\\|y |"));
  EXPECT_THAT(make_summary(make_run(), {cell}), HasSubstr("line 1 line 2 \\| 3 |"));
}

TEST(SummaryMd, HasATableOfCostsAndOneOfErrors) {
  const std::string summary = make_summary(make_run(), {make_attributed_cell("vsm", 0.04, {0.001, 0.71, 0.089, 0.2})});
  for (const char* text : {"### What it costs", "### How wrong it is, and why", "| estimator 71 % |",
                           "`estimator_share`:", "5 truths ray traced", "Most of the error of vsm"})
    EXPECT_THAT(summary, HasSubstr(text));
}

}  // namespace
}  // namespace shadowbench::pages
