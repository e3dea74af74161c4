#include "report/regress/tolerances.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "tests/test_files.h"

namespace shadowbench::regress {
namespace {

class ToleranceFile : public ::testing::Test {
 protected:
  Tolerances read(const std::string& text) const { return read_tolerances(folder_.write("tolerances.toml", text)); }

  /// Expects one message that names the line and holds the words.
  void expect_refusal(const std::string& text, int line, const std::string& words) const {
    const Error error = error_of([&] { read(text); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput) << text;
    EXPECT_EQ(error.where(), (folder_.path() / "tolerances.toml").string() + ":" + std::to_string(line));
    EXPECT_THAT(error.message(), ::testing::HasSubstr(words));
  }

  TestFolder folder_;
};

TEST_F(ToleranceFile, WhatIsWritten_IsReadBack) {
  Tolerances written;
  written.set("vsm", "error.rmse", {0.25, "moments \"of\" 16 bits \\ here"});
  written.set("", "ratio_to_none.lookup", {HUGE_VAL, "not compared"});
  const Tolerances back = read(write_tolerances(written));
  for (const std::string& metric : list_limited_metrics()) {
    for (const char* filter : {"vsm", "none"}) {
      EXPECT_EQ(back.find(filter, metric).limit, written.find(filter, metric).limit) << filter << " " << metric;
      EXPECT_EQ(back.find(filter, metric).reason, written.find(filter, metric).reason) << filter << " " << metric;
    }
  }
  EXPECT_EQ(back.find("vsm", "error.rmse").limit, 0.25);
}

TEST_F(ToleranceFile, OfOneFilter_LeavesTheOthersAsTheyAre) {
  const Tolerances read_back = read("[filter.\"esm\".\"visibility.pixel\"]\nlimit = 0.5\nreason = \"r\"\n");
  EXPECT_EQ(read_back.find("esm", kPixel).limit, 0.5);
  EXPECT_EQ(read_back.find("vsm", kPixel).limit, Tolerances().find("vsm", kPixel).limit);
}

TEST_F(ToleranceFile, EveryToleranceHasItsReason) {
  const Tolerances fresh;
  for (const std::string& metric : list_limited_metrics())
    EXPECT_FALSE(fresh.find("any", metric).reason.empty()) << metric;
}

TEST_F(ToleranceFile, BadFiles_AreRefusedWithTheirLine) {
  expect_refusal("[all.\"error.rmse\"]\nlimit = 0.1\n", 1, "needs a reason");
  expect_refusal("[all.\"error.rmse\"]\nlimit = 0.1\nreason = \"\"\n", 1, "needs a reason");
  expect_refusal("[all.\"error.rmse\"]\nlimit = -0.1\nreason = \"r\"\n", 1, "limit of 0 or more");
  expect_refusal("[all.\"error.rmse\"]\nlimit = nan\nreason = \"r\"\n", 1, "limit of 0 or more");
  expect_refusal("[all.\"error.rmse\"]\nreason = \"r\"\n", 1, "limit of 0 or more");
  expect_refusal("[all.\"error.rms\"]\nlimit = 0\nreason = \"r\"\n", 1, "did you mean 'error.rmse'?");
  expect_refusal("\n[other.\"error.rmse\"]\nlimit = 0\nreason = \"r\"\n", 2,
                 "unknown key 'other' in the tolerances; known: all, filter");
  expect_refusal("[all.\"error.rmse\"]\nlimit = 0\nreason = \"r\"\nwhy = 1\n", 4,
                 "unknown key 'why' in [error.rmse]; known: limit, reason");
  expect_refusal("all = 3\n", 1, "must be a table");
  expect_refusal("[all\n", 1, "");
}

}  // namespace
}  // namespace shadowbench::regress
