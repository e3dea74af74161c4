#include "harness/scene/mesh_tools.h"
#include "tests/harness/scene/gltf_parts.h"

namespace shadowbench::scene {
namespace {

Bounds bounds_of(const MeshFile& model) {
  Bounds box;
  for (const Mesh& mesh : model.meshes)
    for (const Vertex& vertex : mesh.vertices) box.add(vertex.position_ws);
  return box;
}

glm::dvec3 first_face(const Mesh& mesh) {
  return area_normal(mesh.vertices[mesh.indices[0]].position_ws, mesh.vertices[mesh.indices[1]].position_ws,
                     mesh.vertices[mesh.indices[2]].position_ws);
}

TEST(GltfFileTest, Quad_HasTwoTrianglesWithFlatNormals) {
  const MeshFile model = import_parts(GltfParts{});
  ASSERT_EQ(model.meshes.size(), 1U);
  EXPECT_EQ(model.meshes[0].indices.size(), 6U);
  EXPECT_EQ(model.meshes[0].name, "quad");
  for (const Vertex& v : model.meshes[0].vertices) EXPECT_EQ(v.normal_ws, glm::vec3(0, 0, 1));
  ASSERT_EQ(model.materials.size(), 1U);
  EXPECT_TRUE(model.cameras.empty());
  EXPECT_TRUE(model.lights.empty());
  EXPECT_TRUE(model.warnings.empty());
}

TEST(GltfFileTest, Glb_HoldsTheSame) {
  const TestFolder folder;
  const MeshFile model = import_gltf(folder.write("test.glb", glb_of({})));
  ASSERT_EQ(model.meshes.size(), 1U);
  EXPECT_EQ(bounds_of(model).max, glm::vec3(1, 1, 0));
}

TEST(GltfFileTest, NestedTransforms_ApplyParentLast) {
  GltfParts parts;
  // The child is turned a quarter about z and moved; its parent doubles everything; theirs moves along z by a matrix.
  parts.nodes = R"([{"children": [1], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,7,1]},
                    {"children": [2], "scale": [2, 2, 2]},
                    {"mesh": 0, "name": "leaf", "translation": [10, 0, 0], "rotation": [0, 0, 0.70710678118654752, 0.70710678118654752]}])";
  const MeshFile model = import_parts(parts);
  const Bounds box = bounds_of(model);
  EXPECT_NEAR(glm::distance(box.min, glm::vec3(18, 0, 7)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::distance(box.max, glm::vec3(20, 2, 7)), 0.0f, 1e-5f);
  EXPECT_EQ(model.meshes[0].name, "leaf");
}

TEST(GltfFileTest, NegativeScale_KeepsWindingAndNormalTogether) {
  GltfParts parts;
  parts.nodes = R"([{"mesh": 0, "scale": [-1, 1, 1]}])";
  const Mesh mesh = import_parts(parts).meshes[0];
  EXPECT_GT(first_face(mesh).z, 0.0);
  EXPECT_EQ(mesh.vertices[0].normal_ws, glm::vec3(0, 0, 1));
  parts.nodes = R"([{"mesh": 0, "scale": [1, 1, -1]}])";
  const Mesh flipped = import_parts(parts).meshes[0];
  EXPECT_LT(first_face(flipped).z, 0.0);
  EXPECT_EQ(flipped.vertices[0].normal_ws, glm::vec3(0, 0, -1));
}

TEST(GltfFileTest, MeshPlacedTwice_IsThereTwice) {
  GltfParts parts;
  parts.nodes = R"([{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 5]}])";
  parts.scenes = R"([{"nodes": [0, 1]}])";
  const MeshFile model = import_parts(parts);
  ASSERT_EQ(model.meshes.size(), 2U);
  EXPECT_EQ(bounds_of(model).max.z, 5.0f);
}

TEST(GltfFileTest, StripAndFan_WindAsTheQuadDoes) {
  for (const auto& [mode, indices] :
       {std::pair(5, std::vector<std::uint16_t>{0, 1, 3, 2}), std::pair(6, std::vector<std::uint16_t>{0, 1, 2, 3})}) {
    GltfParts parts;
    parts.buffer = bytes_of(kQuad) + bytes_of(indices) + std::string(4, '\0');
    parts.primitive = fmt::format(R"({{"attributes": {{"POSITION": 0}}, "indices": 1, "mode": {}}})", mode);
    parts.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5123, "count": 4, "type": "SCALAR"}])";
    const Mesh mesh = import_parts(parts).meshes[0];
    ASSERT_EQ(mesh.indices.size(), 6U) << mode;
    for (const Vertex& v : mesh.vertices) EXPECT_EQ(v.normal_ws, glm::vec3(0, 0, 1)) << mode;
    double area = 0.0;
    for (std::size_t i = 0; i < 6; i += 3) {
      area += 0.5 * area_normal(mesh.vertices[i].position_ws, mesh.vertices[i + 1].position_ws,
                                mesh.vertices[i + 2].position_ws)
                        .z;
    }
    EXPECT_NEAR(area, 1.0, 1e-6) << mode;
  }
}

