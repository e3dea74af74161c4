#include "filters/front_matter.h"
#include "filters/store_format.h"
#include "harness/measure/stability_meter.h"
#include "harness/measure/view_receivers.h"
#include "tests/harness/scene/made_scenes.h"
#include "tests/test_files.h"

namespace shadowbench::measure {
namespace {

constexpr int kWidth = 40;
constexpr int kHeight = 30;

/// A light from straight above: u along x, v along -z, over `width_ws` around the origin.
scene::LightFrustum light_from_above(double width_ws, int map_size, float tilt_deg = 0.0f) {
  const double angle = glm::radians(static_cast<double>(tilt_deg));
  scene::LightFrustum frustum;
  frustum.width_ws = width_ws;
  frustum.texel_size_ws = width_ws / map_size;
  frustum.direction_ws = glm::vec3(std::sin(angle), -std::cos(angle), 0.0);
  const glm::dvec3 back(-glm::dvec3(frustum.direction_ws));
  const glm::dvec3 up(0.0, 0.0, -1.0), right = glm::cross(up, back);
  frustum.light_from_world = glm::dmat4(glm::transpose(glm::dmat3(right, up, back)));
  return frustum;
}

/// What a camera sees of the floor y = 0, pixel by pixel; all of it, as if it had no end.
ViewReceivers look_at_floor(const scene::Camera& camera) {
  const glm::dvec3 forward(camera.forward_ws), right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up_ws)));
  const glm::dvec3 up = glm::cross(right, forward);
  const bool flat = camera.orthographic_height_m > 0.0f;
  const double half = flat ? 0.5 * static_cast<double>(camera.orthographic_height_m)
                           : std::tan(0.5 * static_cast<double>(camera.vertical_fov_rad));
  ViewReceivers view{{kWidth, kHeight, {}}, {}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec3 across =
          half * ((2.0 * (x + 0.5) - kWidth) / kHeight * right + (1.0 - 2.0 * (y + 0.5) / kHeight) * up);
      const glm::dvec3 origin = glm::dvec3(camera.position_ws) + (flat ? across : glm::dvec3(0.0));
      const glm::dvec3 ray = flat ? forward : forward + across;
      const glm::dvec3 hit = origin - ray * (origin.y / ray.y);
      view.image.points.push_back({glm::vec3(hit), {0.0f, 1.0f, 0.0f}, true});
      view.is_surface.push_back(1);
    }
  }
  return view;
}

images::Image half_filled_map(int size) {
  images::Image map(size, size, 1);
  for (std::size_t i = 0; i < map.texels.size(); ++i) map.texels[i] = i % 2 == 0 ? 0.5f : 1.0f;
  return map;
}

TEST(MapCoverage, OrthographicViewAlongTheLight_IsTexelAreaOverPixelArea) {
  // A pixel is 0.1 m wide, a texel 0.05 m; the view covers 4 m x 3 m of 12.8 m x 12.8 m.
  const scene::Camera camera = scene::look_down({0.0f, 5.0f, 0.0f}, 3.0f);
  const MapCoverage c =
      measure_coverage(look_at_floor(camera), camera, {{light_from_above(12.8, 256)}}, half_filled_map(256));
  EXPECT_NEAR(*c.record.texels_per_pixel, 4.0, 1e-4);
  EXPECT_NEAR(*c.record.fewest_texels_per_pixel, 4.0, 1e-4);
  EXPECT_NEAR(*c.record.map_used, 12.0 / (12.8 * 12.8), 1e-3);
  EXPECT_EQ(*c.record.map_filled, 0.5);
}

