// At the width that the light asks for, filters are compared and not the widths of their kernels.

#include <fmt/format.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

/// A scene's filters, with the widths of their kernels and their errors.
struct Ranked {
  std::vector<std::string> filters;
  std::vector<double> widths, errors;

  /// The rank correlation (Spearman) of error and width: 1 where the wider one is always the worse.
  double correlation() const {
    std::vector<double> work(2 * widths.size());
    return gsl_stats_spearman(widths.data(), 1, errors.data(), 1, widths.size(), work.data());
  }
};

class EqualKernels : public ProgramTest {
 protected:
  nlohmann::json measure(const std::string& options) {
    const Outcome outcome =
        run("run --scene cubes --scene stack --scene fence --size 480x270 --rounds 1 --no-grids "
            "--no-attribution --out out " +
            options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(read_text(folder() / "out" / "results.json"))["cells"];
  }

  static std::map<std::string, Ranked> rank(const nlohmann::json& cells, const std::string& name) {
    std::map<std::string, Ranked> scenes;
    for (const nlohmann::json& cell : cells) {
      if (cell["kernel"]["sigma_texels"].is_null()) continue;  // it differs from pixel to pixel
      Ranked& scene = scenes[cell["scene"]];
      scene.filters.push_back(cell["filter"]);
      scene.widths.push_back(cell["kernel"]["sigma_texels"]);
      scene.errors.push_back(cell["error"]["rmse"]);
    }
    for (const auto& [scene, ranked] : scenes) {
      fmt::print("{}, {}: rank correlation of error and width {:.2f}\n", name, scene, ranked.correlation());
      for (std::size_t i = 0; i < ranked.filters.size(); ++i)
        fmt::print("  {:<8} {:.2f} texels, RMSE {:.4f}\n", ranked.filters[i], ranked.widths[i], ranked.errors[i]);
    }
    return scenes;
  }
};

constexpr const char* kFilters = "--filters none,pcf2x2,tent3x3,poisson,vsm,esm,evsm4 ";

// At the filters' own radii, 3 and 4 texels, the correlation is 0.85, 0.82 and 0.82 on cubes, fence and stack; at the
// light's width it was measured as -0.59, -0.37 and -0.74.
TEST_F(EqualKernels, ByDefault_TheyAreAsTheLightAsks_AndNoneIsWorseThanNoFilter) {
  constexpr double kFollows = 0.5;
  const nlohmann::json cells = measure(kFilters);
  std::map<std::string, double> unfiltered;
  for (const nlohmann::json& cell : cells) {
    EXPECT_EQ(cell["kernel"]["class"], "light") << cell["filter"];
    EXPECT_GT(cell["kernel"]["light_texels"], 0.0) << cell["filter"];
    if (cell["filter"] == "none") unfiltered[cell["scene"]] = cell["error"]["rmse"];
    if (!cell["kernel"].contains("by_light")) continue;
    EXPECT_EQ(cell["kernel"]["by_light"], "radius");
    EXPECT_LT(cell["error"]["rmse"], unfiltered.at(cell["scene"])) << cell["filter"] << " " << cell["scene"];
  }
  for (const auto& [scene, ranked] : rank(cells, "light's width")) {
    ASSERT_EQ(ranked.filters.size(), 7u);
    EXPECT_LT(ranked.correlation(), kFollows) << scene;
  }
  for (const auto& [scene, ranked] : rank(measure(std::string(kFilters) + "--width own --fresh"), "own radii"))
    EXPECT_GT(ranked.correlation(), kFollows) << scene;
}

}  // namespace
}  // namespace shadowbench::test