TEST(GltfFileTest, IndicesOfEveryWidth_AndNone_Read) {
  GltfParts bytes;
  bytes.buffer = bytes_of(kQuad) + bytes_of(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}) + std::string(6, '\0');
  bytes.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                        {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"}])";
  EXPECT_EQ(import_parts(bytes).meshes[0].indices.size(), 6U);
  GltfParts words;
  words.buffer = bytes_of(kQuad) + bytes_of(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
  words.views = R"([{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}])";
  words.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                        {"bufferView": 1, "componentType": 5125, "count": 6, "type": "SCALAR"}])";
  EXPECT_EQ(import_parts(words).meshes[0].indices.size(), 6U);
  GltfParts none;
  none.primitive = R"({"attributes": {"POSITION": 0}})";
  none.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}])";
  EXPECT_EQ(import_parts(none).meshes[0].indices.size(), 3U);
}

TEST(GltfFileTest, StridedAndNormalizedAttributes_Read) {
  GltfParts parts;
  parts.buffer = bytes_of(std::vector<std::int16_t>{0, 0, 0, 99, 32767, 0, 0, 99, 0, 32767, 0, 99});
  parts.primitive = R"({"attributes": {"POSITION": 0}})";
  parts.views = R"([{"buffer": 0, "byteLength": 24, "byteStride": 8}])";
  parts.accessors = R"([{"bufferView": 0, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC3"}])";
  EXPECT_EQ(bounds_of(import_parts(parts)).max, glm::vec3(1, 1, 0));
}

/// A triangle whose positions, normals and texture coordinates are of the given type of component.
template <class T>
Mesh quantized_triangle(const std::vector<T>& positions, const std::vector<T>& normals, const std::vector<T>& uvs,
                        int type, bool normalized) {
  GltfParts parts;
  parts.buffer.clear();
  parts.views = parts.accessors = "[";
  for (const auto& [values, components, is_normalized] :
       {std::tuple(positions, 3, normalized), std::tuple(normals, 3, true), std::tuple(uvs, 2, normalized)}) {
    const std::size_t stride = (static_cast<std::size_t>(components) * sizeof(T) + 3) / 4 * 4;
    parts.views += fmt::format(R"({}{{"buffer": 0, "byteOffset": {}, "byteLength": {}, "byteStride": {}}})",
                               parts.buffer.empty() ? "" : ", ", parts.buffer.size(), 3 * stride, stride);
    parts.accessors +=
        fmt::format(R"({}{{"bufferView": {}, "componentType": {}, "normalized": {}, "count": 3, "type": "VEC{}"}})",
                    parts.buffer.empty() ? "" : ", ", std::count(parts.views.begin(), parts.views.end(), '{') - 1, type,
                    is_normalized, components);
    for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(components)) {
      std::string element = bytes_of(std::vector<T>(&values[i], &values[i] + components));
      element.resize(stride, '\x55');
      parts.buffer += element;
    }
  }
  parts.views += "]";
  parts.accessors += "]";
  parts.primitive = R"({"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}})";
  parts.more = R"(, "extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"])";
  const MeshFile model = import_parts(parts);
  EXPECT_TRUE(model.warnings.empty());
  return model.meshes.at(0);
}

void expect_triangle(const Mesh& mesh, const glm::vec3& second, const glm::vec3& third, const glm::vec2& second_uv,
                     const glm::vec2& third_uv) {
  ASSERT_EQ(mesh.vertices.size(), 3U);
  EXPECT_LT(glm::distance(mesh.vertices[1].position_ws, second), 1e-6f) << mesh.vertices[1].position_ws.x;
  EXPECT_LT(glm::distance(mesh.vertices[2].position_ws, third), 1e-6f) << mesh.vertices[2].position_ws.y;
  EXPECT_LT(glm::distance(mesh.vertices[1].uv, second_uv), 1e-6f) << mesh.vertices[1].uv.x;
  EXPECT_LT(glm::distance(mesh.vertices[2].uv, third_uv), 1e-6f) << mesh.vertices[2].uv.y;
  for (const Vertex& vertex : mesh.vertices) EXPECT_EQ(vertex.normal_ws, glm::vec3(0, 0, 1));
}

