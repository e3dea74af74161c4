// Scalar models over a view: rows are turned, excused receivers are counted.

#include "harness/measure/view_receivers.h"

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

using Receivers = std::vector<filters::Receiver>;

ModelLayer make_grey_layer(const Receivers& receivers) { return {{4, std::vector<float>(16, 0.5f)}, receivers}; }

constexpr ModelView kView{kImageWidth, kImageHeight};

ModelImages evaluate(const std::vector<ModelLayer>& layers) {
  static const filters::Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  return evaluate_model(catalogue.parse_requests("none").front(), layers, kView);
}

std::vector<double> compare(const std::vector<ModelLayer>& layers) {
  return compare_kernel(filters::Kernel::make_point(filters::Reconstruction::kNearest), layers, kView);
}

TEST(ModelImages, HaveTheirTopRowFirst_AndAreLitWhereThereIsNoReceiver) {
  // GL counts rows from below: (2, 0) is the last pixel of the image, (0, 3) its first.
  const std::vector<filters::Receiver> blocked = {make_receiver(2, 0, 0.75f), make_receiver(0, 3, 0.75f),
                                                  make_receiver(1, 2, 0.25f)};
  const ModelImages images = evaluate({make_grey_layer(blocked)});
  std::vector<double> expected(kImageWidth * kImageHeight, 1.0);
  expected.front() = expected.back() = 0.0;
  EXPECT_EQ(images.model, expected);
  EXPECT_EQ(compare({make_grey_layer(blocked)}), expected);
  EXPECT_EQ(images.excused, 0);
}

TEST(ModelImages, CountWhatIsExcused) {
  const std::vector<filters::Receiver> receivers = {make_receiver(0, 0, 0.5f), make_receiver(1, 0, 0.25f),
                                                    make_receiver(2, 0, 0.5f)};
  EXPECT_EQ(evaluate({make_grey_layer(receivers)}).excused, 2) << "ties";
}

TEST(ModelImages, AddWhatLayersMakeOfTheirShares) {
  const auto share = [](float of, float depth) {
    filters::Receiver r = make_receiver(1, 1, depth);
    r.layer_share = of;
    return make_grey_layer({r});
  };
  constexpr std::size_t kPixel = 2 * kImageWidth + 1;
  const std::vector<ModelLayer> layers = {share(0.25f, 0.75f), share(0.75f, 0.25f)};
  EXPECT_EQ(evaluate(layers).model[kPixel], 0.75);
  EXPECT_EQ(compare(layers)[kPixel], 0.75);
  EXPECT_EQ(evaluate({share(0.25f, 0.75f), share(0.75f, 0.75f)}).model[kPixel], 0.0);
}

}  // namespace
}  // namespace shadowbench::measure
