#pragma once

#include <cstdint>
#include <cstring>

#include "harness/scene/files/mesh_file.h"
#include "harness/scene/scene.h"
#include "tests/test_files.h"

namespace shadowbench::scene {

/// The bytes of numbers, one after the other.
template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// A quad in the plane z = 0, facing +z: four positions (48 bytes), then the indices 0 1 2 0 2 3 (12 bytes).
inline const std::vector<float> kQuad{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
inline const std::vector<std::uint16_t> kQuadIndices{0, 1, 2, 0, 2, 3};

/// The parts of a small file that tests replace.
struct GltfParts {
  std::string nodes = R"([{"mesh": 0}])";
  std::string primitive = R"({"attributes": {"POSITION": 0}, "indices": 1})";
  std::string accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                              {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}])";
  std::string views = R"([{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}])";
  std::string buffer = bytes_of(kQuad) + bytes_of(kQuadIndices);
  std::string uri = "data.bin";
  std::string more;          ///< further members, each with a comma in front
  std::string more_buffers;  ///< further buffers, each with a comma in front
  std::string scenes = R"([{"nodes": [0]}])";
};

inline std::string gltf_of(const GltfParts& p) {
  const std::string uri = p.uri.empty() ? "" : fmt::format(R"(, "uri": "{}")", p.uri);
  return fmt::format(R"({{"asset": {{"version": "2.0"}}, "scenes": {}, "nodes": {},
    "meshes": [{{"name": "quad", "primitives": [{}]}}], "accessors": {}, "bufferViews": {},
    "buffers": [{{"byteLength": {}{}}}{}]{}}})",
                     p.scenes, p.nodes, p.primitive, p.accessors, p.views, p.buffer.size(), uri, p.more_buffers,
                     p.more);
}

inline MeshFile import_parts(const GltfParts& parts) {
  const TestFolder folder;
  folder.write("data.bin", parts.buffer);
  return import_gltf(folder.write("test.gltf", gltf_of(parts)));
}

inline std::string complaint_about_gltf(const GltfParts& parts) {
  const Error error = error_of([&] { import_parts(parts); });
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_THAT(error.where(), HasSubstr("test.gltf"));
  EXPECT_THAT(error.message(), Not(HasSubstr("\n")));
  return error.message();
}

inline std::string little_endian(std::size_t value) {
  return bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(value)});
}

inline std::string glb_of(GltfParts parts) {
  parts.uri.clear();
  std::string json = gltf_of(parts);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string binary = parts.buffer;
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const std::size_t size = 12 + 8 + json.size() + 8 + binary.size();
  return "glTF" + little_endian(2) + little_endian(size) + little_endian(json.size()) + "JSON" + json +
         little_endian(binary.size()) + std::string("BIN\0", 4) + binary;
}

/// A 2 x 1 picture: red, then half transparent blue; 32-bit TGA, rows from the top.
inline std::string tga_bytes() {
  std::string tga("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\40\50", 18);
  return tga + std::string("\x00\x00\xff\xff\xff\x00\x00\x80", 8);
}

/// The quad, and nodes with lights, each as its JSON and the rest of its node's.
inline GltfParts lit_parts(const std::vector<std::pair<std::string, std::string>>& lights) {
  GltfParts parts;
  std::string all, nodes = R"({"mesh": 0})", indices = "0";
  for (const auto& [light, more_of_node] : lights) {
    nodes += fmt::format(R"(, {{"extensions": {{"KHR_lights_punctual": {{"light": {}}}}}{}}})",
                         std::count(indices.begin(), indices.end(), ','), more_of_node);
    all += (all.empty() ? "" : ", ") + light;
    indices += fmt::format(", {}", std::count(indices.begin(), indices.end(), ',') + 1);
  }
  parts.more = fmt::format(
      R"(, "extensionsUsed": ["KHR_lights_punctual"], "extensions": {{"KHR_lights_punctual": {{"lights": [{}]}}}})",
      all);
  parts.nodes = "[" + nodes + "]";
  parts.scenes = R"([{"nodes": [)" + indices + "]}]";
  return parts;
}

inline GltfParts textured_parts(const std::string& image) {
  GltfParts parts;
  parts.more = fmt::format(R"(, "images": [{}], "textures": [{{"source": 0}}], "materials": [{{"pbrMetallicRoughness":
      {{"baseColorTexture": {{"index": 0}}}}}}])",
                           image);
  parts.primitive = R"({"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0})";
  parts.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                        {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
                        {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"}])";
  parts.buffer += bytes_of(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}) + tga_bytes();
  parts.views = R"([{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12},
      {"buffer": 0, "byteOffset": 60, "byteLength": 32}, {"buffer": 0, "byteOffset": 92, "byteLength": 26}])";
  return parts;
}

/// Imports a .glb, which is refused or is a valid model.
inline void import_or_refuse(const TestFolder& folder, const std::string& glb) {
  const auto file = folder.write("test.glb", glb);
  const Error error = error_of([&] { validate_geometry(add_mesh_file({}, import_gltf(file)), file.string()); });
  if (error.message() != "no error") ASSERT_EQ(error.kind(), ErrorKind::kInput) << error.what();
}

}  // namespace shadowbench::scene
