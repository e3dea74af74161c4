#include "report/regress/comparison.h"

#include <unistd.h>

#include "report/records/cell_key.h"
#include "report/regress/tolerances.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::regress {
namespace {

constexpr int kWidth = 32;
constexpr int kHeight = 16;

images::Image make_image(float value) { return records::fill(images::Image(kWidth, kHeight, 1), value); }

/// A cell of a stand-in filter, half lit everywhere.
ActualCell make_cell() {
  ActualCell cell;
  cell.record.scene = "cubes";
  cell.record.view = "main";
  cell.record.filter = "tent";
  cell.record.map_size = 512;
  cell.record.width = kWidth;
  cell.record.height = kHeight;
  cell.record.receivers = kWidth * kHeight;
  cell.record.nan = 0;
  cell.record.error.rmse = 0.05;
  cell.record.error.mean = -0.01;
  cell.record.artefact.leak = 0.2;
  cell.record.attribution.model.rms = 0.04;
  cell.record.cost.fetches = 4.0;
  cell.record.time_ms.lookup = records::Quartiles{2.0, 1.9, 2.1, kFewestRounds};
  cell.record.ratio_to_none.lookup = records::Ratio{2.0, {1.9, 2.1}};
  cell.record.images.parts = "tent";
  cell.record.key = records::cell_key(cell.record);
  cell.origin = {1, "llvmpipe", "a machine", "abc"};
  cell.images.visibility = make_image(0.5f);
  return cell;
}

BaselineCell expect(const ActualCell& cell) {
  const records::CellRecord& r = cell.record;
  return {name_cell(r), r.map_size, r.width, r.height, cell.origin, read_values(r)};
}

Comparison compare(const ActualCell& now, const ActualCell& before, const Tolerances& tolerances = Tolerances()) {
  return compare_cell(now, expect(before), before.images, tolerances);
}

/// Compares what `change` makes of a cell with the cell as it was.
template <class Change>
Comparison compare_changed(const Change& change, const ActualCell& before = make_cell()) {
  ActualCell now = before;
  change(now);
  return compare(now, before);
}

/// A cell whose pixels may all differ by so much for rounding.
ActualCell make_rounded_cell(float bound) {
  ActualCell cell = make_cell();
  cell.images.uncertainty.rounding = make_image(bound);
  return cell;
}

TEST(Comparison, OfTheSame_FindsNothing) {
  const Comparison same = compare_changed([](ActualCell&) {});
  EXPECT_EQ(same.outcome, Outcome::kSame);
  EXPECT_TRUE(same.findings.empty());
  EXPECT_TRUE(same.notes.empty());
  EXPECT_EQ(same.pixels->compared, kWidth * kHeight);
}

TEST(Comparison, OnePixel_IsSeen_AndItsPlaceIsNamed) {
  const Comparison moved = compare_changed([](ActualCell& cell) { *cell.images.visibility.at(7, 3) += 0.02f; });
  EXPECT_EQ(moved.outcome, Outcome::kChanged);
  EXPECT_EQ(moved.pixels->changed, 1);
  EXPECT_EQ(moved.pixels->max_x, 7);
  EXPECT_EQ(moved.pixels->max_y, 3);
  EXPECT_NEAR(moved.pixels->max, 0.02, 1e-6);
  EXPECT_THAT(moved.findings.front().text, HasSubstr("(7, 3)"));
}

TEST(Comparison, RoundingToHalf_IsNoChange) {
  const auto move_all = [](float by) {
    return compare_changed([by](ActualCell& cell) {
      for (float& texel : cell.images.visibility.texels) texel += by;
    });
  };
  EXPECT_EQ(move_all(0x1p-12f).outcome, Outcome::kSame);
  EXPECT_EQ(move_all(0x1.2p-12f).outcome, Outcome::kChanged);
}

TEST(Comparison, NotFinite_IsAChange_ExcusedOrNot) {
  for (const float bound : {0.0f, 1.0f, images::kMayFlip}) {
    ActualCell before = make_rounded_cell(bound);
    ActualCell now = before;
    *now.images.visibility.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(compare(now, before).outcome, Outcome::kChanged) << bound;
  }
}

TEST(Comparison, NotFiniteAsBefore_IsNoChange) {
  ActualCell cell = make_cell();
  *cell.images.visibility.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(compare(cell, cell).outcome, Outcome::kSame);
  ActualCell more = cell;
  more.record.nan = 1;
  EXPECT_EQ(compare(more, cell).outcome, Outcome::kChanged);
}

TEST(Comparison, BrokenBoundOfTheBaseline_ExcusesNothing) {
  ActualCell before = make_rounded_cell(0.0f);
  ActualCell now = before;
  before.images.uncertainty.rounding.texels[7] = std::numeric_limits<float>::quiet_NaN();
  now.images.visibility.texels[7] = 1.0f;
  EXPECT_EQ(compare(now, before).outcome, Outcome::kChanged);
}

TEST(Comparison, DamagedImages_AreUnreadable) {
  using UncertaintyMember = images::Image images::UncertaintyImages::*;
  // Replaces one image of the baseline, or of the run, and compares the two.
  const auto compare_damaged = [](UncertaintyMember member, bool in_baseline, const images::Image& image) {
    ActualCell cell = make_cell();
    for (const images::UncertaintyImage& each : images::list_uncertainty_images())
      cell.images.uncertainty.*each.image = make_image(0.0f);
    CellImages expected = cell.images;
    (in_baseline ? expected : cell.images).uncertainty.*member = image;
    return compare_cell(cell, expect(cell), expected, Tolerances()).outcome;
  };
  for (const images::UncertaintyImage& each : images::list_uncertainty_images())
    for (const bool in_baseline : {false, true}) {
      EXPECT_EQ(compare_damaged(each.image, in_baseline, make_image(0.0f)), Outcome::kSame) << each.id;
      EXPECT_EQ(compare_damaged(each.image, in_baseline, images::Image(4, 4, 1)), Outcome::kUnreadable) << each.id;
    }
  EXPECT_EQ(compare_damaged(&images::UncertaintyImages::seed_deviation, true, {}), Outcome::kUnreadable);
}

TEST(Comparison, ManyExcusedPixelsThatDiffer_AreAChange) {
  ActualCell before = make_rounded_cell(images::kMayFlip);
  ActualCell now = before;
  *now.images.visibility.at(5, 5) = 1.0f;  // one of 512: more than one in a thousand
  const Comparison found = compare(now, before);
  EXPECT_EQ(found.outcome, Outcome::kChanged);
  EXPECT_EQ(found.findings.front().metric, kExcusedChanged);
}

TEST(Comparison, PixelThatMayFlip_IsExcusedByName) {
  Tolerances tolerances;
  tolerances.set("tent", kExcusedChanged, {0.01, "a small picture"});
  ActualCell before = make_rounded_cell(0.0f);
  *before.images.uncertainty.rounding.at(5, 5) = images::kMayFlip;
  ActualCell now = before;
  *now.images.visibility.at(5, 5) = 1.0f;
  const Comparison excused = compare(now, before, tolerances);
  EXPECT_EQ(excused.outcome, Outcome::kSame);
  EXPECT_EQ(excused.pixels->excused_flips, 1);
  EXPECT_EQ(excused.pixels->excused_changed, 1);
  ASSERT_EQ(excused.notes.size(), 1u);
  *now.images.visibility.at(6, 5) = 1.0f;
  EXPECT_EQ(compare(now, before, tolerances).outcome, Outcome::kChanged);
}

TEST(Comparison, RoundingBound_WidensItsPixelAlone) {
  ActualCell before = make_rounded_cell(0.0f);
  *before.images.uncertainty.rounding.at(5, 5) = 0x1p-7f;
  ActualCell now = before;
  *now.images.visibility.at(5, 5) += 0x1p-7f;
  EXPECT_EQ(compare(now, before).outcome, Outcome::kSame);
  *now.images.visibility.at(6, 5) += 0x1p-7f;
  EXPECT_EQ(compare(now, before).outcome, Outcome::kChanged);
}

/// Both images keep bounds below 2^-14 as 0, and the pixel's own tolerance is spent on storing visibility in 16 bits.
TEST(Comparison, SmallRounding_IsAddedToThatOfStoring) {
  ActualCell before = make_cell();
  const auto compare_moved = [&](float difference) {
    ActualCell now = before;
    *now.images.visibility.at(5, 5) += difference;
    return compare(now, before).outcome;
  };
  EXPECT_EQ(compare_moved(0x1p-12f), Outcome::kSame);
  EXPECT_EQ(compare_moved(0x1p-12f + 0x1p-15f), Outcome::kChanged) << "there are no bounds";
  before.images.uncertainty.rounding = make_image(0.0f);
  EXPECT_EQ(compare_moved(0x1p-12f + 0x1p-15f), Outcome::kSame);
  EXPECT_EQ(compare_moved(0x1p-12f + 0x1p-13f), Outcome::kSame);
  EXPECT_EQ(compare_moved(0x1p-12f + 0x1.1p-13f), Outcome::kChanged);
}

TEST(Comparison, PixelThatRoundingMovesFar_DiffersWhereItMovesFartherThanItsBounds) {
  ActualCell before = make_rounded_cell(kWidestBound);
  const auto count_moved = [&](float difference) {
    ActualCell now = before;
    now.images.visibility = make_image(0.5f + difference);
    return compare(now, before).pixels->excused_changed;
  };
  EXPECT_EQ(count_moved(0x1p-4f), 0);
  EXPECT_EQ(count_moved(0x1.1p-4f), kWidth * kHeight);
}

/// A map that is broken has bounds that explain anything: no reason to excuse the whole image.
TEST(Comparison, ExcusingMuchMoreThanTheBaseline_IsAChange) {
  ActualCell before = make_rounded_cell(0.0f);
  ActualCell now = before;
  now.images.uncertainty.rounding = make_image(1.0f);
  now.images.visibility = make_image(0.0f);
  const Comparison broken = compare(now, before);
  EXPECT_EQ(broken.outcome, Outcome::kChanged);
  EXPECT_EQ(broken.findings.front().metric, kExcused);
}

TEST(Comparison, LargerError_IsARegressionOfAccuracy_SmallerOneIsNot) {
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.record.error.rmse = 0.06; }).outcome, Outcome::kLessAccurate);
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.record.error.rmse = 0.04; }).outcome, Outcome::kChanged);
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.record.error.mean = -0.02; }).outcome, Outcome::kLessAccurate);
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.record.error.mean = 0.005; }).outcome, Outcome::kChanged);
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.record.artefact.leak = 0.3; }).outcome, Outcome::kLessAccurate);
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.record.attribution.model.rms = 0.05; }).outcome,
            Outcome::kChanged);
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.record.error.rmse = 0.05 + 0x1p-13; }).outcome, Outcome::kSame);
}

