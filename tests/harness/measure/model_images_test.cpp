// Scalar models over a view: rows are turned, both stations are asked, and excused receivers are counted.

#include "harness/measure/model_images.h"

#include <gtest/gtest.h>

namespace shadowbench::measure {
namespace {

constexpr int kImageWidth = 3, kImageHeight = 4;

filters::Receiver make_receiver(int x, int y, float depth) {
  filters::Receiver r;
  r.uv = {0.55f, 0.45f};
  r.depth = r.depth_unbiased = depth;
  r.pixel = {x, y};
  return r;
}

ModelImages evaluate(const ModelReceivers& receivers) {
  static const filters::Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  static const filters::DepthMap map{4, std::vector<float>(16, 0.5f)};
  return evaluate_model(catalogue.parse_requests("none").front(), map, receivers, 0.0, 1, kImageWidth, kImageHeight);
}

TEST(ModelImages, HaveTheirTopRowFirst_AndAreLitWhereThereIsNoReceiver) {
  // GL counts rows from below: (2, 0) is the last pixel of the image, (0, 3) its first.
  const std::vector<filters::Receiver> blocked = {make_receiver(2, 0, 0.75f), make_receiver(0, 3, 0.75f),
                                                  make_receiver(1, 2, 0.25f)};
  const ModelImages images = evaluate({blocked, blocked});
  std::vector<double> expected(kImageWidth * kImageHeight, 1.0);
  expected.front() = expected.back() = 0.0;
  EXPECT_EQ(images.model, expected);
  EXPECT_EQ(images.closer, expected);
  EXPECT_EQ(images.excused, 0);
}

TEST(ModelImages, AskEachStationWithItsOwnBias) {
  const ModelImages images = evaluate({{make_receiver(1, 1, 0.75f)}, {make_receiver(1, 1, 0.25f)}});
  constexpr std::size_t kPixel = 2 * kImageWidth + 1;
  EXPECT_EQ(images.model[kPixel], 0.0);
  EXPECT_EQ(images.closer[kPixel], 1.0);
}

TEST(ModelImages, CountWhatIsExcused) {
  const std::vector<filters::Receiver> receivers = {make_receiver(0, 0, 0.5f), make_receiver(1, 0, 0.25f),
                                                    make_receiver(2, 0, 0.5f)};
  EXPECT_EQ(evaluate({receivers, receivers}).excused, 2) << "ties";
}

}  // namespace
}  // namespace shadowbench::measure
