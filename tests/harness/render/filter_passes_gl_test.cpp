// Passes that a filter declares itself, against the same numbers made in its lookup: such a filter gives 1 where they
// agree and 0 elsewhere.

// The prefilter against the same sums in single precision, term by term, and what it reads outside the map.

// Filter passes that take other parameters draw what new passes draw.

// What a paper says of the memory of prefiltered maps.

#include "filters/front_matter.h"
#include "filters/kernel.h"
#include "tests/harness/render/bench_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

constexpr int kPassSide = 128;

struct Checked {
  const char* name;
  const char* passes;
  const char* glsl;  ///< has `bool agrees(Receiver r, ivec2 own)`, own being the receiver's texel
  int passes_run;
  double allowed = 0.0;  ///< share of receivers that may disagree
  int side = kPassSide;  ///< of the map, texels
};

filters::FilterRequest make_request(const Checked& checked) {
  return filters::request_of_file(
      filters::write_filter(
          std::string("radius_texels = 8\n") + checked.passes,
          std::string(checked.glsl) +
              "float visibility(Receiver r) { return agrees(r, ivec2(r.uv / map_texel_uv)) ? 1.0 : 0.0; }\n"),
      "checked.glsl");
}

const Checked kPrefix{"Prefix", "[pass.sums]\nstore = \"r32ui\"\nsteps = \"prefix\"\n",
                      R"(uint steps_of(ivec2 t) { return uint(load_depth(t) * 65536.0); }
uvec4 sums(PassInput p) {
  if (p.step == 0) return uvec4(steps_of(p.texel));
  uvec4 sum = load_sums(p.texel);
  for (int i = 1; i < 4; ++i) {
    ivec2 before = p.texel - i * p.stride * p.direction;
    if (min(before.x, before.y) >= 0) sum += load_sums(before);
  }
  return sum;
}
bool agrees(Receiver r, ivec2 own) {
  uint sum = 0u;
  for (int y = -2; y <= 2; ++y) for (int x = -2; x <= 2; ++x) sum += steps_of(own + ivec2(x, y));
  uint table = load_sums(own + 2).x - load_sums(own + ivec2(-3, 2)).x - load_sums(own + ivec2(2, -3)).x + load_sums(own - 3).x;
  return min(own.x, own.y) < 3 || max(own.x, own.y) > textureSize(map_depth, 0).x - 3 || table == sum;
})",
                      2 + 1 + 2 * 4};

const Checked kLevels{"Levels", "[pass.farthest]\nstore = \"r32f\"\nsteps = \"levels\"\n",
                      R"(vec4 farthest(PassInput p) {
  if (p.step == 0) return vec4(load_depth(p.texel));
  ivec2 t = 2 * p.texel;
  int below = p.step - 1;
  return max(max(load_farthest(t, below), load_farthest(t + ivec2(1, 0), below)),
             max(load_farthest(t + ivec2(0, 1), below), load_farthest(t + 1, below)));
}
bool agrees(Receiver r, ivec2 own) {
  ivec2 block = own / 8;
  float largest = 0.0;
  for (int y = 0; y < 8; ++y) for (int x = 0; x < 8; ++x) largest = max(largest, load_depth(8 * block + ivec2(x, y)));
  vec2 to_middle = (vec2(own / 8 * 8) + 4.0) - r.uv / map_texel_uv;
  return load_farthest(block, 3).x == largest && load_farthest(ivec2(0), 7).x == 1.0 &&
         abs(fetch_farthest_lod(r, to_middle, 3.0).x - largest) < 1e-4;
})",
                      2 + 8};

/// The same with a map of 96 texels: the side of the levels is the next power of two.
const Checked kLevelsOfAnySide{"LevelsOfAnySide", kLevels.passes, kLevels.glsl, kLevels.passes_run, 0.0, 96};

const Checked kHalf{"Half", "[pass.mean]\nstore = \"r32f\"\nsize = \"half\"\n",
                    R"(float mean_of(ivec2 t) {
  return 0.25 * (load_depth(t) + load_depth(t + ivec2(1, 0)) + load_depth(t + ivec2(0, 1)) + load_depth(t + 1));
}
vec4 mean(PassInput p) { return vec4(mean_of(2 * p.texel)); }
bool agrees(Receiver r, ivec2 own) {
  float expected = mean_of(own / 2 * 2);
  vec2 to_middle = vec2(own / 2 * 2 + 1) - r.uv / map_texel_uv;
  return load_mean(own / 2).x == expected && abs(fetch_mean(r, to_middle).x - expected) < 1e-4;
})",
                    2 + 1};

const Checked kAxes{"Axes", "[pass.box]\nstore = \"r32f\"\nsteps = \"axes\"\n",
                    R"(vec4 box(PassInput p) {
  if (p.step == 0) return vec4(load_depth(p.texel));
  return (load_box(p.texel - p.direction) + load_box(p.texel) + load_box(p.texel + p.direction)) / 3.0;
}
bool agrees(Receiver r, ivec2 own) {
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y) for (int x = -1; x <= 1; ++x) sum += load_depth(own + ivec2(x, y));
  return abs(load_box(own).x - sum / 9.0) < 1e-6;
})",
                    2 + 3};

