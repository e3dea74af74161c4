#include "harness/engines/alignment.h"

#include "harness/engines/external_images.h"
#include "report/images/picture_io.h"
#include "tests/test_files.h"

namespace shadowbench::engines {
namespace {

using images::Image;

constexpr int kWidth = 96, kHeight = 54;
const glm::dvec3 kToLight = glm::normalize(glm::dvec3(0.5, 0.7, 0.6));

/// A view of a floor, a wall, a slope at the left and a leaning chimney, with sky above; sampled anywhere, as by
/// another camera.
struct Surface {
  double depth = 0.0;  ///< 0: sky
  glm::dvec3 normal{0.0};
};

Surface look(double x, double y, bool has_chimney = true) {
  const double u = (x - 40.0) / kWidth, v = (y - 20.0) / kHeight;  // nothing is symmetrical
  if (has_chimney && std::abs(u - 0.05 + 0.3 * v) < 0.05 && v > -0.6 && v < 0.0) return {3.0, {0.0, 0.6, 0.8}};
  if (v < -0.15 - 0.2 * u) return {};
  if (u > 0.25 && v < 0.3) return {1.0 / (0.3 - 0.1 * u), {-0.6, 0.0, 0.8}};
  if (u < -0.2 && v < 0.45) return {1.0 / (0.25 + 0.15 * u + 0.1 * v), {0.8, 0.6, 0.0}};
  return {1.0 / (0.1 + 0.4 * (v + 0.4)), {0.0, 1.0, 0.0}};
}

double shadow(double x, double y) { return 0.5 + 0.5 * std::sin(0.3 * x + 0.2 * y) * std::sin(0.11 * y); }

OwnView make_own() {
  OwnView own{{}, {}, Image(kWidth, kHeight, 1), Image(kWidth, kHeight, 1), {}, glm::vec3(kToLight)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Surface seen = look(x + 0.5, y + 0.5);
      own.is_surface.push_back(seen.depth > 0.0);
      own.counts.push_back(seen.depth > 0.0);
      own.normals_ws.emplace_back(seen.normal);
      *own.depth.at(x, y) = static_cast<float>(seen.depth);
      *own.direct.at(x, y) = static_cast<float>(0.7 * glm::dot(seen.normal, kToLight));
    }
  }
  return own;
}

/// How another renderer may draw it.
struct Drawing {
  std::function<glm::dvec2(const glm::dvec2&)> place = [](const glm::dvec2& p) { return p; };  ///< of a pixel's middle
  std::function<double(double)> encode = [](double value) { return value; };
  glm::dvec3 to_light = kToLight;
  bool has_depth = true;
  bool has_chimney = true;
};

ExternalImages draw(const Drawing& drawing = {}) {
  ExternalImages made{
      Image(kWidth, kHeight, 1), Image(kWidth, kHeight, 1), {}, Image(kWidth, kHeight, 1), "test", {}, {}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec2 p = drawing.place({x + 0.5, y + 0.5});
      const Surface seen = look(p.x, p.y, drawing.has_chimney);
      const double light = seen.depth > 0.0 ? 0.35 * std::max(glm::dot(seen.normal, drawing.to_light), 0.0) : 0.0;
      *made.unlit->at(x, y) = static_cast<float>(drawing.encode(light));
      *made.lit->at(x, y) = static_cast<float>(drawing.encode(light * shadow(p.x, p.y)));
      *made.depth->at(x, y) = static_cast<float>(seen.depth);
    }
  }
  if (!drawing.has_depth) made.depth.reset();
  return made;
}

std::string all_texts(const CheckedImages& checked) {
  std::string texts;
  for (const Finding& each : checked.findings) texts += each.text + (each.refuses ? " REFUSED\n" : "\n");
  return texts;
}

std::string find_texts(const ExternalImages& images, const OwnView& own = make_own()) {
  return all_texts(check_images(images, own));
}

