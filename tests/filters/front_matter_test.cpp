#include "filters/front_matter.h"

#include "filters/glsl_words.h"
#include "filters/kernel.h"
#include "tests/filters/filtered.h"
#include "tests/test_files.h"

namespace shadowbench::filters {
namespace {

const std::string kLit = "float visibility(Receiver r) { return 1.0; }\n";
const std::string kStored = "vec4 encode(EncodeInput e) { return vec4(0); }\n" + kLit;

/// Puts lines into the front matter of a filter that is otherwise right; they start at line 6.
std::string with(const std::string& lines, const std::string& glsl = kLit) {
  return write_filter("radius_texels = 2\n" + lines, glsl);
}

void expect_error(const std::string& text, int line, const std::string& words) {
  EXPECT_THAT(error_of([&] { parse_filter(text, "mine.glsl"); }),
              is_error(ErrorKind::kFilter, fmt::format("mine.glsl:{}", line) + ": ", words))
      << text;
}

TEST(FrontMatter, GivesEveryField) {
  const FilterSpec spec = parse_filter(
      "/*+++\ntitle = \"Title\"\nsource = \"Source\"\nkind = \"bound\"\nstore = [\"rg32f\", \"rg16f\"]\n"
      "combine = [\"linear\", \"log\"]\nsample = \"linear\"\nclaims = [\"contact-hardening\"]\nteaching = "
      "true\nradius_texels = "
      "\"radius\"\n"
      "[param.radius]\ndefault = 3\nmin = 0\nmax = 9\nunit = \"texels\"\ntext = \"help\"\n"
      "[param.amount]\ndefault = 0.5\nmin = 0.0\nmax = 1.0\ntext = \"help\"\nconst = true\n+++*/\n" +
          kStored,
      "mine.glsl");
  EXPECT_EQ(spec.id, "mine");
  EXPECT_EQ(spec.title, "Title");
  EXPECT_EQ(spec.source, "Source");
  EXPECT_EQ(spec.kind, FilterKind::kBound);
  EXPECT_EQ(spec.claims, std::vector<std::string>{"contact-hardening"});
  EXPECT_TRUE(spec.teaching);
  EXPECT_TRUE(spec.has_encode);
  EXPECT_TRUE(spec.has_prefilter);
  ASSERT_EQ(spec.params.size(), 5u);
  EXPECT_EQ(spec.params[0].name, "radius");
  EXPECT_TRUE(spec.params[0].integer);
  EXPECT_EQ(spec.params[0].unit, "texels");
  EXPECT_EQ(spec.params[1].name, "amount");
  EXPECT_TRUE(spec.params[1].is_const);
  EXPECT_FALSE(spec.params[1].integer);
  EXPECT_EQ(to_string(spec.find_param("store")->default_value), "rg32f");
  EXPECT_EQ(radius_texels(spec, {{"radius", 5.0}}), 5.0);
  EXPECT_EQ(prefilter_radius_texels(spec, {{"radius", 5.0}}), 5);
}

TEST(FrontMatter, BodyKeepsItsLineNumbers) {
  const FilterSpec spec = parse_filter(with(""), "mine.glsl");
  EXPECT_EQ(spec.body_first_line, 6);
  EXPECT_EQ(spec.body.substr(0, 7), "\nfloat ");
}

TEST(FrontMatter, BiasReachIsTheKernels_UnlessGiven) {
  EXPECT_EQ(bias_reach_texels(parse_filter(with(""), "a.glsl"), {}), 2.0);
  EXPECT_EQ(bias_reach_texels(parse_filter(with("bias_texels = 0\n"), "a.glsl"), {}), 0.5);
}

TEST(FrontMatter, SamplersInCode_NotInComments_MakeFetchesUnknown) {
  EXPECT_TRUE(parse_filter(with("", "float visibility(Receiver r) { return texture(map_depth, r.uv).r; }"), "a.glsl")
                  .uses_samplers);
  EXPECT_FALSE(
      parse_filter(with("", "// map_depth\nfloat visibility(Receiver r) { return 1.0; /* map_stored */ }"), "a.glsl")
          .uses_samplers);
}

TEST(FrontMatter, ReadsOfAnEncodedMap_WithoutEncode_AreFound) {
  const auto reads_unwritten = [](const std::string& front_matter, const std::string& code) {
    return parse_filter(with(front_matter, code), "a.glsl").reads_unwritten;
  };
  const std::string reads = "float visibility(Receiver r) { return fetch_map(r, vec2(0.0)).x; }";
  EXPECT_TRUE(reads_unwritten("", reads));
  EXPECT_TRUE(reads_unwritten("", "float visibility(Receiver r) { return texture(map_stored, r.uv).x; }"));
  EXPECT_FALSE(reads_unwritten("", "float visibility(Receiver r) { return 1.0; /* fetch_map */ }"));
  EXPECT_FALSE(reads_unwritten("store = \"r32f\"\n", "vec4 encode(EncodeInput e) { return vec4(1.0); }\n" + reads));
}

TEST(FrontMatter, MissingOrMalformed_NamesTheLine) {
  expect_error("float visibility(Receiver r) { return 1.0; }", 1, "no front matter");
  expect_error("/*+++\ntitle = \"t\"\n", 1, "no front matter");
  expect_error(with("x = = 1\n"), 6, "not valid TOML");
  expect_error("/*+++\nsource = \"s\"\nkind = \"other\"\n+++*/\nfloat visibility(Receiver r) {}", 1, "'title'");
}

TEST(FrontMatter, UnknownKeysAndValues_SuggestTheNearest) {
  expect_error(with("clams = []\n"), 6, "did you mean 'claims'");
  expect_error(with("[param.a]\ndefault = 1.0\nmni = 0.0\nmax = 2.0\ntext = \"x\"\n"), 8, "did you mean 'min'");
  expect_error(write_filter("", kLit, "fast"), 4, "'fast'");
}

TEST(FrontMatter, WrongTypes_AreRefused) {
  expect_error(with("claims = 3\n"), 6, "must be a string or a list of strings, but is 3");
  expect_error(with("[param.a]\ndefault = nan\nmin = 0.0\nmax = 1.0\ntext = \"x\"\n"), 7, "finite");
  expect_error(with("[param.a]\ndefault = 3.0\nmin = 0.0\nmax = 1.0\ntext = \"x\"\n"), 7, "outside 0 .. 1");
  expect_error(with("[param.a]\ndefault = 3.0\ntext = \"x\"\n"), 7, "needs 'min' and 'max'");
  expect_error(with("[param.a]\ndefault = \"x\"\nchoices = [\"y\"]\ntext = \"x\"\n"), 7, "not one of its choices");
  expect_error(with("[param.gl_a]\ndefault = 1.0\nmin = 0.0\nmax = 1.0\ntext = \"x\"\n"), 6,
               "[param.gl_a]: 'gl_a' cannot be a name in GLSL");
}

TEST(FrontMatter, StoreAndEncode_ComeTogether) {
  expect_error(with("store = \"r32f\"\n"), 6, "lacks 'vec4 encode");
  expect_error(with("", kStored), 1, "lacks 'store'");
  expect_error(with("combine = \"linear\"\n"), 6, "needs 'store'");
  expect_error(with("samples = 4\n"), 6, "'samples' says what is stored, and needs 'store'");
  for (const char* wrong : {"3", "0", "32", "4.0", "[1, 5]", "\"4\"", "[]"})
    expect_error(with(fmt::format("store = \"r32f\"\nsamples = {}\n", wrong)), 7, "'samples'");
  expect_error(with("store = \"rgb8\"\n"), 6, "unknown store 'rgb8'");
}

TEST(FrontMatter, WhatTheMapHolds_IsDeclared) {
  const std::string param = "[param.c]\ndefault = 1.0\nmin = 0.0\nmax = 2.0\ntext = \"x\"\n";
  const FilterSpec spec = parse_filter(
      with("store = \"rg32f\"\nmoments = true\nexponent = \"c\"\nvariance_floor = \"c\"\n" + param, kStored), "a.glsl");
  EXPECT_TRUE(spec.holds_moments);
  EXPECT_EQ(spec.exponent, "c");
  EXPECT_EQ(spec.variance_floor, "c");
  EXPECT_FALSE(parse_filter(with("store = \"rg32f\"\n", kStored), "a.glsl").holds_moments);
  expect_error(with("store = [\"rg32f\", \"r32f\"]\nmoments = true\n", kStored), 7, "'r32f' has one");
  expect_error(with("store = \"r32f\"\nexponent = \"d\"\n" + param, kStored), 7,
               "'d', which is not a numeric parameter");
  expect_error(with("store = \"rg32f\"\nvariance_floor = \"c\"\n" + param, kStored), 7, "needs 'moments = true'");
  expect_error(with("exponent = \"c\"\n" + param), 6, "needs 'store'");
  std::string bound = with("bound_at_zero = \"c\"\n" + param);
  expect_error(bound, 6, "needs 'kind = \"bound\"'");
  bound.replace(bound.find("other"), 5, "bound");
  EXPECT_FALSE(promises_bound(parse_filter(bound, "a.glsl"), {{"c", 1.0}}));
  EXPECT_TRUE(promises_bound(parse_filter(bound, "a.glsl"), {{"c", 0.0}}));
  expect_error(with("bound_at_zero = \"d\"\n" + param), 6, "'d', which is not a numeric parameter");
}

TEST(FrontMatter, NoVisibility_IsRefused) { expect_error(with("", "float lit() { return 1.0; }"), 1, "visibility"); }

TEST(FrontMatter, PrefilterRadius_MustBeWhole) {
  expect_error(write_filter("store = \"r32f\"\ncombine = \"linear\"\nradius_texels = 1.5\n", kStored), 6,
               "whole number");
}

TEST(FrontMatter, LongBlanksAndNames_DoNotExhaustTheStack) {
  const std::string blanks(1'000'000, ' ');
  EXPECT_FALSE(
      parse_filter(with("", "float" + blanks + "visibility" + blanks + "(Receiver r) { return 1.0; }"), "mine.glsl")
          .has_encode);
  expect_error(with("", "float" + blanks + "visibility"), 1, "visibility");
  const std::string name(1'000'000, 'a');
  EXPECT_EQ(parse_filter(with("[param." + name + "]\ndefault = 1.0\nmin = 0.0\nmax = 2.0\ntext = \"x\"\n"), "mine.glsl")
                .params.size(),
            1u);
  std::string key = "a";
  for (int i = 0; i < 1'000'000; ++i) key += ".a";
  expect_error(with(key + " = 1\n"), 6, "256 dots");
}

TEST(FrontMatter, FunctionsAreFoundAsWholeWords) {
  for (const char* glsl : {"float my_visibility(Receiver r) {}", "myfloat visibility(Receiver r) {}",
                           "float visibility_of(Receiver r) {}", "float visibility;"})
    expect_error(with("", glsl), 1, "visibility");
  EXPECT_NO_THROW(parse_filter(with("", "int x; float\n\tvisibility\n(Receiver r) { return 1.0; }"), "mine.glsl"));
  EXPECT_FALSE(parse_filter(with("", "float visibility(Receiver r) { return my_map_depth + map_depths; }"), "mine.glsl")
                   .uses_samplers);
}

TEST(FrontMatter, ChoicesAreOfOneType_AndBoundWhatTheyDrive) {
  expect_error(with("[param.a]\ndefault = 1\nchoices = [1, \"x\"]\ntext = \"x\"\n"), 7, "different types");
  const auto with_radius = [](const std::string& choices) {
    return write_filter(
        "store = \"r32f\"\ncombine = \"linear\"\nradius_texels = \"radius\"\n[param.radius]\n"
        "default = 1\nchoices = " +
            choices + "\ntext = \"x\"\n",
        kStored);
  };
  EXPECT_TRUE(parse_filter(with_radius("[1, 2]"), "mine.glsl").has_prefilter);
  expect_error(with_radius("[1, 100000]"), 6, "radius_texels");
  expect_error(with_radius("[1, -2]"), 6, "radius_texels");
}

TEST(FrontMatter, DisksOfTooManyPoints_AreRefused) {
  const auto with_disk = [](const std::string& param, const std::string& seed) {
    return with("[param.taps]\ndefault = 4\n" + param +
                "const = true\ntext = \"x\"\n[disk.points]\ncount = \"taps\"\nseed = " + seed + "\n");
  };
  EXPECT_EQ(parse_filter(with_disk("min = 1\nmax = 64\n", "4294967295"), "mine.glsl").disks.front().seed, 4294967295u);
  expect_error(with_disk("min = 1\nmax = 2000000000\n", "1"), 13, "at most 4096 points");
  expect_error(with_disk("choices = [4, 5000]\n", "1"), 12, "at most 4096 points");
  expect_error(with_disk("min = 1\nmax = 64\n", "-1"), 14, "'seed'");
  expect_error(with_disk("min = 1\nmax = 64\n", "1.5"), 14,
               "'seed' in [disk.points] must be a whole number from 0 to 4294967295, but is 1.5");
  expect_error(with_disk("min = 1\nmax = 64\n", "1e10"), 14, "'seed'");
}

TEST(FrontMatter, PassesAreReadInTheirOrder) {
  const FilterSpec spec = parse_filter(
      with(
          "[pass.later]\nstore = \"rg32ui\"\nsteps = \"prefix\"\n[pass.earlier]\nstore = \"r16f\"\nsteps = \"levels\"\n"
          "size = \"half\"\nanisotropy = 8\n",
          "uvec4 later(PassInput p) { return uvec4(0); }\nvec4 earlier(PassInput p) { return vec4(0); }\n" + kLit),
      "mine.glsl");
  ASSERT_EQ(spec.passes.size(), 2u);
  EXPECT_EQ(spec.passes[0].name, "later");
  EXPECT_TRUE(spec.passes[0].is_integer());
  EXPECT_EQ(spec.passes[0].steps, PassSteps::kPrefix);
  EXPECT_EQ(spec.passes[0].line, 6);
  EXPECT_EQ(spec.passes[1].name, "earlier");
  EXPECT_TRUE(spec.passes[1].half);
  EXPECT_EQ(spec.passes[1].anisotropy, 8);
}

TEST(FrontMatter, BadPassesAreRefused) {
  expect_error(with("pass = 1\n"), 6, "'pass' must hold tables");
  expect_error(with("[pass.p]\nstore = \"rgb9\"\n"), 7, "unknown store 'rgb9' in [pass.p]; expected one of: r16f");
  expect_error(with("[pass.p]\nsteps = \"once\"\n"), 6, "lacks 'store'");
  expect_error(with("[pass.p]\nstore = \"r32f\"\nsteps = \"twice\"\n"), 8,
               "expected one of: once, axes, prefix, levels");
  expect_error(with("[pass.p]\nstore = \"r32f\"\nsize = \"third\"\n"), 8, "expected one of: full, half");
  expect_error(with("[pass.p]\nstore = \"r32f\"\nstep = \"once\"\n"), 8, "unknown key 'step'");
  for (const char* taken : {"map", "depth", "stored", "compare", "compare_nearest", "encode", "visibility"}) {
    expect_error(with(fmt::format("[pass.{}]\nstore = \"r32f\"\n", taken)), 6,
                 fmt::format("[pass.{0}]: '{0}' is the name of something else", taken));
  }
  expect_error(with("[pass.p-1]\nstore = \"r32f\"\n"), 6, "'p-1' cannot be a name in GLSL");
  expect_error(with("[param.p]\ndefault = 1\nmin = 0\nmax = 2\ntext = \"t\"\n[pass.p]\nstore = \"r32f\"\n"), 11,
               "'p' is the name of something else");
  expect_error(with("[pass.p]\nstore = \"r32f\"\n"), 6, "lacks 'vec4 p(PassInput p)'");
  expect_error(with("[pass.p]\nstore = \"r32ui\"\n", "vec4 p(PassInput p) { return vec4(0); }\n" + kLit), 6,
               "lacks 'uvec4 p(PassInput p)'");
  for (const char* number : {"2.5", "0", "17"}) {
    expect_error(with(fmt::format("[pass.p]\nstore = \"r32f\"\nanisotropy = {}\n", number)), 8,
                 "'anisotropy' in [pass.p] must be a whole number from 1 to 16");
  }
  expect_error(with("[pass.p]\nstore = \"r32f\"\nanisotropy = 4\n"), 8, "needs steps = \"levels\"");
}

TEST(FrontMatter, DisksPattern_IsNamed_OrAParameterThatChooses) {
  const auto with_pattern = [](const std::string& pattern, const std::string& choices = "\"stratified\", \"vogel\"") {
    return with(
        "[param.taps]\ndefault = 4\nmin = 1\nmax = 9\nconst = true\ntext = \"x\"\n[param.p]\ndefault = "
        "\"vogel\"\nchoices = [" +
        choices + "]\ntext = \"x\"\n[disk.points]\ncount = \"taps\"\npattern = \"" + pattern + "\"\n");
  };
  EXPECT_EQ(parse_filter(with_pattern("blue-noise"), "mine.glsl").disks.front().pattern, "blue-noise");
  EXPECT_EQ(parse_filter(with_pattern("p"), "mine.glsl").disks.front().pattern, "p");
  for (const char* wrong : {"sunflower", "taps", ""}) expect_error(with_pattern(wrong), 18, "'pattern'");
  expect_error(with_pattern("p", "\"vogel\", \"grid\""), 18, "vogel, stratified, blue-noise");
}

// Kernels that front matter declares, and users' copies of built-in filters.

/// A filter whose front matter ends with these lines, the first of which is line 14.
std::string with_kernel(const std::string& lines) {
  return "/*+++\ntitle = \"t\"\nsource = \"s\"\nkind = \"other\"\nradius_texels = \"radius\"\nparam.radius.default = "
         "3\n"
         "param.radius.min = 0\nparam.radius.max = 9\nparam.radius.text = \"help\"\nparam.taps.default = 3\n"
         "param.taps.min = 1\nparam.taps.max = 9\nparam.taps.text = \"help\"\n" +
         lines + "\n+++*/\n" + kLit;
}

FilterSpec parse_with(const std::string& lines) { return parse_filter(with_kernel(lines), "mine.glsl"); }

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
  for (const auto& [text, lines] : pairs) {
    SCOPED_TRACE(text);
    const FilterRequest request = request_of(text);
    EXPECT_EQ(declare(lines).name(), find_kernel(request.spec, request.values)->name());
  }
}

TEST(DeclaredKernel, WithAParameter_FollowsIt_AndGivesTheFilterAWidth) {
  const FilterSpec spec = parse_with("kernel = 'disk:radius'");
  EXPECT_EQ(find_kernel(spec, {{"radius", 5.0}})->disk_radius(), 5.0);
  EXPECT_EQ(solve_radius(spec, default_values(spec), "soft"), 3.0);
}

TEST(DeclaredKernel, ThatIsNone_IsRefused_WithItsLine) {
  expect_error(with_kernel("kernel = 'tant:2'"), 14, "did you mean 'tent'");
  expect_error(with_kernel("kernel = 'tent'"), 14, "\"tent:2\"");
  expect_error(with_kernel("kernel = 3"), 14, "\"tent:2\"");
  expect_error(with_kernel("kernel = 'disk:2x'"), 14, "neither a number nor a numeric parameter");
  expect_error(with_kernel("kernel = 'disk:nan'"), 14, "neither a number nor a numeric parameter");
  expect_error(with_kernel("kernel = 'disk:radios'"), 14, "neither a number nor a numeric parameter");
  expect_error(with_kernel("kernel = 'disk:-1'"), 14, "within 0 .. 64");
  expect_error(with_kernel("kernel = 'tent:radius'"), 14, "within 0.5 .. 64");
  expect_error(with_kernel("kernel = 'box:2.5'"), 14, "whole number within 1 .. 129");
  expect_error(with_kernel("[kernel]\nshape = 'gaussian:65'"), 15, "within 0 .. 64");
  expect_error(with_kernel("[kernel]\nread = 'nearest'"), 14, "either 'shape' or 'weights'");
  expect_error(with_kernel("[kernel]\nshape = 'box:3'\nread = 'cubic'"), 16, "expected one of: bilinear, nearest");
  expect_error(with_kernel("[kernel]\nshape = 'disk:3'\nread = 'nearest'"), 16, "a box, a gaussian, or weights");
  expect_error(with_kernel("[kernel]\nweigths = [1]"), 15, "did you mean 'weights'");
}

TEST(DeclaredKernel, ThatDoesNotSumToOne_OrIsNotSymmetric_IsRefused_WithItsLine) {
  expect_error(with_kernel("[kernel]\nweights = [0.25, 0.4, 0.25]"), 15, "sum to 0.9, not to 1");
  expect_error(with_kernel("[kernel]\nweights = [0, 0]"), 15, "sum to 0, not to 1");
  expect_error(with_kernel("[kernel]\nweights = [1, 2]"), 15, "symmetric");
  expect_error(with_kernel("[kernel]\nweights = []"), 15, "a list of 1 .. 129 numbers");
  expect_error(with_kernel("[kernel]\nweights = [0.5,\ninf, 0.5]"), 16, "finite");
  expect_error(with_kernel("[kernel]\nweights = [1.0, -1.0, 1.0]"), 15, "0 or more");
  EXPECT_NO_THROW(parse_with("kernel = { weights = [0.3333333, 0.3333334, 0.3333333] }"));
}

/// Reads filters that a user wrote into a folder.
class Copies : public ::testing::Test {
 protected:
  FilterSpec add(const std::string& text) {
    Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
    catalogue.add_user_file(folder_.write("mine.glsl", text));
    return catalogue.find("mine");
  }

