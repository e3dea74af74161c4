#include "harness/scene/scene.h"

#include <tuple>

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/load.h"
#include "harness/scene/mesh_tools.h"
#include "reference/truth/visibility.h"
#include "tests/harness/scene/gltf_parts.h"

namespace shadowbench::scene {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Scene make_scene() {
  Scene scene;
  scene.meshes.push_back(make_plane({2.0f, 2.0f}, 2));
  scene.meshes.back().name = "floor";
  scene.materials.push_back({.name = "grey"});
  scene.cameras.emplace_back();
  return scene;
}

/// What is done to a scene, and a part of what is said of it.
struct Spoiled {
  std::function<void(Scene&)> spoil;
  const char* message;
};

TEST(ValidateTest, WhatCannotBeDrawn_IsNamed) {
  std::vector<Spoiled> all{
      {[](Scene& s) { s.meshes[0].vertices[2].normal_ws.x = kNaN; },
       "vertex 2 of mesh 'floor' has the not finite normal"},
      {[](Scene& s) { s.meshes[0].vertices[1].uv.x = kInfinity; },
       "vertex 1 of mesh 'floor' has the not finite texture coordinate"},
      {[](Scene& s) { s.meshes[0].indices[5] = 9; }, "9 vertices"},
      {[](Scene& s) { s.meshes[0].material = 1; }, "material 1 of 1"},
      {[](Scene& s) { s.materials[0].base_color_texture = 0; }, "texture 0 of 0"},
      {[](Scene& s) { s.meshes.clear(); }, "empty"},
      {[](Scene& s) {
         s.meshes[0].indices = {0, 0, 1};
       },
       "none of its 1 triangles has an area"},
      {[](Scene& s) { s.light.kind = Sun{glm::vec3(0.0f)}; }, "light has no direction"},
      {[](Scene& s) {
         s.light.kind = Sun{{0.0f, kNaN, 0.0f}};
       },
       "light has no direction"},
      {[](Scene& s) { s.light.intensity = -1.0f; }, "intensity"},
      {[](Scene& s) { s.light.color.x = kInfinity; }, "colour"},
      {[](Scene& s) { std::get<Sun>(s.light.kind).angular_diameter_deg = kNaN; }, "angular diameter"},
      {[](Scene& s) { s.cameras[0].forward_ws = glm::vec3(0.0f); }, "camera 'main' has no direction"},
      {[](Scene& s) { s.cameras[0].vertical_fov_rad = 4.0f; }, "field of view"},
      {[](Scene& s) { s.cameras[0].position_ws.z = kNaN; }, "stands at"}};
  for (const float bad : {kNaN, kInfinity, -kInfinity, 1e30f})
    all.push_back({[bad](Scene& s) { s.meshes[0].vertices[3].position_ws.y = bad; }, "vertex 3 of mesh 'floor'"});
  for (const float bad : {1.5f, -0.25f, kNaN, kInfinity})
    all.push_back({[bad](Scene& s) {
                     s.materials[0].base_color.a = bad;
                     if (std::isfinite(bad)) EXPECT_NO_THROW(validate(s, "file.toml")) << "an opaque material's";
                     s.materials[0].alpha_mode = AlphaMode::kBlend;
                   },
                   "'grey'"});
  for (const auto& [spoil, message] : all) {
    Scene scene = make_scene();
    spoil(scene);
    EXPECT_THAT(error_of([&] { validate(scene, "file.toml"); }), is_error(ErrorKind::kInput, "file.toml: ", message))
        << message;
  }
}

TEST(ValidateTest, SoundScene_PassesUnchanged) {
  const Scene scene = validate(make_scene(), "file.toml");
  EXPECT_EQ(scene.triangle_count(), 8U);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(ValidateTest, TrianglesWithoutArea_AreDroppedCountedAndTold) {
  Scene scene = make_scene();
  scene.meshes[0].indices.insert(scene.meshes[0].indices.end(), {0, 0, 1, 0, 1, 2});
  const Scene valid = validate(scene, "file.toml");
  EXPECT_EQ(valid.triangle_count(), 8U);
  EXPECT_THAT(valid.warnings, ElementsAre(HasSubstr("2 of 10 triangles")));
}

TEST(ValidateTest, TinyButSoundTriangles_AreKept) {
  Scene scene = make_scene();
  for (Vertex& vertex : scene.meshes[0].vertices) vertex.position_ws *= 1e-12f;
  EXPECT_EQ(validate(scene, "file.toml").triangle_count(), 8U);
}

TEST(ValidateTest, VerticesThatNoTriangleUses_DoNotWidenTheBounds) {
  Scene scene = make_scene();
  scene.meshes[0].vertices.push_back({glm::vec3(500.0f), {0, 1, 0}, {}});
  EXPECT_FLOAT_EQ(validate(scene, "file.toml").bounds().max.x, 1.0f);
}

TEST(ValidateTest, NormalsOfAnyLength_BecomeUnitLength) {
  Scene scene = make_scene();
  scene.meshes[0].vertices[0].normal_ws = {0.0f, 5.0f, 0.0f};
  scene.meshes[0].vertices[1].normal_ws = glm::vec3(0.0f);
  const Scene valid = validate(scene, "file.toml");
  for (const Vertex& v : valid.meshes[0].vertices) EXPECT_EQ(v.normal_ws, glm::vec3(0, 1, 0));
}

TEST(ValidateTest, LightDirection_BecomesUnitLength) {
  Scene scene = make_scene();
  scene.light.kind = Sun{{0.0f, -8.0f, 0.0f}};
  EXPECT_EQ(-to_light(validate(scene, "file.toml").light, {}), glm::vec3(0, -1, 0));
}

TEST(ValidateTest, CameraUpAlongItsView_IsReplacedByAnAxisAcrossIt) {
  for (const glm::vec3& forward : {glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(0, -3, 0)}) {
    Scene scene = make_scene();
    scene.cameras[0].forward_ws = forward;
    const Camera camera = validate(scene, "file.toml").cameras[0];
    EXPECT_NEAR(glm::length(camera.up_ws), 1.0f, 1e-6f);
    EXPECT_NEAR(glm::dot(camera.up_ws, camera.forward_ws), 0.0f, 1e-6f);
  }
}

TEST(ValidateTest, CamerasOfEqualName_AreToldApart) {
  Scene scene = make_scene();
  scene.cameras.resize(3);
  const Scene valid = validate(scene, "file.toml");
  EXPECT_EQ(valid.cameras[1].name, "main 2");
  EXPECT_EQ(valid.cameras[2].name, "main 3");
}

// What rays hit of a scene: what casts a shadow, but for the holes of its material; and where kernels lie in a map.

/// A roof over the left half of a floor that is seen from above.
Scene make_roofed_scene() {
  Scene scene;
  scene.materials.emplace_back();
  Mesh roof;
  for (const glm::vec3 p : {glm::vec3(-2, 1, -2), glm::vec3(0, 1, -2), glm::vec3(-2, 1, 2), glm::vec3(0, 1, 2)})
    roof.vertices.push_back({p, {0.0f, 1.0f, 0.0f}, {0.5f * p.x, 0.5f * p.z}});
  roof.indices = {0, 1, 2, 2, 1, 3};
  scene.meshes = {roof};
  return scene;
}

truth::ReceiverImage make_receivers() {
  truth::ReceiverImage receivers{32, 1, {}};
  for (int i = 0; i < 32; ++i) {
    const float x = -1.0f + 2.0f * (static_cast<float>(i) + 0.5f) / 32.0f;
    receivers.points.push_back({{x, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, true});
  }
  return receivers;
}

std::vector<float> trace_hard(const Scene& scene) {
  return truth::trace_hard(truth::Occluders(list_occluders(scene)), make_receivers(), make_area_light(scene.light));
}

TEST(Occluders, MeshesThatCastNoShadow_BlockNothing) {
  Scene scene = make_roofed_scene();
  EXPECT_EQ(trace_hard(scene).front(), 0.0f);
  EXPECT_EQ(trace_hard(scene).back(), 1.0f);
  scene.meshes[0].casts_shadow = false;
  EXPECT_TRUE(list_occluders(scene).empty());
  EXPECT_EQ(trace_hard(scene), std::vector<float>(32, 1.0f));
}

TEST(Occluders, HolesOfAMaterial_LetRaysThrough) {
  Scene scene = make_roofed_scene();
  scene.materials[0].alpha_mode = AlphaMode::kMask;
  scene.materials[0].base_color.a = 0.2f;
  EXPECT_EQ(trace_hard(scene), std::vector<float>(32, 1.0f));
  scene.materials[0].alpha_cutoff = 0.1f;
  EXPECT_EQ(trace_hard(scene).front(), 0.0f);
  // u runs from -1 to 0 under the roof, and from -0.5 above the receivers: the texture's second texel, then its first.
  scene.materials[0].alpha_cutoff = 0.5f;
  scene.materials[0].base_color.a = 1.0f;
  scene.materials[0].base_color_texture = 0;
  scene.textures.push_back(
      {"striped", 4, 1, {255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 255}});
  const std::vector<float> hard = trace_hard(scene);
  EXPECT_NEAR(static_cast<double>(std::count(hard.begin(), hard.begin() + 16, 1.0f)), 8.0, 2.0)
      << "the transparent texel";
  EXPECT_EQ(hard[15], 0.0f) << "an opaque one";
}

TEST(Occluders, AMaterialThatBlends_DimsRays) {
  Scene scene = make_roofed_scene();
  scene.materials[0].alpha_mode = AlphaMode::kBlend;
  scene.materials[0].base_color.a = 0.2f;
  EXPECT_NEAR(trace_hard(scene).front(), 0.8f, 1e-6f);
  EXPECT_EQ(trace_hard(scene).back(), 1.0f);
  scene.materials[0].base_color_texture = 0;
  scene.textures.push_back({"half", 1, 1, {255, 255, 255, 51}});
  EXPECT_NEAR(trace_hard(scene).front(), 1.0f - 0.2f * 0.2f, 1e-6f);
}

/// Whether light falls through a roof over the receivers' left and right half. The roof is a picture whose right half
/// is a hole, under a KHR_texture_transform.
std::pair<bool, bool> lit_halves(const std::string& transform) {
  scene::GltfParts parts = scene::textured_parts(R"({"bufferView": 3, "mimeType": "image/png"})");
  parts.nodes = R"([{"mesh": 0, "translation": [-1, 1, 1], "scale": [2, 2, 2],
      "rotation": [-0.70710678118654752, 0, 0, 0.70710678118654752]}])";
  parts.more = fmt::format(R"(, "images": [{{"bufferView": 3, "mimeType": "image/png"}}], "textures": [{{"source": 0}}],
      "materials": [{{"alphaMode": "MASK", "alphaCutoff": 0.75, "pbrMetallicRoughness": {{"baseColorTexture":
      {{"index": 0, "extensions": {{"KHR_texture_transform": {}}}}}}}}}])",
                           transform);
  const std::vector<float> hard = trace_hard(scene::add_mesh_file({}, scene::import_parts(parts)));
  const auto lit = [&](std::ptrdiff_t first) { return std::count(&hard[0] + first, &hard[0] + first + 16, 1.0f); };
  EXPECT_EQ(lit(0) + lit(16), 16) << "half of them";
  return {lit(0) == 16, lit(16) == 16};
}