/// Two maps, of which one is made from the other and from what encode() stored, and raw depth beside them.
const Checked kSeveral{"Several",
                       "store = \"rg32f\"\n[pass.squares]\nstore = \"r32f\"\n[pass.both]\nstore = \"rg32f\"\n",
                       R"(vec4 encode(EncodeInput e) { return vec4(e.depth, 1.0 - e.depth, 0.0, 0.0); }
vec4 squares(PassInput p) { return vec4(load_depth(p.texel) * load_depth(p.texel)); }
vec4 both(PassInput p) { return vec4(load_squares(p.texel).x, load_map(p.texel).y, 0.0, 0.0); }
bool agrees(Receiver r, ivec2 own) {
  float depth = load_depth(own);
  vec2 to_middle = vec2(own) + 0.5 - r.uv / map_texel_uv;
  return load_both(own).xy == vec2(depth * depth, 1.0 - depth) && load_map(own).x == depth &&
         fetch_depth(r, to_middle) == depth;
})",
                       2 + 1 + 2};

/// The mean of a ramp over any footprint is its value in the middle. llvmpipe 22.3 reads other texels for 0.8 % of
/// these receivers.
const Checked kFootprint{"Footprint", "[pass.mean]\nstore = \"r32f\"\nsteps = \"levels\"\nanisotropy = 8\n",
                         R"(vec4 mean(PassInput p) {
  if (p.step == 0) return vec4(float(p.texel.x));
  ivec2 t = 2 * p.texel;
  int finer = p.step - 1;
  return 0.25 * (load_mean(t, finer) + load_mean(t + ivec2(1, 0), finer) + load_mean(t + ivec2(0, 1), finer) +
                 load_mean(t + 1, finer));
}
bool agrees(Receiver r, ivec2 own) {
  float here = r.uv.x / map_texel_uv - 0.5;  // on a ramp every mean is the value in its middle
  bool inside = here > 12.0 && here < 116.0;
  float level = fetch_mean_grad(r, vec2(0.0), vec2(4.0, 0.0), vec2(0.0, 4.0)).x;
  float texel = load_mean(ivec2(r.uv / map_texel_uv) / 4, 2).x;
  bool is_level = fetch_mean_grad(r, vec2(own / 4 * 4) + 2.0 - r.uv / map_texel_uv, vec2(4.0, 0.0), vec2(0.0, 4.0)).x == texel;
  float along = fetch_mean_grad(r, vec2(0.0), vec2(8.0, 0.0), vec2(0.0, 1.0)).x;
  mat2 pixel = texels_per_pixel(r);
  vec4 next = texelFetch(receiver_places, r.pixel + ivec2(1, 0), 0);
  vec4 before = texelFetch(receiver_places, r.pixel - ivec2(1, 0), 0);
  vec2 right = (next.xy - r.uv) / map_texel_uv, left = (r.uv - before.xy) / map_texel_uv;
  bool is_step = distance(pixel[0], right) < 1e-3 || distance(pixel[0], left) < 1e-3;
  bool is_shorter = length(pixel[0]) <= min(next.w == mark_background ? 1e9 : length(right),
                                            before.w == mark_background ? 1e9 : length(left)) + 1e-3;
  bool at_edge = r.pixel.x == 0 || r.pixel.x == 159;
  return is_level && (!inside || (abs(level - here) < 0.3 && abs(along - here) < 0.3)) && (at_edge || (is_step && is_shorter));
})",
                         2 + 8, 0.02};

class OwnPasses : public ::testing::TestWithParam<Checked> {};

TEST_P(OwnPasses, WriteWhatTheyShould) {
  Bench bench(load_builtin("stack"), GetParam().side, 160, 90);
  const filters::FilterRequest request = make_request(GetParam());
  const std::vector<float> image = bench.draw(request);
  const auto receivers = bench.receivers(request);
  ASSERT_GT(receivers.size(), 1000u);
  std::size_t differing = 0;
  for (const filters::Receiver& r : receivers) differing += image[bench.index(r)] != 1.0f;
  EXPECT_LE(static_cast<double>(differing), GetParam().allowed * static_cast<double>(receivers.size()))
      << differing << " of " << receivers.size();
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  EXPECT_EQ(passes.measure_cost(bench.gbuffer(), bench.map()).passes, GetParam().passes_run);
}

INSTANTIATE_TEST_SUITE_P(Steps, OwnPasses,
                         ::testing::Values(kPrefix, kLevels, kLevelsOfAnySide, kHalf, kAxes, kSeveral, kFootprint),
                         [](const auto& each) { return std::string(each.param.name); });

struct Refused {
  const char* passes;
  std::string glsl;
  const char* where;
  const char* words;
};

