// What mips and anisotropic lookup are for: the teaching scene `minified`, with the filter that filters/README.md
// shows.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "report/images/picture_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

constexpr int kWidth = 192, kHeight = 108;
constexpr const char* kLookups[] = {"finest", "mips", "anisotropic"};
constexpr int kFiner = 4;  ///< how many times as many pixels the picture has, each way, whose truth is averaged

class Minified : public ProgramTest {
 protected:
  /// The file that filters/README.md shows under this name.
  static std::string shown_in_readme(const std::string& name) {
    const std::string readme = read_text(SHADOWBENCH_SOURCE_DIR "/filters/README.md"), fence = "```glsl " + name + "\n";
    const std::size_t begin = readme.find(fence);
    EXPECT_NE(begin, std::string::npos) << name;
    if (begin == std::string::npos) return {};
    return readme.substr(begin + fence.size(), readme.find("```", begin + fence.size()) - begin - fence.size());
  }

  nlohmann::json measure(const std::string& out, int finer, const std::string& arguments) const {
    const Outcome outcome =
        run("run --scene minified --map-size 2048 --rounds 1 --no-attribution --out " + out + " --size " +
            std::to_string(finer * kWidth) + "x" + std::to_string(finer * kHeight) + " " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(read_text(folder() / out / "results.json"))["cells"];
  }

  std::vector<float> part(const std::string& out, const std::string& name) const {
    for (const images::Part& part : images::read_exr(folder() / out / "minified.exr").parts)
      if (part.name == name) return part.image.texels;
    ADD_FAILURE() << "no part " << name;
    return {};
  }

  /// The truth of each pixel, averaged over the finer pixels in it; negative where not all of them count.
  std::vector<float> average_truth() const {
    const std::vector<float> truth = part("fine", "truth.area"), mask = part("fine", "truth.mask");
    std::vector<float> mean(kWidth * kHeight, 0.0f);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const std::size_t x = i % (kFiner * kWidth) / kFiner, y = i / (kFiner * kWidth) / kFiner;
      mean[y * kWidth + x] += mask[i] > 0.0f ? truth[i] / (kFiner * kFiner) : -100.0f;
    }
    return mean;
  }

  /// Root mean square error of a filter's image where `truth` is not negative.
  double measure_rmse(const std::string& lookup, const std::vector<float>& truth) const {
    const std::vector<float> image = part("out", "vsm_mips (lookup=" + lookup + ").visibility");
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
      if (truth[i] < 0.0f) continue;
      sum += std::pow(static_cast<double>(image[i] - truth[i]), 2.0);
      ++count;
    }
    EXPECT_GT(count, 2000.0);
    return std::sqrt(sum / count);
  }
};

TEST_F(Minified, MipsFlickerLess_AndFootprintsComeNearestToThePixelsMean) {
  write("vsm_mips.glsl", shown_in_readme("vsm_mips.glsl"));
  const nlohmann::json cells = measure("out", 1,
                                       "--filter-file vsm_mips.glsl --filters none,vsm_mips:lookup=finest,"
                                       "vsm_mips:lookup=mips,vsm_mips:lookup=anisotropic");
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_GE(cells[0]["coverage"]["fewest_texels_per_pixel"], 8.0);
  EXPECT_LT(cells[2]["cost"]["fetches"], cells[3]["cost"]["fetches"]);

  measure("fine", kFiner, "--phases 1 --filters none");
  const std::vector<float> truth = average_truth();
  std::vector<double> flicker, rmse;
  for (const int i : {0, 1, 2}) {
    flicker.push_back(cells[i + 1]["error"]["flicker"]);
    rmse.push_back(measure_rmse(kLookups[i], truth));
    fmt::print("{}: flicker {:.4f}, RMSE to the pixel's mean {:.4f}\n", kLookups[i], flicker[i], rmse[i]);
  }
  EXPECT_LT(flicker[1], 0.4 * flicker[0]);
  EXPECT_LT(flicker[2], 0.5 * flicker[0]);
  EXPECT_LT(rmse[2], 0.5 * rmse[0]);
  EXPECT_LT(rmse[2], 0.5 * rmse[1]) << "a square as wide as the footprint is long blurs";
}

}  // namespace
}  // namespace shadowbench::test