TEST(Occluders, HoleOfATransformedTexture_IsWhereTheTransformPutsIt) {
  EXPECT_EQ(lit_halves("{}"), std::pair(false, true));
  EXPECT_EQ(lit_halves(R"({"offset": [0.5, 0]})"), std::pair(true, false));
  EXPECT_EQ(lit_halves(R"({"scale": [-1, 1]})"), std::pair(true, false));
  EXPECT_EQ(lit_halves(R"({"rotation": 3.14159265358979})"), std::pair(true, false));
}

TEST(MapGrid, IsThatOfTheLightsMap) {
  Scene scene = make_roofed_scene();
  scene.light.kind = Sun{glm::normalize(glm::vec3(-0.5f, -1.0f, -0.25f))};
  const LightFrustum frustum = fit_light(scene, FitMode::kTight, 64, 2.0);
  const truth::MapGrid grid = make_map_grid(frustum);
  const auto texel_of = [&](const glm::dvec3& p) {
    return 64.0 * glm::dvec3(glm::dmat4(frustum.uv_depth_from_world) * glm::dvec4(p, 1.0));
  };
  const glm::dvec3 start = texel_of(glm::dvec3(0.0));
  const glm::dvec3 right = texel_of(grid.texel_size_ws * grid.right) - start;
  const glm::dvec3 up = texel_of(grid.texel_size_ws * grid.up) - start;
  const glm::dvec3 towards = texel_of(grid.to_light) - start;
  EXPECT_LT(glm::distance(right, glm::dvec3(1.0, 0.0, 0.0)), 1e-4);
  EXPECT_LT(glm::distance(up, glm::dvec3(0.0, 1.0, 0.0)), 1e-4);
  EXPECT_LT(glm::length(glm::dvec2(towards)), 1e-4);
  EXPECT_LT(towards.z, 0.0);
}

