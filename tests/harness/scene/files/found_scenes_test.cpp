#include <cctype>

#include "tests/harness/scene/gltf_parts.h"

// Small scenes of the kinds that other programs write, with what is right for each.

namespace shadowbench::scene {
namespace {

/// What a file holds. Sizes are of all that is drawn, opacities of each material as rays meet it, on average.
struct Content {
  std::size_t triangles = 2;
  glm::vec3 size{1, 1, 0};
  std::vector<double> opacities = {1.0};
  std::size_t lights = 0;
  std::vector<std::string> warnings = {};  ///< a word of each
};

struct Found {
  const char* what;
  std::vector<std::pair<std::string, std::string>> files;  ///< the first is the scene
  Content right;
};

double opacity_of(const Material& material, const std::vector<Texture>& textures) {
  if (material.alpha_mode == AlphaMode::kOpaque) return 1.0;
  std::vector<double> alphas = {1.0};
  if (material.base_color_texture >= 0) {
    alphas.clear();
    const std::vector<std::uint8_t>& rgba = textures.at(static_cast<std::size_t>(material.base_color_texture)).rgba;
    for (std::size_t i = 3; i < rgba.size(); i += 4) alphas.push_back(rgba[i] / 255.0);
  }
  double sum = 0.0;
  for (const double alpha : alphas) {
    const double own = alpha * static_cast<double>(material.base_color.a);
    sum += material.alpha_mode == AlphaMode::kBlend            ? own
           : own >= static_cast<double>(material.alpha_cutoff) ? 1.0
                                                               : 0.0;
  }
  return sum / static_cast<double>(alphas.size());
}

void expect_right(const Found& found) {
  const TestFolder folder;
  for (const auto& [name, bytes] : found.files) folder.write(name, bytes);
  const MeshFile model = import_mesh_file(folder.path() / found.files.front().first);
  Scene scene;
  scene.meshes = model.meshes;
  EXPECT_EQ(scene.triangle_count(), found.right.triangles);
  const Bounds bounds = scene.bounds();
  EXPECT_LT(glm::distance(bounds.max - bounds.min, found.right.size), 1e-6f) << bounds.max.x << " " << bounds.max.y;
  EXPECT_EQ(model.lights.size(), found.right.lights);
  std::vector<testing::Matcher<double>> opacities;
  for (const double opacity : found.right.opacities) opacities.push_back(testing::DoubleNear(opacity, 0.003));
  std::vector<double> own;
  for (const Material& material : model.materials) own.push_back(opacity_of(material, model.textures));
  EXPECT_THAT(own, testing::ElementsAreArray(opacities));
  std::vector<testing::Matcher<std::string>> warnings;
  for (const std::string& word : found.right.warnings) warnings.push_back(HasSubstr(word));
  EXPECT_THAT(model.warnings, testing::ElementsAreArray(warnings));
}

/// A picture of two texels, each blue, green, red and alpha; 32-bit TGA, rows from the top.
std::string tga_of(const std::string& texels) {
  return std::string("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\40\50", 18) + texels;
}

const std::string kHalfBlack = tga_of(std::string("\x00\x00\x00\xff\xff\xff\xff\xff", 8));
const std::string kGrey = tga_of(std::string("\x80\x80\x80\xff\x80\x80\x80\xff", 8));
const std::string kHalfClear = tga_of(std::string("\xff\xff\xff\x00\xff\xff\xff\xff", 8));
constexpr const char* kTexturedObj =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n";

/// A square whose material library has these lines; pictures stand beside it.
Found obj_of(const char* what, const std::string& lines, Content right) {
  right.opacities.push_back(1.0);  // the default material
  return {what,
          {{"a.obj", kTexturedObj},
           {"m.mtl", "newmtl m\n" + lines},
           {"half.tga", kHalfBlack},
           {"grey.tga", kGrey},
           {"clear.tga", kHalfClear},
           {"tex/c.tga", kGrey}},
          std::move(right)};
}

Found gltf_found(const char* what, const GltfParts& parts, Content right) {
  return {what, {{"a.gltf", gltf_of(parts)}, {"data.bin", parts.buffer}, {"clear.tga", kHalfClear}}, std::move(right)};
}

GltfParts with(const std::function<void(GltfParts&)>& change) {
  GltfParts parts;
  change(parts);
  return parts;
}

/// The quad with a material; `used` names extensions, with quotes.
GltfParts with_material(const std::string& material, const std::string& used, const std::string& uri = "clear.tga") {
  GltfParts parts = textured_parts("");
  parts.more = fmt::format(R"(, "images": [{{"uri": "{}"}}], "textures": [{{"source": 0}}], "materials": [{}],
      "extensionsUsed": [{}], "extensionsRequired": [{}])",
                           uri, material, used, used);
  return parts;
}

/// The quad with an accessor more, of floats.
void add_floats(GltfParts& parts, const std::vector<float>& values, const char* type, std::size_t components) {
  parts.accessors.back() = parts.views.back() = ',';
  const auto view = std::ranges::count(parts.views, '{');
  parts.views +=
      fmt::format(R"({{"buffer": 0, "byteOffset": {}, "byteLength": {}}}])", parts.buffer.size(), 4 * values.size());
  parts.accessors += fmt::format(R"({{"bufferView": {}, "componentType": 5126, "count": {}, "type": "{}"}}])", view,
                                 values.size() / components, type);
  parts.buffer += bytes_of(values);
}

GltfParts with_instances(const std::string& attributes) {
  return with([&](GltfParts& parts) {
    parts.nodes = fmt::format(
        R"([{{"mesh": 0, "scale": [2, 2, 2], "extensions": {{"EXT_mesh_gpu_instancing": {{"attributes": {{{}}}}}}}}}])",
        attributes);
    parts.more =
        R"(, "extensionsUsed": ["EXT_mesh_gpu_instancing"], "extensionsRequired": ["EXT_mesh_gpu_instancing"])";
    add_floats(parts, {0, 0, 0, 3, 0, 0, 0, 0, 5}, "VEC3", 3);
    add_floats(parts, {1, 1, 1, 2, 1, 1, 1, 1, 1}, "VEC3", 3);
    add_floats(parts, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0}, "VEC4", 4);
  });
}