/// KHR_mesh_quantization: b/255, max(b/127, -1), s/65535 and max(s/32767, -1) where normalized, else the number itself.
TEST(GltfFileTest, QuantizedAttributes_AreTheNumbersThatTheyStandFor) {
  const std::vector<std::int8_t> up8{0, 0, 127, 0, 0, 127, 0, 0, 127};
  const std::vector<std::int16_t> up16{0, 0, 32767, 0, 0, 32767, 0, 0, 32767};
  const std::vector<std::int8_t> positions8{0, 0, 0, 127, -128, 0, -3, 64, 0};
  expect_triangle(quantized_triangle<std::int8_t>(positions8, up8, {0, 0, -127, 127, 64, -128}, 5120, true), {1, -1, 0},
                  {-3.0f / 127, 64.0f / 127, 0}, {-1, 1}, {64.0f / 127, -1});
  expect_triangle(quantized_triangle<std::int8_t>(positions8, up8, {0, 0, -127, 127, 64, -128}, 5120, false),
                  {127, -128, 0}, {-3, 64, 0}, {-127, 127}, {64, -128});
  const std::vector<std::int16_t> positions16{0, 0, 0, 32767, -32768, 0, -3, 8192, 0};
  expect_triangle(quantized_triangle<std::int16_t>(positions16, up16, {0, 0, -32767, 1, 2, 3}, 5122, true), {1, -1, 0},
                  {-3.0f / 32767, 8192.0f / 32767, 0}, {-1, 1.0f / 32767}, {2.0f / 32767, 3.0f / 32767});
  expect_triangle(quantized_triangle<std::int16_t>(positions16, up16, {0, 0, -32767, 1, 2, 3}, 5122, false),
                  {32767, -32768, 0}, {-3, 8192, 0}, {-32767, 1}, {2, 3});
  const std::vector<std::uint8_t> up_u8{0, 0, 255, 0, 0, 255, 0, 0, 255};
  expect_triangle(
      quantized_triangle<std::uint8_t>({0, 0, 0, 255, 51, 0, 0, 200, 0}, up_u8, {0, 0, 255, 51, 1, 254}, 5121, true),
      {1, 0.2f, 0}, {0, 200.0f / 255, 0}, {1, 0.2f}, {1.0f / 255, 254.0f / 255});
  const std::vector<std::uint16_t> up_u16{0, 0, 65535, 0, 0, 65535, 0, 0, 65535};
  expect_triangle(quantized_triangle<std::uint16_t>({0, 0, 0, 65535, 13107, 0, 0, 40000, 0}, up_u16,
                                                    {0, 0, 65535, 13107, 1, 65534}, 5123, false),
                  {65535, 13107, 0}, {0, 40000, 0}, {65535, 13107}, {1, 65534});
}

TEST(GltfFileTest, SparseAccessor_ReplacesItsElements) {
  GltfParts parts;
  parts.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "sparse": {"count": 1,
      "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 3}}},
      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}])";
  parts.buffer += bytes_of(std::vector<std::uint16_t>{2, 0}) + bytes_of(std::vector<float>{9, 9, 0});
  parts.views = R"([{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12},
                    {"buffer": 0, "byteOffset": 60, "byteLength": 2}, {"buffer": 0, "byteOffset": 64, "byteLength": 12}])";
  EXPECT_EQ(bounds_of(import_parts(parts)).max, glm::vec3(9, 9, 0));
  parts.buffer[60] = 4;
  EXPECT_THAT(complaint_about_gltf(parts), HasSubstr("replaces element 4 of 4"));
}

struct Damage {
  std::string GltfParts::*part;
  const char* from;
  const char* to;
  const char* message;
};

