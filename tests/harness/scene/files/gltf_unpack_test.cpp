#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include "harness/scene/files/gltf.h"
#include "harness/scene/load.h"
#include "tests/harness/scene/gltf_parts.h"

namespace shadowbench::scene {
namespace {

constexpr int kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT;

/// A wave over [-1,1] x [-1,1] as separate lists of numbers.
struct Wave {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> uvs;
  std::vector<std::uint32_t> indices;
  std::size_t vertex_count = 0;
};

Wave make_wave(std::uint32_t cells) {
  Wave wave;
  for (std::uint32_t j = 0; j <= cells; ++j) {
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const glm::vec2 uv = glm::vec2(i, j) / static_cast<float>(cells);
      const float x = 2.0f * uv.x - 1.0f;
      const glm::vec3 normal = glm::normalize(glm::vec3(-0.9f * std::cos(3.0f * x), 0.0f, 1.0f));
      wave.positions.insert(wave.positions.end(), {x, 2.0f * uv.y - 1.0f, 0.3f * std::sin(3.0f * x)});
      wave.normals.insert(wave.normals.end(), {normal.x, normal.y, normal.z});
      wave.uvs.insert(wave.uvs.end(), {uv.x, uv.y});
      const std::uint32_t at = j * (cells + 1) + i;
      if (i < cells && j < cells)
        wave.indices.insert(wave.indices.end(), {at, at + 1, at + cells + 2, at, at + cells + 2, at + cells + 1});
    }
  }
  wave.vertex_count = wave.positions.size() / 3;
  return wave;
}

/// A file that is put together view by view; every view has one accessor.
struct PackedParts {
  GltfParts parts;

  PackedParts() {
    parts.buffer.clear();
    parts.views = parts.accessors = "[]";
    parts.primitive = R"({"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0})";
    parts.more = R"(, "materials": [{"pbrMetallicRoughness": {}}])";
  }

  void add_to_list(std::string& list, const std::string& element) const {
    list.pop_back();
    list += (list.size() > 1 ? ", " : "") + element + "]";
  }

  void add_accessor(int component_type, std::size_t count, int components, const std::string& more = "") {
    const std::string type = components == 1 ? "SCALAR" : fmt::format("VEC{}", components);
    add_to_list(parts.accessors, fmt::format(R"({{"componentType": {}, "count": {}, "type": "{}"{}}})", component_type,
                                             count, type, more));
  }

  std::size_t append(const std::string& bytes) {
    parts.buffer.resize((parts.buffer.size() + 3) / 4 * 4);
    parts.buffer += bytes;
    return parts.buffer.size() - bytes.size();
  }

  template <class T>
  void add_plain(const std::vector<T>& values, int component_type, int components) {
    const std::string bytes = bytes_of(values);
    const std::size_t at = append(bytes);
    const auto view = std::count(parts.views.begin(), parts.views.end(), '{');
    add_to_list(parts.views, fmt::format(R"({{"buffer": 0, "byteOffset": {}, "byteLength": {}}})", at, bytes.size()));
    add_accessor(component_type, values.size() / static_cast<std::size_t>(components), components,
                 fmt::format(R"(, "bufferView": {})", view));
  }
};

GltfParts plain_parts(const Wave& wave) {
  PackedParts file;
  file.add_plain(wave.positions, kFloat, 3);
  file.add_plain(wave.normals, kFloat, 3);
  file.add_plain(wave.uvs, kFloat, 2);
  file.add_plain(wave.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 1);
  return file.parts;
}

/// One compressed view.
struct MeshoptView {
  std::string packed;
  std::size_t count;
  std::size_t stride;
  std::string mode;  ///< and filter, as JSON
  bool states_stride = true;
};

constexpr const char* kUsesMeshopt =
    R"(, "extensionsUsed": ["EXT_meshopt_compression"], "extensionsRequired": ["EXT_meshopt_compression"])";

void add_meshopt(PackedParts& file, const MeshoptView& view) {
  const std::size_t at = file.append(view.packed);
  const std::string stride = view.states_stride ? fmt::format(R"(, "byteStride": {})", view.stride) : "";
  file.add_to_list(
      file.parts.views,
      fmt::format(R"({{"buffer": 1, "byteLength": {}{}, "extensions": {{"EXT_meshopt_compression": {{"buffer": 0,
      "byteOffset": {}, "byteLength": {}, "byteStride": {}, "count": {}, {}}}}}}})",
                  view.count * view.stride, stride, at, view.packed.size(), view.stride, view.count, view.mode));
}

