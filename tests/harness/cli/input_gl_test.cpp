// Each kind of bad input gets one clear message and its exit code; input that is odd and not wrong is measured, and the
// run says what is odd.

#include <sys/stat.h>

#include <iterator>
#include <tuple>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using BadInput = ProgramTest;

/// What nothing but the words is wrong with.
TEST_F(BadInput, WordsThatAreWrong) {
  expect_refusals({
      {"run --colour red", 2, {"--colour"}},
      {"", 2, {"subcommand"}},
      {"rn", 2, {"'shadowbench rn'", "did you mean 'run'"}},
      {"nosuch", 2, {"'shadowbench nosuch'", "run, advise, list"}},
      {"submit sweep --engine slurm", 2, {"'shadowbench submit'", "harness/slurm.sh"}},
      {"status big", 2, {"'shadowbench status'", "harness/slurm.sh"}},
      {"flicker --frames 2", 2, {"is gone", "error.flicker"}},
      {"diff a b --html page", 2, {"--html is gone", "--out"}},
      {"list gl --measure", 2, {"--measure is gone"}},
      {"merge out --times gpu-times.json", 2, {"--times is gone", "'advise --times'"}},
      {"merge nosuch", 2, {"--out"}},
      {"list filter", 2, {"'shadowbench list filter'", "did you mean 'filters'"}},
      {"advise out --json=5", 2, {"--json", "takes no value", "'5'"}},
      {small("--grids=7"), 2, {"--grids", "takes no value", "'7'"}},
      {small("--no-truth --attribution"), 2, {"--attribution", "--no-truth"}},
      {small("--filters vsm:radius=1,radius=2"), 2, {"vsm", "'radius' is given twice"}},
      {small("--filters vsm:width=soft,width=sharp"), 2, {"vsm", "'width' is given twice"}},
      {small("--bias constant:depth=1,depth=2"), 2, {"--bias constant", "'depth' is given twice"}},
      {small("--filter pcf2x3"), 2, {"pcf2x3", "did you mean 'pcf2x2'"}},
      {"tune --filter pcf2x3", 2, {"'pcf2x3'"}},
      {small("--filters none,none"), 2, {"'none' twice"}},
      {small("--width own --filters vsm,vsm:radius=4"), 2, {"twice"}},
      {"bias --scene cubes --filters vsm:width=light", 2, {"vsm:width=light", "only 'run'"}},
      {small("--filters none --width sort"), 2, {"--width: 'sort'", "did you mean 'soft'", "'own'"}},
      {small("--scene cube"), 2, {"cube", "cubes"}},
      {small("--scene no/such.gltf"), 3, {"no/such.gltf"}},
      {small("--filters none --map-size 1000000"), 2, {"1000000", "16384"}},
      {small("--map-size 0"), 2, {"--map-size", "'0'"}},
      {small("--map-size 64,64"), 2, {"64 twice"}},
      {small("--fit cascades --fit cascades:count=3 --fit cascades"), 2, {"--fit", "twice"}},
      {small("--size 64"), 2, {"--size", "WIDTHxHEIGHT"}},
      {small("--size 100000x10"), 2, {"100000"}},
      {small("--map-format d32"), 2, {"'d32'", "d16, d24, d32f"}},
      {small("--map-format r32f"), 2, {"unknown depth format 'r32f'"}},
      {small("--fit lispsm --snap on"), 2, {"--snap on", "--fit view or cascades"}},
      {small("--fit tsm --bias polygon-offset:factor=1"), 2, {"polygon-offset", "--fit"}},
      {small("--filter-file /dev/zero"), 5, {"/dev/zero", "a device, a pipe or a socket"}},
      {"diff /dev/zero /dev/zero", 3, {"/dev/zero", "a device"}},
      {small("--fit cascades:"), 2, {"--fit", "nothing follows the ':'"}},
      {small("--bias front-cull:"), 2, {"--bias front-cull", "nothing follows the ':'"}},
      {small("--fit tight view"), 2, {"unknown experiment 'view'", "one value each time"}},
      {small("--snap"), 2, {"--snap"}},
      {small("--scene avenue --fit cascades --equal-bytes --map-size 1"), 2, {"--equal-bytes", "--map-size 4"}},
      {small("--until-different none,vsm"), 2, {"--until-different is gone", "--phases"}},
      {small("--lights 1,2"), 2, {"--lights is gone", "several lights"}},
      {small("--snap perhaps"), 2, {"--snap", "perhaps"}},
      {small("--light 120"), 2, {"'120'", "AZIMUTH,ELEVATION"}},
      {small("--light ''"), 2, {"--light", "AZIMUTH,ELEVATION"}},
      {small("--light 120,91"), 2, {"elevation", "'91'", "-90 .. 90"}},
      {small("--light 120,nan"), 2, {"elevation", "'nan'"}},
      {small("--light 1e9,10"), 2, {"azimuth", "'1e9'"}},
      {small("--perspective-depth 9 --bias polygon-offset:factor=1"), 2, {"polygon-offset", "--perspective-depth"}},
      {small("--perspective-depth far"), 2, {"--perspective-depth", "far"}},
      {small("--bias receiver-plane --filters none,vsm"), 2, {"receiver-plane", "'vsm'"}},
      {small("--border mirror"), 2, {"--border", "mirror", "border", "edge", "repeat"}},
      {small("--far-test yes"), 2, {"--far-test", "yes", "on", "off"}},
      {small("--blend-casters glass"), 2, {"--blend-casters", "glass", "opaque", "hashed", "dither"}},
      {small("--blend-casters hashed --fit logpsm --filters none"), 2, {"--blend-casters hashed", "dither"}},
      {small("--behind-test 0"), 2, {"--behind-test", "0", "on", "off"}},
      {small("--rounds 0"), 2, {"--rounds", "'0'"}},
      {small("--rounds some"), 2, {"--rounds", "some"}},
      {small("--rounds 10001"), 2, {"--rounds", "10001", "10000"}},
      {small("--frames -1"), 2, {"--frames"}},
      {small("--pad-texels -1"), 2, {"--pad-texels", "-1"}},
      {small("--gl vulkan"), 2, {"vulkan"}},
      {small("--gpu navi22"), 2, {"--gpu", "'navi22'", "did you mean 'navi2"}},
      {small("--filter-file no/such.glsl"), 5, {"no/such.glsl"}},
      {small("--filter-file " + user_filter("broken_front_matter.glsl")),
       5,
       {"broken_front_matter.glsl:7", "defualt", "did you mean 'default'"}},
      {small("--filter-file " + user_filter("broken_glsl.glsl")), 5, {"broken_glsl.glsl:9", "no_such_variable"}},
      {"stress --out out --axes ''", 2, {"--axes", "a value is missing"}},
      {"diff '' out", 2, {"a value is missing"}},
  });
  for (const std::string option : {"--filters", "--filter", "--seed", "--tuned", "--pad-texels", "--cache", "--view"})
    expect_refusals(
        {{small(option + " ''"), 2, {"--", "a value is missing"}}, {small("") + " " + option + "=", 2, {"--"}}});
}

