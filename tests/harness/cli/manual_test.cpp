// Manual pages and completions, which the program writes from the description of its options.

#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsSupersetOf;
using ::testing::Not;

std::vector<std::string> find_all(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern); match != std::sregex_iterator(); ++match)
    found.push_back((*match)[1]);
  return found;
}

class Manual : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const Outcome outcome = run("manual pages");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  std::vector<std::string> commands() const {
    return find_all(run("--help").out, std::regex("(?:^|\n)  ([a-z]+) {2,}"));
  }

  /// What a shell command prints, its standard error included.
  std::string shell(const std::string& command) const {
    const std::filesystem::path script = write("shell.sh", "cd '" + folder().string() + "'\n" + command);
    EXPECT_EQ(std::system(("bash '" + script.string() + "' >'" + (folder() / "shell.txt").string() + "' 2>&1").c_str()),
              0)
        << command;
    return read_text(folder() / "shell.txt");
  }

  /// What bash offers for the last of these words, which may be empty.
  std::vector<std::string> complete(const std::string& words) const {
    return find_all(shell("source pages/shadowbench.bash\nCOMP_WORDS=(shadowbench " + words +
                          ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_shadowbench\nprintf '%s\\n' \"${COMPREPLY[@]}\""),
                    std::regex("([^\n]+)\n"));
  }
};

TEST_F(Manual, TroffReadsEveryPageWithoutAWarning) {
  EXPECT_EQ(shell("for page in pages/*.1; do groff -man -Tutf8 -ww \"$page\" >/dev/null; done"), "");
}

TEST_F(Manual, EveryCommandHasAPage_ThatNamesEveryOptionOfItsHelp) {
  const std::vector<std::string> all = commands();
  EXPECT_THAT(all, IsSupersetOf({"run", "list", "regress", "flicker"}));
  EXPECT_THAT(all, Not(::testing::Contains("manual")));
  const std::string front = read_text(folder() / "pages/shadowbench.1");
  for (const std::string& command : all) {
    EXPECT_NE(front.find("shadowbench\\-" + command + " (1)"), std::string::npos) << command;
    const std::string page = shell("groff -man -Tascii -P-c -P-b -P-u pages/shadowbench-" + command + ".1");
    for (const std::string& option : find_all(run(command + " --help").out, std::regex("\n  (?:-h,)?(--[a-z-]+)")))
      EXPECT_NE(page.find(option), std::string::npos) << command << " " << option;
  }
}

TEST_F(Manual, VersionIsPrinted_AsOnThePages) {
  const Outcome outcome = run("--version");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  ASSERT_TRUE(std::regex_match(outcome.out, std::regex("shadowbench [0-9]+\\.[0-9]+\\.[0-9]+\n"))) << outcome.out;
  EXPECT_NE(read_text(folder() / "pages/shadowbench.1").find(outcome.out.substr(0, outcome.out.size() - 1)),
            std::string::npos);
}

TEST_F(Manual, BashCompletesCommandsAndOptions) {
  EXPECT_EQ(complete("''"), commands());
  EXPECT_THAT(complete("re"), ElementsAre("regress"));
  EXPECT_THAT(complete("list ''"), ElementsAre("filters", "presets", "scenes", "metrics", "gpus", "gl"));
  EXPECT_THAT(complete("list gl --m"), ElementsAre("--measure"));
  EXPECT_THAT(complete("run --map"), ElementsAre("--map-size", "--map-format"));
  EXPECT_THAT(complete("run --no-tr"), ElementsAre("--no-truth"));
  EXPECT_THAT(complete("run --work"), ElementsAre()) << "no user gives it";
  for (const std::string command : {"run", "tune", "diff", "advise"})
    EXPECT_THAT(complete(command + " --"),
                IsSupersetOf(find_all(run(command + " --help").out, std::regex("\n  (?:-h,)?(--[a-z-]+)"))))
        << command;
}

TEST_F(Manual, BashCompletesValues) {
  EXPECT_THAT(complete("run --border ''"), ElementsAre("border", "edge", "repeat"));
  EXPECT_THAT(complete("run --border = e"), ElementsAre("edge")) << "as bash splits --border=e";
  EXPECT_THAT(complete("run --gl o"), ElementsAre("osmesa"));
  EXPECT_THAT(complete("advise out --cheapest b"), ElementsAre("bytes"));
  EXPECT_THAT(complete("run --filters none,tent3"), ElementsAre("none,tent3x3"));
  EXPECT_THAT(complete("bias --scene cub"), ElementsAre("cubes"));
  EXPECT_THAT(complete("run gol"), ElementsAre("golden")) << "an experiment";
  EXPECT_THAT(complete("merge pag"), ElementsAre("pages")) << "a folder";
}

}  // namespace
}  // namespace shadowbench::test
