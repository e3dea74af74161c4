// Each kind of bad input gets one clear message and its exit code.

#include <sys/stat.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <tuple>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using BadInput = ProgramTest;

constexpr const char* kSmallRun = "run --out out --size 64x36 --map-size 64 --rounds 1 --scene cubes ";

std::string small(const std::string& rest) { return kSmallRun + rest; }

/// What nothing but the words is wrong with: the words, the exit code, and what the message holds.
TEST_F(BadInput, WordsThatAreWrong) {
  const std::tuple<std::string, int, std::vector<std::string>> refusals[] = {
      {"run --colour red", 2, {"--colour"}},
      {"", 2, {"subcommand"}},
      {"rn", 2, {"'shadowbench rn'", "did you mean 'run'"}},
      {"nosuch", 2, {"'shadowbench nosuch'", "run, advise, list"}},
      {"submit sweep --engine slurm", 2, {"'shadowbench submit'", "harness/slurm.sh"}},
      {"status big", 2, {"'shadowbench status'", "harness/slurm.sh"}},
      {"merge nosuch", 2, {"--out"}},
      {"list filter", 2, {"'shadowbench list filter'", "did you mean 'filters'"}},
      {"advise out --json=5", 2, {"--json", "takes no value", "'5'"}},
      {small("--grids=7"), 2, {"--grids", "takes no value", "'7'"}},
      {small("--no-truth --attribution"), 2, {"--attribution", "--no-truth"}},
      {small("--filters vsm:radius=1,radius=2"), 2, {"vsm", "'radius' is given twice"}},
      {small("--filters vsm:width=soft,width=sharp"), 2, {"vsm", "'width' is given twice"}},
      {small("--bias constant:depth=1,depth=2"), 2, {"--bias constant", "'depth' is given twice"}},
      {small("--filters pcf2x3"), 2, {"pcf2x3", "did you mean 'pcf2x2'"}},
      {small("--filters vsm:min_varianc=1"), 2, {"min_varianc", "did you mean 'min_variance'"}},
      {small("--filters esm:c=1e9"), 2, {"esm:c=", "out of range", "1 .. 2000"}},
      {small("--filters esm:c=nan"), 2, {"'nan'", "finite number"}},
      {small("--filters poisson:taps=6"), 2, {"taps=6", "4, 5, 8, 16, 32"}},
      {small("--filters none,none"), 2, {"'none' twice"}},
      {small("--width own --filters vsm,vsm:radius=4"), 2, {"twice"}},
      {"bias --scene cubes --filters vsm:width=light", 2, {"vsm:width=light", "only 'run'"}},
      {small("--filters none --width sort"), 2, {"--width: 'sort'", "did you mean 'soft'", "'own'"}},
      {"run --out out --scene cube", 2, {"cube", "cubes"}},
      {"run --out out --scene no/such.gltf", 3, {"no/such.gltf"}},
      {"run --out out --scene cubes --filters none --map-size 1000000", 2, {"1000000", "16384"}},
      {"run --out out --map-size 0", 2, {"--map-size", "'0'"}},
      {"run --out out --map-size 64,64", 2, {"64 twice"}},
      {small("--fit cascades --fit cascades:count=3 --fit cascades"), 2, {"--fit", "twice"}},
      {"run --out out --size 64", 2, {"--size", "WIDTHxHEIGHT"}},
      {"run --out out --size 100000x10", 2, {"100000"}},
      {small("--map-format d32"), 2, {"'d32'", "d16, d24, d32f"}},
      {small("--map-format r32f"), 2, {"unknown depth format 'r32f'"}},
      {small("--fit lispsm --snap on"), 2, {"--snap on", "--fit view or cascades"}},
      {small("--fit tsm --bias polygon-offset:factor=1"), 2, {"polygon-offset", "--fit"}},
      {small("--fit psm:near=1"), 2, {"'psm' takes no values"}},
      {small("--filter-file /dev/zero"), 5, {"/dev/zero", "a device, a pipe or a socket"}},
      {"diff /dev/zero /dev/zero", 3, {"/dev/zero", "a device"}},
      {small("--fit cascades:"), 2, {"--fit", "nothing follows the ':'"}},
      {small("--bias front-cull:"), 2, {"--bias front-cull", "nothing follows the ':'"}},
      {small("--filters none:"), 2, {"none:", "PARAM=VALUE"}},
      {small("--fit tight view"), 2, {"unknown experiment 'view'", "one value each time"}},
      {small("--fit box"), 2, {"'box'", "sphere, tight, view"}},
      {small("--snap"), 2, {"--snap"}},
      {"run --out out --scene avenue --fit cascades --equal-bytes --map-size 1", 2, {"--equal-bytes", "--map-size 4"}},
      {small("--until-different none,vsm"), 2, {"--until-different is gone", "--phases"}},
      {small("--lights 1,2"), 2, {"--lights is gone", "several lights"}},
      {small("--snap perhaps"), 2, {"--snap", "perhaps"}},
      {small("--light 120"), 2, {"'120'", "AZIMUTH,ELEVATION"}},
      {small("--light ''"), 2, {"--light", "AZIMUTH,ELEVATION"}},
      {small("--light 120,91"), 2, {"elevation", "'91'", "-90 .. 90"}},
      {small("--light 120,nan"), 2, {"elevation", "'nan'"}},
      {small("--light 1e9,10"), 2, {"azimuth", "'1e9'"}},
      {small("--perspective-depth 9 --bias polygon-offset:factor=1"), 2, {"polygon-offset", "--perspective-depth"}},
      {small("--filters none,vsm:width=40"), 2, {"vsm:width=40", "0.408 .. 28.3 texels"}},
      {small("--filters none,vsm:width=thin"), 2, {"vsm:width=thin", "sharp, medium, soft"}},
      {small("--filters none,nine_compares:width=soft --filter-file " + user_filter("nine_compares.glsl")),
       2,
       {"nine_compares:width=soft", "no radius"}},
      {small("--bias plane:kernels=-1"), 2, {"--bias", "'-1'"}},
      {small("--bias receiver-plane --filters none,vsm"), 2, {"receiver-plane", "'vsm'"}},
      {small("--bias slop:kernels=1"), 2, {"did you mean 'slope'"}},
      {small("--border mirror"), 2, {"--border", "mirror", "border", "edge", "repeat"}},
      {small("--far-test yes"), 2, {"--far-test", "yes", "on", "off"}},
      {small("--blend-casters glass"), 2, {"--blend-casters", "glass", "opaque", "hashed", "dither"}},
      {small("--blend-casters hashed --fit logpsm --filters none"), 2, {"--blend-casters hashed", "dither"}},
      {small("--behind-test 0"), 2, {"--behind-test", "0", "on", "off"}},
      {"run --out out --scene cubes --rounds 0", 2, {"--rounds", "'0'"}},
      {"run --out out --scene cubes --rounds some", 2, {"--rounds", "some"}},
      {"run --out out --scene cubes --rounds 10001", 2, {"--rounds", "10001", "10000"}},
      {small("--gl vulkan"), 2, {"vulkan"}},
      {small("--filter-file no/such.glsl"), 5, {"no/such.glsl"}},
      {small("--filter-file " + user_filter("broken_front_matter.glsl")),
       5,
       {"broken_front_matter.glsl:7", "defualt", "did you mean 'default'"}},
      {small("--filter-file " + user_filter("broken_glsl.glsl")), 5, {"broken_glsl.glsl:9", "no_such_variable"}},
  };
  for (const auto& [words, exit_code, message] : refusals) {
    SCOPED_TRACE(words);
    expect_refusal(words, exit_code, message);
  }
}

