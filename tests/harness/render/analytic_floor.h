#pragma once

#include <cmath>
#include <vector>

#include "harness/scene/mesh_tools.h"
#include "harness/scene/scene.h"
#include "tests/harness/render/contract_fixture.h"

namespace shadowbench::test {

/// A rectangle that hangs over the floor, in texels of the map from its middle, along u and v.
struct Caster {
  glm::vec2 low;
  glm::vec2 high;
  float height = 24.0f;  ///< over the floor, as long as so many texels are wide
};

/// Pixels per texel, per axis. Their centres keep a sixteenth of a texel off every border of a texel and off its
/// centre, so that no rounding decides which texel a filter reads, whichever way ties fall there.
inline constexpr int kPixelsPerTexel = 8;

/// A floor under a light from straight above, seen straight from above: a pixel is an eighth of a texel. A metre is a
/// texel, and the light's frustum is frozen, so that it does not follow casters.
class AnalyticFloor {
 public:
  /// Makes a floor with room for a kernel of `radius_texels` on both sides of the view's middle.
  AnalyticFloor(double radius_texels, const std::vector<Caster>& casters)
      : view_(view_texels(radius_texels)),
        map_(4 * view_),
        scene_(make_scene(casters)),
        bench_(shared_context(), scene_, map_, pixels(), pixels()) {}

  /// Gives how many texels are in view, per side, where a kernel of this half-width is to be seen.
  static int view_texels(double radius_texels) { return 2 * static_cast<int>(std::ceil(radius_texels)) + 8; }

  int pixels() const { return view_ * kPixelsPerTexel; }  ///< per side of the view
  Bench& bench() { return bench_; }

 private:
  static constexpr float kNear = 32.0f, kFar = 8.0f;  ///< of the map's planes, over and under the floor
  static constexpr float kCamera = 4.0f;              ///< over the floor, and under all casters

  int view_;
  int map_;
  scene::Scene scene_;
  Bench bench_;

  /// The light's u runs along -x, its v along z.
  static scene::Mesh make_rectangle(const glm::vec2& low, const glm::vec2& high, float height) {
    const glm::vec2 middle = 0.5f * (low + high);
    scene::Mesh mesh = scene::make_plane(high - low, 4);
    for (scene::Vertex& v : mesh.vertices) v.position_ws += glm::vec3(-middle.x, height, middle.y);
    return mesh;
  }

  scene::Scene make_scene(const std::vector<Caster>& casters) const {
    scene::Scene scene;
    scene.name = "analytic floor";
    scene.materials.emplace_back();
    const glm::vec2 half(0.5f * static_cast<float>(map_));
    scene.meshes.push_back(make_rectangle(-half, half, 0.0f));
    for (const Caster& c : casters)
      scene.meshes.push_back(make_rectangle(glm::max(c.low, -half), glm::min(c.high, half), c.height));
    scene::Camera camera;
    camera.position_ws = {0.0f, kCamera, 0.0f};
    camera.forward_ws = {0.0f, -1.0f, 0.0f};
    camera.up_ws = {0.0f, 0.0f, 1.0f};
    camera.vertical_fov_rad = 2.0f * std::atan(0.5f * static_cast<float>(view_) / kCamera);
    scene.cameras.push_back(camera);
    scene.light.kind = scene::Sun{{0.0f, -1.0f, 0.0f}};
    scene.light.map_window =
        scene::MapWindow{{0.0, 0.0, 0.0}, static_cast<double>(map_), scene::MapWindow::Planes{-kNear, kFar}};
    return scene::validate(scene, scene.name);
  }
};

}  // namespace shadowbench::test
