// Costs on GPUs that are not there, as a user sees them: in the record, in advice, and where the driver fails.

#include "harness/gpu/gpu.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

constexpr const char* kGpuRun = "run --out out --fresh --scene cubes --rounds 1 --phases 1 --width own --map-size ";

/// A filter without weights: the mean of so many hardware fetches along a side.
std::string plain_pcf(int side) {
  return filters::write_filter(
      fmt::format("radius_texels = {}\n", side),
      fmt::format("float visibility(Receiver r) {{\n  float sum = 0.0;\n"
                  "  for (int y = 0; y < {0}; ++y)\n    for (int x = 0; x < {0}; ++x)\n"
                  "      sum += compare_2x2(r, vec2(x, y) - {1:.1f}, r.depth);\n  return sum / {2:.1f};\n}}\n",
                  side, 0.5 * (side - 1), 1.0 * side * side));
}

class Gpus : public ProgramTest {
 protected:
  /// The cells of a run by filter; skips the test where there is no compiler.
  std::map<std::string, json> measure(const std::string& arguments, const std::string& environment = "",
                                      const std::string& size = "128 --size 96x54 ") {
    const Outcome outcome = succeed(kGpuRun + size + arguments, environment);
    messages_ = outcome.err;
    std::map<std::string, json> cells;
    const json results = json::parse(read("out/results.json"), nullptr, false);
    if (results.is_object())
      for (const json& cell : results["cells"]) cells[cell["filter"]] = cell;
    return cells;
  }

  bool has_no_compiler() const { return messages_.find("no costs on") != std::string::npos; }

  /// A loader's list of one driver.
  std::string use_driver(const std::string& library) const {
    const auto file = write(
        "driver.json",
        json{{"file_format_version", "1.0.0"}, {"ICD", {{"library_path", library}, {"api_version", "1.3.0"}}}}.dump());
    return "VK_DRIVER_FILES='" + file.string() + "' VK_ICD_FILENAMES='" + file.string() + "'";
  }

  std::string messages_;
};

const json& lookup_of(const json& cell, const char* pass = "lookup") {
  for (const json& facts : cell["gpu"]["navi21"]["facts"])
    if (facts["pass"] == pass) return facts;
  static const json kNone;
  ADD_FAILURE() << "no pass " << pass;
  return kNone;
}

TEST_F(Gpus, EveryPassHasFacts_AndFiltersTheirOrder) {
  for (const int side : {3, 5, 7}) write(fmt::format("plain{}.glsl", side), plain_pcf(side));
  const auto cells = measure(
      "--no-attribution --gpu navi21 --filters none,pcf2x2,castano3,castano5,castano7,vsm,plain3,plain5,plain7 "
      "--filter-file "
      "plain3.glsl "
      "--filter-file plain5.glsl --filter-file plain7.glsl");
  if (has_no_compiler()) GTEST_SKIP() << messages_;
  ASSERT_EQ(cells.size(), 9u);
  const auto estimate = [&](const char* filter) {
    return cells.at(filter)["gpu"]["navi21"]["frame_ms"]["moving"].get<double>();
  };
  const auto compares = [&](const char* filter) { return lookup_of(cells.at(filter))["compares"].get<int>(); };
  // Castano's kernels of 3x3, 5x5 and 7x7 texels take 4, 9 and 16 fetches where plain ones take as many as texels
  // (Castano 2013; Pettineau 2013 finds the same order): dearer the wider, and each cheaper than the plain one.
  EXPECT_LT(estimate("castano3"), estimate("castano5"));
  EXPECT_LT(estimate("castano5"), estimate("castano7"));
  EXPECT_LT(compares("castano3"), compares("plain3"));
  EXPECT_LT(compares("castano5"), compares("plain5"));
  EXPECT_LT(compares("castano7"), compares("plain7"));
  EXPECT_EQ(estimate("none"), estimate("pcf2x2"));
  EXPECT_GT(cells.at("none")["gpu"]["navi21"]["parts_us"]["memory"], 0.0) << "counted without attribution too";
  EXPECT_LT(estimate("castano3"), estimate("plain3")) << "the reads of a user's filter are counted";
  EXPECT_EQ(lookup_of(cells.at("plain5"))["compares"], 25);
  EXPECT_EQ(lookup_of(cells.at("castano5"))["compares"], 9);
  EXPECT_EQ(lookup_of(cells.at("none"), "empty")["compares"], 0);
  EXPECT_EQ(lookup_of(cells.at("vsm"), "blur")["draws"], 2);
  EXPECT_EQ(lookup_of(cells.at("vsm"), "encode")["loads"], 5);
  expect_valid();
  EXPECT_THAT(read("out/index.html"), HasSubstr("navi21: estimates"));
  const Outcome advice = succeed("advise out --cheapest gpu:navi21 --max-rmse 1");
  EXPECT_THAT(advice.out, HasSubstr("s estimated for navi21"));
  EXPECT_EQ(run("advise out --cheapest gpu:navi22").exit_code, 2);
  EXPECT_EQ(run("advise out --cheapest gpus").exit_code, 2);
}

