// The command `regress`, from a run to its exit code.

#include <sys/stat.h>

#include "base/folder_lock.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

class Regress : public ProgramTest {
 protected:
  /// A run of two filters on one scene, small; no time counts.
  void draw(const std::string& out, const std::string& options = "--filters none,pcf2x2") const {
    draw_once("run --gl software --scene cubes --size 96x54 --rounds 1 --pad-texels 4 --uncertainty " + options +
                  (options.find("--map-size") == std::string::npos ? " --map-size 128" : "") +
                  (options.find("--no-grids") == std::string::npos ? " --grids" : ""),
              out);
  }

  Outcome compare(const std::string& out, const std::string& options = "") const {
    return run("regress " + out + " --baseline base " + options);
  }

  /// A run and the baseline that was accepted from it.
  void make_baseline() {
    draw("a");
    ASSERT_EQ(compare("a", "--accept").exit_code, 0);
    ASSERT_EQ(compare("a").exit_code, 0);
  }

  json report(const std::string& out) const { return read_json(out + "/regress/regress.json"); }

  void cut(const std::string& file) const {
    std::filesystem::resize_file(folder() / file, std::filesystem::file_size(folder() / file) / 2);
  }

  /// Expects exit code 1 and that the worst cell is what it should be.
  void expect_failure(const std::string& out, const std::string& outcome) const {
    const Outcome compared = compare(out);
    EXPECT_EQ(compared.exit_code, 1) << compared.out << compared.err;
    EXPECT_THAT(compared.err, HasSubstr("is " + outcome));
    EXPECT_EQ(report(out)["cells"][0]["outcome"], outcome);
  }

  std::map<std::string, std::string> read_baseline() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder() / "base"))
      if (entry.is_regular_file()) files[entry.path().filename().string()] = read_text(entry.path());
    return files;
  }

  /// Names the baseline's files that are not as they were.
  std::vector<std::string> list_changes(const std::map<std::string, std::string>& before) const {
    std::vector<std::string> names;
    const auto after = read_baseline();
    for (const auto& [name, text] : after)
      if (!before.contains(name) || before.at(name) != text) names.push_back(name);
    for (const auto& [name, text] : before)
      if (!after.contains(name)) names.push_back(name + " is gone");
    return names;
  }
};

/// A copy of tent3x3 whose first fetch lies a texel aside.
TEST_F(Regress, OneTexelOffset_IsCaught_WithItsPicture) {
  const std::string tent = read_source("filters/tent3x3.glsl");
  std::string shifted = tent;
  const std::string first = "vec2(-0.5, -0.5)";
  ASSERT_NE(shifted.find(first), std::string::npos);
  shifted.replace(shifted.find(first), first.size(), "vec2(0.5, -0.5)");
  write("my_tent.glsl", tent);
  draw("a", "--filters none --filter-file my_tent.glsl");
  ASSERT_EQ(compare("a", "--accept").exit_code, 0);
  EXPECT_EQ(compare("a").exit_code, 0);
  write("shifted/my_tent.glsl", shifted);
  draw("b", "--filters none --filter-file shifted/my_tent.glsl");
  const Outcome caught = compare("b");
  EXPECT_EQ(caught.exit_code, 1);
  EXPECT_THAT(caught.err, HasSubstr("my_tent"));
  EXPECT_THAT(caught.out, HasSubstr("if this is meant: "));
  const json worst = report("b")["cells"][0];
  EXPECT_EQ(worst["outcome"], "less accurate");
  EXPECT_GT(worst["pixels"]["max"], 0.2);
  EXPECT_TRUE(std::filesystem::exists(folder() / "b" / "regress" / worst["picture"].get<std::string>()));
}

/// Without phases, no picture depends on the seed but by its filter's noise.
TEST_F(Regress, Accept_ChangesWhatMovedAlone_AndSaysWhat) {
  draw("a", "--filters none,pcf2x2 --phases 1");
  ASSERT_EQ(compare("a", "--accept").exit_code, 0);
  const auto before = read_baseline();
  draw("b", "--filters none,pcf2x2 --bias plane:kernels=1,depth=2e-5 --seed 2 --phases 1");
  EXPECT_EQ(compare("b").exit_code, 0) << "neither filter depends on the seed, and the truth is noise";
  ASSERT_EQ(compare("b", "--accept").exit_code, 0);
  EXPECT_EQ(list_changes(before), (std::vector<std::string>{}));
  json wrong = json::parse(before.at("pcf2x2.json"));
  wrong["cells"][0]["values"]["error.rmse"] = 0.0;
  write("base/cubes/pcf2x2.json", wrong.dump());
  EXPECT_EQ(compare("a").exit_code, 1);
  const Outcome accepted = compare("a", "--accept");
  EXPECT_EQ(accepted.exit_code, 0) << accepted.err;
  EXPECT_THAT(accepted.out, HasSubstr("accepted: 1 change"));
  const auto lines = report("a")["accepted"];
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0].get<std::string>(), AllOf(HasSubstr("replaced: cubes pcf2x2"), HasSubstr("error.rmse")));
  // The image holds the second in which it was written; the numbers are what they were.
  EXPECT_THAT(list_changes(before), Each("pcf2x2.exr"));
}