// A scene far from its origin: every stage sees it as if it were near.

/// A floor and a model, under a lamp, moved along x and z.
std::string toml_at(double distance) {
  const auto at = [&](double x, double y, double z) {
    return fmt::format("[{:.12g}, {}, {:.12g}]\n", distance + x, y, distance + z);
  };
  return "title = \"far\"\n[camera]\nposition = " + at(3.1, 2.5, 4.3) + "target = " + at(0.3, 0.5, 0.2) +
         "[[light]]\nname = \"lamp\"\ntype = \"spot\"\nposition = " + at(1.3, 3.7, 0.1) +
         "target = " + at(0.1, 0.0, 0.7) +
         "[[light]]\nname = \"sun\"\nazimuth_deg = 40\nelevation_deg = 50\nmap_center = " + at(0.1, 0.0, 0.3) +
         "map_width = 3\n[[object]]\nshape = \"plane\"\nsize = [8.2, 8.2]\ncenter = " + at(0.1, 0.1, 0.3) +
         "[[object]]\nshape = \"model\"\nfile = \"far.obj\"\nscale = 2\nrotation_deg = [0, 90, 0]\n";
}

/// A square whose place is in its vertices.
std::string obj_at(double x, double z) {
  return fmt::format("v {0} 0 {1}\nv {2} 0 {1}\nv {2} 1.1 {1}\nv {0} 1.1 {1}\nf 1 2 3 4\n", x, z, x + 1.3);
}