TEST(GltfFileTest, DamagedReferences_AreToldAndNeverRead) {
  const std::vector<Damage> damages{
      {&GltfParts::accessors, R"("count": 4)", R"("count": 5)", "accessor 0 is out of range"},
      {&GltfParts::accessors, R"("count": 4)", R"("count": 4000000000)", "at most"},
      {&GltfParts::accessors, R"("count": 6)", R"("count": 7)", "accessor 1 is out of range"},
      {&GltfParts::accessors, R"("count": 4)", R"("byteOffset": 4, "count": 4)", "accessor 0 is out of range"},
      {&GltfParts::accessors, R"("count": 4)", R"("byteOffset": 400, "count": 4)", "out of range"},
      {&GltfParts::accessors, R"("bufferView": 0)", R"("bufferView": 7)", "no buffer view 7"},
      {&GltfParts::accessors, "5126", "5124", "component type 5124"},
      {&GltfParts::accessors, "5126", "5130", "component type 5130"},
      {&GltfParts::accessors, "5123", "5122", "unsigned"},
      {&GltfParts::accessors, "5123", "5126", "out of range"},
      {&GltfParts::accessors, R"("VEC3")", R"("VEC2")", "must have 3 component"},
      {&GltfParts::views, R"("byteLength": 48)", R"("byteLength": 480)", "runs past its buffer"},
      {&GltfParts::views, R"("byteOffset": 48)", R"("byteOffset": 4800)", "runs past its buffer"},
      {&GltfParts::views, R"({"buffer": 0, "byteLength": 48)", R"({"buffer": 3, "byteLength": 48)", "names buffer 3"},
      {&GltfParts::views, R"("byteLength": 48)", R"("byteLength": 48, "byteStride": 4)", "stride of 4"},
      {&GltfParts::views, R"("byteLength": 48)", R"("byteLength": 48, "byteStride": 16)", "out of range"},
      {&GltfParts::primitive, R"("POSITION": 0)", R"("POSITION": 9)", "no accessor 9"},
      {&GltfParts::primitive, R"("POSITION": 0)", R"("POSITION": -1)", "accessor -1"},
      {&GltfParts::primitive, R"("indices": 1)", R"("indices": 1, "material": 3)", "no material 3"},
      {&GltfParts::nodes, R"("mesh": 0)", R"("mesh": 5)", "no mesh 5"},
      {&GltfParts::scenes, "[0]", "[4]", "no node 4"},
      {&GltfParts::nodes, R"("mesh": 0)", R"("mesh": 0, "children": [8])", "no node 8"},
      {&GltfParts::nodes, R"("mesh": 0)", R"("mesh": 0, "matrix": [1, 0])", ""},
      {&GltfParts::nodes, R"("mesh": 0)", R"("mesh": 0, "rotation": [0, 1])", ""},
      {&GltfParts::nodes, R"("mesh": 0)", R"("mesh": 0, "rotation": [0, 0, 0, 0])", "rotation of node 0 is zero"},
      {&GltfParts::nodes, R"("mesh": 0)", R"("mesh": 0, "translation": [1e999, 0, 0])", "not valid glTF"},
      {&GltfParts::nodes, "[{", "[{{", "not valid glTF"},
      {&GltfParts::accessors, R"("bufferView": 0, "componentType": 5126, "count": 4)",
       R"("componentType": 5126, "count": 65537)", "65537"},
      {&GltfParts::buffer, "\2", "\4", "index 2 of 'quad' is 4, but there are 4 vertices"}};
  for (const Damage& damage : damages) {
    SCOPED_TRACE(damage.to);
    GltfParts parts;
    std::string& text = parts.*damage.part;
    const std::size_t at = text.find(damage.from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, std::string(damage.from).size(), damage.to);
    EXPECT_THAT(complaint_about_gltf(parts), HasSubstr(damage.message));
  }
}

TEST(GltfFileTest, CountsBeyondAllMemory_AreRefused) {
  for (const char* count : {"2147483648", "4294967295", "9223372036854775807", "9223372036854775808",
                            "18446744073709551615", "1e300", "-1"}) {
    GltfParts parts;
    parts.accessors.replace(parts.accessors.find("4,"), 1, count);
    EXPECT_FALSE(complaint_about_gltf(parts).empty()) << count;
    parts = {};
    parts.views.replace(parts.views.find(R"("byteLength": 48)"), 16,
                        fmt::format(R"("byteOffset": {0}, "byteLength": {0})", count));
    EXPECT_FALSE(complaint_about_gltf(parts).empty()) << count;
  }
  for (const char* stride : {"2147483648", "9223372036854775808", "18446744073709551615"}) {
    GltfParts parts;
    parts.views.insert(parts.views.find('}'), fmt::format(R"(, "byteStride": {})", stride));
    EXPECT_FALSE(complaint_about_gltf(parts).empty()) << stride;
  }
}