  TestFolder folder_;
};

std::string replace(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST_F(Copies, OfAnyBuiltInFilter_HaveItsModel_UnderAnotherTitle_WithOtherCommentsAndBlanks) {
  for (const FilterSpec& spec : built_in().filters()) {
    std::string text = replace(read_text(spec.path), "title = \"", "title = \"My ");
    text = replace(text, "+++*/\n", "+++*/\n// My own lines.\n\n");
    text = replace(text, "float visibility(Receiver r) {", "float\t visibility(Receiver r) /* mine */  {") + "\n\n";
    EXPECT_EQ(add(text).copy_of, spec.id);
    EXPECT_EQ(find_kernel_sigma(add(text), default_values(spec)), find_kernel_sigma(spec, default_values(spec)));
  }
}

TEST_F(Copies, ThatComputeSomethingElse_AreNone) {
  const std::string text = read_text(built_in().find("poisson").path);
  EXPECT_EQ(add(text).copy_of, "poisson");
  EXPECT_EQ(add(replace(text, "r.depth", "r.depth_unbiased")).copy_of, "");
  EXPECT_EQ(add(replace(text, "seed = ", "seed = 9")).copy_of, "");
  EXPECT_EQ(add(replace(text, "default = \"per-pixel\"", "default = \"none\"")).copy_of, "") << "a default";
  EXPECT_EQ(add(replace(text, "kind = ", "kernel = 'disk:radius'\nkind = ")).copy_of, "") << "it declares a kernel";
}

// Names that filters may use.

/// The names before a parenthesis in the first column of a table: "| `float fetch_depth(Receiver r, ...)` | ...".
std::vector<std::string> list_functions(const std::string& table) {
  std::vector<std::string> names;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find('(');
    if (!line.starts_with("| `") || end == std::string::npos) continue;
    names.push_back(line.substr(line.rfind(' ', end) + 1, end - line.rfind(' ', end) - 1));
  }
  return names;
}

TEST(MapNames, AreThoseOfTheDocuments_AndOfTheShaders) {
  const std::filesystem::path root(SHADOWBENCH_SOURCE_DIR);
  const std::string page = read_text(root / "filters/README.md");
  const std::size_t begin = page.find("## Map functions"), end = page.find("## Rules and faults");
  ASSERT_LT(begin, end);
  const std::string section = page.substr(begin, end - begin);
  std::string shaders;
  for (const char* file : {"map_access.glsl", "random.glsl", "screen_input.glsl"})
    shaders += read_text(root / "shaders/lib" / file);
  const std::vector<std::string> documented = list_functions(section);
  EXPECT_GE(documented.size(), 12U);
  for (const std::string& name : documented) EXPECT_THAT(list_map_names(), Contains(name));
  for (const std::string& name : list_map_names()) {
    EXPECT_TRUE(has_word(page, name)) << name;
    EXPECT_TRUE(has_word(shaders, name)) << name;
  }
}

TEST(DeclaredNames, AreWhatStandsBehindATypeOrDefine) {
  EXPECT_THAT(list_declared_names("#define TAPS 4\n#define square(x) ((x) * (x))\nuniform float radius;\n"
                                  "struct Disk { vec2 at; };\n/* float no; */ Disk turn(Disk d) { return d; }"),
              ElementsAre("square", "radius", "Disk", "at", "turn", "d"));
  EXPECT_THAT(list_declared_names(""), ElementsAre());
}

TEST(CountLoops, WrapsEveryCondition_AndKeepsTheLines) {
  const CountedLoops counted = count_loops(
      "for (int i = 0; i < n(2, 3); ++i)\n  while (x < 1.0) x += 1.0;\nfor (;;) break;\ndo { y(); } while (z == 1);\n");
  EXPECT_EQ(counted.body,
            "for (int i = 0; count_turn(0,  i < n(2, 3)); ++i)\n  while ( count_turn(1, x < 1.0)) x += 1.0;\n"
            "for (; count_turn(2, true);) break;\ndo { y(); } while ( count_turn(3, z == 1));\n");
  EXPECT_EQ(counted.loops, 4);
}

TEST(CountLoops, LeavesTheRestAsItIs) {
  for (const char* glsl :
       {"", "float x = 1.0;", "// for (int i = 0; i < 9; ++i)\n/* while (x) */ float before; float meanwhile;",
        "while (bool more = next()) {}", "for (int i = 0; bool more = i < 3; ++i) {}", "for", "for (int i = 0; i < 3",
        "#define each for\n", "while ()"}) {
    const CountedLoops counted = count_loops(glsl);
    EXPECT_EQ(counted.body, glsl);
    EXPECT_EQ(counted.loops, 0) << glsl;
  }
  EXPECT_EQ(count_loops("for (int i = 0; i <= 3; ++i) {}").loops, 1) << "a comparison declares nothing";
}

}  // namespace
}  // namespace shadowbench::filters