struct Place {
  const char* what;
  std::function<Scene(double distance)> load_at;
};

std::vector<Place> list_places() {
  return {{"a scene file",
           [](double d) {
             const TestFolder folder;
             // Turned by a quarter and doubled, the square stands at twice (z, -x).
             folder.write("far.obj", obj_at(-0.5 * d, 0.5 * d));
             return load(folder.write("far.toml", toml_at(d)).string(), {});
           }},
          {"an OBJ file",
           [](double d) {
             const TestFolder folder;
             return load(folder.write("far.obj", obj_at(d, d)).string(), {});
           }},
          {"a glTF file",
           [](double d) {
             const TestFolder folder;
             GltfParts parts;
             parts.nodes = fmt::format(R"([{{"mesh": 0, "translation": [{0}, 0.3, {0}]}},
                 {{"extensions": {{"KHR_lights_punctual": {{"light": 0}}}}, "translation": [{0}, 5, {0}]}},
                 {{"camera": 0, "translation": [{1}, 2, {1}]}}])",
                                       d, d + 3.1);
             parts.scenes = R"([{"nodes": [0, 1, 2]}])";
             parts.more = R"(, "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual":
                 {"lights": [{"type": "point"}]}}, "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}])";
             folder.write("data.bin", parts.buffer);
             return load(folder.write("far.gltf", gltf_of(parts)).string(), {});
           }}};
}

