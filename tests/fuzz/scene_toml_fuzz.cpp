// A scene file, read whole: its tables, its shapes, the model beside it, and the checks of the finished scene.

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/load.h"
#include "tests/fuzz/input.h"

void shadowbench::fuzz::try_input(std::string_view text) {
  static const std::filesystem::path model = write_input("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const scene::Scene scene = scene::load(write_input("input.toml", text).string(), {});
  scene::fit_light(scene, scene::FitMode::kTight, 64, 2.0);
}
