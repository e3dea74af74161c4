#include "report/analysis/accuracy_words.h"

#include <gmock/gmock.h>

#include "reference/metrics/metric_table.h"
#include "report/analysis/cell_group.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

constexpr records::PartValues kMostlyEstimator{0.01, 0.7, 0.09, 0.2};

records::CellRecord make_scored(double rmse, std::optional<double> se) {
  records::CellRecord cell = make_cell("cubes", "a", 1.0);
  cell.error.rmse = rmse;
  cell.truth.se = se;
  return cell;
}

TEST(RankErrors, SmallestFirst_AndCellsWithoutErrorAreLeftOut) {
  const std::vector<records::CellRecord> cells = {make_scored(0.03, 0.0), make_cell("cubes", "b", 1.0),
                                                  make_scored(0.01, 0.0)};
  EXPECT_THAT(rank_errors(cells), ElementsAre(ElementsAre(2), ElementsAre(0)));
}

TEST(RankErrors, DifferenceUpToTheLargerStandardError_IsATie) {
  EXPECT_THAT(rank_errors({make_scored(0.25, 0.0), make_scored(0.5, 0.25)}), ElementsAre(ElementsAre(0, 1)));
  EXPECT_THAT(rank_errors({make_scored(0.25, 0.25), make_scored(0.5, 0.0)}), ElementsAre(ElementsAre(0, 1)));
  EXPECT_THAT(rank_errors({make_scored(0.25, 0.125), make_scored(0.5, 0.125)}),
              ElementsAre(ElementsAre(0), ElementsAre(1)));
  EXPECT_THAT(rank_errors({make_scored(0.25, std::nullopt), make_scored(0.25, std::nullopt)}),
              ElementsAre(ElementsAre(0, 1)));
}

TEST(RankErrors, Ties_AreWithTheBestOfAGroup) {
  const std::vector<records::CellRecord> chain = {make_scored(1.0, 0.25), make_scored(1.25, 0.25),
                                                  make_scored(1.5, 0.25)};
  EXPECT_THAT(rank_errors(chain), ElementsAre(ElementsAre(0, 1), ElementsAre(2)));
}

TEST(FindDominatingPart, IsTheOnlyOneAboveHalf) {
  EXPECT_EQ(find_dominating_part({0.0, 0.51, 0.0, 0.49}), 1u);
  EXPECT_EQ(find_dominating_part({0.0, 0.5, 0.5, 0.0}), std::nullopt);
  EXPECT_EQ(find_dominating_part({0.0, 0.9, 0.8, -0.7}), std::nullopt);
  EXPECT_EQ(find_dominating_part({-0.3, -0.3, 0.2, 1.4}), 3u);
}

TEST(AccuracyWords, Ranking_NamesTiesAndSaysWhatTheyAre) {
  const CellGroup group{
      "cubes",
      {make_attributed_cell("c", 0.0155, kMostlyEstimator), make_attributed_cell("a", 0.0125, kMostlyEstimator),
       make_attributed_cell("b", 0.015, kMostlyEstimator)}};
  const auto sentences = describe_accuracy(group);
  EXPECT_EQ(sentences[0],
            "Error to the area truth (RMSE) of medium kernels, smallest first: a (0.0125); then b (0.015) tied with c "
            "(0.0155).");
  EXPECT_EQ(sentences[1], "Tied filters differ by no more than the truth's standard error.");
}

TEST(AccuracyWords, Ranking_IsWithinAClassOfWidth) {
  CellGroup group{"cubes", {}};
  for (const char* name : {"a", "b", "c", "d", "e"})
    group.cells.push_back(make_attributed_cell(name, 0.01 + 0.01 * (name[0] - 'a'), kMostlyEstimator));
  group.cells[1].kernel = {0.41, "sharp"};
  group.cells[2].kernel = {3.0, std::nullopt};
  group.cells[3].kernel = {};
  const auto sentences = describe_accuracy(group);
  EXPECT_EQ(sentences[0], "Error to the area truth (RMSE) of sharp kernels, smallest first: b (0.02).");
  EXPECT_EQ(sentences[1], "Error to the area truth (RMSE) of medium kernels, smallest first: a (0.01); then e (0.05).");
  EXPECT_EQ(sentences[2], "Not ranked, for their kernels are of no class, too wide or unknown: c (0.03), d (0.04).");
}