TEST(RefusedPasses, AreNamedWithFileAndLine) {
  Bench bench(load_builtin("ball"), 96, 64, 36);
  const std::string agree = "bool agrees(Receiver r, ivec2 own) { return true; }\n";
  const Refused all[] = {
      {"[pass.first]\nstore = \"r32f\"\n[pass.second]\nstore = \"r32f\"\n",
       "vec4 first(PassInput p) { return vec4(load_second(p.texel)); }\nvec4 second(PassInput p) { return vec4(1.0); "
       "}\n",
       "checked.glsl:6", "reads the map 'second', which is not written yet"},
      {"[pass.first]\nstore = \"r32f\"\n", "vec4 first(PassInput p) { return load_first(p.texel); }\n",
       "checked.glsl:6", "reads the map 'first', which is not written yet"},
      {"store = \"r32f\"\n[pass.first]\nstore = \"r32f\"\n",
       "vec4 encode(EncodeInput e) { return load_first(ivec2(0)); }\nvec4 first(PassInput p) { return vec4(1.0); }\n",
       "checked.glsl:7", "encode() reads the map 'first', which is not written yet"}};
  for (const Refused& each : all) {
    const std::string glsl = each.glsl + agree;
    EXPECT_THAT(error_of([&] {
                  bench.draw(make_request({"", each.passes, glsl.c_str(), 0}));
                }),
                is_error(ErrorKind::kFilter, each.where, each.words));
  }
}

constexpr int kBlurredSide = 96;

/// Blurs one axis of a square image of one channel: every product and every sum rounded to float, in the kernel's
/// order. Texels nearer to the edge than the radius stay 0.
std::vector<float> blur(const std::vector<float>& from, int radius, int step_x, int step_y) {
  const std::vector<float> weights = filters::gaussian_weights(radius);
  std::vector<float> to(from.size(), 0.0f);
  for (int y = step_y * radius; y < kBlurredSide - step_y * radius; ++y) {
    for (int x = step_x * radius; x < kBlurredSide - step_x * radius; ++x) {
      float sum = 0.0f;
      for (int i = -radius; i <= radius; ++i)
        sum += weights[static_cast<std::size_t>(i + radius)] *
               from[static_cast<std::size_t>((y + i * step_y) * kBlurredSide + x + i * step_x)];
      to[static_cast<std::size_t>(y * kBlurredSide + x)] = sum;
    }
  }
  return to;
}

class Blur : public ::testing::TestWithParam<int> {};

TEST_P(Blur, IsTheSumOfItsTermsToTheBit) {
  const int radius = GetParam();
  Bench bench(load_builtin("fence"), kBlurredSide, 64, 36);
  const auto request = request_of("esm:radius=" + std::to_string(radius));
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  const std::vector<float> blurred = passes.encoded_map()->read();
  const std::vector<float> encoded = passes.encoded_map()->read_before_blur(bench.map());
  const std::vector<float> expected = blur(blur(encoded, radius, 1, 0), radius, 0, 1);
  for (int y = radius; y < kBlurredSide - radius; ++y)
    for (int x = radius; x < kBlurredSide - radius; ++x) {
      const auto i = static_cast<std::size_t>(y * kBlurredSide + x);
      ASSERT_EQ(blurred[i], expected[i]) << "radius " << radius << ", texel " << x << ", " << y;
    }
}

INSTANTIATE_TEST_SUITE_P(Radii, Blur, ::testing::Range(1, 17));

/// Every number of the filter at a step through its range, 0 .. 1; the others stay.
filters::FilterRequest at(filters::FilterRequest request, double step) {
  for (const filters::ParamSpec& param : request.spec.params) {
    if (param.is_const || !param.choices.empty() || !param.min) continue;
    const double value = *param.min + step * std::min(*param.max - *param.min, 24.0);
    request.values[param.name] = param.integer ? std::floor(value) : value;
  }
  return request;
}

class Retune : public ::testing::TestWithParam<const char*> {};

TEST_P(Retune, DrawsTheSameBitsAsNewPasses_ForEveryFilterAndLight) {
  const scene::Scene scene = load_builtin(GetParam());
  scene::Scene other = scene;
  other.light = scene::turn_light(
      other.light, [](const glm::vec3& way) { return glm::normalize(way + glm::vec3(0.3f, 0.0f, 0.0f)); });
  Bench bench(scene, 128, 96, 54), turned(other, 128, 96, 54);
  for (const filters::FilterRequest& request : built_in().parse_requests("all,teaching")) {
    SCOPED_TRACE(request.spec.id);
    render::FilterPasses passes(bench.shaders(), at(request, 0.0), bench.map(), bench.light(at(request, 0.0)));
    bench.draw(passes);
    for (Bench* each : {&bench, &turned}) {
      for (const double step : {0.5, 0.0, 1.0}) {  // a radius of 0, without a blur, in between
        const filters::FilterRequest changed = at(request, step);
        passes.retune(changed.values, each->light(changed));
        EXPECT_EQ(each->draw(passes), each->draw(changed)) << step;
      }
    }
  }
}

// On "edge" the map's edge cuts casters: what lies outside it is seen. The map of a lamp that was moved curves depth
// otherwise.
INSTANTIATE_TEST_SUITE_P(Scenes, Retune, ::testing::Values("fence", "edge", "lamp", "lantern"));

}  // namespace
}  // namespace shadowbench::test