/// A quad that two joints move: the first twice as large, the second 10 m along z. Its own node, which shrinks it, does
/// not count.
GltfParts with_skin(const std::string& skin, const std::vector<float>& weights) {
  return with([&](GltfParts& parts) {
    parts.nodes = R"([{"mesh": 0, "skin": 0, "scale": [0.01, 0.01, 0.01]}, {"scale": [2, 2, 2]},
        {"translation": [0, 0, 10]}])";
    parts.scenes = R"([{"nodes": [0, 1, 2]}])";
    parts.primitive = R"({"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1})";
    parts.more = fmt::format(R"(, "skins": [{}])", skin);
    parts.views.back() = parts.accessors.back() = ',';
    parts.views += fmt::format(R"({{"buffer": 0, "byteOffset": {}, "byteLength": 16}}])", parts.buffer.size());
    parts.accessors += R"({"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC4"}])";
    parts.buffer += bytes_of(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    add_floats(parts, weights, "VEC4", 4);
    // Moves what was bound by -1 along x.
    add_floats(parts, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
               "MAT4", 16);
  });
}

const std::vector<float> kFirstJoint{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
const std::vector<float> kHalfFirstJoint{0.5, 0, 0, 0, 0.5, 0, 0, 0, 0.5, 0, 0, 0, 0.5, 0, 0, 0};
const std::vector<float> kBothJoints{1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};

const std::string kGloss = R"("KHR_materials_pbrSpecularGlossiness")";
const std::string kTransmission = R"("KHR_materials_transmission")";

std::vector<Found> list_obj_files() {
  std::string marked = std::string("\xef\xbb\xbf") + "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
  return {
      {"a byte order mark", {{"a.obj", marked}}, {.triangles = 1}},
      {"a byte order mark in the library",
       {{"a.obj", kTexturedObj}, {"m.mtl", "\xef\xbb\xbfnewmtl m\nd 0.25\n"}},
       {.opacities = {0.25, 1.0}, .warnings = {"blends"}}},
      {"references with backslashes",
       {{"a.obj", "mtllib .\\tex\\m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"}, {"tex/m.mtl", "newmtl m\n"}},
       {.triangles = 1, .opacities = {1.0, 1.0}}},
      obj_of("a picture with backslashes", "map_Kd .\\tex\\c.tga\n", {}),
      obj_of("a picture that is missing", "map_Kd absent.tga\n", {.warnings = {"'absent.tga' is missing"}}),
      obj_of("d", "d 0.25\n", {.opacities = {0.25}, .warnings = {"blends"}}),
      obj_of("Tr", "Tr 0.25\n", {.opacities = {0.75}, .warnings = {"blends"}}),
      obj_of("d and a picture whose alpha does not count", "d 0.5\nmap_Kd clear.tga\n",
             {.opacities = {0.5}, .warnings = {"blends"}}),
      obj_of("map_d, black and white", "map_d half.tga\n", {.opacities = {0.5}}),
      obj_of("map_d beside map_Kd", "map_Kd grey.tga\nmap_d half.tga\n", {.opacities = {0.5}}),
      obj_of("map_d with alpha", "map_d clear.tga\n", {.opacities = {0.5}}),
      obj_of("map_d in half-tones", "map_d grey.tga\n", {.opacities = {0.502}, .warnings = {"blends"}}),
      obj_of("map_d and d", "map_d half.tga\nd 0.5\n", {.opacities = {0.25}, .warnings = {"blends"}}),
  };
}

std::vector<Found> list_gltf_files() {
  const std::string gloss = "{{\"alphaMode\": \"{}\", \"extensions\": {{" + kGloss + ": {{{}}}}}}}";
  const std::string diffuse = R"("diffuseTexture": {"index": 0})";
  const std::string transmits = R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75}}})";
  return {
      gltf_found("specular-glossiness with holes",
                 with_material(fmt::format(fmt::runtime(gloss), "MASK", diffuse), kGloss), {.opacities = {0.5}}),
      gltf_found(
          "specular-glossiness that blends",
          with_material(fmt::format(fmt::runtime(gloss), "BLEND", R"("diffuseFactor": [1, 1, 1, 0.25])"), kGloss),
          {.opacities = {0.25}, .warnings = {"blends"}}),
      gltf_found("transmission", with_material(transmits, kTransmission),
                 {.opacities = {0.25}, .warnings = {"blends"}}),
      gltf_found("transmission of a material whose alpha does not count",
                 with_material(
                     R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5], "baseColorTexture": {"index": 0}},
                         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75}}})",
                     kTransmission),
                 {.opacities = {0.25}, .warnings = {"blends"}}),
      gltf_found("transmission beside holes",
                 with_material(R"({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
                         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75}}})",
                               kTransmission),
                 {.opacities = {0.5}, .warnings = {"only the holes"}}),
      gltf_found("volume", with_material("{}", R"("KHR_materials_volume")"), {.warnings = {"KHR_materials_volume"}}),
      gltf_found("a material of the future",
                 with([](GltfParts& p) { p.more = R"(, "extensionsUsed": ["KHR_materials_gauze"])"; }),
                 {.warnings = {"KHR_materials_gauze"}}),
      gltf_found("a colour picture that is missing",
                 with_material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})", "", "absent.png"),
                 {.warnings = {"'absent.png' is missing"}}),
      gltf_found("a node that is not visible, and its child", with([](GltfParts& p) {
                   p.nodes = R"([{"mesh": 0}, {"children": [2], "mesh": 0, "translation": [9, 0, 0],
                       "extensions": {"KHR_node_visibility": {"visible": false}}}, {"mesh": 0}])";
                   p.scenes = R"([{"nodes": [0, 1]}])";
                   p.more = R"(, "extensionsUsed": ["KHR_node_visibility"])";
                 }),
                 {}),
      gltf_found("a spot as wide as half of everything",
                 lit_parts({{R"({"type": "spot", "name": "wide", "spot": {"outerConeAngle": 1.5707963267948966}})", ""},
                            {R"({"type": "directional"})", ""}}),
                 {.lights = 2, .warnings = {"'wide' has a cone of 180 degrees"}}),
      gltf_found("animations of the future", with([](GltfParts& p) {
                   p.more = R"(, "animations": [{"channels": [{"sampler": 0, "target": {"path": "pointer",
                       "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/0/scale"}}}}],
                       "samplers": [{"input": 0, "output": 0}]}], "extensionsUsed": ["KHR_animation_pointer"])";
                 }),
                 {}),
      gltf_found("instances", with_instances(R"("TRANSLATION": 2)"), {.triangles = 6, .size = {8, 2, 10}}),
      gltf_found("instances that are scaled", with_instances(R"("TRANSLATION": 2, "SCALE": 3)"),
                 {.triangles = 6, .size = {10, 2, 10}}),
      gltf_found("instances that are turned", with_instances(R"("ROTATION": 4)"), {.triangles = 6, .size = {4, 4, 0}}),
      gltf_found("a skin without bind matrices, of one joint", with_skin(R"({"joints": [1, 2]})", kFirstJoint),
                 {.size = {2, 2, 0}}),
      gltf_found("a skin whose weights add up to a half", with_skin(R"({"joints": [1, 2]})", kHalfFirstJoint),
                 {.size = {2, 2, 0}}),
      gltf_found("a skin without weights", with_skin(R"({"joints": [1, 2]})", std::vector<float>(16)),
                 {.size = {2, 2, 0}}),
      gltf_found("a skin of two joints", with_skin(R"({"joints": [1, 2], "inverseBindMatrices": 4})", kBothJoints),
                 {.size = {3, 1, 10}}),
      gltf_found("a skin whose joint is elsewhere", with_skin(R"({"joints": [1, 3]})", kFirstJoint),
                 {.size = {0.01f, 0.01f, 0}, .warnings = {"unposed"}}),
  };
}