TEST(AccuracyWords, DominatingPart_IsExplainedOnceForAllFilters) {
  const CellGroup group{
      "cubes",
      {make_attributed_cell("vsm", 0.04, kMostlyEstimator), make_attributed_cell("esm", 0.05, {0.0, 0.6, 0.2, 0.2}),
       make_attributed_cell("none", 0.06, {0.0, 0.0, 0.9, 0.1})}};
  const auto sentences = describe_accuracy(group);
  EXPECT_THAT(sentences,
              Contains("Most of the error of vsm (70 %) and esm (60 %) is estimator: what the filter makes of "
                       "the depths it reads, such as light bleeding of a bound or noise of few taps."));
  EXPECT_THAT(sentences,
              Contains("Most of the error of none (90 %) is discretisation: the map's resolution and the bias."));
  EXPECT_THAT(sentences, Not(Contains(HasSubstr("offsets others"))));
}

TEST(AccuracyWords, WithoutADominatingPart_TheTwoLargestAreNamed) {
  const CellGroup group{"cubes",
                        {make_attributed_cell("tent3x3", 0.04, {0.0, 0.2, 0.4, 0.4}),
                         make_attributed_cell("pcf2x2", 0.03, {-0.1, 0.2, 0.48, 0.42})}};
  const auto sentences = describe_accuracy(group);
  EXPECT_THAT(
      sentences,
      Contains("No single part dominates the error of tent3x3 (40 % and 40 %) and pcf2x2 (48 % and 42 %); the "
               "largest are discretisation (the map's resolution and the bias) and model (a fixed kernel is not "
               "this light's penumbra)."));
  EXPECT_THAT(sentences, Contains(HasSubstr("A part with a share below 0 % offsets others")));
}

TEST(AccuracyWords, ErrorWithinTheTruthsOwn_IsNotExplained) {
  const CellGroup group{"cubes", {make_attributed_cell("pcf2x2", 0.001, kMostlyEstimator)}};
  const auto sentences = describe_accuracy(group);
  EXPECT_THAT(sentences, Contains("The error of pcf2x2 cannot be told from the truth's own (standard error 0.001)."));
  EXPECT_THAT(sentences, Not(Contains(HasSubstr("Most of the error"))));
}

TEST(AccuracyWords, Artefacts_AreSaidFromOneInAThousandOn) {
  CellGroup group{"cubes", {make_cell("cubes", "vsm", 4.0), make_cell("cubes", "esm", 4.0)}};
  group.cells[0].artefact = {0.0009, 0.042, std::nullopt, 0.0};
  group.cells[1].artefact = {0.0009, 0.001, std::nullopt, 0.0};
  EXPECT_THAT(describe_accuracy(group), ElementsAre("Leak: vsm 4.2 %, esm 0.1 %. The rate is the share " +
                                                    metrics::find_metric("artefact.leak").definition + "."));
}

TEST(AccuracyWords, EachKindOfArtefact_HasItsSentence) {
  CellGroup group{"cubes", {make_cell("cubes", "vsm", 4.0)}};
  group.cells[0].artefact = {0.01, 0.02, 0.03, 0.04};
  EXPECT_THAT(describe_accuracy(group),
              ElementsAre(AllOf(StartsWith("Acne: vsm 1 %."), HasSubstr("darker than 0.9")),
                          AllOf(StartsWith("Leak: vsm 2 %."), HasSubstr("brighter than 0.1")),
                          AllOf(StartsWith("Contact gap: vsm 3 %."), HasSubstr("brighter than 0.5")),
                          AllOf(StartsWith("Noise: vsm 4 %."), HasSubstr("by more than 0.05"))));
}

TEST(AccuracyWords, WithoutMeasurements_NothingIsSaid) {
  EXPECT_THAT(describe_accuracy({"cubes", {make_cell("cubes", "vsm", 4.0)}}), IsEmpty());
}

TEST(AccuracyWords, ArePartOfWhatIsSaidOfAGroup) {
  const CellGroup group{"cubes", {make_attributed_cell("vsm", 0.04, kMostlyEstimator)}};
  EXPECT_THAT(describe_group(group, make_run().gl), Contains(HasSubstr("Most of the error of vsm")));
}

}  // namespace
}  // namespace shadowbench::analysis
