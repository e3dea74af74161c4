// Models from elsewhere that claim too much, or point outside their folder.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scene/files/mesh_file.h"
#include "test_files.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

const std::string kPositions = bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});

/// A triangle whose parts tests replace.
struct Parts {
  std::string uri = "data.bin";
  std::string accessor = R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"})";
  std::string view = R"({"buffer": 0, "byteLength": 36})";
  std::string primitives = R"({"attributes": {"POSITION": 0}})";
  std::string nodes = R"({"mesh": 0})";
};

std::string json_of(const Parts& p) {
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{}], "meshes": [{{"primitives": [{}]}}],
    "accessors": [{}], "bufferViews": [{}], "buffers": [{{"byteLength": 36, "uri": "{}"}}]}})",
      p.nodes, p.primitives, p.accessor, p.view, p.uri);
}

MeshFile import_parts(const TestFolder& folder, const Parts& parts) {
  folder.write("model/data.bin", kPositions);
  return import_gltf(folder.write("model/test.gltf", json_of(parts)));
}

std::string complaint_about(const Parts& parts) {
  const TestFolder folder;
  const Error error = error_of([&] { import_parts(folder, parts); });
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  return error.message();
}

TEST(HostileModel, CountsBeyondAllMemory_AreRefused) {
  for (const char* count : {"2147483648", "4294967295", "9223372036854775807", "9223372036854775808",
                            "18446744073709551615", "1e300", "-1"}) {
    Parts parts;
    parts.accessor = fmt::format(R"({{"bufferView": 0, "componentType": 5126, "count": {}, "type": "VEC3"}})", count);
    EXPECT_FALSE(complaint_about(parts).empty()) << count;
    parts = {};
    parts.view = fmt::format(R"({{"buffer": 0, "byteOffset": {0}, "byteLength": {0}}})", count);
    EXPECT_FALSE(complaint_about(parts).empty()) << count;
  }
  for (const char* stride : {"2147483648", "9223372036854775808", "18446744073709551615"}) {
    Parts parts;
    parts.view = fmt::format(R"({{"buffer": 0, "byteLength": 36, "byteStride": {}}})", stride);
    EXPECT_FALSE(complaint_about(parts).empty()) << stride;
  }
}

TEST(HostileModel, ElementsThatNoByteStandsFor_AreFew) {
  Parts parts;
  parts.accessor = R"({"componentType": 5126, "count": 65537, "type": "VEC3"})";
  EXPECT_THAT(complaint_about(parts), AllOf(HasSubstr("65537"), HasSubstr("no buffer view")));
}

TEST(HostileModel, ChainOfManyNodes_IsRead) {
  constexpr int kNodes = 300'000;
  Parts parts;
  parts.nodes.clear();
  for (int i = 0; i < kNodes; ++i) parts.nodes += fmt::format(R"({{"children":[{}]}},)", i + 1);
  parts.nodes += R"({"mesh":0})";
  const TestFolder folder;
  EXPECT_EQ(import_parts(folder, parts).meshes.size(), 1U);
}

TEST(HostileModel, ReferencesOutOfTheFolder_AreRefusedInEverySpelling) {
  const TestFolder folder;
  const std::string secret = folder.write("secret.bin", kPositions).string();
  for (const std::string& uri :
       {secret, "file://" + secret, std::string("../secret.bin"), std::string("./.././secret.bin"),
        std::string("x/../../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("%2E%2E%2Fsecret.bin"),
        std::string("..%2fsecret.bin"), "/" + secret, std::string("../../../../../../../../etc/passwd"),
        std::string("/etc/passwd"), std::string("..\\u0000/secret.bin"), std::string("data.bin\\u0000../secret.bin")}) {
    Parts parts;
    parts.uri = uri;
    const Error error = error_of([&] { import_parts(folder, parts); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput) << uri;
    EXPECT_THAT(error.where(), HasSubstr("test.gltf")) << uri;
  }
}

TEST(HostileModel, LinksOutOfTheFolder_AreRefused_OthersFollowed) {
  const TestFolder folder;
  folder.write("secret.bin", kPositions);
  folder.write("model/own.bin", kPositions);
  fs::create_symlink("../secret.bin", folder.path() / "model" / "out.bin");
  fs::create_directory_symlink("..", folder.path() / "model" / "up");
  fs::create_symlink("own.bin", folder.path() / "model" / "in.bin");
  fs::create_directory_symlink("model", folder.path() / "alias");
  Parts parts;
  for (const char* uri : {"out.bin", "up/secret.bin"}) {
    parts.uri = uri;
    EXPECT_THAT(error_of([&] { import_parts(folder, parts); }).message(), HasSubstr("outside its folder")) << uri;
  }
  parts.uri = "in.bin";
  EXPECT_EQ(import_parts(folder, parts).meshes.size(), 1U);
  EXPECT_EQ(import_gltf(folder.path() / "alias" / "test.gltf").meshes.size(), 1U);
}

TEST(HostileModel, ObjAndItsLibrary_StayInTheirFolder) {
  const TestFolder folder;
  const std::string secret = folder.write("secret.mtl", "newmtl red\nKd 1 0 0\n").string();
  fs::create_directories(folder.path() / "model");
  fs::create_symlink("../secret.mtl", folder.path() / "model" / "link.mtl");
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
  for (const std::string& library : {secret, std::string("../secret.mtl"), std::string("link.mtl")}) {
    const auto file = folder.write("model/test.obj", "mtllib " + library + "\n" + faces);
    EXPECT_THAT(error_of([&] { import_obj(file); }).message(), HasSubstr("outside its folder")) << library;
    folder.write("model/own.mtl", "newmtl red\nmap_Kd " + library + "\n");
    const auto textured = folder.write("model/test.obj", "mtllib own.mtl\n" + faces);
    EXPECT_THAT(error_of([&] { import_obj(textured); }).message(), HasSubstr("outside its folder")) << library;
  }
}

}  // namespace
}  // namespace shadowbench::scene