TEST_F(Regress, MissingCell_Fails_AndLeavesOnRequestAlone) {
  make_baseline();
  draw("b", "--filters none");
  expect_failure("b", "missing");
  EXPECT_EQ(compare("b", "--filters none").exit_code, 0);
  EXPECT_EQ(compare("b", "--accept").exit_code, 1) << "a cell that was not compared stays";
  EXPECT_TRUE(exists("base/cubes/pcf2x2.exr"));
  EXPECT_EQ(compare("b", "--accept --remove-missing").exit_code, 0);
  EXPECT_FALSE(exists("base/cubes/pcf2x2.exr"));
  EXPECT_FALSE(exists("base/cubes/pcf2x2.json"));
  EXPECT_EQ(compare("b").exit_code, 0);
}

TEST_F(Regress, ExtraCell_Fails) {
  make_baseline();
  draw("b", "--filters none,pcf2x2,box3x3");
  expect_failure("b", "extra");
}

TEST_F(Regress, UnreadableFileOfTheBaseline_IsNamed_AndLeftAsItIs) {
  make_baseline();
  const auto whole = read_baseline();
  for (const char* file : {"cubes/pcf2x2.exr", "cubes/pcf2x2.json", "cubes/truth.area.exr"}) {
    const std::string path = std::string("base/") + file;
    cut(path);
    for (const char* options : {"", "--accept", "--filters pcf2x2"})
      expect_refusal("regress a --baseline base " + std::string(options), 3, {file, "restore the file"});
    write(path, whole.at(std::filesystem::path(file).filename().string()));
  }
  EXPECT_EQ(compare("a").exit_code, 0);
  std::filesystem::remove(folder() / "base/cubes/pcf2x2.exr");
  expect_refusal("regress a --baseline base --accept", 3, {"pcf2x2.exr"});
  for (const char* removed : {"base/cubes/pcf2x2.json", "base/cubes"}) {
    std::filesystem::remove_all(folder() / removed);
    EXPECT_EQ(compare("a", "--accept").exit_code, 0) << removed;
  }
  EXPECT_EQ(compare("a").exit_code, 0);
}

TEST_F(Regress, LimitsThatWereEdited_Hold) {
  make_baseline();
  json wrong = read_json("base/cubes/pcf2x2.json");
  wrong["cells"][0]["values"]["error.rmse"] = 0.0;
  write("base/cubes/pcf2x2.json", wrong.dump());
  EXPECT_EQ(compare("a").exit_code, 1);
  write("base/baseline.toml", "[all.\"error.rmse\"]\nlimit = 1\nreason = \"a test\"\n");
  EXPECT_EQ(compare("a").exit_code, 0);
  std::filesystem::remove(folder() / "base/baseline.toml");
  std::filesystem::create_directory(folder() / "base/baseline.toml");
  EXPECT_EQ(compare("a").exit_code, 3);
  EXPECT_THAT(compare("a", "--accept").err, HasSubstr("baseline.toml: this is a folder"));
}

/// What an accept that was killed leaves behind must not keep the next one from its work.
TEST_F(Regress, HalfAcceptedBaseline_IsMadeWhole) {
  make_baseline();
  std::filesystem::remove(folder() / "base/baseline.toml");
  EXPECT_EQ(compare("a").exit_code, 3);
  EXPECT_EQ(compare("a", "--accept").exit_code, 0);
  EXPECT_EQ(compare("a").exit_code, 0);
  const std::string half = "base/cubes/none.shadowbench-tmp-1.json";
  write(half, "{");
  EXPECT_EQ(compare("a").exit_code, 0);
  EXPECT_EQ(compare("a", "--accept").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder() / half));
}

TEST_F(Regress, AcceptThatIsKilledWhileItWrites_IsMadeWholeByTheNext) {
  draw("a", "--filters none,pcf2x2,box3x3,tent3x3,poisson");
  const std::string accept = "'" SHADOWBENCH_PROGRAM "' regress a --baseline base --accept >/dev/null 2>&1";
  for (const char* wait : {"0", "0.02"}) {
    std::filesystem::remove_all(folder() / "base");
    const std::string script = "cd '" + folder().string() + "'; " + accept +
                               " & while [ ! -e base/baseline.toml ] && kill -0 \\$!; do :; done; sleep " + wait +
                               "; kill -9 \\$!; wait";
    std::system(("bash -c \"" + script + "\" 2>/dev/null").c_str());
    EXPECT_EQ(compare("a", "--accept").exit_code, 0);
    EXPECT_EQ(compare("a").exit_code, 0);
    for (const auto& [name, text] : read_baseline()) EXPECT_EQ(name.find("tmp"), std::string::npos) << name;
  }
}

TEST_F(Regress, AcceptBesideAnother_IsRefused) {
  make_baseline();
  const FolderLock other(folder() / "base", true);
  expect_refusal("regress a --baseline base --accept", 6, {"base"});
  EXPECT_EQ(compare("a").exit_code, 0) << "to look is always allowed";
}

