// What a user meets whose filter copies a built-in one, declares its kernel, has mistakes, or is wrong.

#include "report/images/picture_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

class UserKernel : public ProgramTest {
 protected:
  json measure(const std::string& rest) const { return ProgramTest::measure("--size 96x54 --map-size 128 " + rest); }
};

TEST_F(UserKernel, AloneInARun_HasTheMapsPicturesAsWell) {
  copy_filter("tent5x5", "mine", "# mine\n");
  const auto picture = [&](const std::string& arguments) {
    const json cells = measure(arguments);
    EXPECT_EQ(cells.size(), 1u);
    return read("out/" + cells[0]["images"]["depth_map"].get<std::string>());
  };
  const std::string alone = picture("--grids --filters mine --filter-file mine.glsl");
  std::filesystem::remove_all(folder() / "out");
  EXPECT_EQ(alone, picture("--grids --filters tent5x5"));
}

TEST_F(UserKernel, Declared_GivesWidthAndAttribution_WithNumericErrorInTheEstimators) {
  copy_filter("tent5x5", "declared", "kernel = \"tent:2.5\"\n");
  const json cells = measure("--filters tent5x5,declared --filter-file declared.glsl");
  const json &built_in = cells[0], &declared = cells[1];
  EXPECT_EQ(declared["kernel"], built_in["kernel"]);
  EXPECT_EQ(declared["error"], built_in["error"]);
  for (const char* part : {"discretisation", "model"})
    EXPECT_EQ(declared["attribution"][part], built_in["attribution"][part]) << part;
  EXPECT_TRUE(declared["attribution"]["numeric"]["rms"].is_null());
  EXPECT_EQ(declared["absent"]["attribution.numeric"],
            "the filter has no scalar model: numeric error is within the estimator's");
  double shares = 0.0;
  for (const char* part : {"estimator", "discretisation", "model"})
    shares += declared["attribution"][part]["share"].get<double>();
  EXPECT_NEAR(shares, 1.0, 1e-9);
  EXPECT_NEAR(declared["attribution"]["estimator"]["rms"], built_in["attribution"]["numeric"]["rms"], 1e-12);
  EXPECT_GT(declared["attribution"]["estimator"]["rms"], 0.0);
  EXPECT_THAT(read("out/index.html"), HasSubstr("numeric and estimator"));
}

TEST_F(UserKernel, DeclaredByAStochasticFilter_GivesItsNoise_AndFollowsItsRadius) {
  copy_filter("poisson", "mine", "kernel = \"disk:radius\"\n");
  const json cells = measure("--filters poisson:radius=5,mine:radius=5 --filter-file mine.glsl");
  EXPECT_EQ(cells[1]["kernel"], cells[0]["kernel"]);
  EXPECT_EQ(cells[1]["error"]["kernel_rmse"], cells[0]["error"]["kernel_rmse"]);
  EXPECT_EQ(cells[1]["artefact"]["noise"], cells[0]["artefact"]["noise"]);
  EXPECT_FALSE(cells[1]["artefact"]["noise"].is_null());
}

class WrittenFilters : public ProgramTest {
 protected:
  /// A filter whose function's body stands in its line 8.
  std::string write_filter(const std::string& id, const std::string& body, const char* kind = "other",
                           double radius = 1.0) const {
    return write(id + ".glsl", filters::write_filter(fmt::format("radius_texels = {}\n", radius),
                                                     "float visibility(Receiver r) {\n" + body + "\n}\n", kind));
  }
};

class FilterMistakesOfARun : public WrittenFilters {
 protected:
  Outcome draw(const std::string& filters) const {
    return run(
        small("--gl software --grids --size 32x18 --map-size 32 --no-truth --pad-texels 4 --filters none " + filters));
  }
};

constexpr const char* kGoodBody = "  return compare_2x2(r, vec2(0.0), r.depth);";

TEST_F(FilterMistakesOfARun, AllFiles_AreCheckedBeforeAnyIsMeasured) {
  write_filter("good", kGoodBody);
  write_filter("one", "  return 12.x;");
  write_filter("two", "  return compare2x2(r, vec2(0.0), r.depth);");
  const Outcome outcome = draw("--filter-file good.glsl --filter-file one.glsl --filter-file two.glsl");
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("shadowbench: 2 filters have mistakes\n"));
  EXPECT_THAT(outcome.err, HasSubstr("one.glsl:8: the GLSL of 'one lookup' does not compile: syntax error"));
  EXPECT_THAT(outcome.err, HasSubstr("two.glsl:8: the GLSL of 'two lookup' does not compile: there is no function "
                                     "'compare2x2'; did you mean 'compare_2x2'?\n    return compare2x2(r, vec2(0.0), "
                                     "r.depth);\n"));
  EXPECT_THAT(outcome.err, Not(HasSubstr(" % ·")));
  EXPECT_TRUE(std::filesystem::is_empty(folder() / "out" / "cells")) << "nothing was measured";
}

