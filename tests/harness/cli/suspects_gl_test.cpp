// Wrong filters are marked before they score, as a user sees it.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "report/images/picture_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;

class Suspects : public ProgramTest {
 protected:
  /// Runs a file of the folder of wrong filters beside three others, and gives its cell.
  nlohmann::json measure(const std::string& filter) const {
    const Outcome outcome =
        run("run --grids --no-attribution --out out --scene cubes --size 160x90 --map-size 256 --rounds 1 --filters "
            "none,pcf2x2,tent3x3," +
            filter + " --filter-file " + user_filter("wrong/" + filter + ".glsl"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(filter + " is suspect: "));
    EXPECT_THAT(read_text(folder() / "out" / "index.html"), HasSubstr(filter + " is suspect: "));
    document_ = nlohmann::json::parse(read_text(folder() / "out" / "results.json"));
    return document_["cells"].back();
  }

  /// Expects that a cell is suspect of one thing alone, and that its pictures and errors are there.
  void expect_suspect(const std::string& filter, const std::string& words) const {
    const nlohmann::json cell = measure(filter);
    EXPECT_EQ(cell["status"], "suspect");
    ASSERT_EQ(cell["suspect_of"].size(), 1u) << cell["suspect_of"];
    EXPECT_THAT(cell["suspect_of"][0].get<std::string>(), HasSubstr(words));
    EXPECT_TRUE(cell["error"]["rmse"].is_number());
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / cell["images"]["picture"].get<std::string>()));
    EXPECT_THAT(read_text(folder() / "out" / "accuracy.csv"), HasSubstr(",suspect,"));
  }

  mutable nlohmann::json document_;
};

TEST_F(Suspects, ValuesOutsideZeroToOne) { expect_suspect("out_of_range", "lies between 0 and 16"); }
TEST_F(Suspects, ValuesThatAreNotFinite) { expect_suspect("not_finite", "pixels are not finite"); }
TEST_F(Suspects, AConstant) { expect_suspect("constant", "is 0.5 at every receiver"); }
TEST_F(Suspects, NoFetch) { expect_suspect("no_fetch", "reads nothing from the map"); }
TEST_F(Suspects, TapsOutsideTheDeclaredRadius) {
  expect_suspect("far_taps", "up to 2.5 texels from the receiver, but its radius_texels declares 1.5");
}
TEST_F(Suspects, AMovedReceiver) { expect_suspect("moved_uv", "up to 4 texels"); }
TEST_F(Suspects, AnEncodedMapThatNobodyWrote) { expect_suspect("unwritten_map", "no encode() writes one"); }

TEST_F(Suspects, AreOnNoFront_AndInNoAdvice) {
  const nlohmann::json cell = measure("constant");
  std::istringstream fronts(read_text(folder() / "out" / "fronts.csv"));
  int rows = 0;
  for (std::string row; std::getline(fronts, row);) {
    if (row.find(",constant,") == std::string::npos) continue;
    EXPECT_THAT(row, HasSubstr(",{},256,,light,,,,,,,,,,suspect: see the warnings"));
    ++rows;
  }
  EXPECT_GT(rows, 0);
  const Outcome advice = run("advise out --max-rmse 1 --json");
  EXPECT_EQ(advice.exit_code, 0) << advice.err;
  EXPECT_THAT(advice.out, HasSubstr("wrong on cubes (suspect: "));
  EXPECT_THAT(read_text(folder() / "out" / "summary.md"), HasSubstr("cubes: constant is suspect: "));
  const std::string check = "/usr/bin/python3 -m jsonschema -i '" + (folder() / "out" / "results.json").string() +
                            "' '" + (folder() / "out" / "results.schema.json").string() + "'";
  EXPECT_EQ(std::system(check.c_str()), 0);
}

TEST_F(Suspects, DoNotSetTheScaleOfPictures) {
  const auto grid_beside = [&](const std::string& filter) {
    measure(filter);
    return images::read_picture(folder() / "out" / "cubes.details.png");
  };
  const images::Image a = grid_beside("out_of_range"), b = grid_beside("far_taps");
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  // The third of four columns is that of `none`; its caption differs in its times.
  int different = 0;
  for (int y = 0; y < a.height; ++y)
    different += !std::equal(a.at(a.width / 2, y), a.at(3 * a.width / 4, y), b.at(a.width / 2, y));
  EXPECT_LT(different, a.height / 20) << "of " << a.height << " rows";
}

TEST_F(Suspects, AFilterThatReadsAsFarAsItDeclares_IsNone) {
  for (const char* radius : {"0", "2", "5"}) {
    const Outcome outcome =
        run(std::string("run --out out --fresh --no-truth --scene cubes --size 96x54 --map-size 128 "
                        "--rounds 1 --filters none,declared_reach:radius=") +
            radius + " --filter-file " + user_filter("declared_reach.glsl"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto cells = nlohmann::json::parse(read_text(folder() / "out" / "results.json"))["cells"];
    EXPECT_EQ(cells.back()["status"], "ok") << cells.back()["suspect_of"];
  }
}

/// Every built-in filter on every scene, with parameters too that change what is read.
TEST_F(Suspects, BuiltInFilters_AreNone) {
  const Outcome outcome =
      run("run --out out --size 160x90 --map-size 512 --rounds 1 --phases 1 --no-attribution --no-truth --no-grids "
          "--filters "
          "all,teaching,vsm:radius=0,esm:radius=8,esm:combine=log,poisson:radius=0,gather_pcf:radius=3,"
          "pcss:max_radius=20,dpcf:max_radius=20,poisson:radius=20,rotation=interleaved-gradient");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto cells = nlohmann::json::parse(read_text(folder() / "out" / "results.json"))["cells"];
  EXPECT_GE(cells.size(), 5u * 24u);
  for (const auto& cell : cells) EXPECT_EQ(cell["status"], "ok") << cell["scene"] << cell["filter"] << cell["message"];
}

}  // namespace
}  // namespace shadowbench::test
