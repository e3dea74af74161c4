#include "reference/metrics/error_stats.h"

#include <numeric>
#include <span>

#include "reference/metrics/artefacts.h"
#include "reference/metrics/flip.h"
#include "reference/metrics/metric_table.h"
#include "tests/test_files.h"

namespace shadowbench::metrics {
namespace {

using ::testing::DoubleNear;
using ::testing::IsSupersetOf;

TEST(ErrorStats, OfFourPixels_AreWhatTheirDefinitionsGive) {
  const std::vector<float> image = {0.5f, 1.0f, 0.0f, 0.25f, 0.9f}, truth = {0.0f, 1.0f, 0.5f, 0.0f, 0.0f};
  const std::vector<std::uint8_t> mask = {1, 1, 1, 1, 0};
  const auto stats = measure_error(image, truth, mask);
  ASSERT_TRUE(stats);
  EXPECT_EQ(stats->count, 4);
  EXPECT_DOUBLE_EQ(stats->mean, 0.0625);
  EXPECT_DOUBLE_EQ(stats->mae, 0.3125);
  EXPECT_DOUBLE_EQ(stats->rmse, std::sqrt((0.25 + 0.25 + 0.0625) / 4.0));
  EXPECT_DOUBLE_EQ(stats->max, 0.5);
  EXPECT_DOUBLE_EQ(stats->p95, 0.5);
}

TEST(ErrorStats, P95_LeavesFiveInAHundredAbove) {
  std::vector<float> image(100);
  for (std::size_t i = 0; i < 100; ++i) image[i] = static_cast<float>(i);
  const auto stats = measure_error(image, std::vector<float>(100, 0.0f), std::vector<std::uint8_t>(100, 1));
  EXPECT_DOUBLE_EQ(stats->p95, 94.0);
  EXPECT_DOUBLE_EQ(stats->max, 99.0);
}

TEST(ErrorStats, EqualImages_HaveNoError) {
  const std::vector<float> image = {0.1f, 0.9f};
  EXPECT_DOUBLE_EQ(measure_error(image, image, std::vector<std::uint8_t>{1, 1})->max, 0.0);
}

TEST(ErrorStats, NotFinitePixels_AreCountedAndLeftOut) {
  const std::vector<float> image = {std::numeric_limits<float>::quiet_NaN(), 0.5f}, truth = {0.0f, 0.0f};
  const auto stats = measure_error(image, truth, std::vector<std::uint8_t>{1, 1});
  EXPECT_EQ(stats->not_finite, 1);
  EXPECT_DOUBLE_EQ(stats->rmse, 0.5);
}

TEST(ErrorStats, EmptyMask_HasNone) {
  EXPECT_FALSE(measure_error(std::vector<float>{1.0f}, std::vector<float>{0.0f}, std::vector<std::uint8_t>{0}));
}

TEST(ErrorStats, TheTruthsVariance_IsTakenOffTheMeanSquareAlone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> image = {0.5f, 0.25f, nan, 1.0f}, truth = {0.0f, 0.0f, 0.0f, 0.0f};
  const std::vector<std::uint8_t> mask = {1, 1, 1, 0};
  const std::vector<float> variance = {0.0625f, 0.03125f, 9.0f, 9.0f}, more(4, 9.0f);
  const auto plain = measure_error(image, truth, mask), less = measure_error(image, truth, mask, variance);
  EXPECT_NEAR(less->rmse * less->rmse, plain->rmse * plain->rmse - 0.046875, 1e-12) << "of finite pixels that count";
  EXPECT_EQ(less->mae, plain->mae);
  EXPECT_EQ(less->max, plain->max);
  EXPECT_EQ(measure_error(image, truth, mask, more)->rmse, 0.0) << "never below nought";
}

// Errors taken apart: the parts add up, and shares follow from numbers that can be worked out by hand.

struct Stations {
  std::vector<float> image, kernel, area;
  std::vector<double> model, closer;
  std::vector<std::uint8_t> mask;