TEST_F(BadInput, NumbersOutOfRange) {
  const std::tuple<std::string, std::vector<std::string>, std::string> ranges[] = {
      {"--frames", {"0", "100000"}, "choose 1 .. 64"},
      {"--perspective-depth", {"1", "0.5", "-3", "nan", "inf", "1e8"}, "more than 1, at most 1e+07"},
      {"--precision", {"0", "-1", "nan", "1.5"}, "at most 1"},
      {"--budget", {"0", "-1", "nan", "inf"}, "3600"}};
  for (const auto& [option, values, message] : ranges)
    for (const std::string& value : values) expect_refusals({{small(option + " " + value), 2, {option, message}}});
}

TEST_F(BadInput, HelpOfARunIsShort_AndHasOneSpellingOfFilters) {
  std::istringstream all(run("run --help-all").out), help(run("run --help").out);
  using Words = std::istream_iterator<std::string>;
  EXPECT_GT(std::distance(Words(all), Words()), 600);
  const std::vector<std::string> words(Words{help}, Words());
  EXPECT_LE(words.size(), 300u);
  EXPECT_EQ(std::ranges::count(words, "--pad-texels"), 0);
  for (const std::string command : {"run", "tune", "stress", "bias"})
    EXPECT_THAT(run(command + " --help").out,
                AllOf(HasSubstr("--filters "), Not(HasSubstr("--filter ")), Not(HasSubstr("--filter,"))));
}