TEST(Alignment, TheSameView_HasItsVisibilityAndNoFinding) {
  const CheckedImages checked = check_images(draw(), make_own());
  EXPECT_EQ(all_texts(checked), "");
  EXPECT_EQ(checked.undefined, 0);
  ASSERT_TRUE(checked.alignment.shift);
  EXPECT_NEAR(glm::length(*checked.alignment.shift), 0.0, 1e-6);
  EXPECT_NEAR(*checked.visibility.at(50, 40), shadow(50.5, 40.5), 1e-5);
}

TEST(Alignment, DepthFindsAQuarterOfAPixel) {
  const CheckedImages checked =
      check_images(draw({.place = [](const glm::dvec2& p) { return p - glm::dvec2(0.25, -0.125); }}), make_own());
  ASSERT_TRUE(checked.alignment.shift);
  EXPECT_EQ(checked.alignment.by, "depth");
  EXPECT_NEAR(checked.alignment.shift->x, 0.25, 2e-3);
  EXPECT_NEAR(checked.alignment.shift->y, -0.125, 2e-3);
  EXPECT_NEAR(*checked.alignment.p99, 0.25, 0.02);
  EXPECT_THAT(all_texts(checked), HasSubstr("0.25 pixels right and -0.1"));
}

TEST(Alignment, CoverageFindsHalfAPixel_AndItIsRefused) {
  const CheckedImages checked =
      check_images(draw({.place = [](const glm::dvec2& p) { return p - 0.5; }, .has_depth = false}), make_own());
  EXPECT_EQ(checked.alignment.by, "coverage");
  ASSERT_TRUE(checked.alignment.shift);
  EXPECT_NEAR(checked.alignment.shift->x, 0.5, 0.1);
  EXPECT_NEAR(checked.alignment.shift->y, 0.5, 0.1);
  EXPECT_THAT(all_texts(checked), HasSubstr("half a pixel"));
  EXPECT_THAT(all_texts(checked), HasSubstr("REFUSED"));
}

constexpr double kAspect = static_cast<double>(kWidth) / kHeight;

/// Places that are scaled about the picture's middle.
auto scale_places(const glm::dvec2& scale) {
  return [scale](const glm::dvec2& p) {
    const glm::dvec2 half(0.5 * kWidth, 0.5 * kHeight);
    return half + (p - half) * scale;
  };
}

TEST(Alignment, Mistakes_AreRefusedByName) {
  const auto encode = [](double v) { return static_cast<double>(images::encode_srgb(static_cast<float>(v))); };
  const std::pair<Drawing, const char*> mistakes[] = {
      {{.place = scale_places({1.0, -1.0})}, "upside down"},
      {{.place = scale_places({-1.0, 1.0})}, "mirrored"},
      {{.place = scale_places({-1.0, -1.0})}, "180 degrees"},
      {{.place = scale_places({1.0 / kAspect, 1.0})}, "aspect is 1"},
      {{.place = scale_places(glm::dvec2(1.0 / kAspect))}, "field of view"},
      {{.place = scale_places(glm::dvec2(1.015))}, "at the 99th percentile"},  // though the middle lies right
      {{.place = [](const auto& p) { return p + glm::dvec2(30.0, -12.0); }}, "another one"},
      {{.encode = encode}, "sRGB"}};
  for (const auto& [drawing, text] : mistakes)
    EXPECT_THAT(find_texts(draw(drawing)), AllOf(HasSubstr(text), HasSubstr("REFUSED")));
}

TEST(Alignment, ALightThatIsOffByOneDegree_IsNamed) {
  const glm::dvec3 axis = glm::normalize(glm::cross(kToLight, glm::dvec3(0.0, 1.0, 0.0)));
  const double angle = glm::radians(1.0);
  const glm::dvec3 turned = std::cos(angle) * kToLight + std::sin(angle) * glm::cross(axis, kToLight);
  EXPECT_THAT(find_texts(draw({.to_light = turned})), HasSubstr("lit from 1 degrees beside"));
}

