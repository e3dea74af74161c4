#include <chrono>

#include "harness/scene/files/mesh_file.h"
#include "tests/test_files.h"

namespace shadowbench::scene {
namespace {

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
  EXPECT_THAT(colours, Contains(glm::vec4(1, 0, 0, 1)));
  EXPECT_THAT(colours, Contains(glm::vec4(0, 0, 1, 1)));
}

TEST(ObjFileTest, MissingMaterialLibrary_IsAWarning) {
  const MeshFile model = import_text(std::string("mtllib absent.mtl\n") + kObjQuad + "f 1 2 3\n");
  EXPECT_THAT(model.warnings, Contains(HasSubstr("absent.mtl")));
}

/// A scene may be named without a folder, and what it names be missing.
TEST(ObjFileTest, ReferencesOfAFileWithoutAFolder_AreInside) {
  EXPECT_EQ(resolve_inside("", "absent.mtl"), std::filesystem::path("absent.mtl"));
  EXPECT_EQ(resolve_inside("", "tex/absent.png"), std::filesystem::path("tex/absent.png"));
  EXPECT_EQ(resolve_inside("", "../absent.mtl"), std::nullopt);
}

TEST(ObjFileTest, LibraryOrTextureOutsideTheFolder_IsRefused) {
  const TestFolder folder;
  const std::string secret = folder.write("secret.mtl", "newmtl red\nKd 1 0 0\n").string();
  std::filesystem::create_directories(folder.path() / "model");
  std::filesystem::create_symlink("../secret.mtl", folder.path() / "model" / "link.mtl");
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
  for (const std::string& library : {secret, std::string("../secret.mtl"), std::string("link.mtl")}) {
    const auto file = folder.write("model/test.obj", "mtllib " + library + "\n" + faces);
    EXPECT_THAT(error_of([&] { import_obj(file); }).message(), HasSubstr("outside its folder")) << library;
    folder.write("model/own.mtl", "newmtl red\nmap_Kd " + library + "\n");
    const auto textured = folder.write("model/test.obj", "mtllib own.mtl\n" + faces);
    EXPECT_THAT(error_of([&] { import_obj(textured); }).message(), HasSubstr("outside its folder")) << library;
  }
}

TEST(ObjFileTest, CoordinateThatIsNoFiniteNumber_NamesItsLine) {
  for (const std::string bad : {"nan", "inf", "-inf", "abc", "1e999", "1.0x"}) {
    EXPECT_THAT(error_of([&] { import_text("v 0 0 0\nv 1 " + bad + " 0\nv 1 1 0\nf 1 2 3\n"); }),
                is_error(ErrorKind::kInput, "test.obj:2: ", "'" + bad + "'"));
  }
  EXPECT_THAT(error_of([] { import_text("v 0 0\n"); }).message(), HasSubstr("at least 3 numbers"));
}

TEST(ObjFileTest, IndexThatIsNone_NamesItsLine) {
  for (const std::string bad : {"999999999999999999999", "2147483648", "-2147483649", "2x", "1.5"}) {
    for (const std::string& corner : {bad, "1/" + bad, "1//" + bad}) {
      EXPECT_THAT(error_of([&] { import_text(kObjQuad + ("f 1 2 " + corner + "\n")); }),
                  is_error(ErrorKind::kInput, "test.obj:5: ", "'" + bad + "' is not an index"));
    }
  }
}

TEST(ObjFileTest, LinesOfOldMacintosh_AreRead) {
  EXPECT_EQ(import_text("# made long ago\rv 0 0 0\rv 1 0 0\rv 1 1 0\rf 1 2 3\r").meshes.at(0).indices.size(), 3U);
  EXPECT_THAT(error_of([] { import_text("# comment\rv 0 0 0\rv 1 nan 0\rf 1 2 3\r"); }).where(),
              EndsWith("test.obj:3"));
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
  EXPECT_THROW(import_text(std::string(kObjQuad) + "f 1 2 0\n"), Error);
  EXPECT_THROW(import_text(std::string(kObjQuad) + "f 1 2 -9\n"), Error);
}

using Polygon = std::vector<glm::dvec3>;

constexpr int kMostCorners = 2048;

Polygon make_star(int corners, double inner) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners, radius = i % 2 == 0 ? 1.0 : inner;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  return polygon;
}

/// Long thin teeth, each leaning by `lean`.
Polygon make_comb(int corners, double lean) {
  Polygon polygon;
  for (int i = 0; i < corners - 3; ++i)
    polygon.emplace_back(1.0 - 1.0 * i / corners + (i % 2 == 1 ? lean : 0.0), i % 2 == 1 ? 1.0 : 0.0, 0.0);
  polygon.emplace_back(0.0, -1.0, 0.0);
  polygon.emplace_back(1.0, -1.0, 0.0);
  return polygon;
}