MeshoptView pack_attributes(const void* values, std::size_t count, std::size_t stride, const std::string& filter) {
  std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(packed.data());
  packed.resize(meshopt_encodeVertexBuffer(bytes, packed.size(), values, count, stride));
  return {packed, count, stride, fmt::format(R"("mode": "ATTRIBUTES", "filter": "{}")", filter)};
}

MeshoptView pack_indices(const Wave& wave, const std::string& mode, std::size_t stride) {
  const std::size_t count = wave.indices.size();
  std::string packed(meshopt_encodeIndexBufferBound(count, wave.vertex_count) +
                         meshopt_encodeIndexSequenceBound(count, wave.vertex_count),
                     '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(packed.data());
  packed.resize(mode == "TRIANGLES" ? meshopt_encodeIndexBuffer(bytes, packed.size(), wave.indices.data(), count)
                                    : meshopt_encodeIndexSequence(bytes, packed.size(), wave.indices.data(), count));
  return {packed, count, stride, fmt::format(R"("mode": "{}")", mode), false};
}

/// Positions as they are, normals on an octahedron of 8 bits, texture coordinates with 15 bits after the point.
GltfParts meshopt_parts(const Wave& wave, const std::string& index_mode = "TRIANGLES", std::size_t index_size = 2) {
  PackedParts file;
  file.parts.more += kUsesMeshopt;
  file.parts.more_buffers =
      R"(, {"byteLength": 999999, "extensions": {"EXT_meshopt_compression": {"fallback": true}}})";
  std::vector<float> normals;
  for (std::size_t i = 0; i < wave.vertex_count; ++i)
    normals.insert(normals.end(), {wave.normals[3 * i], wave.normals[3 * i + 1], wave.normals[3 * i + 2], 0.0f});
  std::vector<std::int8_t> octahedral(4 * wave.vertex_count);
  meshopt_encodeFilterOct(octahedral.data(), wave.vertex_count, 4, 8, normals.data());
  std::vector<std::uint32_t> exponential(2 * wave.vertex_count);
#if MESHOPTIMIZER_VERSION < 190
  meshopt_encodeFilterExp(exponential.data(), wave.vertex_count, 8, 15, wave.uvs.data());
#else
  meshopt_encodeFilterExp(exponential.data(), wave.vertex_count, 8, 15, wave.uvs.data(), meshopt_EncodeExpSharedVector);
#endif
  add_meshopt(file, pack_attributes(wave.positions.data(), wave.vertex_count, 12, "NONE"));
  add_meshopt(file, pack_attributes(octahedral.data(), wave.vertex_count, 4, "OCTAHEDRAL"));
  add_meshopt(file, pack_attributes(exponential.data(), wave.vertex_count, 8, "EXPONENTIAL"));
  add_meshopt(file, pack_indices(wave, index_mode, index_size));
  file.add_accessor(kFloat, wave.vertex_count, 3, R"(, "bufferView": 0)");
  file.add_accessor(TINYGLTF_COMPONENT_TYPE_BYTE, wave.vertex_count, 3, R"(, "bufferView": 1, "normalized": true)");
  file.add_accessor(kFloat, wave.vertex_count, 2, R"(, "bufferView": 2)");
  file.add_accessor(index_size == 2 ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                    wave.indices.size(), 1, R"(, "bufferView": 3)");
  return file.parts;
}

/// How far decoded vertices may lie from what was encoded.
struct Steps {
  float position;
  float normal;
  float uv;
};

const Vertex& corner_of(const Mesh& mesh, std::size_t triangle, std::size_t corner) {
  return mesh.vertices[mesh.indices[3 * triangle + corner]];
}

/// The farthest of a triangle's corners from those of another that is turned by `turn` corners.
float distance_between(const Mesh& a, std::size_t in_a, const Mesh& b, std::size_t in_b, std::size_t turn) {
  float farthest = 0.0f;
  for (std::size_t c = 0; c < 3; ++c)
    farthest = std::max(
        farthest, glm::distance(corner_of(a, in_a, c).position_ws, corner_of(b, in_b, (c + turn) % 3).position_ws));
  return farthest;
}

/// Every triangle is there once, wound as it was, though triangles and their first corners may be in another order.
void expect_same_triangles(const Mesh& expected, const Mesh& mesh, const Steps& steps) {
  ASSERT_EQ(mesh.indices.size(), expected.indices.size());
  std::vector<bool> found(mesh.indices.size() / 3, false);
  for (std::size_t t = 0; t < found.size(); ++t) {
    std::size_t nearest = 0;
    std::size_t turn = 0;
    for (std::size_t k = 0; k < 3 * found.size(); ++k) {
      if (distance_between(expected, t, mesh, k / 3, k % 3) < distance_between(expected, t, mesh, nearest, turn)) {
        nearest = k / 3;
        turn = k % 3;
      }
    }
    ASSERT_FALSE(found[nearest]) << t;
    found[nearest] = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vertex& wanted = corner_of(expected, t, c);
      const Vertex& vertex = corner_of(mesh, nearest, (c + turn) % 3);
      ASSERT_LE(glm::distance(wanted.position_ws, vertex.position_ws), steps.position) << t;
      ASSERT_LE(glm::distance(wanted.normal_ws, vertex.normal_ws), steps.normal) << t;
      ASSERT_LE(glm::distance(wanted.uv, vertex.uv), steps.uv) << t;
    }
  }
}

