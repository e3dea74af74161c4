#include "filters/screen.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/picture_passes.h"
#include "report/images/picture_io.h"
#include "tests/harness/render/contract_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

// Lights where something is divided by nothing: in a caster, at a receiver, and with receivers in a spot's own plane.
// Visibility that is accumulated over frames.

/// A floor of 8 m seen from straight above: the picture's top is -z, its right +x.
scene::Scene make_lamp_scene(const glm::vec3& position, const glm::vec3& target) {
  return scene::make_scene_of({scene::make_plane({8.0f, 8.0f}, 1)}, scene::Spot{position, target, 60.0f, 45.0f, 0.0f},
                              {scene::look_down({0.0f, 12.0f, 0.0f}, 8.0f)});
}

/// The light alone that arrives, without the ambient part; rows top to bottom.
class LampLight {
 public:
  explicit LampLight(const scene::Scene& scene, const filters::RangeRule& range = {})
      : scene_(scene), range_(range), bench_(scene_, 64, kSide, kSide) {
    bench_.set_range(range);
  }

  /// The share of the floor that a filter finds lit.
  double measure_lit(const std::string& filter) {
    const std::vector<float> image = bench_.draw(request_of(filter));
    return static_cast<double>(std::ranges::count(image, 1.0f)) / static_cast<double>(image.size());
  }

  std::vector<glm::dvec3> draw() {
    const images::Image lit = shade(1.0f), dark = shade(0.0f);
    std::vector<glm::dvec3> light;
    for (std::size_t i = 0; i < lit.texels.size(); i += 3)
      light.emplace_back(lit.texels[i] - dark.texels[i], lit.texels[i + 1] - dark.texels[i + 1],
                         lit.texels[i + 2] - dark.texels[i + 2]);
    return light;
  }

 private:
  static constexpr int kSide = 160;

  images::Image shade(float visibility) {
    images::Image image(kSide, kSide, 1);
    for (float& value : image.texels) value = visibility;
    return render::shade(bench_.shaders(), bench_.gbuffer(), render::upload_image(image), scene_,
                         scene_.cameras.front(), range_);
  }

  scene::Scene scene_;
  filters::RangeRule range_;
  Bench bench_;
};

TEST(BackProjection, MirrorsConeAndMapThroughTheLamp) {
  const scene::Scene shines_up = make_lamp_scene({0.0f, 4.0f, 0.0f}, {0.0f, 8.0f, 0.0f});
  LampLight right(shines_up), wrong(shines_up, {filters::Border::kBorder, true, false}),
      ahead(make_lamp_scene({0.0f, 4.0f, 0.0f}, {}));
  for (const char* filter : {"none", "tent3x3", "pcss", "vsm"}) {
    EXPECT_EQ(right.measure_lit(filter), 0.0) << filter;
    EXPECT_NEAR(wrong.measure_lit(filter), ahead.measure_lit(filter), 0.01) << filter;
  }
  EXPECT_GT(ahead.measure_lit("none"), 0.2);
  const auto mirrored = wrong.draw(), lit = ahead.draw(), behind = right.draw();
  EXPECT_TRUE(std::ranges::all_of(behind, [](const glm::dvec3& c) { return c == glm::dvec3(0.0); }));
  for (std::size_t i = 0; i < lit.size(); ++i) EXPECT_NEAR(mirrored[i].g, lit[i].g, 1e-4) << "pixel " << i;
}

/// A floor, a box on it and a wall in the plane x = 0.
scene::Scene load_room(const std::string& light) {
  const TestFolder folder;
  return scene::load(folder
                         .write("room.toml", "title = \"room\"\n[light]\n" + light + R"(
[camera]
position = [3, 2.5, 4]
target = [0, 0.3, 0]
[[object]]
shape = "plane"
size = [6, 6]
[[object]]
shape = "box"
size = [0.4, 0.4, 0.4]
center = [0.6, 0.2, 0]
[[object]]
shape = "plane"
size = [2, 6]
center = [0, 1, 0]
rotation_deg = [0, 0, 90]
)")
                         .string(),
                     {});
}

struct DegeneratePlace {
  std::string name;
  std::string light;
};

