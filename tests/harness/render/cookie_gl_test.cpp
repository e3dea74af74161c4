// A lamp's cookie colours its light where the closed form says, and nothing else: no shadow, nothing behind the lamp.

#include "harness/render/shade_pass.h"
#include "harness/scene/mesh_tools.h"
#include "report/images/picture_io.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kCookieSide = 64, kCookieBlocks = 4;
constexpr float kCookieCone_deg = 60.0f, kCookieInnerCone_deg = 45.0f;

using CookieCodes = std::function<glm::ivec3(int column, int row)>;

std::shared_ptr<const scene::Texture> make_cookie(const CookieCodes& codes) {
  scene::Texture picture{"made here", kCookieSide, kCookieSide, {}};
  for (int row = 0; row < kCookieSide; ++row) {
    for (int column = 0; column < kCookieSide; ++column) {
      const glm::ivec3 code = codes(column, row);
      for (const int value : {code.r, code.g, code.b, 255}) picture.rgba.push_back(static_cast<std::uint8_t>(value));
    }
  }
  return std::make_shared<const scene::Texture>(std::move(picture));
}

glm::ivec3 white_code(int, int) { return glm::ivec3(255); }

/// Every block of the picture has a colour of its own.
glm::ivec3 block_code(int column, int row) {
  const int block = kCookieSide / kCookieBlocks, x = column / block, y = row / block;
  return {40 + 60 * x, 255 - 60 * y, 20 + 15 * (kCookieBlocks * y + x)};
}

/// A floor of 8 m seen from straight above: the picture's top is -z, its right +x.
scene::Scene make_cookie_scene(const glm::vec3& position, const glm::vec3& target) {
  scene::Scene scene;
  scene.name = "cookie";
  scene.materials.emplace_back();
  scene.meshes.push_back(scene::make_plane({8.0f, 8.0f}, 1));
  scene.light.kind = scene::Spot{position, target, kCookieCone_deg, kCookieInnerCone_deg, 0.0f};
  scene::Camera camera;
  camera.position_ws = {0.0f, 12.0f, 0.0f};
  camera.forward_ws = {0.0f, -1.0f, 0.0f};
  camera.up_ws = {0.0f, 0.0f, -1.0f};
  camera.orthographic_height_m = 8.0f;
  scene.cameras.push_back(camera);
  return scene;
}

/// The light alone that arrives, without the ambient part; rows top to bottom.
class CookieLight {
 public:
  explicit CookieLight(const scene::Scene& scene, const filters::RangeRule& range = {})
      : scene_(scene), range_(range), bench_(shared_context(), scene, 64, kSide, kSide) {
    bench_.set_range(range);
  }

  /// The share of the floor that a filter finds lit.
  double measure_lit(const std::string& filter) {
    const std::vector<float> image = bench_.draw(catalogue().parse_requests(filter).front());
    return static_cast<double>(std::ranges::count(image, 1.0f)) / static_cast<double>(image.size());
  }

  std::vector<glm::dvec3> draw(const std::shared_ptr<const scene::Texture>& cookie) {
    std::get<scene::Spot>(scene_.light.kind).cookie = cookie;
    const images::Image lit = shade(1.0f), dark = shade(0.0f);
    std::vector<glm::dvec3> light;
    for (std::size_t i = 0; i < lit.texels.size(); i += 3)
      light.emplace_back(lit.texels[i] - dark.texels[i], lit.texels[i + 1] - dark.texels[i + 1],
                         lit.texels[i + 2] - dark.texels[i + 2]);
    return light;
  }

  static glm::dvec3 floor_at(std::size_t pixel) {
    const auto metres = [](std::size_t i) { return 8.0 * (static_cast<double>(i) + 0.5) / kSide - 4.0; };
    return {metres(pixel % kSide), 0.0, metres(pixel / kSide)};
  }

  int compiled() { return shaders_.compiled(); }

 private:
  static constexpr int kSide = 160;

  images::Image shade(float visibility) {
    images::Image image(kSide, kSide, 1);
    for (float& value : image.texels) value = visibility;
    return render::shade(shaders_, bench_.gbuffer(), render::upload_image(image), scene_, scene_.cameras.front(),
                         range_);
  }

  scene::Scene scene_;
  filters::RangeRule range_;
  Bench bench_;
  render::ShaderLibrary shaders_{options::find_resources().shaders};  ///< of its own: its variants are counted
};

/// A lamp with the axes that its right and its top must be.
struct CookieLamp {
  glm::dvec3 position, right, up;
};