Mesh only_mesh(const MeshFile& model) {
  EXPECT_EQ(model.meshes.size(), 1U);
  EXPECT_THAT(model.warnings, IsEmpty());
  return model.meshes.at(0);
}

void replace_in(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

constexpr Steps kMeshoptSteps{0.0f, 1.5f / 127.0f, 1.0f / 16384.0f};

TEST(GltfUnpackTest, MeshoptModesAndFilters_GiveTheMeshThatWasPacked) {
  const Wave wave = make_wave(8);
  const Mesh expected = only_mesh(import_parts(plain_parts(wave)));
  for (const std::string mode : {"TRIANGLES", "INDICES"}) {
    for (const std::size_t size : {2U, 4U}) {
      SCOPED_TRACE(fmt::format("{} of {} bytes", mode, size));
      expect_same_triangles(expected, only_mesh(import_parts(meshopt_parts(wave, mode, size))), kMeshoptSteps);
    }
  }
}

TEST(GltfUnpackTest, MeshoptQuaternions_AreUnitAndTheirOwn) {
  const std::vector<float> quaternions{0.1f, 0.2f, 0.3f, 0.9273618f, -0.5f, 0.1f, 0.2f, 0.8366600f,
                                       0.0f, 0.0f, 0.0f, 1.0f,       0.4f,  0.4f, 0.4f, 0.7211103f};
  std::vector<std::int16_t> filtered(16);
  meshopt_encodeFilterQuat(filtered.data(), 4, 8, 16, quaternions.data());
  PackedParts file;
  add_meshopt(file, pack_attributes(filtered.data(), 4, 8, "QUATERNION"));
  file.add_accessor(TINYGLTF_COMPONENT_TYPE_SHORT, 3, 3, R"(, "bufferView": 0, "normalized": true)");
  file.parts.primitive = R"({"attributes": {"POSITION": 0}})";
  file.parts.more_buffers = R"(, {"byteLength": 32})";
  file.parts.more = kUsesMeshopt;
  const Mesh mesh = only_mesh(import_parts(file.parts));
  ASSERT_EQ(mesh.vertices.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 wanted(quaternions[4 * i], quaternions[4 * i + 1], quaternions[4 * i + 2]);
    EXPECT_LT(glm::distance(mesh.vertices[i].position_ws, wanted), 2e-4f) << i;
  }
}

TEST(GltfUnpackTest, FallbackBuffers_NeedNoBytes) {
  const Wave wave = make_wave(3);
  const Mesh expected = only_mesh(import_parts(plain_parts(wave)));
  for (
      const std::string fallback :
      {R"(, {"byteLength": 99999})",
       R"(, {"byteLength": 99999, "extensions": {"EXT_meshopt_compression": {"fallback": true}}})",
       R"(, {"byteLength": 99999, "uri": "absent.bin", "extensions": {"EXT_meshopt_compression": {"fallback": true}}})"}) {
    SCOPED_TRACE(fallback);
    GltfParts parts = meshopt_parts(wave);
    parts.more_buffers = fallback;
    expect_same_triangles(expected, only_mesh(import_parts(parts)), kMeshoptSteps);
    const TestFolder folder;
    const MeshFile model = import_gltf(folder.write("test.glb", glb_of(parts)));
    expect_same_triangles(expected, only_mesh(model), kMeshoptSteps);
  }
}

TEST(GltfUnpackTest, MeshoptThatContradictsItself_IsRefusedByName) {
  struct ViewDamage {
    const char* from;
    const char* to;
    const char* message;
  };
  const std::vector<ViewDamage> damages{
      {R"("count": 25)", R"("count": 2147483647)", "claim more than 2147483648 bytes"},
      {R"("count": 25)", R"("count": 100000)", "buffer view 0 claims 100000 elements of 12 bytes, which"},
      {R"("count": 25)", R"("count": -1)", "no whole number 'count'"},
      {R"("count": 25)", R"("counts": 25)", "no whole number 'count'"},
      {R"("count": 96)", R"("count": 97)", "of which there are no 97 elements of 2 bytes"},
      {R"("count": 96)", R"("count": 99)", "the meshopt data of buffer view 3 are damaged"},
      {R"("byteStride": 12, "count")", R"("byteStride": 10, "count")", "no 25 elements of 10 bytes"},
      {R"("byteStride": 12, "count")", R"("byteStride": 260, "count")", "no 25 elements of 260 bytes"},
      {R"("byteStride": 12, "count")", R"("byteStride": 16, "count")", "has a stride of 12 bytes"},
      {R"("byteStride": 4, "count")", R"("byteStride": 12, "count")", "filter 'OCTAHEDRAL'"},
      {R"("OCTAHEDRAL")", R"("QUATERNION")", "filter 'QUATERNION'"},
      {R"("OCTAHEDRAL")", R"("SPIRAL")", "filter 'SPIRAL'"},
      {R"("mode": "TRIANGLES")", R"("mode": "TRIANGLES", "filter": "EXPONENTIAL")", "mode 'TRIANGLES'"},
      {R"("mode": "TRIANGLES")", R"("mode": "POINTS")", "mode 'POINTS'"},
      {R"("mode": "TRIANGLES")", R"("mode": 1)", "mode ''"},
      {R"("mode": "TRIANGLES")", R"("mode": "INDICES")", "damaged"},
      {R"("mode": "ATTRIBUTES")", R"("mode": "TRIANGLES")", "mode 'TRIANGLES'"},
      {R"("buffer": 0)", R"("buffer": 7)", "buffer view 0 names buffer 7"},
      {R"("buffer": 0)", R"("buffer": 1)", "runs past its buffer"},
      {R"("byteOffset": 0)", R"("byteOffset": 2000000)", "the meshopt data of buffer view 0 runs past its buffer"},
      {R"({"EXT_meshopt_compression": {)", R"({"EXT_meshopt_compression": 5, "other": {)",
       "buffer view 0 runs past its buffer"}};
  for (const ViewDamage& damage : damages) {
    SCOPED_TRACE(damage.to);
    GltfParts parts = meshopt_parts(make_wave(4));
    replace_in(parts.views, damage.from, damage.to);
    EXPECT_THAT(complaint_about_gltf(parts), HasSubstr(damage.message));
  }
}

/// Flips, replaces and cuts bytes; a sanitizer build makes this a fuzz test.
TEST(GltfUnpackTest, DamagedBytes_LoadOrAreRefused) {
  const Wave wave = make_wave(4);
  const TestFolder folder;
  const std::vector<std::string> sound{glb_of(meshopt_parts(wave)), glb_of(meshopt_parts(wave, "INDICES", 4))};
  std::mt19937 random(11);
  for (std::size_t round = 0; round < 800; ++round) {
    std::string damaged = sound[round % sound.size()];
    const std::size_t packed_at = damaged.find(std::string("BIN\0", 4)) + 4;
    for (std::size_t i = 0; i < 1 + round % 3; ++i)
      damaged[packed_at + random() % (damaged.size() - packed_at)] = static_cast<char>(random());
    import_or_refuse(folder, damaged);
  }
}

TEST(GltfUnpackTest, Draco_IsRefusedInOneSentence) {
  const std::string file = std::string(SHADOWBENCH_SOURCE_DIR) + "/tests/fuzz/corpus/gltf/draco.glb";
  EXPECT_THAT(error_of([&] { import_gltf(file); }).message(),
              HasSubstr("requires the extension KHR_draco_mesh_compression, which is not supported; save it without"));
}

const std::string kOwnScenes = std::string(SHADOWBENCH_SOURCE_DIR) + "/data/scenes";

Scene write_and_read(const Scene& scene) {
  const TestFolder folder;
  return load(folder.write("scene.glb", write_glb(scene, 16.0 / 9.0)).string(), {kOwnScenes});
}

/// Every light of every scene that comes with the program, by itself.
std::vector<Scene> list_lit_scenes() {
  std::vector<Scene> all;
  for (const auto& scenes : {list_scenes(kOwnScenes), list_teaching_scenes(kOwnScenes)})
    for (const SceneInfo& info : scenes)
      for (Scene& lit : separate_lights(load(info.name, {kOwnScenes}))) all.push_back(std::move(lit));
  return all;
}

TEST(GltfWriter, ASceneIsReadAsItWasWritten) {
  for (const Scene& scene : list_lit_scenes()) {
    const Scene read = write_and_read(scene);
    SCOPED_TRACE(scene.name);
    EXPECT_EQ(read.title, scene.title);
    EXPECT_EQ(read.background, scene.background);
    EXPECT_THAT(read.warnings, Each(HasSubstr("blends; cameras see it opaque")));
    ASSERT_EQ(read.meshes.size(), scene.meshes.size());
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
      const Mesh &mesh = read.meshes[m], &was = scene.meshes[m];
      EXPECT_EQ(mesh.casts_shadow, was.casts_shadow);
      EXPECT_EQ(mesh.may_cull_front, was.may_cull_front);
      EXPECT_EQ(mesh.indices, was.indices);
      EXPECT_EQ(read.materials[static_cast<std::size_t>(mesh.material)].base_color,
                scene.materials[static_cast<std::size_t>(was.material)].base_color);
      ASSERT_EQ(mesh.vertices.size(), was.vertices.size());
      for (std::size_t v = 0; v < was.vertices.size(); ++v) {
        EXPECT_EQ(mesh.vertices[v].position_ws, was.vertices[v].position_ws);
        EXPECT_NEAR(glm::distance(mesh.vertices[v].normal_ws, was.vertices[v].normal_ws), 0.0f, 1e-6f);
      }
    }
    ASSERT_EQ(read.cameras.size(), scene.cameras.size());
    for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
      EXPECT_EQ(read.cameras[c].position_ws, scene.cameras[c].position_ws);
      EXPECT_NEAR(glm::distance(read.cameras[c].forward_ws, scene.cameras[c].forward_ws), 0.0f, 1e-7f);
      EXPECT_EQ(read.cameras[c].vertical_fov_rad, scene.cameras[c].vertical_fov_rad);
      EXPECT_EQ(read.cameras[c].orthographic_height_m, scene.cameras[c].orthographic_height_m);
    }
    Light back = read.light;
    if (auto* sun = std::get_if<Sun>(&back.kind)) sun->direction_ws += 0.0f;  // makes 0 of -0
    EXPECT_EQ(list_light_content(back).front(), list_light_content(scene.light).front());
  }
}

