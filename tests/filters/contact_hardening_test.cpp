// Filters whose kernel is as wide as the penumbra, against closed forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "filters/catalogue.h"
#include "filters/model.h"
#include "filters/percentage_closer.h"

namespace shadowbench::filters {
namespace {

constexpr int kMapSide = 64;
constexpr float kFloor = 0.7f;

DepthMap make_map(const std::function<float(int x, int y)>& depth) {
  DepthMap map{kMapSide, {}};
  for (int i = 0; i < kMapSide * kMapSide; ++i) map.stored.push_back(depth(i % kMapSide, i / kMapSide));
  return map;
}

/// A receiver of the floor, with texels of 1 m and a depth of 100 m.
Receiver make_floor_receiver(double x, double y, float light_size) {
  Receiver r;
  r.uv = {static_cast<float>(x / kMapSide), static_cast<float>(y / kMapSide)};
  r.depth = r.depth_unbiased = kFloor;
  r.depth_range_ws = 100.0f;
  r.light_size = light_size;
  return r;
}

/// Looks receivers up by a filter.
class Filtered {
 public:
  Filtered(const std::string& text, const DepthMap& map)
      : request_(Catalogue(SHADOWBENCH_SOURCE_DIR "/filters").parse_requests(text).front()),
        lookup_(make_model(request_.spec)->prepare({request_.spec, request_.values, map, {}, 0}, Precision::kDouble)) {}

  double at(const Receiver& r) const { return lookup_->at(r).visibility; }
  double radius_at(const Receiver& r) const { return lookup_->at(r).disk_radius_texels; }

 private:
  FilterRequest request_;
  std::unique_ptr<Lookup> lookup_;
};

class ContactHardening : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Filters, ContactHardening, ::testing::Values("pcss", "dpcf"),
                         [](const auto& each) { return std::string(each.param); });

/// Filters with disks of up to 20 texels and the most taps.
class Penumbra : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Filters, Penumbra,
                         ::testing::Values("pcss:taps=32,max_radius=20,search_taps=32", "dpcf:taps=32,max_radius=20",
                                           "evssm:taps=8,max_radius=40,rotation=per-pixel",
                                           "smrt:rays=32,steps=32,max_radius=20,thickness=1"),
                         [](const auto& each) {
                           const std::string text = each.param;
                           return text.substr(0, text.find(':'));
                         });

TEST_P(ContactHardening, LightOfNoSize_EqualsHardShadow) {
  std::mt19937 random(3);
  const DepthMap map = make_map([&](int, int) { return static_cast<float>(random()) * 0x1p-32f; });
  const Filtered soft(GetParam(), map), hard("pcf2x2", map);
  for (int i = 0; i < 500; ++i) {
    const Receiver r = make_floor_receiver(2.0 + 0.12 * i, 61.0 - 0.11 * i, 0.0f);
    ASSERT_EQ(soft.at(r), hard.at(r)) << i;
  }
}

/// A ray to the centre of the light, and rays to a light without a size, compare with the receiver's own texel alone,
/// however many steps they take.
TEST(Smrt, OneRay_AndALightOfNoSize_EqualNoFilter) {
  std::mt19937 random(4);
  const DepthMap map = make_map([&](int, int) { return static_cast<float>(random()) * 0x1p-32f; });
  const Filtered hard("none", map);
  for (const char* text :
       {"smrt:rays=1", "smrt:rays=1,thickness=1,steps=32", "smrt:rays=1,steps=4", "smrt:thickness=1"}) {
    const Filtered traced(text, map);
    for (int i = 0; i < 2000; ++i) {
      Receiver r = make_floor_receiver(2.0 + 0.03 * i, 61.0 - 0.0275 * i, i % 2 == 0 ? 0.0f : 0.3f);
      if (std::string(text) == "smrt:thickness=1") r.light_size = 0.0f;
      ASSERT_EQ(traced.at(r), hard.at(r)) << text << ", " << i;
    }
  }
}