TEST_F(BadInput, EmptyValues) {
  for (const char* option : {"--filters", "--filter", "--seed", "--tuned", "--pad-texels", "--cache", "--view"}) {
    expect_refusal(small(option + std::string(" ''")), 2, {"--", "a value is missing"});
    expect_refusal(small(option + std::string("=")), 2, {"--"});
  }
  expect_refusal("stress --out out --axes ''", 2, {"--axes", "a value is missing"});
  expect_refusal("diff '' out", 2, {"a value is missing"});
}
TEST_F(BadInput, HelpOfARunIsShort) {
  std::istringstream all(run("run --help-all").out), help(run("run --help").out);
  using Words = std::istream_iterator<std::string>;
  EXPECT_GT(std::distance(Words(all), Words()), 600);
  const std::vector<std::string> words(Words{help}, Words());
  EXPECT_LE(words.size(), 300u);
  EXPECT_EQ(std::ranges::count(words, "--pad-texels"), 0);
}
TEST_F(BadInput, OtherSpellingOfFilters) {
  expect_refusal(small("--filter pcf2x3"), 2, {"'pcf2x3'"});
  expect_refusal(small("--filter=pcf2x3"), 2, {"'pcf2x3'"});
  expect_refusal("tune --filter pcf2x3", 2, {"'pcf2x3'"});
  expect_refusal("flicker --frames 2", 2, {"is gone", "error.flicker"});
  for (const char* command : {"run", "tune", "stress", "bias"}) {
    const std::string help = run(command + std::string(" --help")).out;
    EXPECT_NE(help.find("--filters "), std::string::npos) << command;
    EXPECT_EQ(help.find("--filter "), std::string::npos) << command;
    EXPECT_EQ(help.find("--filter,"), std::string::npos) << command;
  }
}
TEST_F(BadInput, FolderWithoutOneScene) {
  std::filesystem::create_directories(folder() / "models" / "inner.obj");
  write("models/readme.txt", "none here");
  expect_refusal("run --out out --scene models", 3, {"models", "no scene", ".glb"});
  write("models/b.obj", "");
  write("models/a.toml", "");
  for (const char* name : {"models", "models/", "./models"})
    expect_refusal(std::string("run --out out --scene ") + name, 3, {"models", "2 scenes: a.toml, b.obj"});
}
TEST_F(BadInput, MalformedSceneNamesTheLine) {
  write("lit.toml", "scene = 'cubes'\nlights = [1, 2]\n");
  expect_refusal("run lit.toml --out out", 3, {"lit.toml:2", "--lights is gone"});
  write("bad.toml", "title = \"x\"\n[camera\n");
  expect_refusal("run --out out --scene bad.toml", 3, {"bad.toml:2"});
}
TEST_F(BadInput, MalformedGltf) {
  write("bad.gltf", "{ \"asset\": ");
  expect_refusal("run --out out --scene bad.gltf", 3, {"bad.gltf"});
}
TEST_F(BadInput, EmptyGltf) {
  write("empty.gltf", R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[]}],"scene":0})");
  expect_refusal("run --out out --scene empty.gltf", 3, {"empty.gltf"});
}
TEST_F(BadInput, NotFiniteVertex) {
  write("nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
  expect_refusal("run --out out --scene nan.obj", 3, {"nan.obj"});
}
TEST_F(BadInput, OnlyDegenerateTriangles) {
  write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  expect_refusal("run --out out --scene flat.obj", 3, {"flat.obj"});
}
TEST_F(BadInput, LightWithoutDirection) {
  const std::string cubes = read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/data/scenes/cubes.toml");
  std::string text = cubes;
  text.replace(text.find("azimuth_deg = 72"), 16, "direction = [0, 0, 0]");
  text.replace(text.find("elevation_deg = 38"), 18, "");
  write("dark.toml", text);
  expect_refusal("run --out out --scene dark.toml", 3, {"dark.toml", "direction"});
}
TEST_F(BadInput, FramesThatAreNoNumberOfThem) {
  for (const char* frames : {"0", "100000"})
    expect_refusal(small(std::string("--frames ") + frames), 2, {"--frames: " + std::string(frames), "choose 1 .. 64"});
  expect_refusal(small("--frames -1"), 2, {"--frames"});
}

TEST_F(BadInput, FilterThatIsAPipe) {
  ASSERT_EQ(mkfifo((folder() / "pipe.glsl").c_str(), 0600), 0);
  expect_refusal(small("--filter-file " + (folder() / "pipe.glsl").string()), 5, {"pipe.glsl", "a device, a pipe"});
}

TEST_F(BadInput, FilterThatIsTooLarge) {
  write("large.glsl", "");
  std::filesystem::resize_file(folder() / "large.glsl", 5u << 20);
  expect_refusal(small("--filter-file " + (folder() / "large.glsl").string()), 5, {"it has 5 MiB, and 4 MiB are"});
}

TEST_F(BadInput, SceneThatIsAPipeOrTooLarge) {
  ASSERT_EQ(mkfifo((folder() / "pipe.toml").c_str(), 0600), 0);
  expect_refusal(small("--scene pipe.toml"), 3, {"pipe.toml", "a device, a pipe"});
  write("large.toml", "");
  std::filesystem::resize_file(folder() / "large.toml", std::uintmax_t{5} << 30);
  expect_refusal(small("--scene large.toml"), 3, {"large.toml", "it has 5120 MiB, and 4096 MiB are"});
}

TEST_F(BadInput, RunThatIsAPipe) {
  std::filesystem::create_directory(folder() / "piped");
  ASSERT_EQ(mkfifo((folder() / "piped" / "results.json").c_str(), 0600), 0);
  expect_refusal("advise piped --max-rmse 1", 3, {"results.json", "a device, a pipe"});
}

TEST_F(BadInput, SamplersOfAReversedMap) {
  std::string text = read_text(user_filter("nine_compares.glsl"));
  text.insert(text.find("float visibility"), "float raw(Receiver r) { return texture(map_depth, r.uv).r; }\n");
  write("raw.glsl", text);
  expect_refusal(small("--reversed-depth --filter-file raw.glsl"), 2, {"--reversed-depth", "'raw'", "compare_nearest"});
  expect_refusal(small("--perspective-depth 9 --filter-file raw.glsl"), 2,
                 {"--perspective-depth", "'raw'", "compare_nearest"});
}
TEST_F(BadInput, PerspectiveDepthOutOfRange) {
  for (const char* ratio : {"1", "0.5", "-3", "nan", "inf", "1e8"}) {
    expect_refusal(small(std::string("--perspective-depth ") + ratio), 2,
                   {"--perspective-depth", "more than 1, at most 1e+07"});
  }
  expect_refusal(small("--perspective-depth far"), 2, {"--perspective-depth", "far"});
}

TEST_F(BadInput, CullingThatEmptiesTheMap) {
  write("open.toml",
        "title = \"open\"\n[camera]\nposition = [3, 5, 5]\ntarget = [0, 0, 0]\n[light]\nazimuth_deg = "
        "40\nelevation_deg = 50\n"
        "[[object]]\nshape = \"plane\"\nsize = [8, 8]\n");
  expect_refusal(
      "run --out out --size 64x36 --map-size 64 --rounds 1 --filters none --scene open.toml --bias front-cull", 2,
      {"front-cull", "'open'", "may_cull_front"});
}

TEST_F(BadInput, AlphaThatCannotBlend) {
  write("glass.gltf",
        R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}],
            "materials": [{"name": "glass", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1.5]}}]})");
  expect_refusal("run --out out --scene glass.gltf --filters none", 3, {"glass.gltf", "'glass'", "1.5", "0 and 1"});
  const std::string text =
      "title = \"t\"\n[light]\nazimuth_deg = 40\nelevation_deg = 50\n[[material]]\nname = \"m\"\n"
      "color = [1, 1, 1]\nopacity = nan\n[[object]]\nshape = \"plane\"\nsize = [8, 8]\nmaterial = \"m\"\n";
  write("glass.toml", text);
  expect_refusal("run --out out --scene glass.toml --filters none", 3, {"glass.toml:8", "'opacity'", "nan"});
}
TEST_F(BadInput, PrecisionOutOfRange) {
  for (const char* value : {"0", "-1", "nan", "1.5"})
    expect_refusal(small(std::string("--precision ") + value), 2, {"--precision", "at most 1"});
}
TEST_F(BadInput, BudgetOutOfRange) {
  for (const char* value : {"0", "-1", "nan", "inf"})
    expect_refusal(small(std::string("--budget ") + value), 2, {"--budget", "3600"});
}
TEST_F(BadInput, NoContext) {
  expect_refusal("run --out out --scene cubes --gl glfw --size 64x36", 4, {"glfw"},
                 "env -u DISPLAY -u WAYLAND_DISPLAY");
}
TEST_F(BadInput, OutputFolderCannotBeWritten) {
  write("out", "a file, not a folder");
  const Outcome outcome = run(kSmallRun);
  EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
  EXPECT_NE(outcome.err.find("out"), std::string::npos);
  EXPECT_EQ(read_text(folder() / "out"), "a file, not a folder");
}
TEST_F(BadInput, PathThatCannotBeUsed) {
  const std::string path(300, 'x');  // a folder without rights would do, but for root
  expect_refusal("run --size 64x36 --map-size 64 --scene cubes --filters none --out " + path, 6,
                 {path, "choose another"});
  for (const std::string command : {"advise ", "regress --baseline out ", "merge --out out "})
    expect_refusal(command + path, 3, {path});
  expect_refusal("diff " + path + " " + path, 3, {path});
}
TEST_F(BadInput, MissingBraceNamesTheUsersFile) {
  std::string text = read_text(user_filter("nine_compares.glsl"));
  text.erase(text.rfind('}'));
  write("unclosed.glsl", text);
  expect_refusal(small("--filter-file unclosed.glsl"), 5, {"unclosed.glsl:", "missing brace"});
}
TEST_F(BadInput, UserFilterWithATakenId) {
  const auto copy = write("vsm.glsl", read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/filters/vsm.glsl"));
  expect_refusal(small("--filter-file " + copy.string()), 2, {"'vsm'", "taken"});
}

/// A filter file of the test's own, with this GLSL.
std::string with_front_matter(const std::string& glsl) {
  return "/*+++\ntitle = \"t\"\nsource = \"s\"\nkind = \"other\"\nradius_texels = 0\n+++*/\n" + glsl;
}

TEST_F(BadInput, GlslThatCallsItself) {
  write("itself.glsl", with_front_matter("float down(float x) { return x < 0.0 ? x : down(x - 1.0); }\nfloat "
                                         "visibility(Receiver r) { return down(r.depth); }\n"));
  expect_refusal(small("--filter-file itself.glsl"), 5, {"itself.glsl:7", "'down' calls itself", "write a loop"});
  write("mutual.glsl",
        with_front_matter("float b(float x);\nfloat a(float x) { return b(x); }\nfloat b(float x) { return a(x); }\n"
                          "float visibility(Receiver r) { return a(r.depth); }\n"));
  expect_refusal(small("--filter-file mutual.glsl"), 5, {"mutual.glsl:", "calls itself, directly or through others"});
}

TEST_F(BadInput, GlslThatIncludesWhatIsNotItsOwn) {
  write("secret.txt", "the_secret\n");
  for (const std::string& name :
       {(folder() / "secret.txt").string(), std::string("../../../../../../../../etc/passwd")}) {
    write("reader.glsl",
          with_front_matter("#include \"" + name + "\"\nfloat visibility(Receiver r) { return 1.0; }\n"));
    expect_refusal(small("--filter-file reader.glsl"), 5, {"reader.glsl:7", "outside the program's shader folder"});
    EXPECT_EQ(run(small("--filter-file reader.glsl")).err.find("the_secret"), std::string::npos);
  }
}

TEST_F(BadInput, GlslWithALineDirectiveOrANulByte) {
  write("lines.glsl", with_front_matter("#line 1 1\nfloat visibility(Receiver r) { return 1.0; }\n"));
  expect_refusal(small("--filter-file lines.glsl"), 5, {"lines.glsl:7", "#line"});
  write("nul.glsl", with_front_matter("float visibility(Receiver r) { return 1.0; }\n" + std::string(1, '\0') + "\n"));
  expect_refusal(small("--filter-file nul.glsl"), 5, {"nul.glsl:8", "NUL"});
}

TEST_F(BadInput, FilterFileWhoseNameIsNoId) {
  const std::string text = with_front_matter("float visibility(Receiver r) { return 1.0; }\n");
  for (const std::string name : {"<script>alert(1)<.glsl", "a'b.glsl", "...glsl", "a b.glsl", "-x.glsl"}) {
    write(name, text);
    expect_refusal(small("--filter-file=\"" + name + "\""), 5, {"cannot be a filter's id"});
  }
}

TEST_F(BadInput, ControlCharactersInAMessage_AreMadeVisible) {
  write("bad.toml", "title = \"x\"\n\"\\u001b[2J\" = 1\n");
  const Outcome outcome = run("run --out out --scene bad.toml");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos);
  EXPECT_NE(outcome.err.find("\\x1b[2J"), std::string::npos) << outcome.err;
}