/// A corridor that winds inwards.
Polygon make_spiral(int corners) {
  Polygon polygon;
  const int half = corners / 2;
  for (int i = 0; i < 2 * half; ++i) {
    const int step = i < half ? i : 2 * half - 1 - i;
    const double angle = 20.0 * std::numbers::pi * step / half, radius = 1.0 + angle + (i < half ? 1.0 : 0.0);
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  return polygon;
}

/// A square with very many corners along its straight sides.
Polygon make_square(int corners) {
  Polygon polygon;
  const int side = corners / 4;
  const glm::dvec3 at[] = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
  for (int i = 0; i < 4 * side; ++i)
    polygon.push_back(at[i / side] + (at[(i / side + 1) % 4] - at[i / side]) * (1.0 * (i % side) / side));
  return polygon;
}

glm::dvec3 area_of(const Polygon& polygon) {
  glm::dvec3 area(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += 0.5 * glm::cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return area;
}

std::string write_face(const Polygon& polygon) {
  std::string text, face = "f";
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    text += fmt::format("v {} {} {}\n", polygon[i].x, polygon[i].y, polygon[i].z);
    face += fmt::format(" {}", i + 1);
  }
  return text + face + "\n";
}

/// Triangles cover a polygon once where all face its way and their areas add up to its own.
void expect_covered(const Polygon& polygon, const std::string& name) {
  const Mesh mesh = import_text(write_face(polygon)).meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 3 * (polygon.size() - 2)) << name;
  const auto place = [&](std::size_t i) { return glm::dvec3(mesh.vertices[mesh.indices[i]].position_ws); };
  const glm::dvec3 whole = area_of(polygon);
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const double area = glm::dot(area_of({place(i), place(i + 1), place(i + 2)}), glm::normalize(whole));
    EXPECT_GE(area, -1e-6 * glm::length(whole)) << name << " " << i;  // positions are floats
    sum += area;
  }
  EXPECT_NEAR(sum, glm::length(whole), 1e-5 * glm::length(whole)) << name;
}

Polygon move(Polygon polygon, const glm::dvec3& by) {
  for (glm::dvec3& corner : polygon) corner += by;
  return polygon;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Wherever they lie: the parser's own triangles miss parts of those that lie beside the origin.
TEST(ObjPolygon, OfEveryShape_IsCoveredOnce) {
  for (const int corners : {5, 8, 100, 1000, kMostCorners}) {
    for (const glm::dvec3& by : {glm::dvec3(0.0), glm::dvec3(4.0, -3.0, 2.0)}) {
      expect_covered(move(make_star(corners, 1.0), by), "a circle");
      expect_covered(move(make_star(corners, 0.5), by), "a star");
      expect_covered(move(make_comb(corners, 0.0), by), "a comb");
      expect_covered(move(make_comb(corners, 0.7), by), "a leaning comb");
      if (corners >= 8) expect_covered(move(make_square(corners), by), "a square");
      if (corners >= 1000) expect_covered(move(make_spiral(corners), by), "a spiral");
    }
  }
}

/// Its shorter diagonal, along which the parser cuts, lies outside of it.
TEST(ObjPolygon, OfFourCornersAndADent_IsCoveredOnce) {
  Polygon dart = {{0, 3, 0}, {-0.5, 0, 0}, {0, 1, 0}, {0.5, 0, 0}};
  for (int i = 0; i < 4; ++i) {
    std::ranges::rotate(dart, dart.begin() + 1);
    expect_covered(dart, "a dart");
  }
}

TEST(ObjPolygon, FromEverySide_KeepsItsSense) {
  Polygon turned = make_star(500, 0.5);
  for (glm::dvec3& corner : turned) corner = {0.3 * corner.x, corner.y - corner.x, 0.2 * corner.y};
  expect_covered(turned, "turned");
  std::ranges::reverse(turned);
  expect_covered(turned, "reversed");
}

TEST(ObjPolygon, ThatIsATangle_StillGivesTriangles) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  Polygon tangle;
  for (int i = 0; i < kMostCorners; ++i) tangle.emplace_back(place(random), place(random), 0.0);
  EXPECT_EQ(import_text(write_face(tangle)).meshes.at(0).indices.size(), 3U * (kMostCorners - 2U));
  EXPECT_EQ(import_text(write_face(Polygon(1000, {1.0, 2.0, 3.0}))).meshes.at(0).indices.size(), 3U * 998U)
      << "all corners at one point";
}

TEST(ObjPolygon, OfMoreCornersThanAreRead_IsRefused) {
  EXPECT_EQ(import_text(write_face(make_star(kMostCorners, 1.0))).meshes.size(), 1U);
  EXPECT_THAT(error_of([] { import_text("# one more\n" + write_face(make_star(kMostCorners + 1, 1.0))); }),
              is_error(ErrorKind::kInput, "test.obj:2051: ",
                       "this face has 2049 corners; at most 2048 are read: triangulate it in the modelling program"));
}

