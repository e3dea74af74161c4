// Bytes that lookups fetch through a cache: closed forms, for receivers that step over the map texel by texel.

#include "harness/measure/traffic_meter.h"

#include <gtest/gtest.h>

namespace shadowbench::measure {
namespace {

constexpr int kSide = 64;  // texels of the map, and pixels of most pictures
constexpr CacheShape kHoldsAll{1 << 20, 128}, kOneLine{128, 128};

std::vector<filters::FilterRequest> parse(const std::string& filters) {
  static const filters::Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  return catalogue.parse_requests(filters);
}

/// A receiver at the centre of a texel, lit by a map of depth 0.5.
filters::Receiver make_receiver(glm::ivec2 pixel, glm::ivec2 texel, int map_side = kSide) {
  filters::Receiver r;
  r.pixel = pixel;
  r.uv = (glm::vec2(texel) + 0.5f) / static_cast<float>(map_side);
  r.depth = r.depth_unbiased = 0.25f;
  return r;
}

ModelLayer make_layer(std::vector<filters::Receiver> receivers, int map_side = kSide) {
  return {{map_side, std::vector<float>(static_cast<std::size_t>(map_side * map_side), 0.5f)}, std::move(receivers)};
}

/// A receiver for every pixel, which lie so many texels apart in the map.
ModelLayer make_steps(int width, int height, int step_texels = 1, int map_side = kSide) {
  std::vector<filters::Receiver> receivers;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      receivers.push_back(make_receiver({x, y}, step_texels * glm::ivec2(x, y), map_side));
  return make_layer(std::move(receivers), map_side);
}

double count(const std::string& filter, const std::vector<ModelLayer>& layers, const CacheShape& cache,
             glm::ivec2 pixels = glm::ivec2(kSide)) {
  return count_map_traffic(parse(filter).front(), layers, {pixels.x, pixels.y}, {{cache}}).value().front();
}

TEST(MapTraffic, AMapThatIsReadOnce_IsFetchedOnce) {
  EXPECT_EQ(count("none", {make_steps(kSide, kSide)}, kHoldsAll), 4.0);
}

TEST(MapTraffic, OneTexelForAll_IsOneLine) {
  std::vector<filters::Receiver> receivers;
  for (int i = 0; i < kSide; ++i) receivers.push_back(make_receiver({i, i}, {5, 9}));
  EXPECT_EQ(count("none", {make_layer(receivers)}, kHoldsAll), 128.0 / kSide);
  EXPECT_EQ(count("none", {make_layer(receivers)}, kOneLine), 128.0 / kSide);
}

TEST(MapTraffic, CountsTheBytesOfTheMapsThatAreRead) {
  ModelLayer layer = make_steps(kSide, kSide);
  EXPECT_EQ(count("vsm", {layer}, kHoldsAll), 8.0) << "rg32f";
  EXPECT_EQ(count("vsm:store=rg16f", {layer}, kHoldsAll), 4.0);
  EXPECT_EQ(count("evsm4", {layer}, kHoldsAll), 16.0) << "rgba32f";
  EXPECT_EQ(count("evsm4:store=rgba16f", {layer}, kHoldsAll), 8.0);
  EXPECT_EQ(count("csm_conv", {layer}, kHoldsAll), 16.0) << "two maps of rgba16f";
  EXPECT_EQ(count("vsm_sat", {layer}, kHoldsAll), 8.0) << "a table of rg32ui";
  layer.map.texel_bytes = 2;
  EXPECT_EQ(count("none", {layer}, kHoldsAll), 2.0) << "d16";
  EXPECT_EQ(count("vsm", {layer}, kHoldsAll), 8.0) << "does not read the depth map";
}

TEST(MapTraffic, WiderKernelsReadTheSameMap_AndReadItAgainWhereTheCacheIsSmall) {
  const ModelLayer layer = make_steps(kSide, kSide);
  for (const char* filter : {"pcf2x2", "tent3x3", "box4x4", "tent7x7"}) {
    EXPECT_EQ(count(filter, {layer}, kHoldsAll), 4.0) << filter;
    EXPECT_GT(count(filter, {layer}, kOneLine), 4.0) << filter;
  }
  EXPECT_EQ(count("none", {layer}, kOneLine), 4.0) << "no two tiles share a line";
}

TEST(MapTraffic, MoreTapsNeverFetchLess) {
  constexpr int kStep = 3;
  constexpr double kMissed = 0.02;  // at most, of what lookups read that are not asked
  const ModelLayer layer = make_steps(kSide, kSide, kStep, kStep * kSide);
  for (const CacheShape& cache : {kHoldsAll, CacheShape{16 * 128, 128}, kOneLine, CacheShape{1 << 14, 64}}) {
    double fewer = 0.0;
    for (const char* filter : {"none", "pcf2x2", "tent3x3", "tent4x4", "tent5x5", "tent7x7"}) {
      const double bytes = count(filter, {layer}, cache);
      EXPECT_GE(bytes, (1.0 - kMissed) * fewer) << filter << ", a cache of " << cache.bytes;
      fewer = bytes;
    }
  }
}

TEST(MapTraffic, TilesGoRowByRow) {
  // A line is 16x16 texels here, so that two rows of tiles share each of eight lines.
  const ModelLayer layer = make_steps(2 * kSide, 16, 1, 2 * kSide);
  const auto fetched = [&](int lines) { return count("none", {layer}, {lines * 1024, 1024}, {2 * kSide, 16}); };
  EXPECT_EQ(fetched(8), 4.0);
  EXPECT_EQ(fetched(7), 8.0) << "the line that is needed next is the one that was just dropped";
  EXPECT_EQ(fetched(1), 8.0);
}

TEST(MapTraffic, TheLineThatWasNotReadForTheLongestTimeIsDropped) {
  std::vector<filters::Receiver> receivers;
  for (const int line : {0, 1, 0, 2, 0})
    receivers.push_back(make_receiver({8 * static_cast<int>(receivers.size()), 0}, {8 * line, 0}));
  EXPECT_EQ(count("none", {make_layer(receivers)}, {2 * 128, 128}, {40, 8}), 3.0 * 128.0 / 5.0);
}

TEST(MapTraffic, LayersAreDifferentMemory) {
  const ModelLayer one = make_layer({make_receiver({0, 0}, {0, 0})});
  const ModelLayer both = make_layer({make_receiver({0, 0}, {0, 0}), make_receiver({1, 0}, {1, 0})});
  EXPECT_EQ(count("none", {both}, kHoldsAll), 64.0);
  EXPECT_EQ(count("none", {one, one}, kHoldsAll), 128.0);
}

TEST(MapTraffic, NothingIsReadOutsideAMap) {
  ModelLayer layer = make_layer({make_receiver({0, 0}, {-9, 3}), make_receiver({1, 0}, {33, 33})});
  EXPECT_EQ(count("none", {layer}, kHoldsAll), 64.0);
  layer.map.border = filters::Border::kRepeat;
  EXPECT_EQ(count("none", {layer}, kHoldsAll), 128.0) << "a texel on the other side";
}

TEST(MapTraffic, AFewReceiversThatReadElsewhereAreSeen) {
  // All but one receiver of a tile read one texel.
  std::vector<filters::Receiver> receivers;
  for (int i = 0; i < 64; ++i) receivers.push_back(make_receiver({i % 8, i / 8}, {20, 20}));
  for (filters::Receiver& receiver : receivers) {
    const glm::vec2 uv = receiver.uv;
    receiver.uv = glm::vec2(0.9f);
    EXPECT_EQ(count("none", {make_layer(receivers)}, kHoldsAll, glm::ivec2(8)), 4.0);
    receiver.uv = uv;
  }
}

TEST(MapTraffic, WhereReceiversBringNothingNew_TheRestAreNotAsked_AndLittleIsMissed) {
  // The texels that the kernels cover are a square, and so are its lines.
  constexpr int kFirst = 3, kLast = kSide - 1 + 4, kShift = 32, kMap = 2 * kSide;
  ModelLayer layer = make_steps(kSide, kSide, 1, kMap);
  for (filters::Receiver& receiver : layer.receivers) receiver.uv += static_cast<float>(kShift) / kMap;
  const int columns = (kShift + kLast) / 8 - (kShift - kFirst) / 8 + 1;
  const int rows = (kShift + kLast) / 4 - (kShift - kFirst) / 4 + 1;
  const double bytes = count("tent7x7", {layer}, kHoldsAll), expected = columns * rows * 128.0 / (kSide * kSide);
  EXPECT_LE(bytes, expected);
  EXPECT_GE(bytes, 0.98 * expected);
}

TEST(MapTraffic, CachesAreCountedEachForItself) {
  const auto request = parse("tent3x3").front();
  const std::vector<ModelLayer> layers = {make_steps(kSide, kSide)};
  const std::vector<CacheShape> caches = {kOneLine, kHoldsAll, {1 << 20, 64}};
  const auto together = count_map_traffic(request, layers, {kSide, kSide}, caches).value();
  ASSERT_EQ(together.size(), caches.size());
  for (std::size_t i = 0; i < caches.size(); ++i) EXPECT_EQ(together[i], count("tent3x3", layers, caches[i]));
}

TEST(MapTraffic, IsNothingWithoutAModelOrAReceiver) {
  filters::FilterRequest request = parse("none").front();
  EXPECT_FALSE(count_map_traffic(request, {make_layer({})}, {kSide, kSide}, {{kHoldsAll}}));
  request.spec.id = "mine";
  EXPECT_FALSE(count_map_traffic(request, {make_steps(8, 8)}, {8, 8}, {{kHoldsAll}}));
}

/// Every lookup reads so often, of texels of one width, and so far.
double count_reads(const ModelLayer& layer, const PixelReads& reads, const CacheShape& cache) {
  const CountedLayer counted{layer.map, layer.receivers, std::vector<PixelReads>(kSide * kSide, reads)};
  return count_map_traffic({counted}, {kSide, kSide}, {{cache}}).value().front();
}

TEST(MapTraffic, ReadsThatWereCounted_FetchWhatAModelDoes) {
  const ModelLayer layer = make_steps(kSide, kSide);
  for (const CacheShape& cache : {kHoldsAll, CacheShape{16 * 128, 128}}) {
    EXPECT_DOUBLE_EQ(count_reads(layer, {{1, 0, 0}, 1.0}, cache), count("pcf2x2", {layer}, cache));
    EXPECT_NEAR(count_reads(layer, {{9, 0, 0}, 3.0}, cache), count("tent5x5", {layer}, cache), 0.05 * 4.0);
    EXPECT_NEAR(count_reads(layer, {{16, 0, 0}, 4.0}, cache), count("tent7x7", {layer}, cache), 0.05 * 4.0);
  }
  EXPECT_EQ(count_reads(layer, {{0, 1, 0}, 1.0}, kHoldsAll), count("vsm", {layer}, kHoldsAll));
  EXPECT_EQ(count_reads(layer, {{0, 0, 1}, 1.0}, kHoldsAll), count("evsm4", {layer}, kHoldsAll));
  EXPECT_EQ(count_reads(layer, {{1, 1, 0}, 1.0}, kHoldsAll), 4.0 + 8.0) << "of two maps";
}

}  // namespace
}  // namespace shadowbench::measure