/// A scene's places as its file has them.
std::vector<glm::dvec3> list_places_of(const Scene& scene) {
  std::vector<glm::dvec3> all;
  for (const Mesh& mesh : scene.meshes)
    for (const Vertex& v : mesh.vertices) all.emplace_back(v.position_ws);
  for (const Camera& camera : scene.cameras) all.emplace_back(camera.position_ws);
  for (const Scene& lit : separate_lights(scene)) {
    if (const auto beam = find_beam(lit.light)) all.push_back(beam->position_ws);
    if (lit.light.map_window) all.push_back(lit.light.map_window->center_ws);
  }
  for (glm::dvec3& place : all) place += scene.origin_ws;
  return all;
}

double largest_of(const Scene& scene) {
  const Bounds bounds = scene.bounds();
  const glm::vec3 most = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
  return static_cast<double>(std::max({most.x, most.y, most.z}));
}

TEST(SceneOrigin, FarScenes_KeepEveryDigitOfTheirFile) {
  for (const Place& place : list_places()) {
    SCOPED_TRACE(place.what);
    const Scene near = place.load_at(0.0);
    EXPECT_EQ(near.origin_ws, glm::dvec3(0.0));
    const std::vector<glm::dvec3> expected = list_places_of(near);
    for (const double distance : {100.0, 200.0, 500.0, 10e3, 1e6, 1e9}) {
      SCOPED_TRACE(distance);
      const Scene far = place.load_at(distance);
      EXPECT_LT(largest_of(far), 16.0);
      EXPECT_THAT(far.warnings, testing::ElementsAreArray(near.warnings));
      const std::vector<glm::dvec3> places = list_places_of(far);
      ASSERT_EQ(places.size(), expected.size());
      const double rounding = 2e-6 + 4e-16 * distance;
      for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_LT(glm::distance(places[i] - glm::dvec3(distance, 0.0, distance), expected[i]), rounding) << i;
    }
  }
}

TEST(SceneOrigin, WhatIsSaved_IsReadBack) {
  const TestFolder folder;
  folder.write("far.obj", obj_at(-5e3, 5e3));
  const auto file = folder.write("far.toml", toml_at(10e3));
  const Scene scene = load(file.string(), {});
  const Scene read =
      load(folder
               .write("saved.toml", write_scene({file, &scene, scene.cameras, {scene.light, scene.other_lights.at(0)}},
                                                folder.path() / "saved.toml"))
               .string(),
           {});
  EXPECT_EQ(read.origin_ws, scene.origin_ws);
  EXPECT_EQ(list_places_of(read), list_places_of(scene));
}

TEST(SceneOrigin, PositionsThatTheirFileHasRounded_AreAWarning) {
  const auto load_at = [](float distance) {
    const TestFolder folder;
    GltfParts parts;
    std::vector<float> quad = kQuad;
    for (float& number : quad) number += distance;
    parts.buffer = bytes_of(quad) + bytes_of(kQuadIndices);
    folder.write("data.bin", parts.buffer);
    return load(folder.write("baked.gltf", gltf_of(parts)).string(), LoadOptions{{}, true}).warnings;
  };
  EXPECT_THAT(load_at(0.0f), IsEmpty());
  EXPECT_THAT(load_at(100.0f), IsEmpty());
  EXPECT_THAT(load_at(10e3f), ElementsAre(HasSubstr("rounds positions in its file to 0.0012 m")));
}

