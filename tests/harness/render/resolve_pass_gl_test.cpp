// Visibility that is accumulated over frames.

#include "harness/render/resolve_pass.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kResolvedWidth = 64, kResolvedHeight = 36;

/// The cubes seen by a camera without perspective, so that a step of it moves the picture by whole pixels.
class ResolvePassTest : public ::testing::Test {
 protected:
  ResolvePassTest()
      : context_(shared_context()), geometry_((look(), scene_)), gbuffer_(kResolvedWidth, kResolvedHeight) {
    draw(camera());
  }

  scene::Camera& camera() { return scene_.cameras.front(); }
  void draw(const scene::Camera& camera) { gbuffer_.draw(shaders_, geometry_, scene_, camera); }

  /// A picture of which no two pixels are alike.
  static std::vector<float> make_picture(float shift) {
    std::vector<float> picture;
    for (int i = 0; i < kResolvedWidth * kResolvedHeight; ++i)
      picture.push_back(std::abs(std::sin(0.37f * static_cast<float>(i) + shift)));
    return picture;
  }

  static images::Image make_image(const std::vector<float>& rows) {
    images::Image image(kResolvedWidth, kResolvedHeight, 1);
    image.texels = rows;
    return image;
  }

  /// What is resolved after this picture was added, rows top to bottom.
  std::vector<float> add(render::ResolvePass& resolve, const std::vector<float>& picture) {
    return add(resolve, picture, camera());
  }
  std::vector<float> add(render::ResolvePass& resolve, const std::vector<float>& picture, const scene::Camera& camera) {
    const gl::Texture texture = render::upload_image(make_image(picture));
    resolve.add(shaders_, scene_, {gbuffer_, texture, camera});
    context_.require_no_gl_errors();
    return render::read_image(resolve.texture(), 1).texels;
  }

  /// The view depth of each pixel, rows top to bottom; 0 where nothing was drawn.
  std::vector<float> depths() const {
    const images::Image positions = render::read_image(gbuffer_.position(), 4);
    std::vector<float> depths;
    for (std::size_t i = 3; i < positions.texels.size(); i += 4) depths.push_back(positions.texels[i]);
    return depths;
  }

  gl::Context& context_;
  scene::Scene scene_ = load_builtin("cubes");
  render::ShaderLibrary shaders_{options::find_resources().shaders};
  render::Geometry geometry_;
  render::GBuffer gbuffer_;

 private:
  void look() { camera().orthographic_height_m = 6.0f; }
};

TEST_F(ResolvePassTest, OfWeightOne_IsTheLastFrame_ToTheBit) {
  render::ResolvePass resolve({.least_weight = 1.0f, .clamps = false}, kResolvedWidth, kResolvedHeight);
  add(resolve, make_picture(0.0f));
  EXPECT_EQ(add(resolve, make_picture(1.0f)), make_picture(1.0f));
}

TEST_F(ResolvePassTest, OfEqualFrames_IsEachOfThem_ToTheBit) {
  for (const float weight : {0.0f, 0.1f, 0.3f}) {
    render::ResolvePass resolve({.least_weight = weight, .clamps = false}, kResolvedWidth, kResolvedHeight);
    std::vector<float> resolved;
    for (int i = 0; i < 20; ++i) resolved = add(resolve, make_picture(0.0f));
    EXPECT_EQ(resolved, make_picture(0.0f)) << weight;
  }
}

TEST_F(ResolvePassTest, WeighsFrames_FirstAlike_ThenByTheLeastWeight) {
  render::ResolvePass mean({.least_weight = 0.0f, .clamps = false}, kResolvedWidth, kResolvedHeight);
  render::ResolvePass exponential({.least_weight = 0.25f, .clamps = false}, kResolvedWidth, kResolvedHeight);
  double sum = 0.0, expected = 0.0;
  std::vector<float> last, weighted;
  for (int i = 0; i < 10; ++i) {
    const std::vector<float> picture = make_picture(static_cast<float>(i));
    last = add(mean, picture);
    weighted = add(exponential, picture);
    const double now = static_cast<double>(picture[100]), weight = std::max(1.0 / (i + 1), 0.25);
    sum += now;
    expected += weight * (now - expected);
  }
  EXPECT_NEAR(static_cast<double>(last[100]), sum / 10.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(weighted[100]), expected, 1e-6);
}