  void add(float i, double m, double c, float k, float a, bool counts = true) {
    image.push_back(i);
    model.push_back(m);
    closer.push_back(c);
    kernel.push_back(k);
    area.push_back(a);
    mask.push_back(counts ? 1 : 0);
  }
  Attribution attribute() const { return attribute_error({image, model, closer, kernel, area, mask}); }
};

TEST(Attribution, PartsAddUpToTheError_InEveryPixel) {
  std::mt19937 random(3);
  const auto draw = [&] { return static_cast<float>(random()) * 0x1p-32f; };
  Stations stations;
  for (int i = 0; i < 5000; ++i)
    stations.add(draw(), static_cast<double>(draw()), static_cast<double>(draw()), draw(), draw(), i % 7 != 0);
  const Attribution result = stations.attribute();
  for (std::size_t i = 0; i < 5000; ++i) {
    double sum = 0.0;
    for (const auto& part : result.parts) sum += static_cast<double>(part[i]);
    const double error =
        stations.mask[i] ? static_cast<double>(stations.image[i]) - static_cast<double>(stations.area[i]) : 0.0;
    ASSERT_NEAR(sum, error, 1e-6);
  }
  double shares = 0.0;
  for (const auto& stats : result.stats) shares += stats->share;
  EXPECT_NEAR(shares, 1.0, 1e-12);
}

TEST(Attribution, EachPartIsItsOwnDifference) {
  Stations stations;
  stations.add(0.9f, 0.8, 0.5, 0.25f, 0.125f);
  const Attribution result = stations.attribute();
  EXPECT_NEAR(result.parts[0][0], 0.1f, 1e-6f);
  EXPECT_NEAR(result.parts[1][0], 0.3f, 1e-6f);
  EXPECT_NEAR(result.parts[2][0], 0.25f, 1e-6f);
  EXPECT_NEAR(result.parts[3][0], 0.125f, 1e-6f);
}

TEST(Attribution, WithoutAModel_TheEstimatorsPartHoldsTheNumericOne) {
  Stations stations;
  stations.add(0.875f, 0.75, 0.5, 0.25f, 0.125f);
  stations.model.clear();
  const Attribution result = stations.attribute();
  EXPECT_TRUE(result.parts[0].empty());
  EXPECT_FALSE(result.stats[0]);
  EXPECT_EQ(result.parts[1][0], 0.375f);
  EXPECT_EQ(result.stats[1]->share, 0.5);
}

TEST(Attribution, TheKernelsVariance_IsTakenOffTheTwoPartsThatItIsIn) {
  Stations stations;
  stations.add(0.9f, 0.8, 0.5, 0.25f, 0.125f);
  stations.add(0.1f, 0.2, 0.5, 0.25f, 0.75f);
  stations.add(0.0f, 0.0, 0.0, 1.0f, 0.0f, false);
  const std::vector<float> variance = {0.01f, 0.02f, 9.0f};
  const Attribution plain = stations.attribute(),
                    less = attribute_error({stations.image, stations.model, stations.closer, stations.kernel,
                                            stations.area, stations.mask, variance});
  for (std::size_t p = 0; p < kErrorParts; ++p) {
    const double off = p < 2 ? 0.0 : 0.015, before = plain.stats[p]->rms, after = less.stats[p]->rms;
    EXPECT_NEAR(before * before - after * after, off, 1e-8) << p;
    EXPECT_EQ(plain.stats[p]->share, less.stats[p]->share) << p;
    EXPECT_EQ(plain.parts[p], less.parts[p]) << p;
  }
}

TEST(Attribution, SharesOfCancellingParts_AreNegative) {
  // Estimator +0.5 and model -0.25 in one pixel, nothing in the other: e = 0.25.
  Stations stations;
  stations.add(1.0f, 1.0, 0.5, 0.5f, 0.75f);
  stations.add(1.0f, 1.0, 1.0, 1.0f, 1.0f);
  const Attribution result = stations.attribute();
  EXPECT_NEAR(result.stats[1]->rms, 0.5 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(result.stats[1]->share, 2.0, 1e-12);
  EXPECT_NEAR(result.stats[3]->share, -1.0, 1e-12);
  EXPECT_EQ(result.stats[0]->share, 0.0);
}

TEST(Attribution, WithoutError_HasNoShares) {
  Stations stations;
  stations.add(1.0f, 1.0, 1.0, 1.0f, 1.0f);
  stations.add(0.0f, 1.0, 1.0, 1.0f, 1.0f, false);
  EXPECT_FALSE(stations.attribute().stats[0]);
  EXPECT_FALSE(Stations().attribute().stats[0]);
}

TEST(Attribution, LeavesOutWhatIsNotFinite) {
  Stations stations;
  stations.add(std::numeric_limits<float>::quiet_NaN(), 1.0, 1.0, 1.0f, 1.0f);
  stations.add(0.5f, 0.5, 0.5, 0.5f, 0.25f);
  const Attribution result = stations.attribute();
  EXPECT_EQ(result.not_finite, 1);
  EXPECT_NEAR(result.stats[3]->rms, 0.25, 1e-12);
  EXPECT_EQ(result.parts[0][0], 0.0f);
}

TEST(Flicker, ChangeBetweenPlacesOfTheGrid_IsOverAllPairs) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> a = {0.0f, 0.5f, 1.0f, 0.0f}, b = {0.3f, 0.5f, 0.0f, nan}, c = {0.6f, 0.5f, 0.0f, 0.0f};
  const std::vector<std::span<const float>> images = {a, b, c};
  const std::vector<std::uint8_t> mask = {1, 1, 0, 1};
  EXPECT_THAT(measure_change(images, 1, mask)->value, DoubleNear(std::sqrt((0.09 + 0.36 + 0.09) / 6.0), 1e-7));
  EXPECT_EQ(measure_change(std::vector<std::span<const float>>{b, b}, 1, mask)->value, 0.0);
  EXPECT_FALSE(measure_change(std::vector<std::span<const float>>{a}, 1, mask)) << "one place";
  EXPECT_FALSE(measure_change(std::vector<std::span<const float>>{a, b}, 2, mask)) << "one group";
  EXPECT_FALSE(measure_change(images, 1, std::vector<std::uint8_t>{0, 0, 0, 0})) << "no receiver";
}

/// Images of receivers that are lit where the sum of two random offsets of the grid is below a half; the second image
/// of a group is half a texel farther, and so the opposite.
std::vector<std::vector<float>> draw_groups(int groups, int of_group, std::mt19937& generator) {
  constexpr int kReceivers = 64;
  std::uniform_real_distribution<float> anywhere;
  std::vector<std::vector<float>> images;
  for (int g = 0; g < groups; ++g) {
    const float offset = anywhere(generator);
    for (int k = 0; k < of_group; ++k) {
      images.emplace_back();
      for (int i = 0; i < kReceivers; ++i) {
        const float at = static_cast<float>(i) / kReceivers + offset + 0.5f * static_cast<float>(k);
        images.back().push_back(at - std::floor(at) < 0.5f ? 1.0f : 0.0f);
      }
    }
  }
  return images;
}

/// Two independent offsets differ in a half of the receivers on average: sqrt(1/2), however many there are.
TEST(Flicker, ChangeDependsOnNoCountOfPlaces_AndIsWithinItsInterval) {
  const double expected = std::sqrt(0.5);
  for (const auto& [groups, of_group] : {std::pair(4, 1), std::pair(4, 2), std::pair(8, 2), std::pair(16, 2)}) {
    std::mt19937 generator(7);
    constexpr int kTrials = 300;
    double mean_square = 0.0;
    int covered = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto images = draw_groups(groups, of_group, generator);
      const std::vector<std::span<const float>> spans(images.begin(), images.end());
      const Change change =
          *measure_change(spans, static_cast<std::size_t>(of_group), std::vector<std::uint8_t>(64, 1));
      mean_square += change.value * change.value / kTrials;
      covered += std::abs(change.value - expected) <= *change.reach ? 1 : 0;
    }
    EXPECT_NEAR(mean_square, 0.5, 0.03) << groups << " groups of " << of_group;
    EXPECT_GE(covered, 0.88 * kTrials) << groups << " groups of " << of_group;
  }
}

TEST(ZTest, StudentsQuantile_IsWhereItsTableHasIt) {
  // Student's t with 15 degrees of freedom: 2.131 is exceeded on both sides with probability 0.05.
  EXPECT_NEAR(find_p({2.131, 1.0, 15.0}), 0.05, 1e-4);
  EXPECT_NEAR(find_p({-4.262, 4.0, 15.0}), 0.05, 1e-4);
}

TEST(ZTest, NoVariance_MeansNoDifference) {
  EXPECT_EQ(find_p({0.0, 0.0, 15.0}), 1.0);
  EXPECT_EQ(find_p({1e-9, 0.0, 15.0}), 0.0);
}

TEST(ZTest, NotFinite_IsNoChance) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(find_p({nan, 1.0, 15.0}), 0.0);
  EXPECT_EQ(find_p(Share{nan, 16.0}, Share{8.0, 16.0}), 0.0);
}