/// What stands around it stays as it was, and every corner keeps its normal and texture coordinate.
TEST(ObjPolygon, AmongOtherLines_ChangesNoneOfThem) {
  const std::string vertices = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 1 0\nv 0 2 0\nvt 0 0\nvt 0.5 0\nvn 0 0 -1\n";
  const MeshFile model =
      import_text(vertices + "g a\nf 1 2 3\ng b\nf 1/1/1 2/2/1 3/1/1 4/1/1 -1/1/1 # five\nv 9 9 9\ng c\nf 1 2 6");
  ASSERT_EQ(model.meshes.size(), 3U);
  EXPECT_EQ(model.meshes[0].indices.size(), 3U);
  const Mesh& polygon = model.meshes[1];
  EXPECT_EQ(polygon.name, "b");
  EXPECT_EQ(polygon.indices.size(), 9U);
  for (const Vertex& vertex : polygon.vertices) {
    EXPECT_EQ(vertex.normal_ws, glm::vec3(0, 0, -1));
    EXPECT_EQ(vertex.uv.x, vertex.position_ws == glm::vec3(2, 0, 0) ? 0.5f : 0.0f);
    EXPECT_NE(vertex.position_ws, glm::vec3(9, 9, 9)) << "-1 is the last before the face";
  }
  EXPECT_EQ(model.meshes[2].vertices.back().position_ws, glm::vec3(9, 9, 9));
}

TEST(ObjPolygon, IndexThatNamesNoVertex_NamesItsLine) {
  const std::string text = write_face(make_star(300, 1.0));
  for (const char* wrong : {"301", "-301"}) {
    std::string bad = text;
    bad.replace(bad.rfind("300"), 3, wrong);
    EXPECT_THAT(error_of([&] { import_text(bad); }),
                is_error(ErrorKind::kInput, "test.obj:301: ", fmt::format("vertex {}, but there are 300", wrong)));
  }
}

TEST(ObjFileTest, PolygonsOfManyCorners_AreReadInSeconds) {
  std::string text;
  for (const glm::dvec3& corner : make_spiral(kMostCorners)) text += fmt::format("v {} {} 0\n", corner.x, corner.y);
  std::string face = "f";
  for (int i = 0; i < kMostCorners; ++i) face += fmt::format(" {}", i + 1);
  for (int i = 0; i < 50; ++i) text += face + "\n";
  MeshFile model;
  EXPECT_LT(seconds_of([&] { model = import_text(text); }), 20.0);
  EXPECT_EQ(model.meshes.at(0).indices.size(), 150U * (kMostCorners - 2U));
}

TEST(ObjFileTest, FanOfVeryManyTriangles_IsReadInSeconds) {
  constexpr int kMany = 300000;  // what takes the square of that takes minutes
  std::string text = "v 0 0 1\n";
  for (const glm::dvec3& corner : make_star(kMany, 1.0)) text += fmt::format("v {} {} 0\n", corner.x, corner.y);
  for (int i = 0; i < kMany; ++i) text += fmt::format("f 1 {} {}\n", i + 2, (i + 1) % kMany + 2);
  MeshFile model;
  EXPECT_LT(seconds_of([&] { model = import_text(text); }), 20.0);
  const Vertex& tip = model.meshes.at(0).vertices.at(0);
  EXPECT_EQ(tip.position_ws, glm::vec3(0, 0, 1));
  EXPECT_NEAR(tip.normal_ws.z, 1.0f, 1e-3f) << "that of all faces: they are too many to compare";
}

/// Bytes from text, so that zeros and escapes can stand in it.
template <std::size_t N>
std::vector<unsigned char> bytes(const char (&text)[N]) {
  return {text, text + N - 1};
}

constexpr char kHugePng[] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\1\0\0\0\1\0\0\x08\2\0\0\0";
constexpr char kHugeTga[] = "\0\0\2\0\0\0\0\0\0\0\0\0\xff\xff\xff\xff\x20\x28";

TEST(PictureHeader, ClaimsThatNoMemoryHolds_AreRefusedBeforeDecoding) {
  const auto complaint = [](const std::vector<unsigned char>& picture) {
    return error_of([&] { decode_texture(picture, "huge", "a.gltf", {}); }).message();
  };
  EXPECT_THAT(complaint(bytes(kHugePng)),
              HasSubstr("'huge' cannot be decoded: use PNG or JPEG, 1 to 16384 pixels a side"));
  EXPECT_THAT(complaint(bytes(kHugeTga)), AllOf(HasSubstr("65535 x 65535"), HasSubstr("16384")));
  EXPECT_THAT(complaint(bytes("P6 99999 99999 255\n")), HasSubstr("99999 x 99999"));
  EXPECT_THAT(complaint(bytes("\0\0\2\0\0\0\0\0\0\0\0\0\1\x20\1\x20\x20\x28")), HasSubstr("8193 x 8193"));
}

TEST(PictureHeader, AllTexturesOfAModel_AreCountedTogether) {
  const auto small = bytes(
      "\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x20\x28"
      "abcd");
  const Texture large{"large", 16384, 16384, {}};
  EXPECT_EQ(decode_texture(small, "small", "a.gltf", {}).rgba.size(), 4U);
  EXPECT_THAT(error_of([&] { decode_texture(small, "small", "a.gltf", {large}); }),
              is_error(ErrorKind::kInput, "'small'", "268435457"));
}

}  // namespace
}  // namespace shadowbench::scene