/// The sum of all footprints is the area that the picture's corners enclose, as the light sees it.
TEST(MapCoverage, PerspectiveFootprints_AddUpToWhatThePictureShows) {
  scene::Camera camera = scene::make_camera({0.0f, 2.0f, 3.0f}, {0.0f, -1.0f, -0.6f});
  camera.vertical_fov_rad = 0.7f;
  const ViewReceivers view = look_at_floor(camera);
  const scene::LightFrustum light = light_from_above(20.0, 256, 30.0f);
  const MapCoverage c = measure_coverage(view, camera, {{light}}, half_filled_map(256));
  const glm::dvec3 forward(camera.forward_ws), right(1.0, 0.0, 0.0), up = glm::cross(right, forward);
  const double t = std::tan(0.35);
  const auto hit = [&](double sx, double sy) {
    const glm::dvec3 ray = forward + t * (sx * kWidth / kHeight * right + sy * up);
    return glm::dvec3(camera.position_ws) - ray * (2.0 / ray.y);
  };
  const glm::dvec3 a = hit(-1, -1), b = hit(1, -1), d = hit(1, 1), e = hit(-1, 1);
  const double area = 0.5 * (glm::length(glm::cross(b - a, d - a)) + glm::length(glm::cross(d - a, e - a)));
  const double texels = area * std::cos(glm::radians(30.0)) / (light.texel_size_ws * light.texel_size_ws);
  double sum = 0.0;
  for (const float density : c.density.texels) sum += static_cast<double>(density);
  EXPECT_NEAR(sum, texels, 0.002 * texels);
  EXPECT_NEAR(*c.record.map_used * 256 * 256, texels, 0.03 * texels);
  EXPECT_LT(*c.record.fewest_texels_per_pixel, *c.record.texels_per_pixel);
}

TEST(MapCoverage, SurfacesTurnedAwayAndBackground_HaveNoSay) {
  const scene::Camera camera = scene::look_down({0.0f, 5.0f, 0.0f}, 3.0f);
  ViewReceivers view = look_at_floor(camera);
  for (std::size_t i = 0; i < view.image.points.size(); ++i) {
    view.image.points[i].counts = false;
    view.is_surface[i] = i % 2 == 0 ? 1 : 0;
  }
  const MapCoverage c = measure_coverage(view, camera, {{light_from_above(12.8, 256)}}, half_filled_map(256));
  EXPECT_FALSE(c.record.texels_per_pixel);
  EXPECT_FALSE(c.record.map_used);
  EXPECT_TRUE(c.record.map_filled);
  EXPECT_EQ(c.density.texels[0], 0.0f);
  EXPECT_EQ(c.density.texels[1], -1.0f);
}

/// The view is 4 m wide, the map 2 m: half of the columns and two thirds of the rows lie in it.
TEST(MapCoverage, ReceiversOutsideTheMap_HaveNoSay) {
  const scene::Camera camera = scene::look_down({0.0f, 5.0f, 0.0f}, 3.0f);
  const MapCoverage c =
      measure_coverage(look_at_floor(camera), camera, {{light_from_above(2.0, 64)}}, half_filled_map(64));
  EXPECT_NEAR(*c.record.map_used, 1.0, 1e-9);
  EXPECT_EQ(std::count_if(c.density.texels.begin(), c.density.texels.end(), [](float d) { return d > 0.0f; }), 20 * 20);
  EXPECT_EQ(c.density.texels[0], 0.0f);
}

