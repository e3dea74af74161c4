// `shadowbench diff` and `list metrics`, as a user calls them.

#include "report/images/picture_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

images::Image make_grey(std::vector<float> values) {
  images::Image image(static_cast<int>(values.size()), 1, 1);
  image.texels = std::move(values);
  return image;
}

/// A folder with "a.exr", of several parts, and two pictures as text that OpenImageIO reads.
class Diff : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    images::write_exr(folder() / "a.exr",
                      {{"image", {"Y"}, make_grey({0.5f, 1.0f, 0.0f, 0.25f}), false},
                       {"truth", {"Y"}, make_grey({0.0f, 1.0f, 0.5f, 0.0f}), false},
                       {"broken", {"Y"}, make_grey({kNan, 1.0f, 0.5f, 0.0f}), false},
                       {"nothing", {"Y"}, make_grey({kNan, kNan, kNan, kNan}), false},
                       {"mask", {"Y"}, make_grey({1.0f, 1.0f, 0.0f, 0.0f}), false},
                       {"empty", {"Y"}, make_grey({0.0f, 0.0f, 0.0f, 0.0f}), false},
                       {"two", {"U", "V"}, images::Image(4, 1, 2), false}},
                      {});
    write("a.pgm", "P2\n2 1\n255\n51 255\n");
  }

  json diff_json(const std::string& arguments) const {
    const Outcome outcome = run("diff --json " + arguments);
    return outcome.out.empty() ? json(outcome.err) : json::parse(outcome.out);
  }
};

TEST_F(Diff, PrintsOneNumberALine) {
  const Outcome outcome = succeed("diff 'a.exr#image' 'a.exr#truth'");
  EXPECT_THAT(outcome.out, MatchesRegex("rmse        0.375\nmae         0.3125\np95         0.5\nmax         0.5\n"
                                        "mean        0.0625\n([a-z0-9_]+ +[0-9.]+\n)*flip        0.[0-9]+\n"
                                        "compared    4\nnot_finite  0\n"));
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Diff, FileAlone_IsItsFirstPart) { EXPECT_EQ(diff_json("a.exr 'a.exr#image'")["max"], 0.0); }

TEST_F(Diff, OneMetric_IsPrintedAlone) {
  EXPECT_EQ(run("diff 'a.exr#image' 'a.exr#truth' --metric mae").out,
            "mae         0.3125\ncompared    4\nnot_finite  0\n");
  const json json = diff_json("'a.exr#image' 'a.exr#truth' --metric mae");
  EXPECT_TRUE(json.contains("mae"));
  EXPECT_FALSE(json.contains("rmse"));
}

TEST_F(Diff, EveryPictureMetricOfTheList_IsAccepted) {
  for (const auto& metric : json::parse(run("list metrics --json").out)) {
    const auto name = metric["name"].get<std::string>();
    EXPECT_EQ(run("diff 'a.exr#image' 'a.exr#truth' --metric " + name).exit_code, metric["diff"] ? 0 : 2) << name;
  }
}

TEST_F(Diff, PixelsThatAreNotFinite_AreReported) {
  const Outcome outcome = succeed("diff 'a.exr#broken' 'a.exr#truth'");
  EXPECT_THAT(outcome.out, HasSubstr("rmse        0\n"));
  EXPECT_THAT(outcome.out, HasSubstr("flip        absent: a pixel is NaN or infinite"));
  EXPECT_THAT(outcome.out, HasSubstr("compared    3\nnot_finite  1\n"));
  const json json = diff_json("'a.exr#broken' 'a.exr#truth'");
  EXPECT_TRUE(json["flip"].is_null());
  EXPECT_THAT(json["absent"]["flip"].get<std::string>(), HasSubstr("NaN"));
}

TEST_F(Diff, NothingToCompare_IsAnInputError) {
  expect_refusals(
      {{"diff 'a.exr#image' 'a.exr#truth' --mask 'a.exr#empty'", 3, {"nothing can be compared", "mask is 0"}},
       {"diff 'a.exr#nothing' 'a.exr#truth'", 3, {"nothing can be compared", "finite"}},
       {"diff 'a.exr#two' 'a.exr#two' --metric flip", 3, {"nothing can be compared", "these have 2"}}});
  EXPECT_EQ(run("diff 'a.exr#nothing' 'a.exr#truth'").out, "");
  EXPECT_EQ(run("diff --json 'a.exr#nothing' 'a.exr#truth'").exit_code, 3);
  const json json = diff_json("'a.exr#nothing' 'a.exr#truth'");
  EXPECT_TRUE(json["rmse"].is_null());
  EXPECT_THAT(json["absent"]["rmse"].get<std::string>(), HasSubstr("finite"));
  EXPECT_EQ(json["not_finite"], 4);
}

