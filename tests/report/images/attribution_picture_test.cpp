#include "report/images/attribution_picture.h"

#include <gmock/gmock.h>

#include "report/images/color_values.h"
#include "report/images/picture_io.h"
#include "report/images/text.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {

using namespace records;
namespace {

Image make_constant(float value) {
  Image image(96, 54, 1);
  std::fill(image.texels.begin(), image.texels.end(), value);
  return image;
}

AttributionPicture make_picture() {
  AttributionPicture picture{"vsm on cubes", "view main", make_constant(0.1f), "RMSE 0.1", {}, {}};
  const float values[] = {0.0f, 0.2f, -0.15f, 0.05f};
  for (std::size_t i = 0; i < metrics::kErrorParts; ++i) {
    picture.parts[i] = make_constant(values[i]);
    picture.captions[i] = "share " + std::to_string(i);
  }
  return picture;
}

// How many pixels of the picture have a colour, within an 8-bit code.
int count_pixels(const Image& canvas, const images::Rgb& color) {
  int count = 0;
  for (std::size_t i = 0; i < canvas.texels.size(); i += 3) {
    bool equal = true;
    for (std::size_t c = 0; c < 3; ++c) equal = equal && std::abs(canvas.texels[i + c] - color[c]) < 0.5f / 255.0f;
    count += equal ? 1 : 0;
  }
  return count;
}

TEST(AttributionPicture, ErrorAndPartsShareOneScale) {
  const Image canvas = draw_attribution_picture(make_picture());
  const int panel = 384 * 216;  // four times 96 x 54
  for (const float value : {0.1f, 0.0f, 0.2f, -0.15f, 0.05f})
    EXPECT_GE(count_pixels(canvas, map_diverging(value, 0.2f)), panel) << value;
}

TEST(AttributionPicture, GivenScale_IsTaken) {
  AttributionPicture picture = make_picture();
  picture.scale = 1.0;
  EXPECT_GE(count_pixels(draw_attribution_picture(picture), map_diverging(0.2f, 1.0f)), 384 * 216);
}

TEST(AttributionPicture, LargestPart_IsNotSaturatedByWideFaintOnes) {
  AttributionPicture picture = make_picture();
  for (Image* image : {&picture.total, &picture.parts[0], &picture.parts[2], &picture.parts[3]})
    *image = make_constant(0.002f);
  picture.parts[1] = make_constant(0.0f);
  const int texels = 4 * 96;
  std::fill_n(picture.parts[1].texels.begin(), texels, 0.15f);
  EXPECT_GE(count_pixels(draw_attribution_picture(picture), map_diverging(0.15f, 0.2f)), texels * 16);
}

TEST(AttributionPicture, Captions_SayHowLargeAPartIs) {
  EXPECT_EQ(caption_part({0.01234, 0.714}), "RMS 0.0123, share 71 %");
  EXPECT_EQ(caption_part({std::nullopt, 0.714}), "share 71 %");
  EXPECT_EQ(caption_part({}), "");
  records::ErrorRecord error;
  error.rmse = 0.02;
  error.mean = -0.001;
  EXPECT_EQ(caption_total(error), "RMSE 0.02, mean signed -0.001");
}

TEST(AttributionPicture, File_HoldsTheDrawnPicture) {
  const TemporaryFolder folder("attribution_file");
  write_attribution_picture(folder.path() / "a.png", make_picture());
  const Image back = read_picture(folder.path() / "a.png");
  const Image drawn = draw_attribution_picture(make_picture());
  ASSERT_EQ(back.texels.size(), drawn.texels.size());
  for (std::size_t i = 0; i < drawn.texels.size(); ++i) ASSERT_NEAR(back.texels[i], drawn.texels[i], 0.51f / 255.0f);
}

}  // namespace
}  // namespace shadowbench::images