TEST_F(FilterMistakesOfARun, FrontMatters_AreToldTogether) {
  write_filter("one", kGoodBody, "mistaken");
  write_filter("two", kGoodBody, "mistaken");
  const Outcome outcome = draw("--filter-file one.glsl --filter-file two.glsl");
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("2 filters have mistakes\none.glsl:4"), HasSubstr("\ntwo.glsl:4")));
}

TEST_F(FilterMistakesOfARun, ABuildServer_HasAFailingTestCase_UntilTheyAreMended) {
  write_filter("mine", "  return nowhere;");
  EXPECT_EQ(draw("--filter-file mine.glsl").exit_code, 5);
  const Outcome broken = run("regress out --baseline base --junit junit.xml");
  EXPECT_EQ(broken.exit_code, 5) << broken.err;
  EXPECT_THAT(broken.out, HasSubstr("mine.glsl:8: the GLSL of 'mine lookup' does not compile: 'nowhere' is not"));
  EXPECT_THAT(broken.out, HasSubstr("\nnothing was measured, because a filter has a mistake\n"));
  EXPECT_THAT(broken.err, HasSubstr("shadowbench: there is nothing to compare; mend mine.glsl, and run again"));
  const std::string junit = read("junit.xml");
  EXPECT_THAT(junit,
              AllOf(HasSubstr("tests=\"1\" failures=\"1\""), HasSubstr("<testcase classname=\"filters\" name=\"mine"),
                    HasSubstr("<failure type=\"broken\""), HasSubstr("mine.glsl:8: ")));
  EXPECT_THAT(read("out/regress/regress.md"), HasSubstr("return nowhere;"));
  EXPECT_EQ(run("regress out --baseline base --accept").exit_code, 5) << "there is nothing to accept";
  EXPECT_FALSE(exists("base"));
  write_filter("mine", kGoodBody);
  ASSERT_EQ(draw("--filter-file mine.glsl").exit_code, 0);
  succeed("regress out --baseline base --accept");
  succeed("regress out --baseline base --junit junit.xml");
  EXPECT_THAT(read("junit.xml"), AllOf(Not(HasSubstr("broken")), HasSubstr(" time=\"")));
}

TEST_F(FilterMistakesOfARun, OfARunThatWasFinishedBefore_NothingIsCompared) {
  write_filter("mine", kGoodBody);
  ASSERT_EQ(draw("--filter-file mine.glsl").exit_code, 0);
  succeed("regress out --baseline base --accept");
  write_filter("mine", "  return nowhere;");
  EXPECT_EQ(draw("--filter-file mine.glsl").exit_code, 5);
  EXPECT_EQ(run("regress out --baseline base").exit_code, 5) << "the cells are those of another file";
  write_filter("mine", kGoodBody);
  EXPECT_THAT(draw("--filter-file mine.glsl").err, HasSubstr("nothing is left to do"));
  succeed("regress out --baseline base");
}

class Suspects : public WrittenFilters {
 protected:
  /// Runs the filters of files beside three others, and gives their cells.
  json measure(const std::vector<std::filesystem::path>& files) const {
    std::string words = "--grids --no-attribution --size 160x90 --map-size 256 --filters none,pcf2x2,tent3x3", options;
    for (const std::filesystem::path& file : files) {
      words += "," + file.stem().string();
      options += " --filter-file " + file.string();
    }
    json cells = ProgramTest::measure(words + options);
    cells.erase(cells.begin(), cells.begin() + 3);
    return cells;
  }

  static std::string find_constant() { return user_filter("wrong/constant.glsl"); }
};

TEST_F(Suspects, AreSuspectOfOneThing_AndHavePicturesAndErrors) {
  const std::string fetch = "compare_2x2(r, vec2(0.0), r.depth)";
  const std::pair<std::filesystem::path, const char*> wrong[] = {
      {write_filter("out_of_range", "  return 16.0 * " + fetch + ";"), "lies between 0 and 16"},
      {write_filter("not_finite", "  float lit = " + fetch + ";\n  return lit > 0.0 ? lit : lit / lit;"),
       "pixels are not finite"},
      {find_constant(), "is 0.5 at every receiver"},
      {write_filter("no_fetch", "  return random_turn(r.pixel) < 0.5 ? 0.0 : 1.0;"), "reads nothing from the map"},
      {write_filter(
           "far_taps",
           "  float sum = compare_2x2(r, vec2(-1.5, -0.5), r.depth) + compare_2x2(r, vec2(1.5, -0.5), r.depth);\n"
           "  return 0.25 * (sum + compare_2x2(r, vec2(-1.5, 0.5), r.depth) +\n"
           "                 compare_2x2(r, vec2(1.5, 0.5), r.depth));",
           "other", 1.5),
       "up to 2.5 texels from the receiver, but its radius_texels declares 1.5"},
      {write_filter("moved_uv", "  r.uv += 3.0 * map_texel_uv;\n  return " + fetch + ";"), "up to 4 texels"},
      {write_filter("unwritten_map",
                    "  float lit = compare_nearest(r, vec2(0.0), r.depth);\n"
                    "  return r.depth <= fetch_map(r, vec2(0.0)).x ? 1.0 : lit;"),
       "no encode() writes one"}};
  std::vector<std::filesystem::path> files;
  for (const auto& [file, words] : wrong) files.push_back(file);
  const json cells = measure(files);
  ASSERT_EQ(cells.size(), files.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& [path, words] = wrong[i];
    const std::string filter = path.stem();
    SCOPED_TRACE(filter);
    for (const char* file : {"stderr.txt", "out/index.html"})
      EXPECT_THAT(read(file), HasSubstr(filter + " is suspect: "));
    EXPECT_EQ(cells[i]["status"], "suspect");
    EXPECT_THAT(cells[i]["suspect_of"].get<std::vector<std::string>>(), ElementsAre(HasSubstr(words)));
    EXPECT_TRUE(cells[i]["error"]["rmse"].is_number());
    EXPECT_TRUE(exists("out/" + cells[i]["images"]["picture"].get<std::string>()));
  }
  EXPECT_THAT(read("out/accuracy.csv"), HasSubstr(",suspect,"));
}