TEST(Cookie, ColoursTheLight_ByItsPictureUprightAsSeenFromTheLamp) {
  // The top is the world's axis least parallel to the light: z in both cases.
  for (const CookieLamp& lamp : {CookieLamp{{0.0, 4.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}},
                                 CookieLamp{{2.4, 3.2, 0.0}, {-0.8, 0.6, 0.0}, {0.0, 0.0, 1.0}}}) {
    CookieLight light(make_cookie_scene(glm::vec3(lamp.position), {}));
    const std::vector<glm::dvec3> plain = light.draw(nullptr), colored = light.draw(make_cookie(block_code));
    const double tangent = std::tan(glm::radians(0.5 * static_cast<double>(kCookieCone_deg)));
    int lit = 0, compared = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      if (plain[i] == glm::dvec3(0.0)) EXPECT_EQ(colored[i], plain[i]);
      if (plain[i].g < 0.01) continue;  // the cone's edge is soft
      ++lit;
      const glm::dvec3 way = CookieLight::floor_at(i) - lamp.position;
      const double half_side = tangent * glm::dot(way, glm::normalize(-lamp.position));
      const glm::dvec2 texel =
          (0.5 + 0.5 * glm::dvec2(glm::dot(way, lamp.right), -glm::dot(way, lamp.up)) / half_side) *
          static_cast<double>(kCookieSide);
      const glm::ivec2 first = glm::floor(texel - 0.6), last = glm::floor(texel + 0.6);
      if (block_code(first.x, first.y) != block_code(last.x, last.y)) continue;  // the sampler blends both
      ++compared;
      for (int c = 0; c < 3; ++c) {
        const auto code = static_cast<float>(block_code(first.x, first.y)[c]) / 255.0f;
        EXPECT_NEAR(colored[i][c] / plain[i][c], static_cast<double>(images::decode_srgb(code)), 2e-3)
            << "pixel " << i << ", texel " << texel.x << " " << texel.y;
      }
    }
    EXPECT_GT(lit, 3000);
    EXPECT_GT(compared, 4 * lit / 5);
  }
}

TEST(Cookie, HalfBlack_DarkensThatHalf) {
  CookieLight light(make_cookie_scene({0.0f, 4.0f, 0.0f}, {}));
  const std::vector<glm::dvec3> plain = light.draw(nullptr);
  const auto lower_half = [](int, int row) { return glm::ivec3(row < kCookieSide / 2 ? 255 : 0); };
  const std::vector<glm::dvec3> half = light.draw(make_cookie(lower_half));
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const double z = CookieLight::floor_at(i).z;
    if (std::abs(z) < 0.1) continue;  // a texel is 0.07 m wide there
    EXPECT_EQ(half[i], z > 0.0 ? plain[i] : glm::dvec3(0.0)) << "pixel " << i;
  }
}

TEST(Cookie, LightsNothingBehindTheLamp) {
  CookieLight ahead(make_cookie_scene({0.0f, 4.0f, 0.0f}, {})),
      behind(make_cookie_scene({0.0f, 4.0f, 0.0f}, {0.0f, 8.0f, 0.0f}));
  const auto is_dark = [](const std::vector<glm::dvec3>& light) {
    return std::all_of(light.begin(), light.end(), [](const glm::dvec3& c) { return c == glm::dvec3(0.0); });
  };
  EXPECT_FALSE(is_dark(ahead.draw(make_cookie(white_code))));
  EXPECT_TRUE(is_dark(behind.draw(make_cookie(white_code)))) << "the floor faces the lamp, which shines upwards";
}

TEST(BackProjection, MirrorsConeAndMapThroughTheLamp) {
  const scene::Scene shines_up = make_cookie_scene({0.0f, 4.0f, 0.0f}, {0.0f, 8.0f, 0.0f});
  CookieLight right(shines_up), wrong(shines_up, {filters::Border::kBorder, true, false}),
      ahead(make_cookie_scene({0.0f, 4.0f, 0.0f}, {}));
  for (const char* filter : {"none", "tent3x3", "pcss", "vsm"}) {
    EXPECT_EQ(right.measure_lit(filter), 0.0) << filter;
    EXPECT_NEAR(wrong.measure_lit(filter), ahead.measure_lit(filter), 0.01) << filter;
  }
  EXPECT_GT(ahead.measure_lit("none"), 0.2);
  const auto mirrored = wrong.draw(make_cookie(white_code)), lit = ahead.draw(make_cookie(white_code));
  for (std::size_t i = 0; i < lit.size(); ++i) EXPECT_NEAR(mirrored[i].g, lit[i].g, 1e-4) << "pixel " << i;
}

TEST(Cookie, OfWhite_ChangesNoBit_AndIsOneVariantMore) {
  CookieLight light(make_cookie_scene({0.0f, 4.0f, 0.0f}, {}));
  const std::vector<glm::dvec3> plain = light.draw(nullptr);
  const int compiled = light.compiled();
  EXPECT_EQ(light.draw(make_cookie(white_code)), plain);
  EXPECT_EQ(light.compiled(), compiled + 1);
  light.draw(nullptr);
  EXPECT_EQ(light.compiled(), compiled + 1);
}

TEST(Cookie, ChangesNoVisibility) {
  const scene::Scene plain = load_builtin("lamp");
  scene::Scene colored = plain;
  std::get<scene::Spot>(colored.light.kind).cookie = make_cookie(block_code);
  Bench a(shared_context(), plain, 256, 160, 90), b(shared_context(), colored, 256, 160, 90);
  for (const filters::FilterRequest& request : catalogue().parse_requests("pcf2x2,vsm,pcss"))
    EXPECT_EQ(a.draw(request), b.draw(request)) << request.spec.id;
}

}  // namespace
}  // namespace shadowbench::test
