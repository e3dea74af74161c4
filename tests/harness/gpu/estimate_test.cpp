#include "harness/gpu/gpu.h"
#include "report/records/records.h"
#include "tests/test_files.h"

namespace shadowbench::gpu {
namespace {

// The model that makes microseconds of a compiler's facts, against its arithmetic by hand.

/// 64 invocations take a cycle a SIMD: 10 SIMDs at 100 MHz do 64 000 a microsecond for each cycle.
Gpu make_gpu() {
  Gpu gpu;
  gpu.simds.value = 10.0;
  gpu.clock_mhz.value = 100.0;
  gpu.texture_units.value = 50.0;
  gpu.rate_64.value = 0.5;
  gpu.rate_128.value = 0.25;
  gpu.triangles_per_clock.value = 2.0;
  gpu.pixels_per_clock.value = 16.0;
  gpu.memory_gb_s.value = 2.0;
  return gpu;
}

FilterWork make_work(int busy, int empty, const Reads& reads) {
  FilterWork work;
  work.lookup.busy_cycles = busy;
  work.empty.busy_cycles = empty;
  work.reads = reads;
  return work;
}

TEST(GpuEstimate, EachResourceByItself) {
  FilterWork work = make_work(70, 30, {2.0, 1.0, 1.0});
  work.memory_bytes = 3.0;
  const records::GpuEstimateRecord made = estimate(make_gpu(), work);
  EXPECT_DOUBLE_EQ(made.arithmetic_us, 40.0 * 1e6 / 64.0 / (10.0 * 100.0));      // 625
  EXPECT_DOUBLE_EQ(made.sampling_us, (2.0 + 2.0 + 4.0) * 1e6 / (50.0 * 100.0));  // 1600
  EXPECT_DOUBLE_EQ(*made.memory_us, 3e6 / 2e3);                                  // 1500
  EXPECT_DOUBLE_EQ(made.lookup_us, 1600.0);
  EXPECT_EQ(made.bound_by, "sampling");
  work.memory_bytes = 4.0;
  EXPECT_EQ(estimate(make_gpu(), work).bound_by, "memory");
  work.lookup.busy_cycles = 1000;
  EXPECT_EQ(estimate(make_gpu(), work).bound_by, "arithmetic");
}

TEST(GpuEstimate, APassOfThePrefilterCountsEveryTexel) {
  FilterWork work = make_work(30, 30, {1.0, 0.0, 0.0});
  PrefilterWork pass;
  pass.facts.busy_cycles = 64;
  pass.facts.samples = 3;
  pass.texels = 1e6;
  pass.written_bytes = 8;
  pass.read_bytes = 8;
  work.prefilter = {pass};
  const records::GpuEstimateRecord made = estimate(make_gpu(), work);
  EXPECT_DOUBLE_EQ(made.lookup_us, 200.0);
  EXPECT_DOUBLE_EQ(made.prefilter_us, 16e6 / 2e3);  // memory: 8000; sampling is 1200, arithmetic 1000
  EXPECT_DOUBLE_EQ(records::frame_ms(made, false), 0.2 * 2.0736);
  EXPECT_DOUBLE_EQ(records::frame_ms(made, true), 0.2 * 2.0736 + 8.0);
  EXPECT_EQ(made.bound_by, "memory");
  work.prefilter = {pass, pass};
  EXPECT_DOUBLE_EQ(estimate(make_gpu(), work).prefilter_us, 16'000.0);
}

TEST(GpuEstimate, WhatBoundsAFrame_IsTheLongestOfItsLookupsAndOfItsMapsPasses) {
  FilterWork work = make_work(30, 30, {1.0, 0.0, 0.0});
  PrefilterWork pass;
  pass.facts.busy_cycles = 64;
  pass.texels = 0.3e6;  // 300 us of arithmetic beside the 200 us of a million lookups, 415 of a frame
  work.prefilter = {pass};
  EXPECT_EQ(estimate(make_gpu(), work).bound_by, "sampling");
  work.prefilter[0].texels = 0.5e6;
  EXPECT_EQ(estimate(make_gpu(), work).bound_by, "arithmetic");
}

/// At 100 MHz 200 triangles, or 1600 texels, take a microsecond.
TEST(GpuEstimate, TheMapTakesAtLeastItsTrianglesOrItsTexels_InAFrameOfAMovingLight) {
  FilterWork work = make_work(30, 30, {});
  work.map = {600.0, 1600.0};
  EXPECT_DOUBLE_EQ(estimate(make_gpu(), work).map_us, 3.0);
  work.map.texels = 16'000.0;
  const records::GpuEstimateRecord made = estimate(make_gpu(), work);
  EXPECT_DOUBLE_EQ(made.map_us, 10.0);
  EXPECT_DOUBLE_EQ(records::frame_ms(made, true), 0.01);
  EXPECT_DOUBLE_EQ(records::frame_ms(made, false), 0.0);
}

TEST(GpuEstimate, ALookupThatIsCheaperThanTheEmptyOne_CostsItsReads) {
  const records::GpuEstimateRecord made = estimate(make_gpu(), make_work(29, 30, {1.0, 0.0, 0.0}));
  EXPECT_EQ(made.arithmetic_us, 0.0);
  EXPECT_DOUBLE_EQ(made.lookup_us, 200.0);
}

TEST(GpuEstimate, MoreOfEverythingIsNeverCheaper) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> some(0, 50);
  const auto more = [&](auto value) { return value + static_cast<decltype(value)>(some(random)); };
  for (int i = 0; i < 1000; ++i) {
    FilterWork less = make_work(some(random), 20, {});
    less.reads = {more(0.0), more(0.0), more(0.0)};
    less.memory_bytes = more(0.0);
    PrefilterWork pass;
    pass.facts.busy_cycles = some(random);
    pass.facts.loads = some(random);
    pass.texels = 1e3 * some(random);
    pass.written_bytes = pass.read_bytes = 4;
    less.prefilter = {pass};
    FilterWork all = less;
    all.lookup.busy_cycles = more(less.lookup.busy_cycles);
    all.reads = {more(less.reads.of_32), more(less.reads.of_64), more(less.reads.of_128)};
    all.memory_bytes = more(*less.memory_bytes);
    all.prefilter[0].facts.busy_cycles = more(pass.facts.busy_cycles);
    all.prefilter[0].facts.loads = more(pass.facts.loads);
    all.prefilter[0].texels = more(pass.texels);
    all.prefilter[0].written_bytes = 8;
    all.prefilter[0].read_bytes = 16;
    for (const bool is_moving : {false, true})
      EXPECT_GE(records::frame_ms(estimate(make_gpu(), all), is_moving),
                records::frame_ms(estimate(make_gpu(), less), is_moving));
  }
}

// The descriptions of GPUs: what comes with the program, and what is refused.

const std::filesystem::path kShipped = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "data" / "gpus";

/// The message of the error that loading `text` ends in.
std::string load_error(const std::string& text) {
  const TestFolder folder;
  return error_of([&] { load_gpu(folder.write("a.toml", text)); }).what();
}

std::string replace(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Gpus, EveryShippedOneNamesASourceForEveryNumber) {
  const std::vector<Gpu> gpus = load_gpus(kShipped);
  EXPECT_GE(gpus.size(), 2u);
  for (const Gpu& gpu : gpus)
    visit_constants(gpu, [&](const char* key, const Constant& constant) {
      EXPECT_GE(constant.source.size(), 20u) << gpu.name << " " << key;
    });
}

TEST(Gpus, AFileIsRefusedWithItsLine) {
  const std::string good = read_text(kShipped / "navi21.toml");
  EXPECT_EQ(load_error(good), "no error");
  EXPECT_THAT(load_error(replace(good, "[simds]", "[simd]")), HasSubstr("unknown key 'simd'"));
  EXPECT_THAT(load_error(replace(good, "value = 2015", "value = 0")), HasSubstr(":9: "));
  EXPECT_THAT(load_error(replace(good, "value = 2015", "")), HasSubstr("value"));
  EXPECT_THAT(load_error(replace(good, "value = 0.5", "value = 1.5")), HasSubstr("0.001 to 1"));
  EXPECT_THAT(load_error(replace(good, "value = 128\nsource = \"AMD, RDNA", "value = 96\nsource = \"AMD, RDNA")),
              HasSubstr("'value' is 96; a line has a power of two"));
  EXPECT_THAT(load_error(good.substr(0, good.find("[memory_gb_s]"))), HasSubstr("the table [memory_gb_s] is missing"));
}

TEST(Gpus, AreChosenByName) {
  const std::vector<Gpu> all = load_gpus(kShipped);
  const auto refusal = [&](const std::vector<std::string>& names) {
    const Error error = error_of([&] { choose_gpus(all, names); });
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    return error.message();
  };
  EXPECT_TRUE(choose_gpus(all, {"none"}).empty());
  EXPECT_EQ(choose_gpus(all, {"vega10", "navi21"}).front().name, "vega10");
  EXPECT_THAT(refusal({"navi12"}), HasSubstr("'navi12' is no GPU that is described; did you mean 'navi"));
  EXPECT_THAT(refusal({"rtx3080"}), HasSubstr(kOtherGpus));
  EXPECT_THAT(refusal({"navi21", "navi21"}), HasSubstr("named twice"));
  EXPECT_THAT(refusal({"navi21", "none"}), HasSubstr("'none' stands alone"));
}

}  // namespace
}  // namespace shadowbench::gpu