TEST_F(BadInput, FolderWithoutOneScene) {
  std::filesystem::create_directories(folder() / "models" / "inner.obj");
  write("models/readme.txt", "none here");
  expect_refusal(small("--scene models"), 3, {"models", "no scene", ".glb"});
  write("models/b.obj", "");
  write("models/a.toml", "");
  for (const std::string name : {"models", "models/", "./models"})
    expect_refusal(small("--scene " + name), 3, {"models", "2 scenes: a.toml, b.obj"});
}

constexpr const char* kVisibility = "float visibility(Receiver r) { return 1.0; }\n";
/// A plane under a sun, but for its size and material.
constexpr const char* kPlane =
    "title = \"t\"\n[camera]\nposition = [3, 5, 5]\ntarget = [0, 0, 0]\n[light]\nazimuth_deg = 40\nelevation_deg = 50\n"
    "[[material]]\nname = \"m\"\ncolor = [1, 1, 1]\n[[object]]\nshape = \"plane\"\nsize = [8, 8]\n";

TEST_F(BadInput, FilesThatAreWrong) {
  const std::string nine = read_source("tests/user_filters/nine_compares.glsl");
  std::string raw = nine, unclosed = nine;
  raw.insert(raw.find("float visibility"), "float raw(Receiver r) { return texture(map_depth, r.uv).r; }\n");
  unclosed.erase(unclosed.rfind('}'));
  write("lit.toml", "scene = 'cubes'\nlights = [1, 2]\n");
  write("scene.toml", "title = \"x\"\n[camera\n");
  write("open.toml", kPlane);
  write("raw.glsl", raw);
  write("unclosed.glsl", unclosed);
  write("vsm.glsl", read_source("filters/vsm.glsl"));
  write("itself.glsl", filters::write_filter("radius_texels = 0\n",
                                             "float down(float x) { return x < 0.0 ? x : down(x - 1.0); }\n"
                                             "float visibility(Receiver r) { return down(r.depth); }\n"));
  write("mutual.glsl", filters::write_filter(
                           "radius_texels = 0\n",
                           "float b(float x);\nfloat a(float x) { return b(x); }\nfloat b(float x) { return a(x); }\n"
                           "float visibility(Receiver r) { return a(r.depth); }\n"));
  const std::string mine = "--filter-file ";
  expect_refusals({
      {"run lit.toml --out out", 3, {"lit.toml:2", "--lights is gone"}},
      {small("--scene scene.toml"), 3, {"scene.toml:2"}},
      {small("--scene open.toml --filters none --bias front-cull"), 2, {"front-cull", "'open'", "may_cull_front"}},
      {small(mine + "raw.glsl --reversed-depth"), 2, {"--reversed-depth", "'raw'", "compare_nearest"}},
      {small(mine + "raw.glsl --perspective-depth 9"), 2, {"--perspective-depth", "'raw'", "compare_nearest"}},
      {small(mine + "unclosed.glsl"), 5, {"unclosed.glsl:", "missing brace"}},
      {small(mine + "vsm.glsl"), 2, {"'vsm'", "taken"}},
      {small(mine + "itself.glsl"), 5, {"itself.glsl:7", "'down' calls itself", "write a loop"}},
      {small(mine + "mutual.glsl"), 5, {"mutual.glsl:", "calls itself, directly or through others"}},
  });
  for (const std::string name : {"<script>alert(1)<.glsl", "a'b.glsl", "...glsl", "a b.glsl", "-x.glsl"}) {
    write(name, filters::write_filter("radius_texels = 0\n", kVisibility));
    expect_refusal(small("--filter-file=\"" + name + "\""), 5, {"cannot be a filter's id"});
  }
}