TEST(GltfWriter, TexturesAndHolesStay) {
  Scene scene = load("cubes", {kOwnScenes});
  scene.textures.push_back({"checker", 2, 1, {255, 0, 0, 255, 0, 255, 0, 7}});
  scene.materials[0].base_color_texture = 0;
  scene.materials[0].alpha_mode = AlphaMode::kMask;
  scene.materials[0].alpha_cutoff = 0.25f;
  const Scene read = write_and_read(scene);
  ASSERT_EQ(read.textures.size(), 1u);
  EXPECT_EQ(read.textures[0].rgba, scene.textures[0].rgba);
  EXPECT_EQ(read.materials[0].alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(read.materials[0].alpha_cutoff, 0.25f);
  EXPECT_EQ(read.materials[0].base_color_texture, 0);
}

TEST(GltfWriter, NamesInOtherEncodings_AreReplaced) {
  Scene scene = load("cubes", {kOwnScenes});
  scene.name = scene.title = scene.materials[0].name = scene.meshes[0].name = scene.light.name = "Gr\xfcn";
  const Scene read = write_and_read(scene);
  for (const std::string& name : {read.title, read.materials[0].name, read.meshes[0].name, read.light.name})
    EXPECT_EQ(name, "Gr\ufffdn");
}

TEST(GltfWriter, WhatBlends_Stays) {
  Scene scene = load("panes", {kOwnScenes});
  const Scene read = write_and_read(scene);
  EXPECT_EQ(read.materials[1].alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(read.materials[1].base_color.a, 0.3f);
  EXPECT_EQ(read.materials[0].alpha_mode, AlphaMode::kOpaque);
}

TEST(GltfWriter, ExtrasThatASceneFileDoesNotTake_AreRefused) {
  const TestFolder folder;
  std::string text = write_glb(load("cubes", {kOwnScenes}), 1.5);
  const std::string key = "angular_diameter_deg";
  ASSERT_NE(text.find(key), std::string::npos);
  text.replace(text.find(key), key.size(), "angular_diameter_rad");
  EXPECT_THAT(error_of([&] { load(folder.write("scene.glb", text).string(), {kOwnScenes}); }).what(),
              HasSubstr("angular_diameter_rad"));
}

}  // namespace
}  // namespace shadowbench::scene