TEST(Comparison, Cost_MayNotChangeAtAll) {
  const Comparison dearer = compare_changed([](ActualCell& cell) { cell.record.cost.fetches = 5.0; });
  EXPECT_EQ(dearer.outcome, Outcome::kChanged);
  EXPECT_THAT(dearer.findings.front().text, HasSubstr("cost.fetches: 5, was 4"));
}

TEST(Comparison, NumberThatIsGone_IsAChange_WithItsReason) {
  const Comparison gone = compare_changed([](ActualCell& cell) {
    cell.record.error = {};
    cell.record.absent["error"] = "the run was made with --no-truth";
  });
  EXPECT_EQ(gone.outcome, Outcome::kChanged);
  EXPECT_THAT(gone.findings.front().text, HasSubstr("the run was made with --no-truth"));
}

TEST(Comparison, NumberThatTheBaselineLacks_IsAChange) {
  const ActualCell cell = make_cell();
  BaselineCell empty = expect(cell);
  empty.values.numbers.clear();
  EXPECT_EQ(compare_cell(cell, empty, cell.images, Tolerances()).outcome, Outcome::kChanged);
}

TEST(Comparison, TruthsNoise_CountsWhereTheTruthIsAnother) {
  const auto compare_with = [](std::uint64_t seed) {
    ActualCell before = make_cell();
    before.record.truth.se = 0.001;
    ActualCell now = before;
    now.origin.seed = seed;
    now.record.error.rmse = *before.record.error.rmse + 0.003;  // 3 x sqrt 2 x 0.001 = 0.0042
    return compare(now, before).outcome;
  };
  EXPECT_EQ(compare_with(1), Outcome::kLessAccurate);
  EXPECT_EQ(compare_with(2), Outcome::kSame);
}