/// Writes a model whose buffer is elsewhere, and reads it.
MeshFile import_with(const TestFolder& folder, const std::string& uri) {
  GltfParts parts;
  parts.uri = uri;
  return import_gltf(folder.write("model/test.gltf", gltf_of(parts)));
}

TEST(GltfFileTest, ReferencesOutOfTheFolder_AreRefusedInEverySpelling) {
  const TestFolder folder;
  const std::string secret = folder.write("secret.bin", GltfParts().buffer).string();
  folder.write("model/data.bin", GltfParts().buffer);
  for (const std::string& uri :
       {secret, "file://" + secret, std::string("../secret.bin"), std::string("./.././secret.bin"),
        std::string("x/../../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("%2E%2E%2Fsecret.bin"),
        std::string("..%2fsecret.bin"), "/" + secret, std::string("../../../../../../../../etc/passwd"),
        std::string("/etc/passwd"), std::string("..\\u0000/secret.bin"), std::string("data.bin\\u0000../secret.bin")})
    EXPECT_THAT(error_of([&] { import_with(folder, uri); }), is_error(ErrorKind::kInput, "test.gltf")) << uri;
}

TEST(GltfFileTest, LinksOutOfTheFolder_AreRefused_OthersFollowed) {
  namespace fs = std::filesystem;
  const TestFolder folder;
  folder.write("secret.bin", GltfParts().buffer);
  folder.write("model/own.bin", GltfParts().buffer);
  fs::create_symlink("../secret.bin", folder.path() / "model" / "out.bin");
  fs::create_directory_symlink("..", folder.path() / "model" / "up");
  fs::create_symlink("own.bin", folder.path() / "model" / "in.bin");
  fs::create_directory_symlink("model", folder.path() / "alias");
  for (const char* uri : {"out.bin", "up/secret.bin"})
    EXPECT_THAT(error_of([&] { import_with(folder, uri); }).message(), HasSubstr("outside its folder")) << uri;
  EXPECT_EQ(import_with(folder, "in.bin").meshes.size(), 1U);
  EXPECT_EQ(import_gltf(folder.path() / "alias" / "test.gltf").meshes.size(), 1U);
}

TEST(GltfFileTest, NodesInACycle_AreAnError) {
  GltfParts parts;
  parts.nodes = R"([{"mesh": 0, "name": "a", "children": [1]}, {"name": "b", "children": [0]}])";
  EXPECT_THAT(complaint_about_gltf(parts), AllOf(HasSubstr("'a'"), HasSubstr("cycle")));
  parts.scenes = "[]";
  EXPECT_THAT(complaint_about_gltf(parts), HasSubstr("cycle"));
  parts.nodes = R"([{"children": [0]}])";
  parts.scenes = R"([{"nodes": [0]}])";
  EXPECT_THAT(complaint_about_gltf(parts), HasSubstr("cycle"));
}

TEST(GltfFileTest, ChainOfManyNodes_DoesNotExhaustTheStack) {
  GltfParts parts;
  std::string chain = "[";
  constexpr int kNodes = 50000;
  for (int i = 0; i < kNodes; ++i) chain += fmt::format(R"({{"children": [{}]}}, )", i + 1);
  parts.nodes = chain + R"({"mesh": 0}])";
  EXPECT_EQ(import_parts(parts).meshes.size(), 1U);
}

TEST(GltfFileTest, JsonNestedWithoutEnd_IsAnError) {
  GltfParts parts;
  parts.more = R"(, "extras": )" + std::string(100000, '[') + std::string(100000, ']');
  EXPECT_THAT(complaint_about_gltf(parts), HasSubstr("nested"));
}

TEST(GltfFileTest, NotFiniteVertex_IsNamedByTheMesh) {
  GltfParts parts;
  const float bad = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(parts.buffer.data() + 16, &bad, sizeof bad);
  const TestFolder folder;
  folder.write("data.bin", parts.buffer);
  MeshFile model = import_gltf(folder.write("test.gltf", gltf_of(parts)));
  Scene scene = add_mesh_file({}, std::move(model));
  EXPECT_THAT(error_of([&] { validate_geometry(scene, "test.gltf"); }),
              is_error(ErrorKind::kInput, "'quad'", "not finite"));
}

TEST(GltfFileTest, MissingOrShortBuffer_IsAnError) {
  GltfParts parts;
  parts.uri = "absent.bin";
  EXPECT_THAT(complaint_about_gltf(parts), HasSubstr("absent.bin"));
  const TestFolder folder;
  folder.write("data.bin", "short");
  EXPECT_THAT(error_of([&] { import_gltf(folder.write("test.gltf", gltf_of({}))); }),
              is_error(ErrorKind::kInput, "data.bin"));
}

TEST(GltfFileTest, RequiredExtensionThatIsNotRead_IsNamed) {
  GltfParts parts;
  parts.more = R"(, "extensionsUsed": ["KHR_texture_basisu"], "extensionsRequired": ["KHR_texture_basisu"])";
  EXPECT_THAT(complaint_about_gltf(parts), HasSubstr("KHR_texture_basisu"));
  parts.uri.clear();
  EXPECT_THAT(complaint_about_gltf(parts), HasSubstr("KHR_texture_basisu"));
}

TEST(GltfFileTest, ExtensionThatIsOnlyUsed_IsIgnoredWithAWarning) {
  GltfParts parts;
  parts.more = R"(, "extensionsUsed": ["EXT_texture_webp", "KHR_materials_sheen"])";
  EXPECT_THAT(import_parts(parts).warnings, ElementsAre(HasSubstr("EXT_texture_webp")));
}

TEST(GltfFileTest, OtherVersion_IsAnError) {
  const TestFolder folder;
  const std::string json = R"({"asset": {"version": "1.0"}, "scenes": [{"nodes": []}]})";
  EXPECT_THAT(error_of([&] { import_gltf(folder.write("test.gltf", json)); }).message(), HasSubstr("'1.0'"));
}

TEST(GltfFileTest, Cameras_StandWhereTheirNodesAre) {
  GltfParts parts;
  parts.more = R"(, "cameras": [{"type": "perspective", "name": "eye", "perspective": {"yfov": 0.5, "znear": 0.1}},
      {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 10}}])";
  parts.nodes =
      R"([{"mesh": 0}, {"camera": 0, "translation": [1, 2, 3], "rotation": [0, 0.70710678118654752, 0, 0.70710678118654752]},
                    {"camera": 1, "name": "plan"}])";
  parts.scenes = R"([{"nodes": [0, 1, 2]}])";
  const std::vector<Camera> cameras = import_parts(parts).cameras;
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0].name, "eye");
  EXPECT_EQ(cameras[0].position_ws, glm::vec3(1, 2, 3));
  EXPECT_NEAR(glm::distance(cameras[0].forward_ws, glm::vec3(-1, 0, 0)), 0.0f, 1e-6f);
  EXPECT_FLOAT_EQ(cameras[0].vertical_fov_rad, 0.5f);
  EXPECT_EQ(cameras[0].orthographic_height_m, 0.0f);
  EXPECT_EQ(cameras[1].name, "plan");
  EXPECT_FLOAT_EQ(cameras[1].orthographic_height_m, 4.0f);
}

