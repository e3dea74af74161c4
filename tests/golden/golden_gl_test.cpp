// The project's own baseline, tests/golden, through the command that users have. To accept a change on purpose, look at
// the pictures that `regress` draws, then:
//   shadowbench run golden --out OUT && shadowbench regress OUT --baseline tests/golden --accept

#include "filters/kernel.h"
#include "report/regress/baseline.h"
#include "report/regress/comparison.h"
#include "tests/harness/cli/program.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr const char* kBaseline = SHADOWBENCH_SOURCE_DIR "/tests/golden";

/// What the experiment draws besides every filter at its defaults.
constexpr const char* kVariants[] = {"pcss:taps=4,search_taps=4,screen=bilateral"};

/// Every filter whose test is to run is drawn by one run: the truth is traced once, and the program started once.
class Golden : public ProgramTest, public ::testing::WithParamInterface<std::string> {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    static const std::string chosen = list_chosen();
    static const Outcome drawn =
        run("run golden --grids --gl software --filters " + chosen + " --out '" + common().string() + "'");
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    static const Outcome compared = compare(chosen);
    all_unchanged_ = compared.exit_code == 0;
  }

  Outcome compare(const std::string& filters) const {
    return run("regress '" + common().string() + "' --baseline '" + kBaseline + "' --filters " + filters);
  }

  bool all_unchanged() const { return all_unchanged_; }

  static void TearDownTestSuite() { std::filesystem::remove_all(common()); }

 private:
  static std::filesystem::path common() {
    return std::filesystem::temp_directory_path() / ("shadowbench.golden." + std::to_string(getpid()));
  }

  /// The filters of this suite's tests that --gtest_filter leaves.
  static std::string list_chosen() {
    std::string chosen;
    const auto& suite = *::testing::UnitTest::GetInstance()->current_test_suite();
    for (int i = 0; i < suite.total_test_count(); ++i) {
      const ::testing::TestInfo& test = *suite.GetTestInfo(i);
      const std::string id = filter_ids()[static_cast<std::size_t>(i)];
      if (!test.should_run()) continue;
      chosen += (chosen.empty() ? "" : ",") + id;
      for (const std::string variant : kVariants)
        if (variant.starts_with(id + ":")) chosen += "," + variant;
    }
    return chosen;
  }

  bool all_unchanged_ = false;
};

TEST_P(Golden, OutputIsUnchanged_OnEveryScene) {
  if (all_unchanged()) return;
  const Outcome compared = compare(GetParam());
  EXPECT_EQ(compared.exit_code, 0) << compared.out << compared.err;
}

INSTANTIATE_TEST_SUITE_P(AllFilters, Golden, ::testing::ValuesIn(filter_ids()),
                         [](const auto& each) { return each.param; });

/// A context, the width of LLVM's vectors in bits, the rasteriser's threads, and what of the processor's instructions
/// may be used: without those of AVX2 nothing is multiplied and added with one rounding.
using Platform = std::tuple<std::string, int, int, std::string>;
class Portable : public ProgramTest, public ::testing::WithParamInterface<Platform> {};

/// The driver's shader cache does not tell vector widths apart: with it, one width's code would run under another's
/// name.
std::string make_environment(const Platform& platform) {
  return "MESA_SHADER_CACHE_DISABLE=true LP_NATIVE_VECTOR_WIDTH=" + std::to_string(std::get<1>(platform)) +
         " LP_NUM_THREADS=" + std::to_string(std::get<2>(platform)) +
         " GALLIUM_OVERRIDE_CPU_CAPS=" + std::get<3>(platform);
}