TEST(Comparison, Time_CountsAsRatioWithItsInterval_OnOneMachineAlone) {
  const auto slow = [](double low) {
    return [low](ActualCell& cell) { cell.record.ratio_to_none.lookup = records::Ratio{low + 0.1, {low, low + 0.2}}; };
  };
  EXPECT_EQ(compare_changed(slow(2.6)).outcome, Outcome::kSame);  // 2.1 x 1.25 = 2.625
  EXPECT_EQ(compare_changed(slow(2.7)).outcome, Outcome::kSlower);
  EXPECT_EQ(compare_changed(slow(1.0)).outcome, Outcome::kSame);
  const Comparison elsewhere = compare_changed([&](ActualCell& cell) {
    slow(2.7)(cell);
    cell.origin.machine = "another";
  });
  EXPECT_EQ(elsewhere.outcome, Outcome::kSame);
  ASSERT_FALSE(elsewhere.notes.empty());
  EXPECT_THAT(elsewhere.notes.front(), HasSubstr("times are not compared"));
}

TEST(Comparison, TooFewRounds_GiveNoRatio) {
  ActualCell before = make_cell();
  before.record.time_ms.lookup->n = kFewestRounds - 1;
  EXPECT_TRUE(expect(before).values.ratios.empty());
  const Comparison missing =
      compare_changed([](ActualCell& cell) { cell.record.time_ms.lookup->n = kFewestRounds - 1; });
  EXPECT_EQ(missing.outcome, Outcome::kChanged);
  EXPECT_THAT(missing.findings.front().text, HasSubstr("it was timed over 5 rounds"));
}

