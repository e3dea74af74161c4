// The real models that SHADOWBENCH_SCENES names: they load, draw, and have both light and shadow.

#include <cmath>
#include <cstdlib>

#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

std::vector<std::filesystem::path> real_scenes() {
  std::vector<std::filesystem::path> files;
  const char* folder = std::getenv("SHADOWBENCH_SCENES");
  if (!folder) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".gltf" || extension == ".glb" || extension == ".obj") files.push_back(entry.path());
  }
  return files;
}

TEST(RealScenes, LoadAndDraw_WithLightAndShadow) {
  const auto files = real_scenes();
  if (files.empty()) GTEST_SKIP() << "SHADOWBENCH_SCENES names no folder with models";
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename().string());
    const scene::Scene scene =
        scene::load(file.string(), {.scenes_folder = options::find_resources().scenes, .ground = true});
    Bench bench(shared_context(), scene, 512, 240, 135);
    const auto request = catalogue().parse_requests("pcf2x2").front();
    const std::vector<float> image = bench.draw(request);
    const auto receivers = bench.receivers(request);
    double lit = 0.0;
    for (const auto& r : receivers) {
      ASSERT_TRUE(std::isfinite(image[bench.index(r)]));
      lit += static_cast<double>(image[bench.index(r)]);
    }
    EXPECT_GT(receivers.size(), 3000u);
    EXPECT_GT(lit, 0.05 * static_cast<double>(receivers.size()));
    EXPECT_LT(lit, 0.995 * static_cast<double>(receivers.size()));
  }
}

}  // namespace
}  // namespace shadowbench::test