TEST(ZTest, SharesOfTheTeaTastingLady_AreWhatFisherSays) {
  // Fisher 1935: all four cups of each kind told right has probability 1 in 70; twice that here.
  EXPECT_NEAR(find_p(Share{4.0, 4.0}, Share{0.0, 4.0}), 2.0 / 70.0, 1e-12);
  EXPECT_NEAR(find_p(Share{0.0, 4.0}, Share{4.0, 4.0}), 2.0 / 70.0, 1e-12);
  EXPECT_EQ(find_p(Share{2.0, 4.0}, Share{2.0, 4.0}), 1.0);
  EXPECT_EQ(find_p(Share{16.0, 16.0}, Share{256.0, 256.0}), 1.0);
}

TEST(ZTest, LevelIsCorrectedForTheNumberOfTests_AndTheWorstIsNamed) {
  std::vector<double> probabilities(100, 0.01);
  EXPECT_EQ(test_pixels({probabilities.data(), 1}, 0.05).beyond, 1);
  EXPECT_EQ(test_pixels(probabilities, 0.05).beyond, 0);
  probabilities[42] = 0.0004;
  const PixelTest test = test_pixels(probabilities, 0.05);
  EXPECT_EQ(test.beyond, 1);
  EXPECT_EQ(test.worst, 42u);
  EXPECT_DOUBLE_EQ(test.smallest_p, 0.0004);
  EXPECT_DOUBLE_EQ(test.corrected_level, 0.0005);
}