TEST(Alignment, ALightFromTheOtherSide_IsNamed) {
  const glm::dvec3 mirrored(-kToLight.x, kToLight.y, kToLight.z), behind(kToLight.x, kToLight.y, -kToLight.z);
  EXPECT_THAT(find_texts(draw({.to_light = mirrored})), HasSubstr("degrees beside our light"));
  EXPECT_THAT(find_texts(draw({.to_light = behind})), HasSubstr("lit in one of the two"));
}

TEST(Alignment, MaterialsThatAreNotMatt_AreNamed) {
  ExternalImages shiny = draw();
  for (int y = 20; y < 40; ++y)
    for (int x = 0; x < kWidth; ++x) *shiny.unlit->at(x, y) *= 2.0f;
  EXPECT_THAT(find_texts(shiny), HasSubstr("in other proportions"));
}

/// A ball on a floor, before a camera that stands upright, under the same light.
struct Ball {
  OwnView own{{}, {}, Image(kWidth, kHeight, 1), Image(kWidth, kHeight, 1), {}, glm::vec3(kToLight)};
  ExternalImages images{
      Image(kWidth, kHeight, 1), Image(kWidth, kHeight, 1), {}, Image(kWidth, kHeight, 1), "test", {}, {}};
};

/// What its surfaces add to matt light, by their normal and the direction to the viewer.
using Gloss = std::function<double(const glm::dvec3& normal, const glm::dvec3& to_viewer)>;

Ball draw_ball(const Gloss& gloss, const glm::dvec3& to_light = kToLight) {
  Ball ball;
  const glm::dvec3 eye(0.0, 1.5, 5.0), center(0.0, 1.0, 0.0);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec3 way = glm::normalize(glm::dvec3((x + 0.5 - 45.0) / 60.0, (22.0 - y - 0.5) / 60.0, -1.0));
      const double along = glm::dot(center - eye, way);
      const double under_root = 1.0 - glm::dot(center - eye, center - eye) + along * along;
      const bool on_ball = under_root > 0.0, is_surface = on_ball || way.y < 0.0;
      const glm::dvec3 point = eye + (on_ball ? along - std::sqrt(under_root) : -eye.y / way.y) * way;
      const glm::dvec3 normal = on_ball ? point - center : glm::dvec3(0.0, 1.0, 0.0);
      const double cosine = is_surface ? std::max(glm::dot(normal, kToLight), 0.0) : 0.0;
      const double matt = (on_ball ? 0.2 : 0.5) * std::max(glm::dot(normal, to_light), 0.0);
      const double light = cosine > 0.0 ? matt + gloss(normal, -way) : 0.0;
      ball.own.is_surface.push_back(is_surface);
      ball.own.counts.push_back(cosine > 0.0);
      ball.own.normals_ws.emplace_back(normal);
      *ball.own.depth.at(x, y) = *ball.images.depth->at(x, y) = is_surface ? static_cast<float>(eye.z - point.z) : 0.0f;
      *ball.own.direct.at(x, y) = static_cast<float>((on_ball ? 0.4 : 1.0) * cosine);
      *ball.images.unlit->at(x, y) = static_cast<float>(light);
      *ball.images.lit->at(x, y) = static_cast<float>(light * shadow(x, y));
    }
  }
  return ball;
}

TEST(Alignment, MaterialsThatShine_AreNamed) {
  const Ball matt = draw_ball([](auto...) { return 0.0; });
  EXPECT_EQ(find_texts(matt.images, matt.own), "");
  const Ball turned = draw_ball([](auto...) { return 0.0; }, glm::normalize(kToLight + glm::dvec3(0.02, 0.0, 0.0)));
  EXPECT_THAT(find_texts(turned.images, turned.own), HasSubstr("degrees beside our light"));
  // As glTF materials do that are rough, at grazing angles.
  const Gloss rough = [](const glm::dvec3& normal, const glm::dvec3& to_viewer) {
    const double toward = glm::dot(to_viewer, glm::normalize(to_viewer + kToLight));
    return glm::dot(normal, kToLight) * (0.04 + 0.96 * std::pow(1.0 - toward, 5)) /
           (glm::dot(normal, kToLight) + glm::dot(normal, to_viewer));
  };
  const Ball ball = draw_ball(rough);
  EXPECT_THAT(find_texts(ball.images, ball.own), HasSubstr("materials shine"));
}