TEST_F(Gpus, AUsersFilterHasTheFactsOfABuiltInOne_AndNearlyItsEstimate) {
  std::string filters = "tent5x5,poisson,pcss,vsm", files;
  for (const char* filter : {"tent5x5", "poisson", "pcss", "vsm"}) {
    std::string text = read_text(fmt::format("{}/filters/{}.glsl", SHADOWBENCH_SOURCE_DIR, filter));
    // One that differs in nothing that counts would be known as a copy, and looked up by the scalar model.
    text.insert(text.find("+++*/") + 5, "\nconst int unused = 1;\n");
    write(fmt::format("my_{}.glsl", filter), text);
    filters += fmt::format(",my_{}", filter);
    files += fmt::format(" --filter-file my_{}.glsl", filter);
  }
  const auto cells = measure("--no-attribution --gpu navi21 --filters " + filters + files);
  if (has_no_compiler()) GTEST_SKIP() << messages_;
  for (const char* filter : {"tent5x5", "poisson", "pcss", "vsm"}) {
    SCOPED_TRACE(filter);
    const json own = cells.at(fmt::format("my_{}", filter))["gpu"]["navi21"],
               built_in = cells.at(filter)["gpu"]["navi21"];
    EXPECT_EQ(own["facts"], built_in["facts"]);
    EXPECT_NEAR(own["frame_ms"]["moving"].get<double>() / built_in["frame_ms"]["moving"].get<double>(), 1.0, 0.02);
    EXPECT_NEAR(own["parts_us"]["memory"].get<double>() / built_in["parts_us"]["memory"].get<double>(), 1.0, 0.15);
  }
}

TEST_F(Gpus, WideTexelsTakeLonger_AndReadsOfModelsAreMemory) {
  const auto cells = measure("--gpu navi21,vega10 --filters none,vsm,evsm4");
  if (has_no_compiler()) GTEST_SKIP() << messages_;
  const auto part = [&](const char* filter, const char* gpu, const char* name) {
    return cells.at(filter)["gpu"][gpu]["parts_us"][name].get<double>();
  };
  // One fetch each, of 32, 64 and 128 bits; data/gpus has the rates.
  EXPECT_DOUBLE_EQ(part("vsm", "navi21", "sampling"), part("none", "navi21", "sampling"));
  EXPECT_DOUBLE_EQ(part("evsm4", "navi21", "sampling"), 2.0 * part("none", "navi21", "sampling"));
  EXPECT_DOUBLE_EQ(part("vsm", "vega10", "sampling"), 2.0 * part("none", "vega10", "sampling"));
  EXPECT_DOUBLE_EQ(part("evsm4", "vega10", "sampling"), 4.0 * part("none", "vega10", "sampling"));
  EXPECT_GT(part("none", "navi21", "memory"), 0.0);
  EXPECT_GT(part("evsm4", "navi21", "memory"), part("vsm", "navi21", "memory"));
  for (const char* filter : {"none", "vsm", "evsm4"})
    EXPECT_DOUBLE_EQ(part(filter, "navi21", "lookup"),
                     std::max({part(filter, "navi21", "arithmetic"), part(filter, "navi21", "sampling"),
                               part(filter, "navi21", "memory")}));
}

/// Of the very same frame, whatever the size of the run's pictures.
TEST_F(Gpus, EstimatesDoNotDependOnThePicturesSize) {
  const std::string filters = "--gpu navi21 --no-attribution --filters none,tent5x5,pcss,vsm ";
  const auto small = measure(filters);
  if (has_no_compiler()) GTEST_SKIP() << messages_;
  const auto large = measure(filters, "", "128 --size 480x270 ");
  for (const auto& [filter, cell] : small) {
    const double a = cell["gpu"]["navi21"]["frame_ms"]["moving"],
                 b = large.at(filter)["gpu"]["navi21"]["frame_ms"]["moving"];
    EXPECT_NEAR(a / b, 1.0, 0.1) << filter;
    EXPECT_EQ(cell["gpu"]["navi21"]["parts_us"]["memory"], large.at(filter)["gpu"]["navi21"]["parts_us"]["memory"]);
  }
}