TEST(Comparison, EmptyOrOtherSizedImage_IsUnreadable) {
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.images.visibility = {}; }).outcome, Outcome::kUnreadable);
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.images.visibility = images::Image(4, 4, 1); }).outcome,
            Outcome::kUnreadable);
  EXPECT_EQ(compare_changed([](ActualCell& cell) { cell.unreadable = "timeout"; }).findings.front().text, "timeout");
  const ActualCell cell = make_cell();
  EXPECT_EQ(compare_cell(cell, expect(cell), {}, Tolerances()).outcome, Outcome::kUnreadable);
}

/// A stochastic filter: each pixel the mean of 16 lookups, of which each is lit with probability `p`.
class Spread : public ::testing::Test {
 protected:
  std::mt19937 generator_{1};

  images::Image draw(double p) {
    std::binomial_distribution<int> lit(16, p);
    images::Image image(kWidth, kHeight, 1);
    for (float& texel : image.texels) texel = static_cast<float>(lit(generator_)) / 16.0f;
    return image;
  }

  /// A baseline of the mean and the deviation over 16 seeds.
  CellImages make_baseline(double p) {
    CellImages images{draw(p), {}};
    std::vector<images::Image> seeds;
    for (int i = 0; i < images::kSpreadSeeds; ++i) seeds.push_back(draw(p));
    images.uncertainty.seed_mean = images.uncertainty.seed_deviation = images::Image(kWidth, kHeight, 1);
    for (std::size_t i = 0; i < images.visibility.texels.size(); ++i) {
      double sum = 0.0, squares = 0.0;
      for (const images::Image& seed : seeds) sum += static_cast<double>(seed.texels[i]);
      const double mean = sum / images::kSpreadSeeds;
      for (const images::Image& seed : seeds) squares += std::pow(static_cast<double>(seed.texels[i]) - mean, 2);
      images.uncertainty.seed_mean.texels[i] = static_cast<float>(mean);
      images.uncertainty.seed_deviation.texels[i] = static_cast<float>(std::sqrt(squares / (images::kSpreadSeeds - 1)));
    }
    return images;
  }

