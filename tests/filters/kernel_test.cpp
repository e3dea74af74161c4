#include "filters/kernel.h"

#include "filters/front_matter.h"
#include "filters/percentage_closer.h"
#include "filters/screen.h"
#include "tests/filters/filtered.h"
#include "tests/test_files.h"

namespace shadowbench::filters {
namespace {

// Kernels: continuous shape and weights on the texel grid agree with each other, with the filters, and with closed
// forms.

Kernel kernel_of(const std::string& text) {
  const FilterRequest request = request_of(text);
  return find_kernel(request.spec, request.values).value();
}

TEST(KernelNames, TellKernelsApart) {
  std::set<std::string> names;
  for (const char* text :
       {"none", "pcf2x2", "box3x3", "tent3x3", "teach4x4", "box4x4", "tent4x4", "tent5x5", "tent7x7", "castano3",
        "castano5", "castano7", "poisson", "poisson:radius=2", "vsm", "vsm:radius=6", "esm:combine=log"})
    EXPECT_TRUE(names.insert(kernel_of(text).name()).second) << text;
  EXPECT_EQ(kernel_of("vsm").name(), kernel_of("esm").name()) << "one prefilter, one kernel";
  EXPECT_EQ(kernel_of("gather_pcf").name(), kernel_of("tent5x5").name());
  EXPECT_EQ(kernel_of("gather_pcf:radius=3,shape=castano").name(), kernel_of("castano7").name());
}

TEST(KernelNames, TellWeightsAndRadiiApart) {
  const auto name_of = [](double side) {
    return Kernel::make_grid({{-1.0, side}, {0.0, 1.0 - 2.0 * side}, {1.0, side}}, Reconstruction::kBilinear).name();
  };
  EXPECT_NE(name_of(0.25), name_of(0.125)) << "the same offsets";
  EXPECT_NE(Kernel::make_disk(3.0).name(), Kernel::make_disk(std::nextafter(3.0, 4.0)).name());
}

TEST(KernelWidths, AreTheShapeAndItsReconstruction) {
  EXPECT_TRUE(kernel_of("none").is_point());
  EXPECT_EQ(kernel_of("pcf2x2").half_width(), 1.0);
  EXPECT_EQ(kernel_of("tent3x3").half_width(), 1.5);
  EXPECT_EQ(kernel_of("box3x3").half_width(), 1.0) << "texels, as points";
  EXPECT_EQ(kernel_of("teach4x4").half_width(), 2.0);
  EXPECT_EQ(kernel_of("box4x4").half_width(), 2.0);
  EXPECT_EQ(kernel_of("tent5x5").half_width(), 3.0) << "half a texel more than the triangle";
  EXPECT_EQ(kernel_of("castano5").half_width(), 3.0);
  EXPECT_EQ(kernel_of("poisson:radius=3").half_width(), 4.0);
  EXPECT_EQ(kernel_of("vsm:radius=4").half_width(), 5.0);
  EXPECT_EQ(kernel_of("esm:radius=4,combine=log").half_width(), 4.0);
  EXPECT_EQ(kernel_of("poisson:radius=0").name(), kernel_of("pcf2x2").name());
}

// The front matter of every filter says as much as its kernel does: to the centre of the farthest texel that counts.
TEST(KernelWidths, ReachIsThatOfTheFrontMatter) {
  for (const FilterSpec& spec : built_in().filters()) {
    const ParamValues values = request_of(spec.id).values;
    const std::optional<Kernel> kernel = find_kernel(spec, values);
    if (!kernel) continue;
    const double own_texel = kernel->reconstruction() == Reconstruction::kNearest ? 0.5 : 0.0;
    EXPECT_EQ(reach_texels(spec, values), kernel->half_width() + own_texel) << spec.id;
  }
}

TEST(KernelWidths, AreTheStandardDeviationToTwoDigits) {
  const std::vector<std::pair<const char*, double>> known = {
      {"none", 0.29},     {"pcf2x2", 0.41},   {"tent3x3", 0.65},  {"box3x3", 0.87},
      {"box4x4", 0.91},   {"tent4x4", 0.68},  {"tent5x5", 1.06},  {"tent7x7", 1.46},
      {"castano3", 0.82}, {"castano5", 1.15}, {"castano7", 1.32}, {"teach4x4", 1.08},
      {"poisson", 1.55},  {"vsm", 1.90},      {"esm", 1.90},      {"esm:combine=log", 1.87}};
  for (const auto& [text, sigma] : known) EXPECT_NEAR(kernel_of(text).sigma_texels(), sigma, 0.005) << text;
}

TEST(WidthClasses, StandForTheirFilters_AndReachHalfWayToTheNextInRatio) {
  const auto& [sharp, medium, soft] = width_classes();
  EXPECT_EQ(sharp.sigma_texels, kernel_of("pcf2x2").sigma_texels());
  EXPECT_EQ(medium.sigma_texels, kernel_of("tent3x3").sigma_texels());
  EXPECT_EQ(soft.sigma_texels, kernel_of("poisson").sigma_texels());
  for (const auto& [text, name] : {std::pair("none", "sharp"),
                                   {"pcf2x2", "sharp"},
                                   {"tent3x3", "medium"},
                                   {"box4x4", "medium"},
                                   {"poisson:width=medium", "medium"},
                                   {"vsm:width=medium", "medium"},
                                   {"esm:width=medium", "medium"},
                                   {"vsm", "soft"}})
    EXPECT_EQ(find_width_class(kernel_of(text).sigma_texels())->name, name) << text;
  for (const WidthClass* each : {&sharp, &medium}) {
    const double next = each[1].sigma_texels;
    EXPECT_NEAR(each->widest_texels / each->sigma_texels, next / each->widest_texels, 1e-12);
    EXPECT_EQ(find_width_class(std::nextafter(each->widest_texels, 9.0)), each + 1);
  }
  EXPECT_EQ(find_width_class(soft.widest_texels), &soft);
  EXPECT_EQ(find_width_class(2.42), nullptr);
}

TEST(WidthClasses, AreReachedByEveryFilterWithARadius) {
  for (const char* filter : {"poisson", "vsm", "esm", "esm:combine=log"}) {
    const char separator = std::string(filter).find(':') == std::string::npos ? ':' : ',';
    for (const WidthClass& each : width_classes()) {
      const Kernel kernel = kernel_of(fmt::format("{}{}width={}", filter, separator, each.name));
      EXPECT_EQ(find_width_class(kernel.sigma_texels()), &each) << filter << " " << each.name;
    }
  }
  EXPECT_EQ(kernel_of("poisson:width=medium").disk_radius(), 1.0) << "exactly the tent's width";
  EXPECT_EQ(kernel_of("poisson:width=sharp").name(), kernel_of("pcf2x2").name());
}

TEST(LightWidth, IsThatOfADiskAsWideAsThePenumbra) {
  // A disk that is read bilinearly has the tent's 1/6 on top.
  const double disk = Kernel::make_disk(8.0).sigma_texels();
  EXPECT_NEAR(sigma_of_penumbra(16.0), std::sqrt(disk * disk - 1.0 / 6.0), 1e-6);
}

TEST(LightWidth, TakesTheNearestRadius_AndTheNarrowestWhereNoneIsSoNarrow) {
  const auto sigma_at = [](const char* filter, double wanted) {
    FilterRequest request = request_of(std::string(filter) + ":width=light");
    request.take_light_width(wanted);
    EXPECT_EQ(request.light_sigma_texels, wanted);
    return *find_kernel_sigma(request.spec, request.values);
  };
  for (const char* filter : {"poisson", "vsm", "esm", "evsm4"}) {
    EXPECT_NEAR(sigma_at(filter, 0.1), 0.41, 0.005) << filter;
    EXPECT_NEAR(sigma_at(filter, 5.0), 5.0, 0.25) << filter;
    EXPECT_GT(sigma_at(filter, 1e3), 15.0) << filter;
  }
}

/// Second moment of a kernel per axis, by a regular grid of samples.
double second_moment(const Kernel& kernel) {
  constexpr int kSteps = 1024, kBetween = 64;
  double sum = 0.0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const glm::dvec2 u((i % kSteps + 0.5) / kSteps, (i / kSteps + 0.5) / kSteps);
    const int j = (i * 37 + i / kSteps * 11) % (kBetween * kBetween);
    const glm::dvec2 offset = kernel.sample(u, {(j % kBetween + 0.5) / kBetween, (j / kBetween + 0.5) / kBetween});
    sum += 0.5 * glm::dot(offset, offset);
  }
  return sum / (kSteps * kSteps);
}

TEST(KernelSamples, HaveTheShapesSpread) {
  // Variances add under convolution: tent 1/6, two atoms at +-a a^2, three at -1, 0, 1 2/3, disk R^2/4.
  EXPECT_NEAR(second_moment(kernel_of("pcf2x2")), 1.0 / 6.0, 1e-3);
  EXPECT_NEAR(second_moment(kernel_of("tent3x3")), 1.0 / 4.0 + 1.0 / 6.0, 1e-3);
  EXPECT_NEAR(second_moment(kernel_of("box3x3")), 2.0 / 3.0, 2e-3);
  EXPECT_NEAR(second_moment(kernel_of("teach4x4")), 1.0 + 1.0 / 6.0, 1e-3);
  EXPECT_NEAR(second_moment(kernel_of("box4x4")), 2.0 / 3.0 + 1.0 / 6.0, 2e-3);
  EXPECT_NEAR(second_moment(kernel_of("tent5x5")), 2.5 * 2.5 / 6.0 + 1.0 / 12.0, 2e-3);
  EXPECT_NEAR(second_moment(kernel_of("castano7")), 82.0 / 52.0 + 1.0 / 6.0, 5e-3);
  EXPECT_NEAR(second_moment(kernel_of("poisson:radius=3")), 9.0 / 4.0 + 1.0 / 6.0, 0.01);
  double gaussian = 0.0;
  const Kernel vsm = kernel_of("vsm:radius=4");
  for (const Kernel::Atom& atom : vsm.atoms()) gaussian += atom.weight * atom.offset * atom.offset;
  EXPECT_NEAR(second_moment(vsm), gaussian + 1.0 / 6.0, 0.01);
  EXPECT_EQ(second_moment(kernel_of("none")), 0.0);
}

TEST(KernelSamples, AreCentred_AndTheirAxesAreIndependent) {
  for (const char* text :
       {"pcf2x2", "tent3x3", "tent5x5", "castano7", "poisson:radius=3", "vsm:radius=2", "esm:radius=2,combine=log"}) {
    const Kernel kernel = kernel_of(text);
    constexpr int kSteps = 24;
    glm::dvec2 mean(0.0), squares(0.0);
    double product = 0.0;
    for (int i = 0; i < kSteps * kSteps * kSteps * kSteps; ++i) {
      const auto coordinate = [&](int divisor) { return (i / divisor % kSteps + 0.5) / kSteps; };
      const glm::dvec2 offset = kernel.sample({coordinate(1), coordinate(kSteps)},
                                              {coordinate(kSteps * kSteps), coordinate(kSteps * kSteps * kSteps)});
      mean += offset;
      squares += offset * offset;
      product += offset.x * offset.y;
    }
    constexpr double kCount = 1.0 * kSteps * kSteps * kSteps * kSteps;
    const double deviation = 0.01 * std::sqrt(squares.x / kCount);
    EXPECT_NEAR(mean.x / kCount, 0.0, deviation) << text;
    EXPECT_NEAR(mean.y / kCount, 0.0, deviation) << text;
    EXPECT_NEAR(product / squares.x, 0.0, 0.01) << text;
    EXPECT_NEAR(squares.y / squares.x, 1.0, 0.01) << text;
  }
}

/// Filters that compare are their own brute-force percentage-closer filter.
TEST(PercentageCloser, EqualsTheModelsThatCompare) {
  const DepthMap map = make_random_map(32, 5);
  std::mt19937 random(6);
  for (const char* text :
       {"none", "pcf2x2", "box3x3", "tent3x3", "teach4x4", "box4x4", "tent4x4", "tent5x5", "tent7x7", "castano3",
        "castano5", "castano7", "gather_pcf:radius=1", "gather_pcf", "gather_pcf:radius=3",
        "gather_pcf:shape=castano,radius=1", "gather_pcf:shape=castano", "gather_pcf:shape=castano,radius=3"}) {
    const Filtered filtered(text, map);
    const PercentageCloser closer(kernel_of(text), map);
    for (int i = 0; i < 2000; ++i) {
      const auto coordinate = [&] { return -2.0 + 36.0 * static_cast<double>(random()) * 0x1p-32; };
      const Receiver r = make_receiver_at(map, coordinate(), coordinate(), static_cast<float>(random()) * 0x1p-32f);
      const ModelResult result = filtered.find(r);
      if (result.excused) continue;
      ASSERT_NEAR(closer.at(r), result.visibility, 1e-12) << text;
    }
  }
}

/// On a map of depths 0 and 1 the mean depth is the share that is lit: VSM's first moment, ESM's mean of exponentials.
TEST(PercentageCloser, HasTheWeightsOfThePrefilter) {
  DepthMap map = make_random_map(48, 7);
  for (float& depth : map.stored) depth = depth < 0.5f ? 0.0f : 1.0f;
  for (const char* text :
       {"esm:c=20,radius=3", "esm:c=20,radius=6", "esm:c=20,radius=0", "esm:c=20,radius=3,combine=log"}) {
    const Filtered filtered(text, map);
    const PercentageCloser closer(kernel_of(text), map);
    for (int i = 0; i < 200; ++i) {
      const double x = 12.3 + 0.11 * i, y = 30.7 - 0.07 * i;
      // With the receiver at depth 1, ESM is the mean of exp(-c (1 - z)), which is w + (1 - w) e^-c.
      const Receiver r = make_receiver_at(map, x, y, 1.0f);
      ASSERT_NEAR(closer.at(r), filtered.at(r), 1e-6) << text << i;
    }
  }
}

TEST(PercentageCloser, OfADisk_IsExactlyLit_WhereNothingBlocks) {
  const DepthMap map{32, std::vector<float>(32 * 32, 0.5f)};
  const PercentageCloser closer(kernel_of("poisson:radius=3"), map);
  for (int i = 0; i < 50; ++i) {
    const double x = 16.0 + 0.13 * i, y = 15.0 - 0.07 * i;
    ASSERT_EQ(closer.at(make_receiver_at(map, x, y, 0.5f)), 1.0) << "a tie is lit";
    ASSERT_EQ(closer.at(make_receiver_at(map, x, y, 0.75f)) > 0.0, x + 4.5 > 32.0) << "outside the map the depth is 1";
  }
}

TEST(DiskWeights, InsideTheDisk_AreItsDensity_AndSumToOne) {
  for (const double radius : {0.3, 1.0, 3.0, 17.5, 64.0}) {
    const DiskWeights weights(radius);
    const double density = 1.0 / (std::numbers::pi * radius * radius);
    if (radius > 2.0) EXPECT_NEAR(weights.at(0.2, -0.3), density, 1e-9);
    EXPECT_EQ(weights.at(radius + 1.0, 0.0), 0.0);
    for (const double shift : {0.0, 0.31, 0.5}) {
      double sum = 0.0;
      const int reach = static_cast<int>(radius) + 3;
      for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) sum += weights.at(x + shift, y + 0.7 * shift);
      EXPECT_NEAR(sum, 1.0, 2e-4) << radius << " " << shift;
    }
  }
}