glm::dvec3 corner(const Mesh& mesh, std::size_t i) { return mesh.vertices[mesh.indices[i]].position_ws; }

glm::dvec3 face_normal(const Mesh& mesh, std::size_t first) {
  return area_normal(corner(mesh, first), corner(mesh, first + 1), corner(mesh, first + 2));
}

double area_of(const Mesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) area += 0.5 * glm::length(face_normal(mesh, i));
  return area;
}

/// By the divergence theorem: positive only where faces point outward.
double volume_of(const Mesh& mesh) {
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    volume += glm::dot(corner(mesh, i), face_normal(mesh, i)) / 6.0;
  return volume;
}

using Point = std::tuple<float, float, float>;

Point point_of(const Mesh& mesh, std::size_t i) {
  const glm::vec3 p = mesh.vertices[mesh.indices[i]].position_ws;
  return {p.x, p.y, p.z};
}

/// Every edge is walked once in each direction.
bool has_no_open_edge(const Mesh& mesh) {
  std::map<std::pair<Point, Point>, int> walks;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point a = point_of(mesh, i + k);
      const Point b = point_of(mesh, i + (k + 1) % 3);
      ++walks[{a, b}];
      --walks[{b, a}];
    }
  }
  return std::ranges::all_of(walks, [](const auto& walk) { return walk.second == 0; });
}

void expect_sound(const Mesh& mesh) {
  ASSERT_FALSE(mesh.indices.empty());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 normal = face_normal(mesh, i);
    ASSERT_GT(glm::length(normal), 0.0) << "triangle " << i / 3 << " has no area";
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 shading = mesh.vertices[mesh.indices[i + k]].normal_ws;
      ASSERT_NEAR(glm::length(shading), 1.0, 1e-6);
      ASSERT_GT(glm::dot(shading, glm::normalize(normal)), 0.5) << "triangle " << i / 3 << " is wound the wrong way";
    }
  }
}

TEST(PrimitivesTest, Plane_FacesUpAndHasItsAreaAndCells) {
  const Mesh plane = make_plane({3.0f, 2.0f}, 5);
  expect_sound(plane);
  EXPECT_EQ(plane.indices.size(), 5U * 5U * 6U);
  EXPECT_NEAR(area_of(plane), 6.0, 1e-6);
  for (std::size_t i = 0; i < plane.indices.size(); i += 3) EXPECT_GT(face_normal(plane, i).y, 0.0);
}

/// Expects a closed mesh whose faces point outward, of this volume but for a share.
void expect_solid(const Mesh& mesh, double volume, double precision = 1e-6) {
  expect_sound(mesh);
  EXPECT_TRUE(has_no_open_edge(mesh));
  EXPECT_NEAR(volume_of(mesh) / volume, 1.0, precision);
}

TEST(PrimitivesTest, Solids_AreClosed_FaceOutward_AndHaveTheirSize) {
  const Mesh box = make_box({1.0f, 2.0f, 0.25f}, 8), sphere = make_sphere(2.0f, 96);
  expect_solid(box, 0.5);
  EXPECT_NEAR(area_of(box), 2.0 * (2.0 + 0.5 + 0.25), 1e-6);
  EXPECT_EQ(box.indices.size(), 2U * 6U * (4U * 8U + 8U * 1U + 4U * 1U));
  expect_solid(sphere, 32.0 / 3.0 * std::numbers::pi, 5e-3);
  for (const Vertex& v : sphere.vertices) EXPECT_NEAR(glm::length(v.position_ws), 2.0f, 1e-5f);
  expect_solid(make_cylinder(0.5f, 3.0f, {.segments = 64, .cells = 6}), 0.75 * std::numbers::pi, 5e-3);
}