const std::vector<DegeneratePlace>& degenerate_places() {
  static const std::vector<DegeneratePlace> places = [] {
    std::vector<DegeneratePlace> all;
    const std::vector<std::pair<std::string, std::string>> positions = {{"InACaster", "[0.6, 0.2, 0]"},
                                                                        {"OnTheFloor", "[0.3, 0, 0.2]"},
                                                                        {"AHairOverTheFloor", "[0.3, 1e-6, 0.2]"},
                                                                        {"OnTheWall", "[0, 0.5, 0.5]"},
                                                                        {"OnACastersCorner", "[0.4, 0.4, 0.2]"}};
    for (const auto& [name, position] : positions) {
      all.push_back({"Point" + name, "type = \"point\"\nposition = " + position});
      all.push_back({"Spot" + name, "type = \"spot\"\ntarget = [2, -1, 0.2]\nposition = " + position});
    }
    // w = 0 on the whole floor, and on the whole wall.
    all.push_back({"SpotInTheFloorsPlane", "type = \"spot\"\nposition = [0.3, 0, 0.2]\ntarget = [0.3, 2, 0.2]"});
    all.push_back({"SpotInTheWallsPlane", "type = \"spot\"\nposition = [0, 0.5, 0]\ntarget = [2, 0.5, 0]"});
    all.push_back({"RectangleInTheWallsPlane",
                   "type = \"spot\"\nsize = [0.3, 0.1]\nposition = [0, 0.5, 0]\ntarget = [2, 0.5, 0]\ncone_deg = 170"});
    return all;
  }();
  return places;
}

/// Draws all that a scene has under its light, and the truth.
void expect_numbers(const scene::Scene& scene) {
  Bench bench(scene, 128, 96, 54);
  const auto is_share = [](float v) { return v >= -1e-3f && v <= 1.001f; };
  for (const char* id : {"none", "tent3x3", "vsm", "pcss"}) {
    const std::vector<float> image = bench.draw(request_of(id));
    EXPECT_TRUE(std::ranges::all_of(image, is_share)) << id;
    images::Image visibility(96, 54, 1);
    visibility.texels = image;
    const images::Image picture =
        render::shade(bench.shaders(), bench.gbuffer(), render::upload_image(visibility), scene, scene.cameras.front());
    EXPECT_TRUE(std::ranges::all_of(picture.texels, [](float v) { return std::isfinite(v) && v >= 0.0f; })) << id;
  }
  const auto receivers = measure::read_view_receivers(bench.gbuffer(), scene.light).image;
  const truth::Occluders occluders(scene::list_occluders(scene));
  const truth::AreaLight light = scene::make_area_light(scene.light);
  const truth::TracedVisibility truth = truth::trace_area(occluders, receivers, light, {.max_points = 64});
  EXPECT_TRUE(std::ranges::all_of(truth.visibility, is_share));
  EXPECT_TRUE(std::ranges::all_of(truth.standard_error, [](float v) { return std::isfinite(v); }));
  EXPECT_TRUE(std::ranges::all_of(truth::trace_hard(occluders, receivers, light), is_share));
}

class DegenerateLight : public ::testing::TestWithParam<DegeneratePlace> {};

TEST_P(DegenerateLight, GivesNumbers_InEveryImage) { expect_numbers(load_room(GetParam().light)); }

INSTANTIATE_TEST_SUITE_P(Everywhere, DegenerateLight, ::testing::ValuesIn(degenerate_places()),
                         [](const auto& each) { return each.param.name; });

/// On the floor, the box and the wall, to the last bit.
TEST(DegenerateLight, AtAReceiversVeryPlace_GivesNumbers) {
  const scene::Scene lit = load_room("direction = [-1, -1, -1]");
  Bench bench(lit, 128, 96, 54);
  const std::vector<filters::Receiver> receivers = bench.receivers(request_of("none"));
  ASSERT_GT(receivers.size(), 1000u);
  for (std::size_t i = 0; i < receivers.size(); i += receivers.size() / 7) {
    const glm::vec3 place = receivers[i].position_ws, ahead = place + receivers[i].normal_ws;
    scene::Scene scene = lit;
    scene.light.kind = scene::PointLight{place};
    expect_numbers(scene);
    scene.light.kind = scene::Spot{place, ahead};
    expect_numbers(scene);
  }
}

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

// Screen passes: what a filter's file declares over its own picture.

class ScreenPassesTest : public ::testing::Test {
 protected:
  ScreenPassesTest() {
    for (const char* file : {"screen_box", "atrous"})
      filters_.add_user_file(std::string(SHADOWBENCH_SOURCE_DIR) + "/tests/user_filters/" + file + ".glsl");
  }

  filters::FilterRequest request(const std::string& text) const { return filters_.parse_requests(text).front(); }

  filters::Catalogue filters_{options::find_resources().filters};
};