constexpr const char* kDown = R"(, "rotation": [-0.70710678118654752, 0, 0, 0.70710678118654752])";

TEST(GltfFileTest, Lights_ShineFromTheirNodes_AlongMinusZ) {
  const MeshFile model =
      import_parts(lit_parts({{R"({"type": "area"})", ""},
                              {R"({"type": "directional", "color": [1, 0.5, 0.25], "intensity": 100000})", kDown},
                              {R"({"type": "point"})", R"(, "translation": [1, 5, 2])"},
                              {R"({"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}})",
                               std::string(R"(, "translation": [1, 5, 2])") + kDown}}));
  EXPECT_THAT(model.warnings, ElementsAre(HasSubstr("area lights are not modelled")));
  ASSERT_EQ(model.lights.size(), 3u) << "each is measured by itself";
  EXPECT_NEAR(glm::distance(to_light(model.lights[0], {}), glm::vec3(0, 1, 0)), 0.0f, 1e-6f);
  EXPECT_EQ(model.lights[0].color, glm::vec3(1.0f, 0.5f, 0.25f));
  EXPECT_FLOAT_EQ(model.lights[0].intensity, 1.0f);
  const auto point = std::get<PointLight>(aim_light(model.lights[1], {1.0f, 2.0f, 6.0f}).kind);
  EXPECT_EQ(point.position_ws, glm::vec3(1.0f, 5.0f, 2.0f));
  EXPECT_FLOAT_EQ(point.reference_m, 5.0f) << "as strong as a sun in the scene's middle";
  const auto spot = std::get<Spot>(aim_light(model.lights[2], {7.0f, 2.0f, 7.0f}).kind);
  EXPECT_NEAR(glm::distance(spot.position_ws, glm::vec3(1, 5, 2)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(spot.target_ws, glm::vec3(1, 2, 2)), 0.0f, 1e-5f) << "as far ahead as the scene's middle";
  EXPECT_NEAR(spot.cone_deg, glm::degrees(1.0f), 1e-4f);
  EXPECT_NEAR(spot.inner_cone_deg, glm::degrees(0.5f), 1e-4f);
}

