// Kernels that front matter declares, and users' copies of built-in filters.

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "filters/catalogue.h"
#include "filters/format/front_matter.h"
#include "filters/kernel_width.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

using ::testing::HasSubstr;

/// A filter whose front matter ends with these lines, the first of which is line 14.
FilterSpec parse_with(const std::string& lines) {
  return parse_filter(
      "/*+++\ntitle = \"t\"\nsource = \"s\"\nkind = \"other\"\nradius_texels = \"radius\"\nparam.radius.default = 3\n"
      "param.radius.min = 0\nparam.radius.max = 9\nparam.radius.text = \"help\"\nparam.taps.default = 3\n"
      "param.taps.min = 1\nparam.taps.max = 9\nparam.taps.text = \"help\"\n" +
          lines + "\n+++*/\nfloat visibility(Receiver r) { return 1.0; }\n",
      "mine.glsl");
}

Kernel declare(const std::string& lines) {
  const FilterSpec spec = parse_with(lines);
  return find_kernel(spec, default_values(spec)).value();
}

TEST(DeclaredKernel, CanBeThatOfEveryBuiltInFilter) {
  const std::vector<std::pair<const char*, const char*>> pairs = {
      {"none", "kernel = { shape = 'box:1', read = 'nearest' }"},
      {"pcf2x2", "kernel = 'box:1'"},
      {"tent3x3", "kernel = 'box:2'"},
      {"box4x4", "kernel = 'box:3'"},
      {"box3x3", "[kernel]\nshape = 'box:taps'\nread = 'nearest'"},
      {"tent4x4", "kernel = 'tent:1.5'"},
      {"tent5x5", "kernel = 'tent:2.5'"},
      {"gather_pcf", "kernel = 'tent:2.5'"},
      {"tent7x7", "kernel = 'tent:3.5'"},
      {"castano3", "[kernel]\nweights = [1, 2, 1]"},
      {"castano5", "kernel = { weights = [1, 3, 4, 3, 1], read = 'bilinear' }"},
      {"castano7", "kernel = { weights = [1, 5, 12, 16, 12, 5, 1] }"},
      {"teach4x4", "kernel = { weights = [0.5, 0.0, 0.5] }"},
      {"poisson", "kernel = 'disk:radius'"},
      {"vsm:radius=3", "kernel = 'gaussian:radius'"},
      {"esm:combine=log,radius=3", "kernel = { shape = 'gaussian:radius', read = 'nearest' }"}};
  const Catalogue built_in(SHADOWBENCH_SOURCE_DIR "/filters");
  for (const auto& [text, lines] : pairs) {
    SCOPED_TRACE(text);
    const FilterRequest request = built_in.parse_requests(text).front();
    EXPECT_EQ(declare(lines).name(), find_kernel(request.spec, request.values)->name());
  }
}

TEST(DeclaredKernel, WithAParameter_FollowsIt_AndGivesTheFilterAWidth) {
  const FilterSpec spec = parse_with("kernel = 'disk:radius'");
  EXPECT_EQ(find_kernel(spec, {{"radius", 5.0}})->disk_radius(), 5.0);
  EXPECT_EQ(solve_radius(spec, default_values(spec), "soft"), 3.0);
}

void expect_refused(const std::string& lines, int line, const std::string& words) {
  try {
    parse_with(lines);
    ADD_FAILURE() << "accepted: " << lines;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFilter);
    EXPECT_EQ(error.where(), "mine.glsl:" + std::to_string(line)) << error.what();
    EXPECT_THAT(error.message(), HasSubstr(words));
  }
}