/// Where visibility, falling from light to dark, crosses a level; in texels.
double find_crossing(const std::function<double(double)>& visibility, double level) {
  double lit = 20.0, dark = -20.0;
  while (lit - dark > 0.01) {
    const double middle = 0.5 * (lit + dark);
    (visibility(middle) > level ? lit : dark) = middle;
  }
  return lit;
}

double find_width(const std::function<double(double)>& visibility) {
  return find_crossing(visibility, 0.9) - find_crossing(visibility, 0.1);
}

/// The disk light's penumbra below a straight edge: the share of a disk on one side of a line.
double share_of_disk(double t) {
  t = std::clamp(t, -1.0, 1.0);
  return 1.0 - (std::acos(t) - t * std::sqrt(1.0 - t * t)) / std::numbers::pi;
}

/// A half-plane over a floor that lies parallel to it.
TEST_P(Penumbra, OfAnEdge_IsAsWideAsTheLightMakesIt) {
  constexpr float kEdge = 0.3f;
  const DepthMap map = make_map([](int x, int) { return x < kMapSide / 2 ? kEdge : kFloor; });
  const Filtered soft(GetParam(), map);
  struct Case {
    float light_size, nearness;
  };
  // The last two are of lamps 100 m and 80 m away, 40 m of which lie between the edge and the floor.
  for (const auto& [light_size, nearness] :
       {Case{0.1f, 0.0f}, {0.2f, 0.0f}, {0.4f, 0.0f}, {0.2f, 0.01f}, {0.1f, 0.0125f}}) {
    const double above = static_cast<double>(kFloor - kEdge);
    const double radius =
        50.0 * static_cast<double>(light_size) * above / (1.0 - 100.0 * above * static_cast<double>(nearness));
    const auto seen = [&](double x) {
      double sum = 0.0;
      constexpr int kPixels = 200;
      for (int i = 0; i < kPixels; ++i) {
        Receiver r = make_floor_receiver(kMapSide / 2 + x, 32.3, light_size);
        r.light_nearness = nearness;
        r.pixel = {i, 7 * i};
        sum += soft.at(r);
      }
      return sum / kPixels;
    };
    const double expected = find_width([&](double x) { return share_of_disk(x / radius); });
    // Narrow ones are blurred by how single texels are read.
    EXPECT_NEAR(find_width(seen), expected, std::max(0.1 * expected, 0.35)) << "radius " << radius;
  }
}

TEST(Pcss, SaysWhichDiskItAveraged) {
  const DepthMap map = make_map([](int x, int) { return x < kMapSide / 2 ? 0.3f : 1.0f; });
  const Filtered pcss("pcss", map);
  EXPECT_NEAR(pcss.radius_at(make_floor_receiver(32.0, 32.3, 0.2f)), 50.0 * 0.2 * 0.4, 1e-4);
  EXPECT_NEAR(pcss.radius_at(make_floor_receiver(32.0, 32.3, 3.0f)), 12.0, 1e-6) << "its limit";
  EXPECT_EQ(pcss.radius_at(make_floor_receiver(32.0, 32.3, 0.0f)), 0.0) << "one fetch";
  EXPECT_EQ(pcss.radius_at(make_floor_receiver(60.0, 32.3, 0.2f)), 0.0) << "no blocker";
}

TEST_P(ContactHardening, EveryTap_IsBiasedByItsOwnDistance) {
  constexpr float kSlope = 0.015f;
  const DepthMap map = make_map([](int x, int) { return kFloor + kSlope * (static_cast<float>(x) - 31.5f); });
  const Filtered soft(GetParam(), map);
  Receiver r = make_floor_receiver(32.0, 32.0, 2.0f);
  r.depth -= kSlope;  // the reach of one fetch, which bias_texels declares
  const PercentageCloser closer(Kernel::make_disk(4.0), map, 0.0, PercentageCloser::Owner::kFewReceivers);
  EXPECT_LT(soft.at(r), 1.0);
  EXPECT_LT(closer.at(r), 1.0);
  r.bias_per_texel = {kSlope, 0.0f};
  EXPECT_EQ(soft.at(r), 1.0);
  EXPECT_EQ(closer.at(r), 1.0) << "what it is compared with";
}

}  // namespace
}  // namespace shadowbench::filters