TEST_F(BadInput, PipesAndFilesThatAreTooLarge) {
  for (const char* name : {"pipe.glsl", "pipe.toml", "results.json"})
    ASSERT_EQ(mkfifo((folder() / name).c_str(), 0600), 0);
  for (const auto& [name, megabytes] : {std::pair("large.glsl", 5u), {"large.toml", 5u << 10}}) {
    write(name, "");
    std::filesystem::resize_file(folder() / name, std::uintmax_t{megabytes} << 20);
  }
  expect_refusals({{small("--filter-file pipe.glsl"), 5, {"pipe.glsl", "a device, a pipe"}},
                   {small("--filter-file large.glsl"), 5, {"it has 5 MiB, and 4 MiB are"}},
                   {small("--scene pipe.toml"), 3, {"pipe.toml", "a device, a pipe"}},
                   {small("--scene large.toml"), 3, {"large.toml", "it has 5120 MiB, and 4096 MiB are"}},
                   {"advise . --max-rmse 1", 3, {"results.json", "a device, a pipe"}}});
}

TEST_F(BadInput, PathThatCannotBeUsed) {
  const std::string path(300, 'x');  // a folder without rights would do, but for root
  expect_refusal(small("--filters none --out " + path), 6, {path, "choose another"});
  for (const std::string command : {"advise ", "regress --baseline out ", "merge --out out "})
    expect_refusal(command + path, 3, {path});
  expect_refusal("diff " + path + " " + path, 3, {path});
}

TEST_F(BadInput, ControlCharactersInAMessage_AreMadeVisible) {
  write("bad.toml", "title = \"x\"\n\"\\u001b[2J\" = 1\n");
  expect_refusal(small("--scene bad.toml"), 3, {"\\x1b[2J"});
  EXPECT_THAT(read("stderr.txt"), Not(HasSubstr("\x1b")));
}

TEST_F(BadInput, HostileNamesOfSceneAndCamera_StayInTheReportAndAreEscaped) {
  write("<script>alert('1')<\" onload=x \n..%2f.toml",
        "title = \"</title><script>alert(2)</script>\\u0000\\u001b\"\n[light]\nazimuth_deg = 40\nelevation_deg = 50\n"
        "[camera]\nname = \"../../../<script>alert(3)</script>\\u0000\\n\\\"x\"\nposition = [3, 5, 5]\ntarget = [0, 0, "
        "0]\n[[material]]\nname = \"<b>\"\ncolor = [1, 1, 1]\n[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nname = "
        "\"../x\"\nmaterial = \"<b>\"\n");
  succeed(small("--out out/report --filters none,vsm --scene *alert*.toml"));
  EXPECT_THAT(read("stderr.txt"), Not(HasSubstr("\x1b")));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder() / "out"), {}), 1);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder()), {}), 5)
      << "the scene, both outputs, out, cache";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder() / "out" / "report")) {
    EXPECT_EQ(entry.path().filename().string().find_first_of("<>'\"\n %"), std::string::npos) << entry.path();
    if (entry.path().extension() != ".html") continue;
    for (const char* open : {"<script>alert", "<script&gt;alert", "</title&gt;"})
      EXPECT_THAT(read_text(entry.path()), Not(HasSubstr(open))) << entry.path();
  }
}

constexpr const char* kBlock =
    "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\n"
    "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n";

class OddInput : public ProgramTest {
 protected:
  Outcome draw(const std::string& rest) const {
    return run(small("--phases 1 --no-attribution --filters none " + rest));
  }
};

TEST_F(OddInput, SceneNamedAsAFormula_IsDefusedInCsv_AndKeepsItsNameInJson) {
  write("=cmd.obj", kBlock);
  ASSERT_EQ(draw("--scene ./=cmd.obj").exit_code, 0);
  for (const char* table : {"out/timings.csv", "out/accuracy.csv"})
    EXPECT_THAT(read(table), AllOf(HasSubstr("'=cmd,"), Not(ContainsRegex("(^|[\n,\"])=cmd"))));
  EXPECT_EQ(read_cells()[0]["scene"], "=cmd");
}