TEST_F(ResolvePassTest, Clamping_KeepsToTheNewestFramesNeighbours) {
  render::ResolvePass resolve({.least_weight = 0.1f, .clamps = true}, kResolvedWidth, kResolvedHeight);
  std::vector<float> dark(kResolvedWidth * kResolvedHeight, 0.0f), half(dark.size(), 0.5f);
  half[5 * kResolvedWidth + 7] = 0.25f;
  add(resolve, dark);
  const std::vector<float> resolved = add(resolve, half);
  EXPECT_EQ(resolved[20 * kResolvedWidth + 20], 0.5f);
  EXPECT_EQ(resolved[5 * kResolvedWidth + 8], 0.375f)
      << "0.25 beside it is as dark as history may be; it weighs a half";
}

/// A camera that moves to the right moves the picture to the left, and history with it; what comes in starts anew.
TEST_F(ResolvePassTest, History_FollowsTheSurface) {
  constexpr int kStep = 3;
  const std::vector<float> before = make_picture(0.0f), now = make_picture(2.0f), depths_before = depths();
  render::ResolvePass resolve({.least_weight = 0.0f, .clamps = false}, kResolvedWidth, kResolvedHeight);
  add(resolve, before);
  scene::Camera moved = camera();
  const float pixel_m = moved.orthographic_height_m / kResolvedHeight;
  moved.position_ws += kStep * pixel_m * glm::normalize(glm::cross(moved.forward_ws, moved.up_ws));
  draw(moved);
  const std::vector<float> resolved = add(resolve, now, moved), depths_now = depths();
  int followed = 0, entered = 0;
  for (std::size_t i = 0; i < resolved.size(); ++i) {
    const int x = static_cast<int>(i) % kResolvedWidth;
    if (depths_now[i] == 0.0f) continue;
    if (x + kStep >= kResolvedWidth) {
      EXPECT_EQ(resolved[i], now[i]);
      ++entered;
    } else if (depths_before[i + kStep] > 0.0f && std::abs(depths_before[i + kStep] - depths_now[i]) < 1e-3f) {
      EXPECT_NEAR(resolved[i], 0.5f * (before[i + kStep] + now[i]), 2e-3f) << i;
      ++followed;
    }
  }
  EXPECT_GT(entered, 20);
  EXPECT_GT(followed, 500);
}

/// Where a nearer surface stood, nothing of it stays.
TEST_F(ResolvePassTest, WhatWasHidden_StartsAnew) {
  render::ResolvePass resolve({.least_weight = 0.0f, .clamps = false}, kResolvedWidth, kResolvedHeight);
  std::vector<float> positions = gbuffer_.position().read_floats(4);
  const std::vector<float> there = positions, normals = gbuffer_.normal().read_floats(4);
  for (std::size_t i = 0; i < positions.size(); i += 4) {
    if (positions[i + 3] == 0.0f) continue;
    for (int k = 0; k < 3; ++k) positions[i + static_cast<std::size_t>(k)] -= camera().forward_ws[k];
    positions[i + 3] -= 1.0f;
  }
  gbuffer_.upload(positions, normals);
  add(resolve, make_picture(0.0f));
  gbuffer_.upload(there, normals);
  const std::vector<float> now = make_picture(2.0f), resolved = add(resolve, now), depths_now = depths();
  int anew = 0, all = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (depths_now[i] == 0.0f) continue;
    ++all;
    anew += resolved[i] == now[i] ? 1 : 0;
  }
  EXPECT_GT(anew, 0.9 * all) << "only beside silhouettes may another surface be as far away";
}

}  // namespace
}  // namespace shadowbench::test