TEST(PercentageCloser, Border_SaysWhatLiesOutside) {
  // All blocked inside; a point that reads one texel beyond each side.
  DepthMap map{8, std::vector<float>(64, 0.25f)};
  Receiver r;
  r.uv = {-0.06f, 1.06f};
  r.depth = 0.5f;
  const Kernel point = Kernel::make_point(Reconstruction::kNearest), disk = Kernel::make_disk(2.0);
  EXPECT_EQ(PercentageCloser(point, map).at(r), 1.0);
  EXPECT_GT(PercentageCloser(disk, map).at(r), 0.5);
  for (const Border border : {Border::kEdge, Border::kRepeat}) {
    map.border = border;
    EXPECT_EQ(PercentageCloser(point, map).at(r), 0.0);
    EXPECT_NEAR(PercentageCloser(disk, map).at(r), 0.0, 1e-12);
  }
}

// Screen passes as a filter's file declares them, and what their models share.

std::string write_screens(const std::string& tables, const std::string& glsl) {
  return write_filter(tables,
                      "float visibility(Receiver r) { return compare_nearest(r, vec2(0.0), r.depth); }\n" + glsl);
}

constexpr const char* kBlur = "vec2 blur(ScreenInput s) { return load_screen(s, ivec2(0)); }\n";