TEST(Alignment, ARoundingOfNoLight_IsNoLight) {
  ExternalImages noisy = draw();
  OwnView own = make_own();
  for (std::size_t i = 0; i < own.counts.size(); ++i) {
    if (own.normals_ws[i].y != 1.0f) continue;
    own.counts[i] = 0;
    own.direct.texels[i] = 0.0f;
    noisy.unlit->texels[i] = noisy.lit->texels[i] = 1e-8f;
  }
  EXPECT_EQ(find_texts(noisy, own), "");
}

TEST(Alignment, BackFacesThatAreNotDrawn_AreNamed_AndLeftOut) {
  OwnView own = make_own();
  for (const glm::vec3& normal : own.normals_ws) own.is_back.push_back(normal == glm::vec3(0.0f, 0.6f, 0.8f));
  EXPECT_EQ(find_texts(draw(), own), "");
  for (const bool has_depth : {true, false}) {
    const CheckedImages checked = check_images(draw({.has_depth = has_depth, .has_chimney = false}), own);
    EXPECT_THAT(all_texts(checked), HasSubstr("culls back faces"));
    for (const char* wrong : {"another one", "antialiased", "REFUSED"})
      EXPECT_THAT(all_texts(checked), Not(HasSubstr(wrong))) << has_depth;
    EXPECT_TRUE(std::isnan(*checked.visibility.at(45, 10)));
  }
}

TEST(Alignment, CastersThatCastOnOneSide_AreNamed) {
  OwnView own = make_own();
  ExternalImages drawn = draw();
  for (std::size_t i = 0; i < own.counts.size(); ++i) {
    own.casters.push_back(i % 3 == 0 && own.counts[i] ? static_cast<std::uint8_t>(i % 4) : 0);
    if (own.casters[i] != 0) drawn.lit->texels[i] = 0.0f;
  }
  EXPECT_EQ(find_texts(drawn, own), "");
  for (const auto& [faces, text] :
       {std::pair(kFrontsCast, "only front faces"), std::pair(kBacksCast, "only back faces")}) {
    ExternalImages lit = drawn;
    for (std::size_t i = 0; i < own.casters.size(); ++i)
      if (own.casters[i] == faces) lit.lit->texels[i] = lit.unlit->texels[i];
    EXPECT_THAT(find_texts(lit, own), HasSubstr(text));
  }
  drawn.lit = drawn.unlit;  // where all shadows are missing, that explains nothing
  drawn.lit->texels[drawn.lit->texels.size() - 1] = 0.0f;
  EXPECT_THAT(find_texts(drawn, own), Not(HasSubstr("alone")));
}

TEST(Alignment, ADepthThatIsNone_IsNamed) {
  ExternalImages colors = draw();
  for (float& value : colors.depth->texels) value = 0.3f;
  const CheckedImages checked = check_images(colors, make_own());
  EXPECT_THAT(all_texts(checked), HasSubstr("metres along the camera's axis"));
  EXPECT_EQ(checked.alignment.by, "coverage");
}

TEST(Alignment, SwappedFilesAndMissingShadows_AreRefused) {
  ExternalImages swapped = draw();
  std::swap(swapped.lit, swapped.unlit);
  EXPECT_THAT(find_texts(swapped), HasSubstr("exchanged REFUSED"));
  ExternalImages same = draw();
  same.lit = same.unlit;
  EXPECT_THAT(find_texts(same), HasSubstr("there are no shadows"));
  ExternalImages bright = draw();
  for (int i = 0; i < 40; ++i) *bright.lit->at(40 + i, 45) = 9.0f;
  EXPECT_THAT(find_texts(bright), HasSubstr("brighter than unlit at"));
}

