#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scene/files/mesh_file.h"
#include "tests/harness/scene/gltf_parts.h"

namespace shadowbench::scene {
namespace {

using testing::HasSubstr;

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
        std::pair(R"({"scale": 2})", "the scale"), std::pair(R"({"rotation": [1]})", "the rotation")}) {
    const Error error = error_of([&, text = transform] { transformed_uvs(text); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_THAT(error.message(), HasSubstr(complaint));
  }
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
