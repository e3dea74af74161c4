#include "harness/submit/engine.h"

#include <gtest/gtest.h>

namespace shadowbench::submit {
namespace {

TEST(Shell, ReadsQuotedWordsAsTheyWere) {
  const std::vector<std::string> words = {"plain", "",   "a b", "it's", "$HOME", "`id`",
                                          "\\",    "\"", "*",   "a;b",  "\n",    "vsm:radius=6,c=2"};
  std::string expected;
  for (const std::string& word : words) expected += "[" + word + "]";
  EXPECT_EQ(run_shell("printf '[%s]' " + quote_words(words)).text, expected);
  EXPECT_EQ(quote_words({"--filters", "vsm:radius=6"}), "--filters vsm:radius=6") << "what needs no quotes has none";
}

TEST(Shell, TellsHowACommandEnded) {
  const ShellOutcome outcome = run_shell("echo out; echo err >&2; exit 3");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.text, "out\nerr");
  EXPECT_EQ(run_shell("no-such-command-anywhere").exit_code, 127);
}

}  // namespace
}  // namespace shadowbench::submit
