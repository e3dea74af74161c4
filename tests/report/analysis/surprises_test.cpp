#include "report/analysis/surprises.h"

#include <gmock/gmock.h>

#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// A cell of the medium class whose RMSE is known within 0.001.
CellRecord make_measured(const std::string& scene, const std::string& filter, double rmse, double ms) {
  CellRecord cell = make_attributed_cell(filter, rmse, {0.0, 0.1, 0.1, 0.8});
  cell.scene = scene;
  cell.params = {};
  cell.rmse_ci95 = Interval{rmse - 0.001, rmse + 0.001};
  cell.time_ms.moving = OwnTime{{ms, ms, ms, 9}, {ms, ms}};
  return cell;
}

TEST(Surprises, OrderThatTurnsOver_IsSaidOnceWithItsNumbers) {
  const auto said = list_surprises({make_measured("cubes", "a", 0.01, 1.0), make_measured("stack", "a", 0.04, 1.0),
                                    make_measured("cubes", "b", 0.02, 1.0), make_measured("stack", "b", 0.03, 1.0)});
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], ::testing::MatchesRegex("The order turns over: a.* has a smaller RMSE than b.* on cubes "
                                               "\\(0.01 against 0.02\\), and a larger one on stack \\(0.04 against "
                                               "0.03\\)\\."));
}

TEST(Surprises, ASmallerPartOfALargeError_IsSaidWithBothRatios) {
  const auto measured = [](const std::string& filter, double rmse, double estimator) {
    CellRecord cell = make_measured("stack", filter, rmse, 1.0);
    cell.attribution.estimator = {estimator, 0.5};
    return cell;
  };
  const auto said = list_surprises({measured("vsm", 0.04, 0.03), measured("evsm4", 0.03, 0.0135)});
  EXPECT_THAT(said, Contains(HasSubstr("The estimator's part of the error of evsm4")));
  EXPECT_THAT(said, Contains(HasSubstr("is 0.45 of that of vsm")));
  EXPECT_THAT(said, Contains(HasSubstr("but the RMSE 0.75: the rest")));
  const auto not_weighty = list_surprises({measured("vsm", 0.04, 0.01), measured("evsm4", 0.03, 0.0045)});
  EXPECT_THAT(not_weighty, Not(Contains(HasSubstr("The estimator's part"))));
  const auto has_none = list_surprises({measured("vsm", 0.04, 0.03), measured("tent3x3", 0.03, 0.0)});
  EXPECT_THAT(has_none, Not(Contains(HasSubstr("The estimator's part"))));
}

TEST(Surprises, OfOnePairOfFilters_TheStrongestTurnIsSaid) {
  std::vector<CellRecord> cells = {make_measured("cubes", "a", 0.01, 1.0), make_measured("stack", "a", 0.04, 1.0)};
  for (const double radius : {1.0, 7.0 / 6.0}) {
    for (const auto& [scene, rmse] : {std::pair{"cubes", 0.02}, {"stack", 0.03 - 0.01 * (radius - 1.0)}}) {
      cells.push_back(make_measured(scene, "b", rmse, 1.0));
      cells.back().params["radius"] = radius;
    }
  }
  const auto said = list_surprises(cells);
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], HasSubstr("b (radius 1.16667)"));
}

TEST(Surprises, DifferencesWithinTheIntervals_AreNone) {
  EXPECT_THAT(list_surprises({make_measured("cubes", "a", 0.0100, 1.0), make_measured("stack", "a", 0.0309, 1.0),
                              make_measured("cubes", "b", 0.0105, 1.0), make_measured("stack", "b", 0.0300, 1.0)}),
              IsEmpty());
}

TEST(Surprises, KernelsOfOtherWidths_AreNotCompared) {
  std::vector<CellRecord> cells = {make_measured("cubes", "a", 0.01, 9.0), make_measured("stack", "a", 0.04, 9.0),
                                   make_measured("cubes", "b", 0.02, 1.0), make_measured("stack", "b", 0.03, 1.0)};
  for (std::size_t i : {0, 1}) cells[i].kernel = {0.41, "sharp"};
  EXPECT_THAT(list_surprises(cells), IsEmpty());
}

