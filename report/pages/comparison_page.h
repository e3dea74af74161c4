#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "report/images/image.h"

namespace shadowbench::pages {

/// Two pictures of one size, to be looked at in a browser.
struct ComparedPictures {
  std::string image;         ///< name of the first
  std::string truth;         ///< name of the one that it is compared with
  images::Image image_rgb;   ///< linear RGB; empty where there is no such picture
  images::Image truth_rgb;   ///< likewise
  images::Image image_grey;  ///< 1 channel: mean of the values as stored
  images::Image truth_grey;  ///< likewise
  images::Image mask;        ///< 1 channel: 0 where a pixel does not count; may be empty
  images::Image flip;        ///< 1 channel; empty where there is none
  std::vector<std::pair<std::string, std::string>> numbers;  ///< what was measured, by name
};

/// Writes `index.html` into a folder: the viewer with the first picture beside the other, which stands for the truth.
/// Throws Error(kOutput).
void write_comparison_page(const std::filesystem::path& dir, const ComparedPictures& pictures);

}  // namespace shadowbench::pages