TEST_F(OddInput, FolderWithOneModel_IsTaken) {
  write("block/model.obj", kBlock);
  write("block/readme.txt", "a block");
  for (const std::string name : {"block", "./block/"}) {
    EXPECT_EQ(draw("--fresh --ground --scene " + name).exit_code, 0);
    EXPECT_EQ(read_cells()[0]["scene"], "model");
  }
}

TEST_F(OddInput, BareModel_IsNotedWithTheViewThatWasChosenForIt) {
  write("block.obj", kBlock);
  const Outcome chosen = draw("--ground --strict --scene block.obj"), convex = draw("--scene block.obj");
  EXPECT_EQ(chosen.exit_code, 0) << chosen.err;
  EXPECT_THAT(chosen.err,
              ContainsRegex("block: camera from azimuth [0-9]+, elevation [0-9]+; sun from azimuth [0-9]+, "
                            "elevation [0-9]+: edges of shadows touch [0-9.]+ % of the picture's surfaces"));
  EXPECT_THAT(draw("--ground --scene block.obj --light 10,30").err,
              AllOf(HasSubstr("block: camera from azimuth "), Not(HasSubstr("sun from"))));
  EXPECT_EQ(convex.exit_code, 0) << convex.err;
  EXPECT_THAT(convex.err, HasSubstr("warning: block: camera from azimuth 30, elevation 24; sun from azimuth 110, "
                                    "elevation 50: the usual view, since none of"));
  EXPECT_THAT(draw("--scene cubes").err, Not(HasSubstr("camera from")));
}

TEST_F(OddInput, LightThatNothingFaces_IsWarnedOf) {
  for (const std::string truth : {"", "--no-truth "}) {
    EXPECT_THAT(draw(truth + "--scene stack --light 10,-30").err,
                HasSubstr("stack: the light shines from below, 30 degrees under the horizon"));
    EXPECT_THAT(read_results()["warnings"].dump(), HasSubstr("shines from below"));
  }
  EXPECT_THAT(draw("--scene stack --light 10,30").err, Not(HasSubstr("warning")));
  write("away.toml",
        "title = \"away\"\n[camera]\nposition = [0, 1, 6]\ntarget = [0, 1, 0]\n[light]\nazimuth_deg = 180\n"
        "elevation_deg = 20\n[[object]]\nshape = \"box\"\nsize = [20, 20, 1]\n");
  EXPECT_THAT(draw("--scene away.toml").err, HasSubstr("away: the light reaches no surface in view"));
}

TEST_F(OddInput, Strict_TurnsWarningsIntoExitCode1_AndWritesTheReport) {
  const std::string odd = "--scene stack --light 10,-30 ";
  const Outcome strict = draw("--strict " + odd);
  EXPECT_EQ(strict.exit_code, 1) << strict.err;
  EXPECT_THAT(strict.err, HasSubstr("shadowbench: --strict: the report has 1 warning: stack: the light shines"));
  EXPECT_THAT(strict.out, HasSubstr("report: "));
  EXPECT_THAT(read_results()["warnings"].dump(), HasSubstr("shines from below"));
  EXPECT_EQ(draw("--strict " + odd).exit_code, 1) << "nothing is left to do, and the warning still holds";
  EXPECT_EQ(draw(odd).exit_code, 0);
  EXPECT_EQ(draw("--strict --scene stack --light 10,30").exit_code, 0);
}

TEST_F(OddInput, Strict_CountsACellThatFailed) {
  const std::string failing = "--cell-timeout 0.001 --filter-file " + user_filter("nine_compares.glsl");
  EXPECT_EQ(draw(failing).exit_code, 0);
  const Outcome strict = draw("--strict " + failing);
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_THAT(strict.err, HasSubstr("cubes: nine_compares: not finished after"));
}

}  // namespace
}  // namespace shadowbench::test
