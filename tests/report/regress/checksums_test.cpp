#include "report/regress/checksums.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>
#include <random>
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "report/regress/baseline.h"

namespace shadowbench::regress {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::Not;
using ::testing::Pair;

constexpr int kPixels = 160;  ///< of a side: the files are then longer than what is read of them at a time

std::string read_file(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

images::Image make_noise() {
  images::Image image(kPixels, kPixels, 1);
  std::mt19937 bits(1);
  for (float& texel : image.texels) texel = static_cast<float>(bits()) * 0x1p-32f;
  return image;
}

class ChecksumsOfABaseline : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    BaselineCell cell;
    cell.key = "0123456789abcdef";
    cell.scene = "cubes";
    cell.filter = "tent";
    write_text_file(baseline_.tolerance_file(), write_tolerances({}));
    write_text_file(baseline_.log_file(), "# What was accepted into this baseline\n");
    baseline_.write_cells("cubes", "tent", {{cell}, {{cell.key, {make_noise(), {}}}}});
    baseline_.write_truths("cubes", {{"main 160x160 ", {make_noise(), make_noise()}}});
    baseline_.seal();
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<fs::path> list_files() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (entry.is_regular_file()) files.push_back(entry.path());
    return files;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("shadowbench.checksums_test." + std::to_string(::getpid()));
  Baseline baseline_{folder_};
};

TEST_F(ChecksumsOfABaseline, AreThoseOfSha256sum) {
  ASSERT_EQ(list_files().size(), 6u);
  EXPECT_THAT(baseline_.check(), IsEmpty());
  const std::string check = "cd '" + folder_.string() + "' && sha256sum --strict --quiet -c " + kChecksumFile;
  EXPECT_EQ(std::system(check.c_str()), 0);
  EXPECT_EQ(read_checksums(folder_).size(), 5u);
}

TEST_F(ChecksumsOfABaseline, NoByteOfAnyFile_ChangesUnnoticed) {
  std::mt19937 bits(2);
  for (const fs::path& file : list_files()) {
    const std::string whole = read_file(file);
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    const auto put = [&](std::size_t at, char byte) {
      stream.seekp(static_cast<std::streamoff>(at));
      stream.put(byte).flush();
    };
    const std::size_t step = std::max<std::size_t>(whole.size() / 60, 1);
    for (std::size_t at = 0; at < whole.size(); at += 1 + bits() % (2 * step)) {
      put(at, static_cast<char>(whole[at] ^ (1 << bits() % 8)));
      EXPECT_THAT(find_damage(folder_), Not(IsEmpty())) << file << " byte " << at;
      put(at, whole[at]);
    }
    for (const std::size_t rest : {whole.size() - 1, whole.size() / 2, std::size_t{0}}) {
      fs::resize_file(file, rest);
      EXPECT_THAT(find_damage(folder_), Not(IsEmpty())) << file << " cut to " << rest;
    }
    write_text_file(file, whole + "\n");
    EXPECT_THAT(find_damage(folder_), Not(IsEmpty())) << file << " has a line more";
    write_text_file(file, whole);
    ASSERT_THAT(find_damage(folder_), IsEmpty()) << file;
  }
}

TEST_F(ChecksumsOfABaseline, FilesThatAreMissingOrFoldersOrTooMany_AreNamed) {
  for (const fs::path& file : list_files()) {
    const std::string name = file.lexically_relative(folder_).generic_string(), whole = read_file(file);
    fs::remove(file);
    EXPECT_THAT(find_damage(folder_), Contains(Pair(name, HasSubstr("is missing")))) << name;
    fs::create_directory(file);
    EXPECT_THAT(find_damage(folder_), Contains(Key(name))) << name;
    fs::remove(file);
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    try {
      EXPECT_THAT(find_damage(folder_), Contains(Key(name))) << name << ": a pipe, which nobody writes";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
    }
    fs::remove(file);
    write_text_file(file, whole);
  }
  write_text_file(folder_ / "README.md", "Why these scenes.\n");
  write_text_file(folder_ / "cubes" / "tent.shadowbench-tmp-1.json", "{");
  EXPECT_THAT(find_damage(folder_), IsEmpty()) << "not what a baseline consists of";
  write_text_file(folder_ / "stack" / "tent.json", read_file(folder_ / "cubes" / "tent.json"));
  EXPECT_THAT(find_damage(folder_), ::testing::ElementsAre(Pair("stack/tent.json", HasSubstr("is not listed"))));
  EXPECT_THAT(find_damage(folder_ / "nowhere"), IsEmpty());
}

TEST_F(ChecksumsOfABaseline, DamagedCells_AreNotRead_AndStayDamagedUntilTheyAreWritten) {
  const CellFile cells = baseline_.read_cells("cubes", "tent");
  for (const char* name : {"cubes/tent.json", "cubes/tent.exr"}) {
    write_text_file(folder_ / name, read_file(folder_ / name) + "\n");
    EXPECT_THAT(baseline_.check(), ::testing::ElementsAre(Pair(name, HasSubstr("has changed"))));
    EXPECT_THROW(baseline_.read_cells("cubes", "tent"), Error);
    baseline_.seal();
    EXPECT_THAT(baseline_.check(), ::testing::ElementsAre(Key(name))) << "what was not written is not taken for sound";
    baseline_.write_cells("cubes", "tent", cells);
    baseline_.seal();
    EXPECT_THAT(baseline_.check(), IsEmpty());
    EXPECT_EQ(baseline_.read_cells("cubes", "tent").cells.size(), 1u);
  }
  write_text_file(folder_ / "cubes" / "truth.area.exr", "");
  baseline_.check();
  EXPECT_THROW(baseline_.read_truths("cubes"), Error);
}

TEST_F(ChecksumsOfABaseline, TolerancesAndLogThatWereEdited_AreTakenOver) {
  write_text_file(baseline_.tolerance_file(), "");
  write_text_file(baseline_.log_file(), "");
  EXPECT_EQ(baseline_.check().size(), 2u);
  baseline_.seal();
  EXPECT_THAT(baseline_.check(), IsEmpty());
}

}  // namespace
}  // namespace shadowbench::regress
