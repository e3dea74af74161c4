// A scene with many texels to a pixel, on which mips and anisotropic lookups show what they are for.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "report/images/stored_picture.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

constexpr int kFine = 4, kSmallWidth = 192, kSmallHeight = 108;

class Minification : public ProgramTest {
 protected:
  void measure(const char* out, int width, int height, const std::string& filters) const {
    const Outcome outcome = run(fmt::format(
        "run --grids --scene minified --size {}x{} --map-size 2048 --rounds 1 --no-attribution --out {} --filter-file "
        "'{}/tests/user_filters/vsm_mips.glsl' --filters {}",
        width, height, out, SHADOWBENCH_SOURCE_DIR, filters));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  std::vector<float> read(const char* out, const std::string& part) const {
    return images::read_stored_picture((folder() / out / "minified.exr").string() + "#" + part).image.texels;
  }
};

/// The mean of each pixel's finer pixels; less than 0 where some of them are no receivers.
std::vector<double> average(const std::vector<float>& fine, const std::vector<float>& mask) {
  std::vector<double> mean(kSmallWidth * kSmallHeight, 0.0);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const std::size_t x = i % (kFine * kSmallWidth) / kFine, y = i / (kFine * kSmallWidth) / kFine;
    mean[y * kSmallWidth + x] += mask[i] > 0.0f ? static_cast<double>(fine[i]) / (kFine * kFine) : -1e9;
  }
  return mean;
}

TEST_F(Minification, MipsEndFlicker_AndAnisotropyKeepsMoreOfTheShadow) {
  measure("small", kSmallWidth, kSmallHeight, "vsm_mips:lookup=finest,vsm_mips:lookup=mips,vsm_mips");
  measure("fine", kFine * kSmallWidth, kFine * kSmallHeight, "none --phases 1");
  const std::vector<double> truth = average(read("fine", "truth.area"), read("fine", "truth.mask"));
  std::map<std::string, double> flicker, rmse;
  const auto document = nlohmann::json::parse(read_text(folder() / "small" / "results.json"));
  for (const auto& cell : document["cells"]) {
    const std::string lookup = cell["params"]["lookup"];
    EXPECT_GE(cell["coverage"]["fewest_texels_per_pixel"], 8.0);
    EXPECT_EQ(cell["status"], "ok");
    flicker[lookup] = cell["error"]["flicker"];
    const std::string label = lookup == "anisotropic" ? "vsm_mips" : fmt::format("vsm_mips (lookup={})", lookup);
    const std::vector<float> seen = read("small", label + ".visibility");
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (truth[i] < 0.0) continue;
      sum += std::pow(static_cast<double>(seen[i]) - truth[i], 2.0);
      count += 1.0;
    }
    ASSERT_GT(count, 2000.0);
    rmse[lookup] = std::sqrt(sum / count);
    std::printf("%s: flicker %.4f, RMSE to the mean truth of a pixel %.4f, to that of its middle %.4f\n",
                lookup.c_str(), flicker[lookup], rmse[lookup], cell["error"]["rmse"].get<double>());
  }
  EXPECT_LT(flicker["mips"], 0.4 * flicker["finest"]);
  EXPECT_LT(flicker["anisotropic"], 0.4 * flicker["finest"]);
  EXPECT_LT(rmse["anisotropic"], 0.5 * rmse["finest"]);
  EXPECT_LT(rmse["anisotropic"], 0.5 * rmse["mips"]) << "a square as wide as the footprint is long blurs";
}

}  // namespace
}  // namespace shadowbench::test