TEST(ScreenSpec, IsRead_InTheOrderOfTheFile) {
  const FilterSpec spec = parse_filter(
      write_screens(
          "[param.far]\ndefault = 2\nmin = 0\nmax = 64\ntext = \"t\"\n[screen.blur]\nreach = \"far\"\nsteps = 8\n"
          "[screen.after]\n",
          std::string(kBlur) + "vec2 after(ScreenInput s) { return vec2(0.0); }\n"),
      "f.glsl");
  ASSERT_EQ(spec.screens.size(), 2u);
  EXPECT_EQ(spec.screens[0].steps, 8);
  EXPECT_EQ(reach_pixels(spec.screens[0], {{"far", 7.0}}), 7);
  EXPECT_EQ(spec.screens[1], (ScreenSpec{.name = "after", .line = 13}));
  EXPECT_EQ(list_screens(spec, {}).size(), 2u) << "without a parameter 'screen' all are drawn";
}

TEST(ScreenSpec, ChosenByAParameter_IsTheOneDrawn) {
  const FilterSpec spec = parse_filter(
      write_screens("[param.screen]\ndefault = \"none\"\nchoices = [\"none\", \"blur\"]\ntext = \"t\"\n[screen.blur]\n",
                    kBlur),
      "f.glsl");
  EXPECT_TRUE(list_screens(spec, {{"screen", std::string("none")}}).empty());
  EXPECT_EQ(list_screens(spec, {{"screen", std::string("blur")}}).size(), 1u);
}

