// Pictures of other renderers, from files that the test writes.

#include "harness/engines/external_images.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "report/images/picture_io.h"

namespace shadowbench::engines {
namespace {

images::Image make_grey(float value) {
  images::Image image(4, 4, 3);
  std::ranges::fill(image.texels, value);
  return image;
}

/// A file that is named for two layers gives each its own part, whatever its first part is.
TEST(ExternalImages, AFileOfSeveralParts_GivesEachLayerItsOwn) {
  const ScratchFolder folder(make_temporary_folder_path(std::filesystem::temp_directory_path() / "layers", "test"));
  std::filesystem::create_directories(folder.path());
  const std::string file = (folder.path() / "both.exr").string();
  images::write_exr(file, {{"unlit", {"R", "G", "B"}, make_grey(0.25f)}, {"lit", {"R", "G", "B"}, make_grey(0.75f)}},
                    {});
  ExternalFiles files;
  files.lit = files.unlit = file;
  const ExternalImages read = read_external_images(files);
  EXPECT_EQ(read.lit.value().texels.front(), 0.75f);
  EXPECT_EQ(read.unlit.value().texels.front(), 0.25f);
}

TEST(ExternalImages, AFileOfOnePart_IsTheLayerThatItIsNamedFor) {
  const ScratchFolder folder(make_temporary_folder_path(std::filesystem::temp_directory_path() / "layers", "test"));
  std::filesystem::create_directories(folder.path());
  const std::string lit = (folder.path() / "a.exr").string(), unlit = (folder.path() / "b.exr").string();
  images::write_exr(lit, {{"beauty", {"R", "G", "B"}, make_grey(0.5f)}}, {});
  images::write_exr(unlit, {{"beauty", {"R", "G", "B"}, make_grey(0.125f)}}, {});
  ExternalFiles files;
  files.lit = lit;
  files.unlit = unlit;
  const ExternalImages read = read_external_images(files);
  EXPECT_EQ(read.lit.value().texels.front(), 0.5f);
  EXPECT_EQ(read.unlit.value().texels.front(), 0.125f);
}

}  // namespace
}  // namespace shadowbench::engines