/// Whole pictures of chance must fail about as often as the level says, never much more.
TEST(ZTest, Chance_FailsAsOftenAsItsLevel) {
  std::mt19937 generator(1);
  std::student_t_distribution<double> chance(15.0);
  int failed = 0;
  constexpr int kPictures = 1000;
  for (int picture = 0; picture < kPictures; ++picture) {
    std::vector<double> pixels(200);
    for (double& p : pixels) p = find_p({chance(generator), 1.0, 15.0});
    if (test_pixels(pixels, 0.1).beyond > 0) ++failed;
  }
  // 95 expected (1 - (1 - 0.0005)^200), standard deviation 9.3.
  EXPECT_GT(failed, 58);
  EXPECT_LT(failed, 132);
}

TEST(ZTest, SumsAddVariances_AndDegreesOfFreedom) {
  const std::vector<NoisyDifference> equal(64, {0.5, 0.01, 15.0});
  const NoisyDifference sum = add_differences(equal);
  EXPECT_DOUBLE_EQ(sum.difference, 32.0);
  EXPECT_NEAR(sum.variance, 0.64, 1e-12);
  EXPECT_NEAR(sum.degrees_of_freedom, 960.0, 1e-9);
  const std::vector<NoisyDifference> one_counts = {{0.0, 1.0, 15.0}, {0.0, 1e-9, 15.0}};
  EXPECT_NEAR(add_differences(one_counts).degrees_of_freedom, 15.0, 1e-6);
}