TEST(Alignment, FewBits_AreNamed) {
  EXPECT_THAT(find_texts(draw({.encode = [](double v) { return std::round(255.0 * v) / 255.0; }})),
              HasSubstr("eight bits"));
  ExternalImages half = draw();
  half.lit = images::round_to_half(*half.lit);
  half.unlit = images::round_to_half(*half.unlit);
  EXPECT_THAT(find_texts(half), HasSubstr("half floats"));
}

TEST(Alignment, Multisampling_IsNamed) {
  ExternalImages mixed = draw();
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      double sum = 0.0;
      for (int i = 0; i < 16; ++i) {
        const Surface seen = look(x + (i % 4 + 0.5) / 4.0, y + (i / 4 + 0.5) / 4.0);
        if (seen.depth > 0.0) sum += 0.35 * std::max(glm::dot(seen.normal, kToLight), 0.0) / 16.0;
      }
      *mixed.unlit->at(x, y) = static_cast<float>(sum);
      *mixed.lit->at(x, y) = 0.5f * static_cast<float>(sum);
    }
  }
  EXPECT_THAT(find_texts(mixed), HasSubstr("antialiased"));
}

TEST(Alignment, NaN_IsCountedAndLeftOut) {
  ExternalImages holes = draw();
  for (int i = 0; i < 60; ++i) *holes.lit->at(30 + i, 50) = std::numeric_limits<float>::quiet_NaN();
  const CheckedImages checked = check_images(holes, make_own());
  EXPECT_EQ(checked.undefined, 60);
  EXPECT_TRUE(std::isnan(*checked.visibility.at(35, 50)));
  EXPECT_THAT(all_texts(checked), HasSubstr("have no visibility"));
}

std::string refusal_of(const ExternalImages& images) {
  return error_of([&] { check_images(images, make_own()); }).message();
}

TEST(Alignment, WhatCannotBeCompared_IsAnError) {
  const Image small(48, 27, 1), turned(kHeight, kWidth, 1), black(kWidth, kHeight, 1);
  EXPECT_THAT(refusal_of({{}, {}, small, {}, "test", {}, {}}),
              HasSubstr("48 x 27 pixels, and the run's picture has 96 x 54"));
  EXPECT_THAT(refusal_of({{}, {}, turned, {}, "test", {}, {}}), HasSubstr("exchanged"));
  EXPECT_THAT(refusal_of({black, black, {}, {}, "test", {}, {}}), HasSubstr("black at every receiver"));
  Image nothing = black;
  std::ranges::fill(nothing.texels, std::numeric_limits<float>::infinity());
  EXPECT_THAT(refusal_of({{}, {}, nothing, {}, "test", {}, {}}), HasSubstr("no receiver has a visibility"));
}

// Pictures of other renderers, from files that the test writes.

images::Image make_grey(float value) {
  images::Image image(4, 4, 3);
  std::ranges::fill(image.texels, value);
  return image;
}

/// A file that is named for two layers gives each its own part, whatever its first part is.
TEST(ExternalImages, AFileOfSeveralParts_GivesEachLayerItsOwn) {
  const TestFolder folder;
  const std::string file = (folder.path() / "both.exr").string();
  images::write_exr(file, {{"unlit", {"R", "G", "B"}, make_grey(0.25f)}, {"lit", {"R", "G", "B"}, make_grey(0.75f)}},
                    {});
  ExternalFiles files;
  files.lit = files.unlit = file;
  const ExternalImages read = read_external_images(files);
  EXPECT_EQ(read.lit.value().texels.front(), 0.75f);
  EXPECT_EQ(read.unlit.value().texels.front(), 0.25f);
}