TEST_F(Diff, BadPictures_AreInputErrors) {
  expect_refusals({{"diff no/such.png a.exr", 3, {"no/such.png", "no such file"}},
                   {"diff a.exr .", 3, {"folder"}},
                   {"diff a.exr ''", 2, {"a value is missing"}}});
}

TEST_F(Diff, BadMasks_AreInputErrors) {
  const std::string pair = "diff 'a.exr#image' 'a.exr#truth' --mask ";
  expect_refusals(
      {{pair + "no/such.exr", 3, {"no/such.exr", "no such file"}}, {pair + "''", 2, {"--mask", "a value is missing"}}});
}

TEST_F(Diff, BadOptions_AreUsageErrors) {
  expect_refusals({{"diff a.exr", 2, {"B"}},
                   {"diff a.exr a.exr --metric rsme",
                    2,
                    {"'rsme'", "did you mean 'rmse'", "known: all, rmse, mae, p95, max, mean,", "flip"}},
                   {"diff a.exr a.exr --metric acne", 2, {"'acne'", "known: all, rmse"}}});
  for (const char* value : {"0", "-1", "nan", "inf", "1e9"}) {
    expect_refusal(std::string("diff a.exr a.exr --pixels-per-degree ") + value, 2,
                   {"--pixels-per-degree", "0.1 .. 1000"});
  }
  expect_refusal("diff a.exr a.exr --pixels-per-degree wide", 2, {"--pixels-per-degree", "wide"});
}

TEST_F(Diff, Out_DrawsDifferenceAndFlip) {
  const Outcome outcome = succeed("diff 'a.exr#image' 'a.exr#truth' --out new/d.png");
  EXPECT_THAT(outcome.out, HasSubstr("rmse        0.375"));
  const images::Image two = images::read_picture(folder() / "new" / "d.png");
  ASSERT_EQ(run("diff 'a.exr#two' 'a.exr#two' --out one.png").exit_code, 0) << "two channels have no FLIP";
  EXPECT_GT(two.width, images::read_picture(folder() / "one.png").width);
  expect_refusal("diff 'a.exr#image' 'a.exr#truth' --out d.exr", 2, {"--out: 'd.exr' must end in .png"});
  EXPECT_EQ(run("diff 'a.exr#image' 'a.exr#truth' --out a.pgm/d.png").exit_code, 6) << "no folder";
}

TEST_F(Diff, WhatIsRead_IsNotWrittenOver) {
  succeed("diff 'a.exr#image' 'a.exr#truth' --out first.png");
  succeed("diff first.png first.png --out other.png");
  expect_refusal("diff other.png first.png --out ./first.png", 2, {"--out: './first.png'", "would be lost"});
}

TEST_F(Diff, PixelsPerDegree_ReachFlip) {
  write("c.pgm", "P2\n4 1\n255\n0 255 0 255\n");
  write("d.pgm", "P2\n4 1\n255\n255 0 255 0\n");
  const double near = diff_json("c.pgm d.pgm --pixels-per-degree 0.1")["flip"];
  EXPECT_GT(near, diff_json("c.pgm d.pgm --pixels-per-degree 1000")["flip"]);
  EXPECT_LE(near, 1.0);
}

TEST_F(Diff, ListMetrics_DefinesWhatARunReports) {
  const Outcome outcome = run("list metrics");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* word : {"error.rmse", "truth.se", "artefact.contact_gap", "attribution.model.share", "0 .. 1"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
  const json json = json::parse(run("list metrics --json").out);
  for (const auto& metric : json) {
    EXPECT_FALSE(metric["definition"].get<std::string>().empty()) << metric;
    EXPECT_NE(outcome.out.find(metric["path"].get<std::string>()), std::string::npos) << metric;
  }
}

TEST_F(Diff, Runs_AreForRegress) {
  write("run/results.json", "{}");
  for (const char* words : {"diff run run", "diff a.pgm run", "diff run/results.json a.pgm"})
    expect_refusal(words, 2, {"run", "'shadowbench regress'"});
}

}  // namespace
}  // namespace shadowbench::test