  static Comparison compare(const images::Image& image, const CellImages& expected, std::uint64_t seed) {
    ActualCell before = make_cell();
    before.record.cost.fetches = 16.0;
    ActualCell now = before;
    now.origin.seed = seed;
    now.images.visibility = image;
    return compare_cell(now, expect(before), expected, Tolerances());
  }
};

TEST_F(Spread, AnotherSeed_IsTheSame) {
  for (const double p : {0.0, 0.001, 0.02, 0.5, 0.98, 1.0}) {
    const CellImages expected = make_baseline(p);
    int failed = 0;
    for (std::uint64_t seed = 2; seed < 102; ++seed) failed += compare(draw(p), expected, seed).failed() ? 1 : 0;
    EXPECT_LE(failed, 5) << p;  // one in a hundred expected; more than 5 has probability 6e-4 each
  }
}

TEST_F(Spread, AnotherDistribution_IsFound) {
  const CellImages expected = make_baseline(0.5);
  EXPECT_EQ(compare(draw(0.6), expected, 2).outcome, Outcome::kChanged);
}

TEST_F(Spread, OnePixelOfTheOtherKind_IsFound) {
  const CellImages expected = make_baseline(1.0);
  images::Image acne = draw(1.0);
  *acne.at(9, 2) = 0.5f;
  const Comparison found = compare(acne, expected, 2);
  EXPECT_EQ(found.outcome, Outcome::kChanged);
  EXPECT_THAT(found.findings.front().text, HasSubstr("pixel (9, 2)"));
}

/// Lookups that fall together: a pixel is lit or blocked as a whole. Counts alone would call that a miracle.
TEST_F(Spread, LookupsThatAgree_AreStillNoise) {
  std::bernoulli_distribution lit(0.5);
  const auto flip = [&] {
    images::Image image(kWidth, kHeight, 1);
    for (float& texel : image.texels) texel = lit(generator_) ? 1.0f : 0.0f;
    return image;
  };
  CellImages expected{flip(), {}};
  expected.uncertainty.seed_mean = make_image(0.5f);
  expected.uncertainty.seed_deviation = make_image(0.516f);  // 8 of 16 seeds
  EXPECT_FALSE(compare(flip(), expected, 2).failed());
}

TEST_F(Spread, TheSameSeed_IsComparedPixelByPixel) {
  const CellImages expected = make_baseline(0.5);
  EXPECT_EQ(compare(expected.visibility, expected, 1).outcome, Outcome::kSame);
  EXPECT_EQ(compare(draw(0.5), expected, 1).outcome, Outcome::kChanged);
}

class Truth : public ::testing::Test {
 protected:
  static constexpr float kError = 0.01f;
  std::mt19937 generator_{1};

  TruthImages trace(double at) {
    std::normal_distribution<double> noise(0.0, static_cast<double>(kError));
    TruthImages truth{images::Image(kWidth, kHeight, 1), make_image(kError)};
    for (float& texel : truth.area.texels) texel = static_cast<float>(at + noise(generator_));
    return truth;
  }

  static Comparison compare(const TruthImages& a, const TruthImages& b) {
    return compare_truth({make_cell().record, a}, b, 0.01);
  }
};

TEST_F(Truth, AnotherSeed_IsTheSame_AnotherTruthIsNot) {
  const TruthImages expected = trace(0.5);
  int failed = 0;
  for (int i = 0; i < 100; ++i) failed += compare(trace(0.5), expected).failed() ? 1 : 0;
  EXPECT_LE(failed, 5);
  TruthImages moved = trace(0.5);
  *moved.area.at(3, 4) = 0.8f;
  EXPECT_THAT(compare(moved, expected).findings.at(0).text, HasSubstr("(3, 4)"));
}

TEST_F(Truth, TheErrorsOfBothCount) {
  const TruthImages sure{make_image(0.5f), make_image(1e-4f)};
  EXPECT_FALSE(compare(trace(0.5), sure).failed());
  EXPECT_FALSE(compare(sure, trace(0.5)).failed());
}