TEST(ExternalImages, AFileOfOnePart_IsTheLayerThatItIsNamedFor) {
  const TestFolder folder;
  const std::string lit = (folder.path() / "a.exr").string(), unlit = (folder.path() / "b.exr").string();
  images::write_exr(lit, {{"beauty", {"R", "G", "B"}, make_grey(0.5f)}}, {});
  images::write_exr(unlit, {{"beauty", {"R", "G", "B"}, make_grey(0.125f)}}, {});
  ExternalFiles files;
  files.lit = lit;
  files.unlit = unlit;
  const ExternalImages read = read_external_images(files);
  EXPECT_EQ(read.lit.value().texels.front(), 0.5f);
  EXPECT_EQ(read.unlit.value().texels.front(), 0.125f);
}

constexpr int kSize = 8;
const glm::vec3 kUp(0.0f, 1.0f, 0.0f);

/// A map from straight above over the square 0 .. 8 of the floor: u along x, v against z, depth 0 at y = 8 and 1 at 0.
OwnMap make_map(bool reversed = false) {
  OwnMap map;
  map.depth = images::Image(kSize, kSize, 1);
  map.map_from_world = glm::dmat4(0.0);
  map.map_from_world[0][0] = 1.0 / kSize;
  map.map_from_world[2][1] = -1.0 / kSize;
  map.map_from_world[3][1] = 1.0;
  map.map_from_world[1][2] = reversed ? 0.125 : -0.125;
  map.map_from_world[3][2] = reversed ? 0.0 : 1.0;
  map.map_from_world[3][3] = 1.0;
  const float floor = reversed ? 0.0f : 1.0f, roof = reversed ? 0.25f : 0.75f;
  for (int row = 0; row < kSize; ++row)
    for (int column = 0; column < kSize; ++column) *map.depth.at(column, row) = column < 3 && row < 2 ? roof : floor;
  return map;
}

truth::ReceiverImage make_receivers(const std::vector<truth::ReceiverPoint>& points) {
  truth::ReceiverImage image;
  image.width = static_cast<int>(points.size());
  image.height = 1;
  image.points = points;
  return image;
}

std::vector<double> look_up_from_above(const OwnMap& map, const std::vector<truth::ReceiverPoint>& points) {
  return look_up(map, make_receivers(points), std::vector<glm::vec3>(points.size(), kUp));
}

TEST(OwnMap, ReceiversAreLookedUpInTheirTexel) {
  // Under the roof, beside it along x and along z, and beyond the map; the first row of the map is z = 0.
  const std::vector<truth::ReceiverPoint> points = {{{2.9f, 0.0f, 1.9f}, kUp, true}, {{3.1f, 0.0f, 1.9f}, kUp, true},
                                                    {{2.9f, 0.0f, 2.1f}, kUp, true}, {{9.0f, 0.0f, 1.0f}, kUp, true},
                                                    {{2.0f, 2.0f, 1.0f}, kUp, true}, {{2.9f, 0.0f, 1.9f}, kUp, false}};
  const std::vector<double> expected = {0.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  EXPECT_EQ(look_up_from_above(make_map(), points), expected);
  EXPECT_EQ(look_up_from_above(make_map(true), points), expected) << "a reversed map";
}

TEST(OwnMap, APlaneHasNoAcne_AndNoMoreBiasThanThat) {
  OwnMap map = make_map();
  // A slope that rises by one metre over each along x: a texel holds the depth of its middle.
  for (int row = 0; row < kSize; ++row)
    for (int column = 0; column < kSize; ++column)
      *map.depth.at(column, row) = static_cast<float>(1.0 - 0.125 * (column + 0.5));
  const glm::vec3 normal = glm::normalize(glm::vec3(-1.0f, 1.0f, 0.0f));
  std::vector<truth::ReceiverPoint> on, below;
  for (float x = 0.05f; x < 8.0f; x += 0.1f) {
    on.push_back({{x, x, 4.0f}, normal, true});
    below.push_back({{x, x - 1.05f, 4.0f}, normal, true});
  }
  EXPECT_EQ(look_up_from_above(map, on), std::vector<double>(on.size(), 1.0));
  EXPECT_EQ(look_up_from_above(map, below), std::vector<double>(on.size(), 0.0));
}

}  // namespace
}  // namespace shadowbench::engines
