// What is said of a user's filter that declares its kernel, or copies a built-in one: as much as of the built-in one.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "filters/catalogue.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class UserKernel : public ProgramTest {
 protected:
  /// Writes a built-in filter under another name, with more lines at the beginning of its front matter.
  void write_copy(const std::string& id, const std::string& name, const std::string& lines) const {
    std::string text = read_text(SHADOWBENCH_SOURCE_DIR "/filters/" + id + ".glsl");
    write(name + ".glsl", text.insert(text.find("title ="), lines));
  }

  json measure(const std::string& arguments) const {
    const Outcome outcome = run("run --out out --scene cubes --size 96x54 --map-size 128 --rounds 1 " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return json::parse(read_text(folder() / "out" / "results.json"))["cells"];
  }
};

/// A copy is known by its text, whichever filter it is of: one of each sort will do.
TEST_F(UserKernel, OfACopy_OfAnySortOfBuiltInFilter_GivesTheBuiltInsNumbers) {
  const filters::Catalogue built_in(SHADOWBENCH_SOURCE_DIR "/filters");
  std::set<std::tuple<filters::FilterKind, bool, bool>> sorts;
  std::string filters, files;
  for (const filters::FilterSpec& spec : built_in.filters()) {
    if (!sorts.emplace(spec.kind, spec.has_encode, spec.passes.empty()).second) continue;
    write_copy(spec.id, "my_" + spec.id, "# mine\n");
    filters += (filters.empty() ? "" : ",") + spec.id + ",my_" + spec.id;
    files += " --filter-file my_" + spec.id + ".glsl";
  }
  std::map<std::string, json> cells;
  for (const json& cell : measure("--stability --filters " + filters + files)) cells[cell["filter"]] = cell;
  ASSERT_GT(sorts.size(), 5u);
  ASSERT_EQ(cells.size(), 2 * sorts.size());
  for (const auto& [id, cell] : cells) {
    if (id.starts_with("my_")) continue;
    SCOPED_TRACE(id);
    const json& copy = cells.at("my_" + id);
    for (const char* group : {"error", "attribution", "artefact", "kernel", "excused", "cost", "status"})
      EXPECT_EQ(copy[group], cell[group]) << group;
    EXPECT_EQ(copy["stability"]["bound_violations"], cell["stability"]["bound_violations"]);
    EXPECT_FALSE(copy["attribution"]["numeric"]["rms"].is_null());
  }
}

TEST_F(UserKernel, AloneInARun_HasTheMapsPicturesAsWell) {
  write_copy("tent5x5", "mine", "# mine\n");
  const auto picture = [&](const std::string& arguments) {
    const json cells = measure(arguments);
    EXPECT_EQ(cells.size(), 1u);
    return read_text(folder() / "out" / cells[0]["images"]["depth_map"].get<std::string>());
  };
  const std::string alone = picture("--grids --filters mine --filter-file mine.glsl");
  std::filesystem::remove_all(folder() / "out");
  EXPECT_EQ(alone, picture("--grids --filters tent5x5"));
}

TEST_F(UserKernel, Declared_GivesWidthAndAttribution_WithNumericErrorInTheEstimators) {
  write_copy("tent5x5", "declared", "kernel = \"tent:2.5\"\n");
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
  EXPECT_THAT(read_text(folder() / "out" / "index.html"), HasSubstr("numeric and estimator"));
}

TEST_F(UserKernel, DeclaredByAStochasticFilter_GivesItsNoise_AndFollowsItsRadius) {
  write_copy("poisson", "mine", "kernel = \"disk:radius\"\n");
  const json cells = measure("--filters poisson:radius=5,mine:radius=5 --filter-file mine.glsl");
  EXPECT_EQ(cells[1]["kernel"], cells[0]["kernel"]);
  EXPECT_EQ(cells[1]["error"]["kernel_rmse"], cells[0]["error"]["kernel_rmse"]);
  EXPECT_EQ(cells[1]["artefact"]["noise"], cells[0]["artefact"]["noise"]);
  EXPECT_FALSE(cells[1]["artefact"]["noise"].is_null());
}

}  // namespace
}  // namespace shadowbench::test
