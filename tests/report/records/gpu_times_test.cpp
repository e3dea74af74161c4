// Times of a browser's GPU in place of a run's.

#include "report/records/gpu_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/files.h"
#include "tests/test_files.h"

namespace shadowbench::records {
namespace {

using ::testing::HasSubstr;

constexpr const char* kFilter = R"({"median": 2, "interval": [1.5, 2.5], "rounds": 11})";

class GpuTimesTest : public ::testing::Test {
 protected:
  const ScratchFolder scratch_{make_temporary_folder_path(std::filesystem::temp_directory_path() / "times", "test")};
  const std::filesystem::path file_ = scratch_.path() / "gpu-times.json";

  GpuTimes read(const std::string& text) const {
    std::filesystem::create_directories(scratch_.path());
    std::ofstream(file_) << text;
    return read_gpu_times(file_);
  }

  static std::string write(const std::string& map, const std::string& prefilter, const std::string& key = "a") {
    return R"({"schema": "shadowbench gpu-times 1", "renderer": "A GPU", "isSoftware": false, "cells": {")" + key +
           R"(": {"map": )" + map + R"(, "prefilter": )" + prefilter + R"(, "filter": )" + kFilter + "}}}";
  }

  std::string refusal_of(const std::string& text) const {
    const Error error = error_of([&] { read(text); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.where(), file_.string());
    return error.message();
  }
};

TEST_F(GpuTimesTest, AFrameIsTheSumOfItsParts_AndACellThatWasNotTimedHasNoTime) {
  const GpuTimes times = read(
      write(R"({"median": 1, "interval": null, "rounds": 9})", R"({"median": 4, "interval": [3, 6], "rounds": 10})"));
  Results results;
  results.cells.resize(2);
  results.cells[0].key = "a";
  results.cells[1].key = "b";
  results.cells[1].time_ms.lookup = Quartiles{};
  apply_gpu_times(results, times);
  EXPECT_EQ(results.run.gl.renderer, "A GPU");
  const TimeRecord& timed = results.cells[0].time_ms;
  EXPECT_DOUBLE_EQ(timed.moving->median, 7.0);
  EXPECT_DOUBLE_EQ(timed.moving->ci95.low, 5.5);
  EXPECT_DOUBLE_EQ(timed.moving->ci95.high, 9.5);
  EXPECT_EQ(timed.moving->n, 9);
  EXPECT_DOUBLE_EQ(timed.static_light->median, 2.0);
  EXPECT_FALSE(results.cells[1].time_ms.lookup);
  EXPECT_EQ(results.cells[1].absent.at("time_ms"), "A GPU did not time it");
}

TEST_F(GpuTimesTest, WhatIsNoFileOfTimesIsRefused) {
  EXPECT_THAT(refusal_of("{"), HasSubstr("no JSON"));
  EXPECT_THAT(refusal_of("[]"), HasSubstr("schema"));
  EXPECT_THAT(refusal_of(R"({"schema": "another"})"), HasSubstr("schema is not \"shadowbench gpu-times 1\""));
  EXPECT_THAT(refusal_of(R"({"schema": "shadowbench gpu-times 1"})"), HasSubstr("no renderer"));
  EXPECT_THAT(refusal_of(write("7", "null")), HasSubstr("of the cell a is no time"));
  EXPECT_THAT(refusal_of(write(R"({"median": 1e10, "interval": null, "rounds": 9})", "null")), HasSubstr("is no time"));
  EXPECT_THAT(refusal_of(write(R"({"median": 1, "interval": [1], "rounds": 9})", "null")), HasSubstr("no time"));
  EXPECT_THAT(refusal_of(write(R"({"median": 1, "interval": null, "rounds": 0})", "null")), HasSubstr("is no time"));
  EXPECT_THAT(refusal_of(std::string(17 << 20, ' ')), HasSubstr("MiB"));
}

TEST_F(GpuTimesTest, WhereTheMapCouldNotBeDrawn_OnlyAStaticLightHasATime) {
  const GpuTimes times = read(write("null", kFilter));
  Results results;
  results.cells.resize(1);
  results.cells[0].key = "a";
  apply_gpu_times(results, times);
  EXPECT_FALSE(results.cells[0].time_ms.moving || results.cells[0].time_ms.map);
  EXPECT_DOUBLE_EQ(results.cells[0].time_ms.static_light->median, 2.0);
}

TEST_F(GpuTimesTest, TimesOfAnotherRunAreRefused) {
  const GpuTimes times = read(write(kFilter, "null", "elsewhere"));
  Results results;
  results.cells.resize(1);
  EXPECT_THROW(apply_gpu_times(results, times), Error);
}

}  // namespace
}  // namespace shadowbench::records