/// Under a lamp a pixel covers what its corners, projected one by one, enclose.
TEST(MapCoverage, OfALamp_IsThatOfThePixelsCorners) {
  scene::LightFrustum frustum;
  scene::Light spot;
  spot.kind = scene::Spot{{0.6f, 3.0f, -0.8f}, {0.0f, 0.0f, 0.2f}, 100.0f, 90.0f, 0.0f};
  const scene::Beam beam = *find_beam(spot);
  frustum.light_from_world = glm::dmat4(scene::light_rotation(beam.axis_ws));
  frustum.light_from_world[3] = frustum.light_from_world * glm::dvec4(-beam.position_ws, 1.0);
  frustum.direction_ws = glm::vec3(beam.axis_ws);
  frustum.perspective = scene::PerspectiveMap{beam, 1.0, 8.0};
  frustum.depth_range_ws = 7.0;
  frustum.texel_size_ws = 2.0 * 1.5 * beam.reference_m / 256;
  set_perspective(frustum, 1.5, {});
  const scene::Camera camera = scene::look_down({0.0f, 1.0f, 0.0f}, 0.0f);
  const ViewReceivers floor = look_at_floor(camera);
  const MapCoverage coverage = measure_coverage(floor, camera, {{frustum}}, half_filled_map(256));
  for (const int i : {0, 17, 20 * kWidth + 3, kWidth * kHeight - 1}) {
    const auto at = static_cast<std::size_t>(i);
    const glm::dvec3 p(floor.image.points[at].position_ws);
    // The camera looks straight down from 1 m: pixels are squares on the floor.
    const double half = std::tan(0.5 * static_cast<double>(camera.vertical_fov_rad)) / kHeight * 1e-3;
    const auto place = [&](double x, double z) { return glm::dvec2(frustum.place(p + glm::dvec3(x, 0.0, z), 256)); };
    const glm::dvec2 along_x = (place(half, 0.0) - place(-half, 0.0)) * 1e3,
                     along_z = (place(0.0, half) - place(0.0, -half)) * 1e3;
    const double area = std::abs(along_x.x * along_z.y - along_x.y * along_z.x);
    EXPECT_NEAR(static_cast<double>(coverage.density.texels[at]), area, 1e-4 * area) << i;
  }
}

double find(const scene::Scene& scene, int map_size) {
  options::RunOptions options;
  options.width = options.height = 96;
  const scene::EdgeMeter meter(scene);
  return find_light_sigma(meter, options, {scene, scene.light, scene.cameras.front(), map_size, 4.0}).value_or(-1.0);
}

TEST(LightSigma, IsAQuarterOfThePenumbraInTexels) {
  const scene::Scene scene = scene::make_sheet_over_floor();
  const double width_m = 2.0 * std::tan(glm::radians(0.5 * 0.53)) * 2.0 / std::sin(glm::radians(40.0));
  const double texel_m = scene::fit_light(scene, scene::FitMode::kTight, 1024, 4.0).texel_size_ws;
  EXPECT_NEAR(find(scene, 1024), 0.25 * width_m / texel_m, 0.006);
  EXPECT_NEAR(find(scene, 2048) / find(scene, 1024), 2.0, 0.02);
}

TEST(LightSigma, WithoutAShadow_IsAbsent) {
  scene::Scene scene = scene::make_sheet_over_floor();
  scene.meshes.pop_back();
  EXPECT_EQ(find(scene, 1024), -1.0);
}

/// A filter whose names no code knows: it stores exp(2 k z) and its square, over depths up to `deepest`.
filters::FilterRequest make_request(double k, const std::string& store, const std::string& combine = "linear") {
  filters::FilterRequest request = filters::request_of_file(filters::write_filter(
      "store = [\"rg32f\", \"rg16f\", \"rg16\"]\ncombine = [\"linear\", \"log\"]\nmoments = true\n"
      "exponent = \"k\"\nvariance_floor = \"least\"\nradius_texels = 0\n"
      "[param.k]\ndefault = 1.0\nmin = 0.5\nmax = 30.0\ntext = \"x\"\n"
      "[param.least]\ndefault = 1e-5\nmin = 0.0\nmax = 1e-3\ntext = \"x\"\n",
      "vec4 encode(EncodeInput e) { return vec4(0); }\nfloat visibility(Receiver r) { return 1.0; }\n", "bound"));
  request.values["k"] = k;
  request.values["store"] = store;
  request.values["combine"] = combine;
  return request;
}

/// What that filter's map would hold.
MapTrial make_map(double deepest, int* trials = nullptr) {
  return [=](const filters::ParamValues& values) {
    if (trials) ++*trials;
    const std::string store = filters::text_or(values, "store", "");
    const double exponent = 2.0 * 2.0 * filters::number(values, "k") * deepest;
    const bool logs = filters::combines_logs(values);
    const float stored = filters::round_to_store(static_cast<float>(logs ? exponent : std::exp(exponent)),
                                                 filters::store_precision(store));
    metrics::TexelHealth health{100, std::isinf(stored) ? 25 : 0, 0, std::nullopt, 0, 0.0};
    if (!std::isinf(stored)) health.largest = static_cast<double>(stored);
    return health;
  };
}