LinearPicture make_uniform(const glm::vec3& color, int width = 40, int height = 30) {
  return {width, height, std::vector<glm::vec3>(static_cast<std::size_t>(width * height), color)};
}

LinearPicture make_noise(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> draw(0.0f, 1.0f);
  LinearPicture picture = make_uniform({0.0f, 0.0f, 0.0f});
  for (glm::vec3& pixel : picture.pixels) pixel = {draw(generator), draw(generator), draw(generator)};
  return picture;
}

std::vector<float> measure_flip(const LinearPicture& a, const LinearPicture& b,
                                double pixels_per_degree = kDefaultPixelsPerDegree) {
  return metrics::measure_flip(view_for_flip(a, pixels_per_degree), view_for_flip(b, pixels_per_degree));
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(Flip, EqualPictures_AreZero) {
  for (const float value : measure_flip(make_noise(1), make_noise(1))) EXPECT_EQ(value, 0.0f);
}

TEST(Flip, IsSymmetric_AndWithinZeroAndOne) {
  const std::vector<float> ab = measure_flip(make_noise(1), make_noise(2)),
                           ba = measure_flip(make_noise(2), make_noise(1));
  EXPECT_EQ(ab, ba);
  for (const float value : ab) {
    EXPECT_GE(value, 0.0f);
    EXPECT_LE(value, 1.0f);
  }
}

TEST(Flip, BlackAgainstWhite_IsWhatTheFormulaGivesByHand) {
  // Lightness differs by 100, chroma by 0: the difference is 100^0.7 = 25.119. The largest, green against blue, follows
  // from CIELAB: green (87.735, -86.183, 83.180), blue (32.297, 79.188, -107.860); Hunt: green (-75.613, 72.978), blue
  // (25.575, -34.836); HyAB = 55.438 + sqrt(101.188^2 + 107.814^2) = 203.30; ^0.7 = 41.276. The knee lies at 16.511, so
  // the value is 0.95 + 0.05 (25.119 - 16.511) / (41.276 - 16.511) = 0.96738. Uniform pictures have no features.
  for (const float value : measure_flip(make_uniform(glm::vec3(0.0f)), make_uniform(glm::vec3(1.0f))))
    EXPECT_NEAR(value, 0.96738f, 2e-4f);
}

TEST(Flip, GreenAgainstBlue_IsOne) {
  for (const float value : measure_flip(make_uniform({0.0f, 1.0f, 0.0f}), make_uniform({0.0f, 0.0f, 1.0f})))
    EXPECT_NEAR(value, 1.0f, 1e-5f);
}

TEST(Flip, CloseGreys_AreBelowTheKnee) {
  // Linear 0.2 and 0.21: L* 51.837 and 52.952, difference 1.1146^0.7 = 1.0789; 0.95 / 16.511 of it is 0.06208.
  const double value = mean(measure_flip(make_uniform(glm::vec3(0.2f)), make_uniform(glm::vec3(0.21f))));
  EXPECT_NEAR(value, 0.06208, 3e-4);
}

TEST(Flip, AnEdgeThatMoved_IsSeenMoreThanTheSameColourWithoutEdge) {
  LinearPicture a = make_uniform(glm::vec3(0.1f), 60, 40), b = a, flat = a;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      const auto i = static_cast<std::size_t>(y * 60 + x);
      if (x > 30) a.pixels[i] = glm::vec3(0.3f);
      if (x > 34) b.pixels[i] = glm::vec3(0.3f);
      flat.pixels[i] = glm::vec3(0.3f);
    }
  }
  const std::vector<float> moved = measure_flip(a, b);
  const std::vector<float> uniform = measure_flip(make_uniform(glm::vec3(0.1f), 60, 40), flat);
  EXPECT_GT(moved[20 * 60 + 32], uniform[20 * 60 + 32]);
  EXPECT_LT(moved[20 * 60 + 2], 1e-3f);
}