TEST(GltfFileTest, Materials_KeepColourAndAlphaMode) {
  GltfParts parts;
  parts.more = R"(, "materials": [{"name": "leaf", "alphaMode": "MASK", "alphaCutoff": 0.25,
      "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4]}}, {"name": "glass", "alphaMode": "BLEND"}])";
  parts.primitive = R"({"attributes": {"POSITION": 0}, "indices": 1, "material": 0})";
  const MeshFile model = import_parts(parts);
  ASSERT_EQ(model.materials.size(), 2U);
  EXPECT_EQ(model.materials[0].base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(model.materials[0].alpha_mode, AlphaMode::kMask);
  EXPECT_FLOAT_EQ(model.materials[0].alpha_cutoff, 0.25f);
  EXPECT_EQ(model.materials[1].alpha_mode, AlphaMode::kBlend);
  EXPECT_THAT(model.warnings, ElementsAre(AllOf(HasSubstr("'glass'"), HasSubstr("opaque"))));
}

// A picture of floats, which alone could hold a NaN.
TEST(GltfFileTest, TextureOfFloats_IsNamed) {
  for (const std::string& bytes : {std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\0\0\0\0", 50),
                                   std::string("\x76\x2f\x31\x01\2\0\0\0", 8)}) {
    GltfParts parts = textured_parts(R"({"name": "pane", "uri": "data.bin"})");
    parts.buffer = bytes + parts.buffer;
    EXPECT_THAT(complaint_about_gltf(parts), AllOf(HasSubstr("image 'pane'"), HasSubstr("use PNG or JPEG")));
  }
}

/// Damages single bytes at random; a sanitizer build makes this a fuzz test.
TEST(GltfFileTest, FilesWithDamagedBytes_LoadOrAreRefused) {
  const TestFolder folder;
  const std::string sound = glb_of(textured_parts(R"({"bufferView": 3, "mimeType": "image/png"})"));
  std::mt19937 random(7);
  for (int round = 0; round < 500; ++round) {
    std::string damaged = sound;
    for (int i = 0; i < 1 + round % 3; ++i) damaged[random() % damaged.size()] = static_cast<char>(random());
    if (round % 10 == 0) damaged.resize(random() % damaged.size());
    import_or_refuse(folder, damaged);
  }
}

void expect_textured(const MeshFile& model) {
  ASSERT_EQ(model.textures.size(), 1U);
  EXPECT_EQ(model.textures[0].width, 2);
  EXPECT_EQ(model.textures[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 0, 255, 128}));
  EXPECT_EQ(model.materials[0].base_color_texture, 0);
  EXPECT_EQ(model.meshes[0].vertices[0].uv, glm::vec2(0, 1));
}

TEST(GltfTextureTest, TextureInAFile_IsDecoded) {
  const TestFolder folder;
  const GltfParts parts = textured_parts(R"({"uri": "a%20picture.tga"})");
  folder.write("data.bin", parts.buffer);
  folder.write("a picture.tga", tga_bytes());
  expect_textured(import_gltf(folder.write("test.gltf", gltf_of(parts))));
}

TEST(GltfTextureTest, TextureInABufferView_IsDecoded) {
  expect_textured(import_parts(textured_parts(R"({"bufferView": 3, "mimeType": "image/png"})")));
}

