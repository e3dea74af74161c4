#include "reference/metrics/metric_table.h"

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "reference/metrics/artefacts.h"

namespace shadowbench::metrics {
namespace {

using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;

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
      if (metric.path == path) EXPECT_THAT(std::string(metric.definition), ::testing::HasSubstr(" " + number)) << path;
  }
}

}  // namespace
}  // namespace shadowbench::metrics