/// The mean over a row of up to three receivers, halved twice; background and unlit surfaces stay as they were.
TEST_F(ScreenPassesTest, RunInOrder_OnReceiversAlone) {
  for (const char* scene : {"stack", "avenue"}) {  // the avenue has a map of several layers
    SCOPED_TRACE(scene);
    Bench bench(load_builtin(scene), 256, 160, 90);
    filters::FilterRequest box = request("screen_box"), plain = box;
    plain.spec.screens.clear();
    const std::vector<float> filtered = bench.draw(box), before = bench.draw(plain);
    std::vector<bool> takes_part(filtered.size());
    for (const filters::Receiver& r : bench.receivers(box)) takes_part[bench.index(r)] = true;
    std::size_t edges = 0;
    for (std::size_t i = 0; i < filtered.size(); ++i) {
      if (!takes_part[i]) {
        ASSERT_EQ(filtered[i], before[i]) << i;
        continue;
      }
      float sum = 0.0f, count = 0.0f;
      for (int x = -1; x <= 1; ++x) {
        const auto column = static_cast<int>(i % 160) + x;
        const std::size_t there = i + static_cast<std::size_t>(x + 1) - 1;
        if (column < 0 || column >= 160 || !takes_part[there]) continue;
        sum += before[there];
        count += 1.0f;
      }
      ASSERT_NEAR(filtered[i], 0.25f * sum / count, 1e-6f) << i;
      if (sum > 0.0f && sum < count) ++edges;
    }
    EXPECT_GT(edges, 50u) << "a blur of what is even proves nothing";
  }
}

TEST_F(ScreenPassesTest, Reads_AreCounted_AndWithinTheDeclaredReach) {
  Bench bench(load_builtin("stack"), 256, 160, 90);
  const auto measure = [&](const std::string& text) {
    const filters::FilterRequest filter = request(text);
    render::FilterPasses passes(bench.shaders(), filter, bench.map(), bench.light(filter));
    return passes.measure_cost(bench.gbuffer(), bench.map());
  };
  const render::FilterCost near = measure("screen_box");
  EXPECT_NEAR(near.screen.per_receiver, 6.0, 1e-6);  // 3 and 1 of row(), and 1 of halve(), twice
  EXPECT_EQ(near.passes, 2 + 3);
  EXPECT_TRUE(near.screen.exceeded.empty());
  const render::FilterCost far = measure("screen_box:side=3");
  ASSERT_EQ(far.screen.exceeded.size(), 1u);
  EXPECT_EQ(far.screen.exceeded.front(), "'row' reads 3 pixels away, and declares a reach of 1");
  for (const char* text : {"pcss:taps=4,search_taps=4,screen=bilateral", "atrous"}) {
    const render::FilterCost cost = measure(text);
    EXPECT_TRUE(cost.screen.exceeded.empty()) << text;
    EXPECT_GT(cost.screen.per_receiver, 10.0) << text;
  }
  EXPECT_EQ(measure("pcss").screen.per_receiver, 0.0);
  EXPECT_EQ(measure("pcss").passes, 2);
}

TEST_F(ScreenPassesTest, ThatReadsTheMap_OrOneOfTheFilters_IsRefused) {
  Bench bench(load_builtin("stack"), 64, 32, 18);
  for (const char* read : {"load_depth(s.pixel)", "load_copy(s.pixel).x"}) {
    SCOPED_TRACE(read);
    filters::FilterRequest box = request("screen_box");
    box.spec.passes.push_back({.name = "copy", .store = "r32f"});
    box.spec.body.insert(box.spec.body.find("float visibility"),
                         "vec4 copy(PassInput p) { return vec4(load_depth(p.texel)); }\n");
    const std::string result = "return 0.5 * own;";
    box.spec.body.replace(box.spec.body.find(result), result.size(), "return " + std::string(read) + " * own;");
    EXPECT_THAT(error_of([&] { bench.draw(box); }),
                is_error(ErrorKind::kFilter, "screen_box.glsl:17", "'halve' reads the shadow map"));
  }
}

/// Noise goes, and what is the mean of many pixels stays: edges between surfaces, lit and dark pixels.
TEST_F(ScreenPassesTest, OfPcss_TakeNoiseAway) {
  Bench bench(load_builtin("ball"), 1024, 480, 270);
  const std::vector<float> exact = bench.draw(request("pcss:taps=32,search_taps=32"));
  const auto differ = [&](const std::string& text) {
    const std::vector<float> image = bench.draw(request(text));
    double sum = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) sum += std::pow(static_cast<double>(image[i] - exact[i]), 2.0);
    return std::sqrt(sum / static_cast<double>(image.size()));
  };
  EXPECT_LT(differ("pcss:taps=4,search_taps=4,screen=bilateral"), 0.6 * differ("pcss:taps=4,search_taps=4"));
}

}  // namespace
}  // namespace shadowbench::test