TEST_F(BadInput, HostileNamesOfSceneAndCamera_StayInTheReportAndAreEscaped) {
  const std::string name = "<script>alert('1')<\" onload=x \n..%2f";
  write(name + ".toml",
        "title = \"</title><script>alert(2)</script>\\u0000\\u001b\"\n[light]\nazimuth_deg = 40\nelevation_deg = 50\n"
        "[camera]\nname = \"../../../<script>alert(3)</script>\\u0000\\n\\\"x\"\nposition = [3, 5, 5]\ntarget = [0, 0, "
        "0]\n"
        "[[material]]\nname = \"<b>\"\ncolor = [1, 1, 1]\n[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nname = "
        "\"../x\"\nmaterial = \"<b>\"\n");
  std::ofstream(folder() / "run.sh")
      << "exec '" SHADOWBENCH_PROGRAM
         "' run --out out/report --size 64x36 --map-size 64 --rounds 1 --filters none,vsm --scene *alert*.toml\n";
  ASSERT_EQ(std::system(("cd '" + folder().string() + "' && XDG_CACHE_HOME='" + cache_folder().string() +
                         "' sh run.sh >stdout.txt 2>stderr.txt")
                            .c_str()),
            0)
      << read_text(folder() / "stderr.txt");
  EXPECT_EQ(read_text(folder() / "stderr.txt").find('\x1b'), std::string::npos);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder() / "out"), {}), 1);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder()), {}),
            6);  // the scene, run.sh, both outputs, out, cache
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder() / "out" / "report")) {
    EXPECT_EQ(entry.path().filename().string().find_first_of("<>'\"\n %"), std::string::npos) << entry.path();
    if (entry.path().extension() != ".html") continue;
    for (const char* open : {"<script>alert", "<script&gt;alert", "</title&gt;"})
      EXPECT_EQ(read_text(entry.path()).find(open), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace shadowbench::test