TEST(ScreenSpec, ThatIsWrong_IsRefusedWithItsLine) {
  struct Case {
    std::string tables, glsl, message;
  };
  const std::string number = "[param.far]\ndefault = 2\nmin = 0\nmax = ";
  for (const Case& each : {
           Case{"[screen.blur]\nreach = 500\n", kBlur, "within 0 .. 64"},
           Case{"[screen.blur]\nreach = -1\n", kBlur, "'reach' must not be negative"},
           Case{"[screen.blur]\nreach = 1.5\n", kBlur, "whole number of pixels"},
           Case{number + "65\ntext = \"t\"\n[screen.blur]\nreach = \"far\"\n", kBlur, "within 0 .. 64"},
           Case{"[screen.blur]\nreach = \"far\"\n", kBlur, "far"},
           Case{"[screen.blur]\nsteps = 9\n", kBlur, "steps"},
           Case{"[screen.blur]\nwidth = 1\n", kBlur, "width"},
           Case{"[screen.blur]\n", "", "lacks 'vec2 blur(ScreenInput s)'"},
           Case{"[screen.visibility]\n", "", "'visibility' is the name of something else"},
           Case{"[param.screen]\ndefault = \"none\"\nchoices = [\"none\"]\ntext = \"t\"\n[screen.blur]\n", kBlur,
                "'screen' has no choice 'blur'"},
       }) {
    SCOPED_TRACE(each.tables);
    EXPECT_THAT(error_of([&] { parse_filter(write_screens(each.tables, each.glsl), "f.glsl"); }),
                is_error(ErrorKind::kFilter, "f.glsl:", each.message));
  }
}