TEST(Surprises, CostThatBuysNothing_IsSaid) {
  const auto said =
      list_surprises({make_measured("cubes", "dear", 0.02, 6.0), make_measured("cubes", "fair", 0.02, 2.0)});
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], ::testing::StartsWith("With a moving light dear"));
  EXPECT_THAT(said[0], HasSubstr("costs 3 times what fair"));
  EXPECT_THAT(list_surprises({make_measured("cubes", "dear", 0.01, 6.0), make_measured("cubes", "fair", 0.02, 2.0)}),
              IsEmpty());
}

TEST(Surprises, WhatWasNotMeasuredEverywhere_IsSaidOfNoScene) {
  std::vector<CellRecord> cells = {make_measured("cubes", "dear", 0.02, 6.0), make_measured("stack", "dear", 0.02, 6.0),
                                   make_measured("cubes", "fair", 0.02, 2.0),
                                   make_measured("stack", "fair", 0.02, 2.0)};
  EXPECT_THAT(list_surprises(cells), SizeIs(1));
  cells[1].error.rmse.reset();
  EXPECT_THAT(list_surprises(cells), IsEmpty());
}

TEST(Surprises, PartThatIsNotTheUsualOne_IsNamed) {
  std::vector<CellRecord> cells = {make_measured("cubes", "a", 0.02, 1.0), make_measured("stack", "a", 0.02, 1.0),
                                   make_measured("cubes", "b", 0.02, 1.0), make_measured("stack", "b", 0.02, 1.0)};
  EXPECT_THAT(list_surprises(cells), IsEmpty());
  const CellRecord odd = make_attributed_cell("b", 0.02, {0.0, 1.1, -0.2, 0.1});
  cells[3].attribution = odd.attribution;
  const auto said = list_surprises(cells);
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], HasSubstr("comes from estimator"));
  EXPECT_THAT(said[0], HasSubstr("on stack (110 %, offset by others)"));
}

TEST(Surprises, FaultThatOnlyOneIsFreeOf_IsSaid) {
  std::vector<CellRecord> cells = {make_measured("cubes", "a", 0.02, 1.0), make_measured("cubes", "b", 0.02, 1.0),
                                   make_measured("cubes", "c", 0.02, 1.0)};
  for (CellRecord& cell : cells) cell.artefact.leak = 0.2;
  EXPECT_THAT(list_surprises(cells), IsEmpty());
  cells[1].artefact.leak = 0.0;
  const auto said = list_surprises(cells);
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], HasSubstr("Only b, of 3 measured, has"));
  cells.push_back(make_measured("stack", "a", 0.02, 1.0));
  cells.back().artefact.leak = 0.2;
  EXPECT_THAT(list_surprises(cells), IsEmpty()) << "b and c were not drawn on stack";
}

TEST(Surprises, WhatIsSuspectOrFailed_ComesFirst_AndIsNotCompared) {
  std::vector<CellRecord> cells = {make_measured("cubes", "dear", 0.02, 6.0),
                                   make_measured("cubes", "fair", 0.02, 2.0)};
  cells[1].status = CellStatus::kSuspect;
  cells[1].message = "it reads nothing";
  const auto said = list_surprises(cells);
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], HasSubstr("Not ranked or advised: fair"));
  EXPECT_THAT(said[0], HasSubstr("suspect: see the warnings"));
  cells[0].nan = 12;
  EXPECT_THAT(list_surprises(cells), Contains(HasSubstr("12 pixels on cubes that are not finite")));
}

TEST(Surprises, AreOneOfAKind) {
  std::vector<CellRecord> cells;
  for (int filter = 0; filter < 12; ++filter)
    for (int scene = 0; scene < 6; ++scene)
      cells.push_back(make_measured("s" + std::to_string(scene), std::string(1, static_cast<char>('a' + filter)),
                                    0.01 + 0.01 * ((7 * filter + 5 * scene * filter) % 6), 1.0 + filter * filter));
  EXPECT_THAT(list_surprises(cells), SizeIs(2)) << "of many dear ones and many turnovers, one each";
}

}  // namespace
}  // namespace shadowbench::analysis