class FoundScenesTest : public testing::TestWithParam<Found> {};

TEST_P(FoundScenesTest, IsReadWhole) { expect_right(GetParam()); }

std::string name_row(const testing::TestParamInfo<Found>& row) {
  std::string name = row.param.what;
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Obj, FoundScenesTest, testing::ValuesIn(list_obj_files()), name_row);
INSTANTIATE_TEST_SUITE_P(Gltf, FoundScenesTest, testing::ValuesIn(list_gltf_files()), name_row);

TEST(FoundScenes, PictureOfOpacities_KeepsTheColours) {
  const TestFolder folder;
  for (const auto& [name, bytes] : obj_of("", "map_Kd grey.tga\nmap_d half.tga\n", {}).files) folder.write(name, bytes);
  EXPECT_THAT(import_obj(folder.path() / "a.obj").textures.at(0).rgba,
              ElementsAre(128, 128, 128, 0, 128, 128, 128, 255));
}

TEST(FoundScenes, WhatCannotBeRead_IsNamed) {
  const TestFolder folder;
  const std::string wide("\xff\xfev\0 \0", 6), unmarked("v\0 \0", 4);
  for (const std::string& text : {wide, unmarked})
    EXPECT_THAT(error_of([&] { import_obj(folder.write("a.obj", text)); }).message(), HasSubstr("UTF-16"));
  folder.write("m.mtl", "newmtl m\nmap_d absent.tga\n");
  EXPECT_THAT(error_of([&] { import_obj(folder.write("a.obj", kTexturedObj)); }).what(), HasSubstr("absent.tga"));
  for (const auto& [parts, complaint] :
       {std::pair(with_instances(R"("TRANSLATION": 2, "SCALE": 0)"), "differ in their number"),
        std::pair(with_instances(R"("TRANSLATION": "x")"), "must be an accessor"),
        std::pair(with_instances(R"("TRANSLATION": 99)"), "accessor"),
        std::pair(with_skin(R"({"joints": [1]})", kFirstJoint), "follows joint 1 of 1"),
        std::pair(with_skin(R"({"joints": [1, 2], "inverseBindMatrices": 3})", kFirstJoint), "accessor 3"),
        std::pair(with_skin(R"({"joints": [1, 2]})", {1, 0, 0, 0}), "joints or weights for another number"),
        std::pair(with_material(R"({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})",
                                "", "absent.png"),
                  "'absent.png' is missing")})
    EXPECT_THAT(complaint_about_gltf(parts), HasSubstr(complaint));
}

}  // namespace
}  // namespace shadowbench::scene