TEST(Flip, FartherAway_FineNoiseIsSeenLess) {
  EXPECT_LT(mean(measure_flip(make_noise(1), make_noise(2), 134.0)),
            mean(measure_flip(make_noise(1), make_noise(2), 67.0)));
}

TEST(MetricTable, EveryMetric_IsDescribedOnce) {
  std::set<std::string_view> paths;
  for (const Metric& metric : metric_table()) {
    EXPECT_TRUE(paths.insert(metric.path).second) << metric.path;
    EXPECT_FALSE(metric.unit.empty()) << metric.path;
    EXPECT_FALSE(metric.definition.empty()) << metric.path;
    EXPECT_EQ(metric.statistic != nullptr, metric.source == MetricSource::kValues) << metric.path;
    EXPECT_EQ(std::string(metric.path).substr(metric.path.size() - metric.name().size()), metric.name());
    EXPECT_FALSE(metric.title.empty()) << metric.path;
    EXPECT_TRUE(metric.limit.empty() || metric.direction == MetricDirection::kLess) << metric.path;
  }
}

TEST(MetricTable, EveryRow_HasAMemberOfItsOwn) {
  MetricValues values;
  std::set<const void*> members;
  for (const Metric& metric : metric_table()) {
    visit_metric(
        metric, values,
        [&](const std::string& path, auto& value) {
          EXPECT_TRUE(members.insert(&value).second) << path;
          EXPECT_FALSE(metric.read(values)) << path;
          value = 3;
          EXPECT_EQ(metric.read(values), 3.0) << path;
        });
  }
  EXPECT_EQ(sizeof(MetricValues) / sizeof(std::optional<double>), members.size()) << "a member has no row";
}

TEST(MetricTable, TwoPictures_GiveTheErrorsThatNeedNoRays) {
  std::vector<std::string> names;
  for (const Metric& metric : picture_metrics()) names.emplace_back(metric.name());
  EXPECT_THAT(names, IsSupersetOf({"rmse", "mae", "p95", "max", "mean", "flip"}));
  EXPECT_THAT(names, Not(Contains("kernel_rmse")));
}

TEST(MetricTable, Statistics_AreTheOnesOfTheirNames) {
  EXPECT_EQ(find_metric("error.rmse").statistic, &ErrorStats::rmse);
  EXPECT_EQ(find_metric("error.mae").statistic, &ErrorStats::mae);
  EXPECT_EQ(find_metric("error.p95").statistic, &ErrorStats::p95);
  EXPECT_EQ(find_metric("error.max").statistic, &ErrorStats::max);
  EXPECT_EQ(find_metric("error.mean").statistic, &ErrorStats::mean);
}

/// The definitions state the limits that artefacts are counted with.
TEST(MetricTable, ArtefactLimits_AreTheOnesInUse) {
  const std::pair<std::string_view, double> limits[] = {{"artefact.acne", kArtefactLimits.acne_below},
                                                        {"artefact.acne", kArtefactLimits.guard_texels},
                                                        {"artefact.leak", kArtefactLimits.leak_above},
                                                        {"artefact.leak", kArtefactLimits.contact_texels},
                                                        {"artefact.contact_gap", kArtefactLimits.contact_gap_above},
                                                        {"artefact.contact_gap", kArtefactLimits.contact_texels},
                                                        {"artefact.noise", kArtefactLimits.noise_above}};
  for (const auto& [path, limit] : limits) {
    std::string number = std::to_string(limit);
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
    for (const Metric& metric : metric_table())
      if (metric.path == path) EXPECT_THAT(std::string(metric.definition), HasSubstr(" " + number)) << path;
  }
}

}  // namespace
}  // namespace shadowbench::metrics