TEST_F(Truth, WhereRaysAgree_ThreeInSixtyFourAreLeftOpen) {
  TruthImages expected{make_image(1.0f), make_image(0.0f)}, now = expected;
  *now.area.at(0, 0) = 1.0f - 2.5f / 64.0f;
  EXPECT_FALSE(compare(now, expected).failed());
  *now.area.at(0, 0) = 1.0f - 4.0f / 64.0f;
  EXPECT_TRUE(compare(now, expected).failed());
}

class ToleranceFile : public ::testing::Test {
 protected:
  Tolerances read(const std::string& text) const { return read_tolerances(folder_.write("tolerances.toml", text)); }

  /// Expects one message that names the line and holds the words.
  void expect_refusal(const std::string& text, int line, const std::string& words) const {
    EXPECT_THAT(error_of([&] { read(text); }),
                is_error(ErrorKind::kInput,
                         (folder_.path() / "tolerances.toml").string() + ":" + std::to_string(line) + ": ", words))
        << text;
  }

  TestFolder folder_;
};

TEST_F(ToleranceFile, WhatIsWritten_IsReadBack) {
  Tolerances written;
  written.set("vsm", "error.rmse", {0.25, "moments \"of\" 16 bits \\ here"});
  written.set("", "ratio_to_none.lookup", {HUGE_VAL, "not compared"});
  const Tolerances back = read(write_tolerances(written));
  for (const std::string& metric : list_limited_metrics()) {
    for (const char* filter : {"vsm", "none"}) {
      EXPECT_EQ(back.find(filter, metric).limit, written.find(filter, metric).limit) << filter << " " << metric;
      EXPECT_EQ(back.find(filter, metric).reason, written.find(filter, metric).reason) << filter << " " << metric;
    }
  }
  EXPECT_EQ(back.find("vsm", "error.rmse").limit, 0.25);
}

TEST_F(ToleranceFile, OfOneFilter_LeavesTheOthersAsTheyAre) {
  const Tolerances read_back = read("[filter.\"esm\".\"visibility.pixel\"]\nlimit = 0.5\nreason = \"r\"\n");
  EXPECT_EQ(read_back.find("esm", kPixel).limit, 0.5);
  EXPECT_EQ(read_back.find("vsm", kPixel).limit, Tolerances().find("vsm", kPixel).limit);
}

TEST_F(ToleranceFile, EveryToleranceHasItsReason) {
  const Tolerances fresh;
  for (const std::string& metric : list_limited_metrics())
    EXPECT_FALSE(fresh.find("any", metric).reason.empty()) << metric;
}

TEST_F(ToleranceFile, BadFiles_AreRefusedWithTheirLine) {
  expect_refusal("[all.\"error.rmse\"]\nlimit = 0.1\n", 1, "needs a reason");
  expect_refusal("[all.\"error.rmse\"]\nlimit = 0.1\nreason = \"\"\n", 1, "needs a reason");
  expect_refusal("[all.\"error.rmse\"]\nlimit = -0.1\nreason = \"r\"\n", 1, "limit of 0 or more");
  expect_refusal("[all.\"error.rmse\"]\nlimit = nan\nreason = \"r\"\n", 1, "limit of 0 or more");
  expect_refusal("[all.\"error.rmse\"]\nreason = \"r\"\n", 1, "limit of 0 or more");
  expect_refusal("[all.\"error.rms\"]\nlimit = 0\nreason = \"r\"\n", 1, "did you mean 'error.rmse'?");
  expect_refusal("\n[other.\"error.rmse\"]\nlimit = 0\nreason = \"r\"\n", 2,
                 "unknown key 'other' in the tolerances; known: all, filter");
  expect_refusal("[all.\"error.rmse\"]\nlimit = 0\nreason = \"r\"\nwhy = 1\n", 4,
                 "unknown key 'why' in [error.rmse]; known: limit, reason");
  expect_refusal("all = 3\n", 1, "must be a table");
  expect_refusal("[all\n", 1, "");
}

}  // namespace
}  // namespace shadowbench::regress