TEST_F(Suspects, AreOnNoFront_AndInNoAdvice) {
  measure({find_constant()});
  const Outcome advice = succeed("advise out --max-rmse 1 --json");
  EXPECT_THAT(advice.out, HasSubstr("wrong on cubes (suspect: "));
  EXPECT_THAT(read("out/summary.md"), HasSubstr("cubes: constant is suspect: "));
  expect_valid();
}

TEST_F(Suspects, AFilterThatReadsAsFarAsItDeclares_IsNone) {
  for (const char* radius : {"0", "2", "5"}) {
    succeed(std::string("run --out out --fresh --no-truth --scene cubes --size 96x54 --map-size 128 "
                        "--rounds 1 --filters none,declared_reach:radius=") +
            radius + " --filter-file " + user_filter("declared_reach.glsl"));
    const auto cells = read_cells();
    EXPECT_EQ(cells.back()["status"], "ok") << cells.back()["suspect_of"];
  }
}

/// Passes over the picture: their time and reads are told, and what is wrong with them is.
TEST_F(Suspects, ScreenPasses_AreMeasured_AndJudged) {
  const json cells = ProgramTest::measure(
      "--size 96x54 --map-size 128 --rounds 3 --filters none,screen_box,screen_box:side=3,"
      "screen_box:spoil=not-finite,screen_box:spoil=endless,atrous,pcss:screen=bilateral --filter-file " +
      user_filter("screen_box.glsl") + " --filter-file " + user_filter("atrous.glsl"));
  const char* wrong[] = {nullptr,
                         nullptr,
                         "reads 3 pixels away, and declares a reach of 1",
                         "pixels are not finite",
                         does_gl_end_loops() ? "goes on after" : nullptr,
                         nullptr,
                         nullptr};
  for (std::size_t i = 0; i < std::size(wrong); ++i) {
    SCOPED_TRACE(cells[i]["filter"].get<std::string>() + std::to_string(i));
    EXPECT_EQ(cells[i]["status"], wrong[i] ? "suspect" : "ok");
    if (wrong[i]) EXPECT_THAT(cells[i]["suspect_of"].get<std::vector<std::string>>(), ElementsAre(HasSubstr(wrong[i])));
    ASSERT_EQ(cells[i]["time_ms"].contains("screen"), i > 0);
    if (i == 0) continue;
    EXPECT_LT(cells[i]["time_ms"]["screen"]["median"], cells[i]["time_ms"]["lookup"]["median"]);
    EXPECT_GT(cells[i]["screen_reads"], 4.0);
  }
  EXPECT_THAT(cells[6]["absent"].dump(), HasSubstr("a part of the filter's kernel is on the screen, in pixels"));
  EXPECT_THAT(read("out/timings.csv"), HasSubstr("screen"));
}

/// Every built-in filter on every scene, with parameters too that change what is read.
TEST_F(Suspects, BuiltInFilters_AreNone) {
  succeed(
      "run --out out --size 160x90 --map-size 512 --rounds 1 --phases 1 --no-attribution --no-truth --no-grids "
      "--filters "
      "all,teaching,vsm:radius=0,esm:radius=8,esm:combine=log,poisson:radius=0,gather_pcf:radius=3,"
      "pcss:max_radius=20,dpcf:max_radius=20,poisson:radius=20,rotation=interleaved-gradient");
  const auto cells = read_cells();
  EXPECT_GE(cells.size(), 5u * 24u);
  for (const auto& cell : cells) EXPECT_EQ(cell["status"], "ok") << cell["scene"] << cell["filter"] << cell["message"];
}

}  // namespace
}  // namespace shadowbench::test