/// The texture coordinates of the textured quad's corners under a KHR_texture_transform.
std::vector<glm::vec2> transformed_uvs(const std::string& transform, const std::string& more_of_texture = "") {
  GltfParts parts = textured_parts(R"({"bufferView": 3, "mimeType": "image/png"})");
  const std::string texture =
      fmt::format(R"({{"index": 0{}, "extensions": {{"KHR_texture_transform": {}}}}})", more_of_texture, transform);
  parts.more.replace(parts.more.find(R"({"index": 0})"), 12, texture);
  parts.more += R"(, "extensionsUsed": ["KHR_texture_transform"], "extensionsRequired": ["KHR_texture_transform"])";
  parts.primitive = R"({"attributes": {"POSITION": 0, "TEXCOORD_0": 2, "TEXCOORD_1": 3}, "indices": 1, "material": 0})";
  parts.accessors.back() = ',';
  parts.accessors += R"({"bufferView": 4, "componentType": 5126, "count": 4, "type": "VEC2"}])";
  parts.views.back() = ',';
  parts.buffer.resize(120);
  parts.buffer += bytes_of(std::vector<float>{5, 5, 6, 5, 6, 6, 5, 6});
  parts.views += R"({"buffer": 0, "byteOffset": 120, "byteLength": 32}])";
  const MeshFile model = import_parts(parts);
  EXPECT_TRUE(model.warnings.empty());
  std::vector<glm::vec2> uvs;
  // Flat normals give every triangle vertices of its own: 0 1 2, then 0 2 3.
  for (const std::size_t vertex : {0U, 1U, 2U, 5U}) uvs.push_back(model.meshes.at(0).vertices.at(vertex).uv);
  return uvs;
}

void expect_near(const std::vector<glm::vec2>& uvs, const std::vector<glm::vec2>& wanted) {
  ASSERT_EQ(uvs.size(), wanted.size());
  for (std::size_t i = 0; i < uvs.size(); ++i)
    EXPECT_LT(glm::distance(uvs[i], wanted[i]), 1e-6f) << i << ": " << uvs[i].x << " " << uvs[i].y;
}

/// The quad's corners have (0,1), (1,1), (1,0) and (0,0).
TEST(GltfTextureTest, TextureTransform_ScalesThenTurnsThenMoves) {
  expect_near(transformed_uvs(R"({"offset": [0.25, 0.5]})"), {{0.25, 1.5}, {1.25, 1.5}, {1.25, 0.5}, {0.25, 0.5}});
  expect_near(transformed_uvs(R"({"scale": [2, 3]})"), {{0, 3}, {2, 3}, {2, 0}, {0, 0}});
  // A quarter turn, counter-clockwise where v runs down: +u becomes -v, and +v becomes +u.
  expect_near(transformed_uvs(R"({"rotation": 1.5707963267948966})"), {{1, 0}, {1, -1}, {0, -1}, {0, 0}});
  expect_near(transformed_uvs(R"({"rotation": 1.5707963267948966, "scale": [2, 3], "offset": [10, 20]})"),
              {{13, 20}, {13, 18}, {10, 18}, {10, 20}});
  // The specification's own example: the lower left quarter of the picture, turned clockwise.
  expect_near(transformed_uvs(R"({"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5]})"),
              {{0.5, 1}, {0.5, 0.5}, {0, 0.5}, {0, 1}});
}

TEST(GltfTextureTest, TextureTransform_MayNameOtherTextureCoordinates) {
  expect_near(transformed_uvs(R"({"texCoord": 1, "scale": [2, 2]})"), {{10, 10}, {12, 10}, {12, 12}, {10, 12}});
  expect_near(transformed_uvs(R"({"texCoord": 0})", R"(, "texCoord": 1)"), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  expect_near(transformed_uvs("{}", R"(, "texCoord": 1)"), {{5, 5}, {6, 5}, {6, 6}, {5, 6}});
}

TEST(GltfTextureTest, TextureTransformOfOtherThanNumbers_IsAnError) {
  for (const auto& [transform, complaint] :
       {std::pair(R"({"offset": [1]})", "the offset"), std::pair(R"({"scale": [1, "x"]})", "the scale"),
        std::pair(R"({"scale": 2})", "the scale"), std::pair(R"({"rotation": [1]})", "the rotation")})
    EXPECT_THAT(error_of([&, text = transform] { transformed_uvs(text); }), is_error(ErrorKind::kInput, complaint));
}

TEST(GltfTextureTest, UnreadableOrOutsideTexture_IsAnError) {
  EXPECT_THAT(complaint_about_gltf(textured_parts(R"({"uri": "data.bin"})")), HasSubstr("cannot be decoded"));
  EXPECT_THAT(complaint_about_gltf(textured_parts(R"({"uri": "../x.png"})")), HasSubstr("outside its folder"));
  GltfParts parts = textured_parts(R"({"bufferView": 3, "mimeType": "image/png"})");
  parts.views.replace(parts.views.find("\"byteLength\": 26"), 16, "\"byteLength\": 99");
  EXPECT_THAT(complaint_about_gltf(parts), HasSubstr("runs past its buffer"));
}

}  // namespace
}  // namespace shadowbench::scene