/// By the triangles and texels of every cascade.
TEST_F(Gpus, MoreCascadesCostMore) {
  measure("--gpu navi21 --no-attribution --filters none --fit cascades:count=2 --fit cascades:count=4");
  if (has_no_compiler()) GTEST_SKIP() << messages_;
  const json cells = read_cells();
  ASSERT_EQ(cells.size(), 2u);
  const auto map_us = [&](int cell) { return cells[cell]["gpu"]["navi21"]["parts_us"]["map"].get<double>(); };
  EXPECT_GT(map_us(0), 0.0);
  EXPECT_GT(map_us(1), 1.5 * map_us(0));
  EXPECT_GT(cells[1]["gpu"]["navi21"]["frame_ms"]["moving"], cells[0]["gpu"]["navi21"]["frame_ms"]["moving"]);
}

/// The pixels of a frame of 1080 rows lie about two texels of such a map apart: a lookup that reads one texel brings
/// nearly every line that one of 25 brings. Pixels twice as far apart would bring seven tenths of them.
TEST_F(Gpus, OfLargeMaps_NarrowLookupsBringNearlyTheSameLines) {
  const auto cells = measure("--gpu navi21 --no-attribution --filters none,tent5x5", "", "4096 --size 96x54 ");
  if (has_no_compiler()) GTEST_SKIP() << messages_;
  const auto memory = [&](const char* filter) {
    return cells.at(filter)["gpu"]["navi21"]["parts_us"]["memory"].get<double>();
  };
  EXPECT_GT(memory("none"), 0.9 * memory("tent5x5"));
  EXPECT_LT(memory("none"), memory("tent5x5"));
}

TEST_F(Gpus, WithNone_NothingIsCompiled) {
  const auto cells = measure("--gpu none --filters none,vsm");
  EXPECT_TRUE(cells.at("vsm")["gpu"].is_null());
  EXPECT_EQ(cells.at("vsm")["absent"]["gpu"], "the run was made with --gpu none");
  EXPECT_FALSE(std::filesystem::exists(cache_folder() / "shadowbench" / "gpu"));
  expect_refusal("advise out --cheapest gpu:navi21", 2, {"run it again, with --gpu"});
}

/// The driver's process takes seconds, and says what a list need not say.
TEST_F(Gpus, AreListedWithoutADriver_UnlessItIsToBeChecked) {
  const std::string nowhere = use_driver("/nowhere/driver.so");
  const Outcome plain = run("list gpus", nowhere), checked = run("list gpus --check", nowhere);
  EXPECT_THAT(plain.out, AllOf(HasSubstr("navi21"), HasSubstr(gpu::kOtherGpus), Not(HasSubstr("no Vulkan driver"))));
  EXPECT_THAT(checked.out, HasSubstr("no Vulkan driver"));
  EXPECT_FALSE(json::parse(run("list gpus --json", nowhere).out)[0].contains("driver"));
  EXPECT_TRUE(json::parse(run("list gpus --json --check", nowhere).out)[0]["driver"].is_null());
}

TEST_F(Gpus, WhatVulkanRefuses_IsSaid_AndTheRunGoesOn) {
  write("window.glsl", filters::write_filter("radius_texels = 0\n",
                                             "float visibility(Receiver r) {\n  return "
                                             "compare_nearest(r, vec2(gl_DepthRange.near), r.depth);\n}\n"));
  const auto cells = measure("--gpu navi21 --filters none,window --filter-file window.glsl");
  if (has_no_compiler()) GTEST_SKIP() << messages_;
  const json& cell = cells.at("window");
  EXPECT_EQ(cell["status"], "ok");
  EXPECT_TRUE(cell["gpu"]["navi21"]["frame_ms"]["moving"].is_null());
  EXPECT_THAT(cell["gpu"]["navi21"]["refused"].get<std::string>(), HasSubstr("window.glsl:8: Vulkan refuses"));
  EXPECT_TRUE(cells.at("none")["gpu"]["navi21"]["frame_ms"]["moving"].is_number());
}

TEST_F(Gpus, WithoutADriver_TheRunGoesOn) {
  const auto cells = measure("--gpu navi21 --filters none", use_driver("/nowhere/driver.so"));
  EXPECT_THAT(messages_, HasSubstr("no costs on navi21: "));
  EXPECT_THAT(messages_, HasSubstr("install"));
  EXPECT_EQ(cells.at("none")["status"], "ok");
  EXPECT_TRUE(cells.at("none")["gpu"]["navi21"]["refused"].is_string());
}

TEST_F(Gpus, ADriverThatCrashes_CostsItsFactsAlone) {
  const auto cells = measure("--gpu navi21 --filters none", use_driver(SHADOWBENCH_CRASHING_DRIVER));
  EXPECT_EQ(cells.at("none")["status"], "ok");
  EXPECT_THAT(cells.at("none")["gpu"]["navi21"]["refused"].get<std::string>(), HasSubstr("signal 11"));
  EXPECT_TRUE(cells.at("none")["time_ms"]["lookup"].is_object());
}

}  // namespace
}  // namespace shadowbench::test