TEST_P(Portable, TheSameBaselineHolds) {
  const std::string& backend = std::get<0>(GetParam());
  if (!gl::has_backend(parse_name<gl::Backend>(backend, "GL back end")))
    GTEST_SKIP() << "this build has no --gl " << backend;
  const std::string environment = make_environment(GetParam());
  const std::string some = "--scene fence --filters none,pcf2x2,poisson,esm,vsm";
  const Outcome drawn = run("run golden --grids --gl " + backend + " " + some + " --out out", environment);
  if (drawn.exit_code == 128 + SIGSEGV &&
      run("run golden --grids --gl " + backend + " --scene fence --no-truth --filters none --out crash", environment)
              .exit_code == 128 + SIGSEGV) {
    GTEST_SKIP() << "this Mesa's llvmpipe crashes in its own code generator when it draws depth with vectors of "
                 << std::get<1>(GetParam()) << " bits";
  }
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const Outcome compared = run("regress out --baseline '" + std::string(kBaseline) + "' " + some);
  EXPECT_EQ(compared.exit_code, 0) << compared.out << compared.err;
  EXPECT_NE(read_text(folder() / "out" / "results.json").find(std::to_string(std::get<1>(GetParam())) + " bits"),
            std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Llvmpipe, Portable,
                         ::testing::Values(Platform("osmesa", 128, 1, "sse2"), Platform("osmesa", 256, 2, "avx"),
                                           Platform("osmesa", 512, 2, ""), Platform("egl", 128, 2, "avx"),
                                           Platform("egl", 256, 1, "avx2"), Platform("glfw", 128, 1, "sse2"),
                                           Platform("glfw", 256, 2, "")),
                         [](const auto& each) {
                           return std::get<0>(each.param) + "_" + std::to_string(std::get<1>(each.param)) + "_bits_" +
                                  std::to_string(std::get<2>(each.param)) + "_threads";
                         });

/// The standard deviation of a built-in filter's kernel at its defaults, in texels; 0 where pixels do not share one.
double find_sigma(const std::string& id) {
  const filters::FilterRequest request = request_of(id);
  return filters::find_kernel_sigma(request.spec, request.values).value_or(0.0);
}

constexpr double kRounding = 1e-5;  // of visibility

/// A filter's cell at its defaults, and its images.
struct DefaultCell {
  DefaultCell(const regress::Baseline& baseline, const std::string& scene, const std::string& id) {
    const regress::CellFile file = baseline.read_cells(scene, id);
    cell = *std::ranges::find(file.cells, id, &regress::BaselineCell::label);
    images = file.images.at(cell.key);
  }
  regress::BaselineCell cell;
  regress::CellImages images;
};

class GoldenOfScene : public ::testing::TestWithParam<std::string> {};

/// No tolerance is so wide that another filter's image passes. Two filters that compute the same in two ways are one
/// here; those that differ in what they make of the same kernel may differ in few pixels: moments packed into 64 and
/// into 32 bits in three. The fewest otherwise are the 59 of `smrt` and `none` on `cubes`.
TEST_P(GoldenOfScene, NoFilterPassesAsAnother) {
  const regress::Baseline baseline(kBaseline);
  const regress::Tolerances tolerances = regress::read_tolerances(baseline.tolerance_file());
  std::map<std::string, regress::CellImages> all;
  for (const std::string& id : filter_ids()) all[id] = DefaultCell(baseline, GetParam(), id).images;
  for (const std::string& expected : filter_ids()) {
    for (const std::string& actual : filter_ids()) {
      if (actual == expected) continue;
      const regress::PixelChange change =
          regress::compare_pixels(all[actual], all[expected], tolerances.find(expected, regress::kPixel).limit);
      const bool same_kernel = std::abs(find_sigma(actual) - find_sigma(expected)) < 1e-9;
      if (same_kernel && regress::compare_pixels(all[actual], all[expected], kRounding).changed == 0) continue;
      EXPECT_GT(change.share(), tolerances.find(expected, regress::kShare).limit)
          << actual << " passes as " << expected;
      EXPECT_GT(change.changed, same_kernel ? 0 : 50) << actual << " against " << expected;
    }
  }
}

/// Noise hides small differences, but no hard shadow passes as a stochastic filter's with another seed.
TEST_P(GoldenOfScene, NoHardShadowPassesAsNoise) {
  const regress::Baseline baseline(kBaseline);
  const double level = regress::read_tolerances(baseline.tolerance_file()).find("", regress::kLevel).limit;
  const images::Image hard = DefaultCell(baseline, GetParam(), "none").images.visibility;
  int stochastic = 0;
  for (const std::string& id : filter_ids()) {
    const auto [cell, images] = DefaultCell(baseline, GetParam(), id);
    const images::UncertaintyImages& spread = images.uncertainty;
    if (spread.seed_mean.empty()) continue;
    ++stochastic;
    const auto test = regress::test_spread(hard, spread, cell.values.numbers.at("cost.fetches"), level);
    EXPECT_GT(test.pixels.beyond + test.blocks.beyond, 0) << id;
  }
  EXPECT_GT(stochastic, 0);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, GoldenOfScene, ::testing::ValuesIn(builtin_scenes()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace shadowbench::test