TEST(SafeExponent, IsTheTheoreticalLimit_WhateverTheExponentIsMadeOf) {
  for (const double deepest : {1.0, 0.8, 0.37}) {
    // Numbers up to 65520 round to 65504.
    const double theory = std::log(65520.0) / (4.0 * deepest);
    const auto safe = find_safe_exponent(make_request(20.0, "rg16f"), make_map(deepest));
    ASSERT_TRUE(safe);
    EXPECT_LE(*safe, theory);
    EXPECT_GT(*safe, 0.998 * theory) << deepest;
  }
  EXPECT_NEAR(*find_safe_exponent(make_request(20.0, "rg32f"), make_map(1.0)), 88.72 / 4.0, 0.02);
}

TEST(SafeExponent, OfASoundMap_IsTheSame) {
  EXPECT_EQ(find_safe_exponent(make_request(2.0, "rg16f"), make_map(1.0)),
            find_safe_exponent(make_request(20.0, "rg16f"), make_map(1.0)));
}

TEST(SafeExponent, StaysInItsRange) {
  EXPECT_EQ(find_safe_exponent(make_request(20.0, "rg32f"), make_map(0.1)), 30.0);
  EXPECT_FALSE(find_safe_exponent(make_request(20.0, "rg16f"), make_map(100.0)))
      << "even the smallest exponent overflows";
}

TEST(SafeExponent, OfLogarithms_IsNone) {
  EXPECT_FALSE(find_safe_exponent(make_request(20.0, "rg16f", "log"), make_map(1.0)));
}

TEST(Limits, Overflow_NamesTheLimitAndWhatKeepsIt) {
  const filters::FilterRequest request = make_request(20.0, "rg16f");
  const MapTrial map = make_map(1.0);
  const auto warnings = list_exceeded_limits("hall: odd", request, map(request.values), map);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0],
              AllOf(HasSubstr("hall: odd: 25 of its map's 100 texels (25 %) overflowed"),
                    HasSubstr("rg16f holds numbers up to 65504, which is e^11.09"), HasSubstr("choose k <= 2.77"),
                    HasSubstr("store=rg32f or combine=log"), Not(HasSubstr("rg16 "))));
}

/// At k = 25 the 32-bit store overflows too: what was tried and failed is not recommended.
TEST(Limits, RemediesThatFail_AreNotNamed) {
  const filters::FilterRequest request = make_request(25.0, "rg16f");
  const MapTrial map = make_map(1.0);
  const auto warnings = list_exceeded_limits("hall: odd", request, map(request.values), map);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], AllOf(Not(HasSubstr("rg32f")), HasSubstr("combine=log")));
}

TEST(Limits, SoundMap_HasNone_AndNothingIsTried) {
  int trials = 0;
  const filters::FilterRequest request = make_request(2.0, "rg16f");
  EXPECT_THAT(list_exceeded_limits("hall: odd", request, make_map(1.0)(request.values), make_map(1.0, &trials)),
              IsEmpty());
  EXPECT_EQ(trials, 0);
}

TEST(Limits, VarianceBeyondItsFloor_NamesTheFloorThatIsNeeded) {
  const auto map = [](const filters::ParamValues& values) {
    const bool half = filters::text_or(values, "store", "") == "rg16f";
    return metrics::TexelHealth{100, 0, 0, 1.0, 30, half ? -4.321e-4 : -1e-7};
  };
  const filters::FilterRequest request = make_request(2.0, "rg16f");
  const auto warnings = list_exceeded_limits("hall: odd", request, map(request.values), map);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], AllOf(HasSubstr("variance of 30 of its map's 100 texels below 0, down to -0.00043"),
                                 HasSubstr("least=1e-05"), HasSubstr("choose least >= 0.00044 or store=rg32f")));
  const filters::FilterRequest single = make_request(2.0, "rg32f");
  EXPECT_THAT(list_exceeded_limits("hall: odd", single, map(single.values), map), IsEmpty());
}

}  // namespace
}  // namespace shadowbench::measure