TEST(DeclaredKernel, ThatIsNone_IsRefused_WithItsLine) {
  expect_refused("kernel = 'tant:2'", 14, "did you mean 'tent'");
  expect_refused("kernel = 'tent'", 14, "\"tent:2\"");
  expect_refused("kernel = 3", 14, "\"tent:2\"");
  expect_refused("kernel = 'disk:2x'", 14, "neither a number nor a numeric parameter");
  expect_refused("kernel = 'disk:nan'", 14, "neither a number nor a numeric parameter");
  expect_refused("kernel = 'disk:radios'", 14, "neither a number nor a numeric parameter");
  expect_refused("kernel = 'disk:-1'", 14, "within 0 .. 64");
  expect_refused("kernel = 'tent:radius'", 14, "within 0.5 .. 64");
  expect_refused("kernel = 'box:2.5'", 14, "whole number within 1 .. 129");
  expect_refused("[kernel]\nshape = 'gaussian:65'", 15, "within 0 .. 64");
  expect_refused("[kernel]\nread = 'nearest'", 14, "either 'shape' or 'weights'");
  expect_refused("[kernel]\nshape = 'box:3'\nread = 'cubic'", 16, "expected one of: bilinear, nearest");
  expect_refused("[kernel]\nshape = 'disk:3'\nread = 'nearest'", 16, "a box, a gaussian, or weights");
  expect_refused("[kernel]\nweigths = [1]", 15, "did you mean 'weights'");
}

TEST(DeclaredKernel, ThatDoesNotSumToOne_OrIsNotSymmetric_IsRefused_WithItsLine) {
  expect_refused("[kernel]\nweights = [0.25, 0.4, 0.25]", 15, "sum to 0.9, not to 1");
  expect_refused("[kernel]\nweights = [0, 0]", 15, "sum to 0, not to 1");
  expect_refused("[kernel]\nweights = [1, 2]", 15, "symmetric");
  expect_refused("[kernel]\nweights = []", 15, "a list of 1 .. 129 numbers");
  expect_refused("[kernel]\nweights = [0.5,\ninf, 0.5]", 16, "finite");
  expect_refused("[kernel]\nweights = [1.0, -1.0, 1.0]", 15, "0 or more");
  EXPECT_NO_THROW(parse_with("kernel = { weights = [0.3333333, 0.3333334, 0.3333333] }"));
}

/// Reads filters that a user wrote into a folder.
class Copies : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string read(const FilterSpec& spec) {
    std::ifstream file(spec.path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  FilterSpec add(const std::string& text) {
    std::ofstream(folder_ / "mine.glsl") << text;
    Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
    catalogue.add_user_file(folder_ / "mine.glsl");
    return catalogue.find("mine");
  }

  std::filesystem::path folder_ = std::filesystem::path(::testing::TempDir()) / ("copies" + std::to_string(getpid()));
  Catalogue built_in_{SHADOWBENCH_SOURCE_DIR "/filters"};
};

std::string replace(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST_F(Copies, OfAnyBuiltInFilter_HaveItsModel_UnderAnotherTitle_WithOtherCommentsAndBlanks) {
  for (const FilterSpec& spec : built_in_.filters()) {
    std::string text = replace(read(spec), "title = \"", "title = \"My ");
    text = replace(text, "+++*/\n", "+++*/\n// My own lines.\n\n");
    text = replace(text, "float visibility(Receiver r) {", "float\t visibility(Receiver r) /* mine */  {") + "\n\n";
    EXPECT_EQ(add(text).copy_of, spec.id);
    EXPECT_EQ(find_kernel_sigma(add(text), default_values(spec)), find_kernel_sigma(spec, default_values(spec)));
  }
}

TEST_F(Copies, ThatComputeSomethingElse_AreNone) {
  const std::string text = read(built_in_.find("poisson"));
  EXPECT_EQ(add(text).copy_of, "poisson");
  EXPECT_EQ(add(replace(text, "r.depth", "r.depth_unbiased")).copy_of, "");
  EXPECT_EQ(add(replace(text, "seed = ", "seed = 9")).copy_of, "");
  EXPECT_EQ(add(replace(text, "default = \"per-pixel\"", "default = \"none\"")).copy_of, "") << "a default";
  EXPECT_EQ(add(replace(text, "kind = ", "kernel = 'disk:radius'\nkind = ")).copy_of, "") << "it declares a kernel";
}

}  // namespace
}  // namespace shadowbench::filters
