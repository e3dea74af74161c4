#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scene/files/mesh_file.h"
#include "tests/harness/scene/test_files.h"

namespace shadowbench::scene {
namespace {

using testing::HasSubstr;

constexpr const char* kObjQuad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

MeshFile import_text(const std::string& text) {
  const TestFolder folder;
  return import_obj(folder.write("test.obj", text));
}

TEST(ObjFileTest, Polygon_BecomesTrianglesWithNormals) {
  const MeshFile model = import_text(std::string(kObjQuad) + "f 1 2 3 4\n");
  ASSERT_EQ(model.meshes.size(), 1U);
  EXPECT_EQ(model.meshes[0].indices.size(), 6U);
  EXPECT_EQ(model.meshes[0].name, "test");
  for (const Vertex& v : model.meshes[0].vertices) EXPECT_EQ(v.normal_ws, glm::vec3(0, 0, 1));
}

TEST(ObjFileTest, RelativeIndices_CountFromTheEnd) {
  EXPECT_EQ(import_text(std::string(kObjQuad) + "f -4 -3 -2\n").meshes[0].vertices[0].position_ws, glm::vec3(0, 0, 0));
}

TEST(ObjFileTest, TextureCoordinates_RunFromTheTop) {
  const MeshFile model = import_text(std::string(kObjQuad) + "vt 0 0\nvt 0.25 1\nvt 1 1\nf 1/1 2/2 3/3\n");
  EXPECT_EQ(model.meshes[0].vertices[0].uv, glm::vec2(0, 1));
  EXPECT_EQ(model.meshes[0].vertices[1].uv, glm::vec2(0.25f, 0));
}

TEST(ObjFileTest, Materials_GiveTheirColours) {
  const TestFolder folder;
  folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  const auto file = folder.write("test.obj", std::string("mtllib m.mtl\n") + kObjQuad +
                                                 "usemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\nusemtl none\nf 1 2 4\n");
  const MeshFile model = import_obj(file);
  std::vector<glm::vec4> colours;
  for (const Mesh& mesh : model.meshes)
    colours.push_back(model.materials[static_cast<std::size_t>(mesh.material)].base_color);
  EXPECT_EQ(colours.size(), 3U);
  EXPECT_THAT(colours, testing::Contains(glm::vec4(1, 0, 0, 1)));
  EXPECT_THAT(colours, testing::Contains(glm::vec4(0, 0, 1, 1)));
}

TEST(ObjFileTest, MissingMaterialLibrary_IsAWarning) {
  const MeshFile model = import_text(std::string("mtllib absent.mtl\n") + kObjQuad + "f 1 2 3\n");
  EXPECT_THAT(model.warnings, testing::Contains(HasSubstr("absent.mtl")));
}

/// A scene may be named without a folder, and what it names be missing.
TEST(ObjFileTest, ReferencesOfAFileWithoutAFolder_AreInside) {
  EXPECT_EQ(resolve_inside("", "absent.mtl"), std::filesystem::path("absent.mtl"));
  EXPECT_EQ(resolve_inside("", "tex/absent.png"), std::filesystem::path("tex/absent.png"));
  EXPECT_EQ(resolve_inside("", "../absent.mtl"), std::nullopt);
}

TEST(ObjFileTest, LibraryOrTextureOutsideTheFolder_IsRefused) {
  const Error library = error_of([] { import_text("mtllib ../../etc/passwd\nv 0 0 0\n"); });
  EXPECT_THAT(library.message(), HasSubstr("outside its folder"));
  const TestFolder folder;
  folder.write("m.mtl", "newmtl red\nmap_Kd ../secret.png\n");
  const auto file = folder.write("test.obj", std::string("mtllib m.mtl\n") + kObjQuad + "usemtl red\nf 1 2 3\n");
  EXPECT_THAT(error_of([&] { import_obj(file); }).message(), HasSubstr("outside its folder"));
}

TEST(ObjFileTest, CoordinateThatIsNoFiniteNumber_NamesItsLine) {
  for (const std::string bad : {"nan", "inf", "-inf", "abc", "1e999", "1.0x"}) {
    const Error error = error_of([&] { import_text("v 0 0 0\nv 1 " + bad + " 0\nv 1 1 0\nf 1 2 3\n"); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_THAT(error.message(), HasSubstr("'" + bad + "'"));
    EXPECT_THAT(error.where(), testing::EndsWith("test.obj:2"));
  }
  EXPECT_THAT(error_of([] { import_text("v 0 0\n"); }).message(), HasSubstr("at least 3 numbers"));
}

TEST(ObjFileTest, IndexThatIsNone_NamesItsLine) {
  for (const std::string bad : {"999999999999999999999", "2147483648", "-2147483649", "2x", "1.5"}) {
    for (const std::string& corner : {bad, "1/" + bad, "1//" + bad}) {
      const Error error = error_of([&] { import_text(kObjQuad + ("f 1 2 " + corner + "\n")); });
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_THAT(error.message(), HasSubstr("'" + bad + "' is not an index"));
      EXPECT_THAT(error.where(), testing::EndsWith("test.obj:5"));
    }
  }
}

TEST(ObjFileTest, LinesOfOldMacintosh_AreRead) {
  EXPECT_EQ(import_text("# made long ago\rv 0 0 0\rv 1 0 0\rv 1 1 0\rf 1 2 3\r").meshes.at(0).indices.size(), 3U);
  EXPECT_THAT(error_of([] { import_text("# comment\rv 0 0 0\rv 1 nan 0\rf 1 2 3\r"); }).where(),
              testing::EndsWith("test.obj:3"));
}

TEST(ObjFileTest, NumbersInEverySpelling_Read) {
  const MeshFile model = import_text("v +1 -.5 1e-1 # corner\r\nv 1 0 0\r\nv 1 1 0 1.0\r\nf 1 2 3\r\n");
  EXPECT_EQ(model.meshes[0].vertices[0].position_ws, glm::vec3(1.0f, -0.5f, 0.1f));
}

TEST(ObjFileTest, IndexOutOfRange_IsAnError) {
  EXPECT_THAT(error_of([] { import_text(std::string(kObjQuad) + "f 1 2 5\n"); }).message(), HasSubstr("vertex 5"));
  EXPECT_THAT(error_of([] { import_text(std::string(kObjQuad) + "vn 0 0 1\nf 1//1 2//1 3//2\n"); }).message(),
              HasSubstr("normal 2"));
  EXPECT_THAT(error_of([] { import_text(std::string(kObjQuad) + "vt 0 0\nf 1/1 2/1 3/2\n"); }).message(),
              HasSubstr("texture coordinate 2"));
  error_of([] { import_text(std::string(kObjQuad) + "f 1 2 0\n"); });
  error_of([] { import_text(std::string(kObjQuad) + "f 1 2 -9\n"); });
}

}  // namespace
}  // namespace shadowbench::scene