TEST(PrimitivesTest, Bars_AreAsManyAsCountedAndSpacedAsSaid) {
  const Mesh bars = make_bars({.count = 3, .bar_width_m = 0.1f, .spacing_m = 0.5f, .length_m = 2.0f});
  expect_solid(bars, 3 * 0.1 * 0.1 * 2.0, 2e-5);
  Bounds box;
  for (const Vertex& v : bars.vertices) box.add(v.position_ws);
  EXPECT_FLOAT_EQ(box.max.x, 0.55f);
  EXPECT_FLOAT_EQ(box.max.y, 1.0f);
  EXPECT_FLOAT_EQ(box.max.z, 0.05f);
}

TEST(PrimitivesTest, BarsOfBothDirections_ShareNoFrontPlane) {
  const Mesh bars = make_bars({.count = 2, .bar_width_m = 0.1f, .direction = BarDirection::kBoth});
  EXPECT_NEAR(volume_of(bars), 2 * 2.0 * (0.01 + 0.0064), 1e-6);
}

TEST(MeshToolsTest, MirroringTransform_KeepsFacesOutward) {
  const glm::dmat4 mirror(glm::dmat3(-2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0));
  const Mesh box = transform_mesh(make_box(glm::vec3(1.0f), 2), mirror);
  expect_sound(box);
  EXPECT_NEAR(volume_of(box), 2.0, 1e-6);
}

TEST(MeshToolsTest, UnevenScale_KeepsNormalsAcrossTheSurface) {
  const glm::dmat4 stretch(glm::dmat3(1.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 1.0));
  const Mesh sphere = transform_mesh(make_sphere(1.0f, 192), stretch);
  for (std::size_t i = 0; i < sphere.indices.size(); i += 3) {
    const glm::dvec3 face = glm::normalize(face_normal(sphere, i));
    const glm::dvec3 shading = sphere.vertices[sphere.indices[i]].normal_ws;
    ASSERT_GT(glm::dot(face, shading), 0.9);
  }
}

TEST(MeshToolsTest, FlatNormals_AreThoseOfTheFaces) {
  const Mesh flat = with_flat_normals(make_sphere(1.0f, 8));
  for (std::size_t i = 0; i < flat.indices.size(); ++i) {
    const glm::dvec3 face = glm::normalize(face_normal(flat, i - i % 3));
    ASSERT_NEAR(glm::dot(face, glm::dvec3(flat.vertices[flat.indices[i]].normal_ws)), 1.0, 1e-6);
  }
}

TEST(MeshToolsTest, SmoothNormals_RoundASphereAndKeepABoxSharp) {
  for (const Vertex& v : with_smooth_normals(make_sphere(1.0f, 64), 45.0).vertices)
    ASSERT_GT(glm::dot(v.normal_ws, glm::normalize(v.position_ws)), 0.999f);
  const Mesh box = make_box(glm::vec3(1.0f), 2);
  const Mesh smooth = with_smooth_normals(box, 45.0);
  for (std::size_t i = 0; i < box.indices.size(); ++i) {
    const glm::vec3 before = box.vertices[box.indices[i]].normal_ws;
    ASSERT_GT(glm::dot(smooth.vertices[smooth.indices[i]].normal_ws, before), 0.9999f);
  }
}

TEST(MeshToolsTest, UnusedVertices_AreDroppedAndFacesStay) {
  Mesh mesh = make_plane({1.0f, 1.0f}, 1);
  mesh.vertices.insert(mesh.vertices.begin(), {glm::vec3(99.0f), {}, {}});
  for (std::uint32_t& index : mesh.indices) ++index;
  const Mesh compact = without_unused_vertices(mesh);
  EXPECT_EQ(compact.vertices.size(), 4U);
  EXPECT_NEAR(area_of(compact), 1.0, 1e-6);
}

}  // namespace
}  // namespace shadowbench::scene