TEST(ScreenPicture, OfLayers_TakesPartWhereAllWereAsked) {
  ScreenPicture picture(2, 1);
  Receiver whole, half;
  whole.pixel = {0, 0};
  whole.layer_share = 0.25f;
  picture.add(whole, {.visibility = 1.0, .screen_value = 4.0});
  whole.layer_share = 0.75f;
  picture.add(whole, {.visibility = 0.0, .bound = 0.1, .excused = true});
  half.pixel = {1, 0};
  half.layer_share = 0.5f;
  picture.add(half, {.visibility = 1.0});
  ASSERT_NE(picture.find({0, 0}), nullptr);
  const ModelResult& result = picture.find({0, 0})->result;
  EXPECT_DOUBLE_EQ(result.visibility, 0.25);
  EXPECT_DOUBLE_EQ(result.screen_value, 1.0);
  EXPECT_DOUBLE_EQ(result.bound, 0.075);
  EXPECT_TRUE(result.excused);
  for (const glm::ivec2 absent : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(2, 0), glm::ivec2(0, 1)})
    EXPECT_EQ(picture.find(absent), nullptr);
}

TEST(NearOnSurface, FallsWithDistance_AndAtSilhouettes) {
  Receiver here, there;
  here.position_ws = there.position_ws = {0.0f, 0.0f, 0.0f};
  EXPECT_EQ(near_on_surface(here, there, 1.0), 1.0);
  there.position_ws.x = 0.5f;
  EXPECT_EQ(near_on_surface(here, there, 1.0), 0.75);
  EXPECT_EQ(near_on_surface(here, there, 0.5), 0.0);
  there.position_ws.y = 0.25f;
  EXPECT_EQ(near_on_surface(here, there, 1.0), 0.0) << "off the plane";
  there.position_ws.y = 0.0f;
  there.normal_ws = {1.0f, 0.0f, 0.0f};
  EXPECT_EQ(near_on_surface(here, there, 1.0), 0.0) << "faces another way";
}

}  // namespace
}  // namespace shadowbench::filters
