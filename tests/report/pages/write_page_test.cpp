#include "report/pages/write_page.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>
#include <sstream>

#include "base/files.h"

namespace shadowbench::pages {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class WritePage : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(report_); }
  void TearDown() override { std::filesystem::remove_all(report_); }

  /// Writes a page into a folder of the report, and reads its HTML back.
  std::string write(const std::string& folder, const std::string& command) const {
    write_page(report_ / folder, command, {"A page", {}, {}});
    return read(folder, command);
  }

  std::string read(const std::string& folder, const std::string& command) const {
    std::ifstream stream(report_ / folder / (command + ".html"));
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  const std::filesystem::path report_ =
      std::filesystem::temp_directory_path() / ("shadowbench.write_page_test." + std::to_string(::getpid()));
};

TEST_F(WritePage, LinksThePagesThatLieInTheSameReport) {
  write("bias", "bias");
  write_text_file(report_ / "index.html", "");
  EXPECT_THAT(write("stress", "stress"),
              AllOf(HasSubstr("href=\"../index.html\""), HasSubstr("href=\"../bias/bias.html\""),
                    Not(HasSubstr("href=\"../tune/tune.html\""))));
}

TEST_F(WritePage, LinksPagesThatWereWrittenEarlier_WithTheNewOne) {
  write("bias", "bias");
  EXPECT_THAT(read("bias", "bias"), Not(HasSubstr("stress.html")));
  write("stress", "stress");
  EXPECT_THAT(read("bias", "bias"), HasSubstr("href=\"../stress/stress.html\""));
}

TEST_F(WritePage, LinksNoPipe) {
  std::filesystem::create_directories(report_ / "stress");
  ASSERT_EQ(mkfifo((report_ / "stress" / "stress.html").c_str(), 0600), 0);
  EXPECT_THAT(write("bias", "bias"), Not(HasSubstr("stress.html")));
}

/// A folder of the user's choice may lie beside somebody else's index.html.
TEST_F(WritePage, LinksNothingOutsideTheReport) {
  write_text_file(report_ / "index.html", "");
  EXPECT_THAT(write("mine", "stress"), Not(HasSubstr("index.html")));
}

}  // namespace
}  // namespace shadowbench::pages
