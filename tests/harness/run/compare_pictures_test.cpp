#include "harness/run/compare_pictures.h"

#include <OpenImageIO/imageio.h>

#include "harness/measure/scene_truth.h"
#include "report/images/picture_io.h"
#include "report/records/record_fields.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::run {

using namespace records;
namespace {

using images::Image;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Image make_image(int width, int height, int channels, std::vector<float> texels) {
  Image image(width, height, channels);
  image.texels = std::move(texels);
  return image;
}

/// Writes pictures into a folder of its own and compares them there.
class ComparePictures : public ::testing::Test {
 protected:
  void write(const std::string& name, const Image& image) const {
    std::vector<std::string> channels = {"Y"};
    if (image.channels > 1) channels = {"R", "G", "B", "A", "U"};
    channels.resize(static_cast<std::size_t>(image.channels));
    images::write_exr(path(name), {{"part", channels, image, false}}, {});
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  ComparisonOptions options(const std::string& image, const std::string& truth, const std::string& mask = "") const {
    ComparisonOptions options{path(image), path(truth), std::nullopt, metrics::picture_metrics(), 67.0};
    if (!mask.empty()) options.mask = path(mask);
    return options;
  }

  Comparison compare(const std::string& image, const std::string& truth, const std::string& mask = "") const {
    return compare_pictures(options(image, truth, mask));
  }

  /// Compares pictures that are written for it; an empty mask is none.
  Comparison compare(const Image& image, const Image& truth, const Image& mask = {}) const {
    write("a.exr", image);
    write("b.exr", truth);
    if (!mask.empty()) write("mask.exr", mask);
    return compare("a.exr", "b.exr", mask.empty() ? "" : "mask.exr");
  }

  void expect_refusal(const ComparisonOptions& options, const std::vector<std::string>& words) const {
    const Error error = error_of([&] { compare_pictures(options); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    for (const std::string& word : words) EXPECT_THAT(error.what(), HasSubstr(word));
  }

  /// Shadows of two widths.
  const Image narrow_ = make_visibility(48, 32, 3.0f), wide_ = make_visibility(48, 32, 12.0f);

 private:
  TestFolder folder_;
};

TEST_F(ComparePictures, SamePicture_HasNoError) {
  for (const auto& [name, value] : compare(shade(narrow_), shade(narrow_)).values) EXPECT_EQ(value, 0.0) << name;
}

TEST_F(ComparePictures, AllChannelsCount_AndAlphaDoesNot) {
  for (const Image& truth :
       {make_image(1, 1, 4, {0.0f, 0.0f, 0.25f, 0.0f}), make_image(1, 1, 3, {0.0f, 0.0f, 0.25f})}) {
    const Comparison result = compare(make_image(1, 1, 4, {0.5f, 0.0f, 0.0f, 1.0f}), truth);
    EXPECT_EQ(result.channels, 3);
    EXPECT_EQ(result.compared, 1);
    EXPECT_DOUBLE_EQ(result.values.at("mae"), 0.25) << truth.channels;
    EXPECT_DOUBLE_EQ(result.values.at("max"), 0.5) << truth.channels;
  }
}

TEST_F(ComparePictures, PixelsThatAreNotFinite_AreCountedAndLeftOut) {
  const Comparison result = compare(make_image(4, 1, 1, {0.5f, kNan, kInfinity, 0.0f}),
                                    make_image(4, 1, 1, {0.0f, 0.0f, kInfinity, -kInfinity}));
  EXPECT_EQ(result.compared, 1);
  EXPECT_EQ(result.not_finite, 3);
  EXPECT_DOUBLE_EQ(result.values.at("rmse"), 0.5);
  EXPECT_FALSE(result.values.contains("flip"));
  EXPECT_THAT(result.absent.at("flip"), HasSubstr("NaN"));
}

TEST_F(ComparePictures, PixelWithOneChannelNotFinite_IsLeftOutWhole) {
  const Comparison result = compare(make_image(2, 1, 3, {1.0f, kNan, 1.0f, 0.5f, 0.5f, 0.5f}),
                                    make_image(2, 1, 3, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}));
  EXPECT_EQ(result.compared, 1);
  EXPECT_EQ(result.not_finite, 1);
  EXPECT_DOUBLE_EQ(result.values.at("max"), 0.5);
}

TEST_F(ComparePictures, NothingFinite_HasNoValueAndSaysWhy) {
  const Comparison result = compare(make_image(1, 1, 1, {kNan}), make_image(1, 1, 1, {0.0f}));
  EXPECT_TRUE(result.values.empty());
  EXPECT_EQ(result.absent.size(), metrics::picture_metrics().size());
  for (const auto& [name, reason] : result.absent) EXPECT_THAT(reason, HasSubstr("finite")) << name;
}

TEST_F(ComparePictures, Mask_ChoosesThePixels) {
  const Comparison result =
      compare(make_image(3, 1, 1, {0.5f, 0.25f, kNan}), Image(3, 1, 1), make_image(3, 1, 1, {0.0f, -0.125f, 0.0f}));
  EXPECT_EQ(result.compared, 1);
  EXPECT_EQ(result.not_finite, 0);
  EXPECT_DOUBLE_EQ(result.values.at("rmse"), 0.25);
  EXPECT_THAT(result.absent.at("flip"), HasSubstr("NaN")) << "FLIP sees the whole picture";
}

TEST_F(ComparePictures, EmptyMask_HasNoValueAndSaysWhy) {
  const Image any = make_image(2, 1, 1, {0.5f, 0.25f});
  const Comparison result = compare(any, any, Image(2, 1, 1));
  EXPECT_TRUE(result.values.empty());
  EXPECT_EQ(result.absent.at("rmse"), "the mask is 0 everywhere");
  EXPECT_EQ(result.absent.at("flip"), "the mask is 0 everywhere");
}

TEST_F(ComparePictures, Flip_IsTheOneOfARun) {
  const Image a = shade(narrow_), b = shade(wide_);
  const double flip = compare(a, b).values.at("flip");
  EXPECT_DOUBLE_EQ(flip, *measure::measure_mean_flip(a, b));
  ComparisonOptions near = options("a.exr", "b.exr");
  near.pixels_per_degree = 10.0;
  EXPECT_DOUBLE_EQ(compare_pictures(near).values.at("flip"), *measure::measure_mean_flip(a, b, {}, 10.0));
  EXPECT_NE(compare_pictures(near).values.at("flip"), flip);
}

TEST_F(ComparePictures, FlipOverAMask_SeesTheWholePictureAndAveragesTheMask) {
  const Image a = shade(narrow_), b = shade(wide_);
  Image left(48, 32, 1), right(48, 32, 1);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 48; ++x) *(x < 20 ? left : right).at(x, y) = 1.0f;
  const double all = compare(a, b).values.at("flip"), of_left = compare(a, b, left).values.at("flip"),
               of_right = compare(a, b, right).values.at("flip");
  EXPECT_NE(of_left, of_right);
  EXPECT_NEAR((20.0 * of_left + 28.0 * of_right) / 48.0, all, 1e-12);
}

TEST_F(ComparePictures, FlipOfSrgbCodes_IsThatOfTheLinearPicture) {
  const Image a = shade(narrow_), b = shade(wide_);
  images::write_picture_png(path("a.png"), a);
  images::write_picture_png(path("b.png"), b);
  EXPECT_NEAR(compare("a.png", "b.png").values.at("flip"), *measure::measure_mean_flip(a, b), 2e-3) << "8 bits";
  EXPECT_TRUE(compare("a.png", "b.png").warnings.empty());
}

TEST_F(ComparePictures, SrgbCodesAgainstLinearValues_AreWarnedOf) {
  const Image a = shade(narrow_);
  write("a.exr", a);
  images::write_picture_png(path("a.png"), a);
  const Comparison result = compare("a.exr", "a.png");
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_THAT(result.warnings[0], HasSubstr("a.png holds sRGB codes"));
  EXPECT_LT(result.values.at("flip"), 0.02) << "8 bits";
  EXPECT_GT(result.values.at("rmse"), 0.05);
}

TEST_F(ComparePictures, OneChannel_IsGreyForFlip) {
  const auto to_rgb = [](const Image& grey) {
    Image rgb(grey.width, grey.height, 3);
    for (std::size_t i = 0; i < rgb.texels.size(); ++i) rgb.texels[i] = grey.texels[i / 3];
    return rgb;
  };
  EXPECT_DOUBLE_EQ(compare(narrow_, wide_).values.at("flip"),
                   *measure::measure_mean_flip(to_rgb(narrow_), to_rgb(wide_)));
}

TEST_F(ComparePictures, OtherChannelCounts_HaveNoFlip) {
  const Comparison result =
      compare(make_image(1, 1, 5, {0.0f, 0.0f, 0.0f, 0.0f, 0.5f}), make_image(1, 1, 5, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f}));
  EXPECT_DOUBLE_EQ(result.values.at("max"), 0.5);
  EXPECT_THAT(result.absent.at("flip"), HasSubstr("these have 4"));
}

TEST_F(ComparePictures, OnlyWhatIsAsked_IsMeasured) {
  write("a.exr", make_image(1, 1, 1, {0.5f}));
  ComparisonOptions two = options("a.exr", "a.exr");
  std::erase_if(two.metrics, [](const auto& metric) { return metric.name() != "mae" && metric.name() != "max"; });
  EXPECT_EQ(compare_pictures(two).values.size(), 2u);
}

TEST_F(ComparePictures, PicturesThatDoNotFit_AreRefused) {
  write("a.exr", Image(3, 2, 1));
  write("wide.exr", Image(4, 2, 1));
  write("high.exr", Image(3, 3, 1));
  write("rgb.exr", Image(3, 2, 3));
  expect_refusal(options("a.exr", "wide.exr"), {"a.exr has 3 x 2", "wide.exr has 4 x 2"});
  expect_refusal(options("a.exr", "high.exr"), {"a.exr has 3 x 2", "high.exr has 3 x 3"});
  expect_refusal(options("a.exr", "rgb.exr"), {"a.exr has 1 channels", "rgb.exr has 3"});
  expect_refusal(options("a.exr", "a.exr", "wide.exr"), {"wide.exr has 4 x 2", "a.exr has 3 x 2"});
  expect_refusal(options("a.exr", "a.exr", "rgb.exr"), {"the mask", "rgb.exr has 3 channels"});
}

TEST_F(ComparePictures, DataWindowsApart_AreRefused) {
  write("a.exr", Image(2, 1, 1));
  const auto output = OIIO::ImageOutput::create(path("moved.exr"));
  OIIO::ImageSpec spec(2, 1, 1, OIIO::TypeDesc::FLOAT);
  spec.x = 3;
  ASSERT_TRUE(output->open(path("moved.exr"), spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, Image(2, 1, 1).texels.data()) && output->close());
  expect_refusal(options("a.exr", "moved.exr"), {"a.exr begins at (0, 0)", "moved.exr at (3, 0)"});
}

TEST_F(ComparePictures, MaskThatIsNotFinite_IsRefused) {
  write("a.exr", make_image(2, 1, 1, {0.0f, 0.0f}));
  write("mask.exr", make_image(2, 1, 1, {1.0f, kNan}));
  expect_refusal(options("a.exr", "a.exr", "mask.exr"), {"mask.exr", "NaN"});
}

TEST(MeanFlip, PixelThatIsNotFinite_LeavesNone) {
  Image a(4, 4, 3), b(4, 4, 3);
  EXPECT_EQ(measure::measure_mean_flip(a, b), 0.0);
  b.texels[7] = kNan;
  EXPECT_FALSE(measure::measure_mean_flip(a, b));
  EXPECT_FALSE(measure::measure_mean_flip(b, a));
}

TEST(MeanFlip, EmptyMask_LeavesNone) {
  const Image a(4, 4, 3);
  EXPECT_FALSE(measure::measure_mean_flip(a, a, std::vector<std::uint8_t>(16, 0)));
}

TEST(MeanFlip, ValuesADisplayCannotShow_AreClamped) {
  Image a(4, 4, 3), b(4, 4, 3);
  std::fill(a.texels.begin(), a.texels.end(), 1.0f);
  std::fill(b.texels.begin(), b.texels.end(), 7.0f);
  EXPECT_EQ(measure::measure_mean_flip(a, b), 0.0);
}

TEST(MetricTable, NamesEveryNumberThatARunMeasures) {
  std::vector<std::string> listed, recorded;
  for (const metrics::Metric& metric : metrics::metric_table()) listed.emplace_back(metric.path);
  const CellRecord cell;
  visit_fields(cell, [&](const std::string& path, const auto&, const About& = {}) {
    for (const char* group : {"error.", "truth.", "coverage.", "artefact.", "penumbra.", "attribution.", "cost.",
                              "stability.", "map_scale.", "receivers", "nan"})
      if (path.rfind(group, 0) == 0 && !path.ends_with("_ci95") && !path.ends_with("_replicates"))
        recorded.push_back(path);
  });
  EXPECT_THAT(listed, ::testing::UnorderedElementsAreArray(recorded));
}

}  // namespace
}  // namespace shadowbench::run