TEST_F(Regress, MissingTruth_Fails_AndLeavesOnRequestAlone) {
  make_baseline();
  draw("b", "--filters none,pcf2x2 --no-truth");
  EXPECT_THAT(compare("b").out, HasSubstr("missing: cubes truth"));
  EXPECT_EQ(compare("b", "--accept --remove-missing").exit_code, 0);
  EXPECT_FALSE(exists("base/cubes/truth.area.exr"));
  EXPECT_EQ(compare("b").exit_code, 0);
}

TEST_F(Regress, UnreadableRun_Fails_AndIsNotAccepted) {
  make_baseline();
  const auto before = read_baseline();
  cut("a/cubes.exr");
  expect_failure("a", "unreadable");
  EXPECT_EQ(compare("a", "--accept").exit_code, 1);
  EXPECT_EQ(list_changes(before), (std::vector<std::string>{}));
  draw("b", "--filters none,pcf2x2 --no-grids");
  expect_failure("b", "unreadable");
  EXPECT_THAT(compare("b").out, HasSubstr("run it with --grids"));
}

TEST_F(Regress, CellThatTimedOut_IsUnreadable) {
  draw("a", "--filters none --filter-file '" + user_filter("endless.glsl") + "' --cell-timeout 1");
  EXPECT_EQ(read_cells("a")[0]["status"], "ok");
  EXPECT_EQ(read_cells("a")[1]["status"], "timeout") << "the run goes on without it";
  const Outcome outcome = compare("a", "--accept");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("not finished after 1 s"));
}

TEST_F(Regress, StochasticFilter_OfAnotherSeed_IsTestedAsNoise) {
  draw("a", "--filters none,poisson --phases 1 --width own");
  ASSERT_EQ(compare("a", "--accept").exit_code, 0);
  draw("b", "--filters none,poisson --seed 9 --phases 1 --width own");
  const auto picture = [&](const std::string& out) {
    return read(out + "/" + read_cells(out)[1]["images"]["visibility"].get<std::string>());
  };
  EXPECT_NE(picture("b"), picture("a")) << "the seed reaches the filter";
  const Outcome noise = compare("b");
  EXPECT_EQ(noise.exit_code, 0) << noise.out;
  draw("b", "--filters none,poisson:radius=1 --seed 9 --phases 1 --width own --fresh");
  EXPECT_EQ(compare("b").exit_code, 1);
}

TEST_F(Regress, ForBuildServers_JUnitAndJson) {
  make_baseline();
  draw("b", "--filters none,box3x3");
  const Outcome outcome = compare("b", "--junit junit.xml --json");
  EXPECT_EQ(outcome.exit_code, 1);
  const json printed = json::parse(outcome.out);
  EXPECT_EQ(printed, report("b"));
  EXPECT_EQ(printed["failed"], 2);
  const std::string count = "import xml.etree.ElementTree as e; r = e.parse('" + (folder() / "junit.xml").string() +
                            "').getroot(); assert r.get('failures') == '2', r.attrib; assert "
                            "len(r.findall('.//failure')) == 2; assert len(r.findall('.//testcase')) == 4";
  EXPECT_EQ(std::system(("python3 -c \"" + count + "\"").c_str()), 0) << read("junit.xml");
}

TEST_F(Regress, BadInput_IsRefused) {
  make_baseline();
  expect_refusals(
      {{"regress nowhere --baseline base", 3, {"nowhere"}},
       {"regress a --baseline none", 3, {"none: there is no baseline here", "--accept"}},
       {"regress a --baseline base --remove-missing", 2, {"--remove-missing", "add --accept"}},
       {"regress a", 2, {"--baseline"}},
       {"regress a --baseline base --filters nosuch", 3, {"--filters: neither the run nor the baseline has 'nosuch'"}},
       {"regress a --baseline base --filters \"none, pcf2x3\"", 3, {"did you mean 'pcf2x2'?"}},
       {"regress a --baseline base --scene cubes --scene stakc", 3, {"'stakc'"}},
       {"regress a --baseline stdout.txt", 3, {"stdout.txt: this is a file"}},
       {"regress a --baseline stdout.txt --accept", 3, {"stdout.txt: this is a file"}}});
  write("base/baseline.toml", "[all.\"error.rms\"]\nlimit = 1\nreason = \"r\"\n");
  expect_refusal("regress a --baseline base", 3, {"baseline.toml:1", "did you mean 'error.rmse'?"});
  write("base/baseline.toml", "");
  write("file", "");
  expect_refusal("regress a --baseline base --out file/sub", 6, {"file/sub"});
  const std::string old = (folder() / "old").string();
  std::filesystem::create_directory(old);
  write("old/.shadowbench-folder", "");
  ASSERT_EQ(mkfifo((old + "/regress.json").c_str(), 0600), 0);
  expect_refusal("regress a --baseline base --out old", 3, {"old/regress.json", "a device, a pipe"});
  expect_refusal("run --pad-texels -1 --out out", 2, {"--pad-texels", "-1"});
}

}  // namespace
}  // namespace shadowbench::test
