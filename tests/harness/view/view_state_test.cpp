// What a file of lessons may say.

#include "harness/view/view_state.h"

#include <gmock/gmock.h>

#include <string>

#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

constexpr const char* kGood =
    "[[lesson]]\n"
    "name = 'a'\n"
    "title = 'A'\n"
    "text = ['One.', 'Two.', 'Three.']\n"
    "scene = 'cubes'\n"
    "left = 'none'\n"
    "right = 'truth'\n"
    "map_size = 64\n"
    "layer = 'error'\n"
    "reading = {place = [0, 0, 0], side = 'right', zoom = 2, content = 'channel 1'}\n";

class LessonsFile : public ::testing::Test {
 protected:
  std::vector<view::Lesson> read(const std::string& text) const {
    return view::read_lessons(folder_.write("lessons.toml", text));
  }

  /// What is said of the good file with a line in place of another.
  std::string refuse(const std::string& old_line, const std::string& line) const {
    std::string text = kGood;
    text.replace(text.find(old_line), old_line.size(), line);
    return error_of([&] { read(text); }).what();
  }

 private:
  TestFolder folder_;
};

TEST_F(LessonsFile, Good_IsReadWhole) {
  const std::vector<view::Lesson> lessons = read(kGood);
  ASSERT_EQ(lessons.size(), 1u);
  EXPECT_EQ(lessons[0].sides[1], "truth");
  EXPECT_EQ(lessons[0].layer, "error");
  EXPECT_EQ(lessons[0].reading.side, 1u);
  EXPECT_EQ(lessons[0].reading.content, "channel 1");
  EXPECT_EQ(lessons[0].settings.fit, "tight");
  EXPECT_TRUE(lessons[0].instead_title.empty());
}

TEST_F(LessonsFile, Bad_IsRefusedWithItsLine) {
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  EXPECT_THAT(refuse("'Three.'", ""), AllOf(HasSubstr("lessons.toml:4"), HasSubstr("three sentences")));
  EXPECT_THAT(refuse("layer = 'error'", "layer = 'eror'"), AllOf(HasSubstr("lessons.toml:9"), HasSubstr("error")));
  EXPECT_THAT(refuse("left = ", "lft = "), AllOf(HasSubstr("lessons.toml:6"), HasSubstr("left")));
  EXPECT_THAT(refuse("zoom = 2", "zoom = 0"), HasSubstr("lessons.toml:10"));
  EXPECT_THAT(refuse("'channel 1'", "'chanel 1'"), AllOf(HasSubstr("lessons.toml:10"), HasSubstr("channel 1")));
  EXPECT_THAT(refuse("name = 'a'", ""), HasSubstr("name"));
  EXPECT_THAT(refuse("reading = ", "divider = 0.3 # "), HasSubstr("reading"));
}

}  // namespace
}  // namespace shadowbench::test
