#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "report/images/heat_figures.h"
#include "report/regress/tolerances.h"

namespace shadowbench::regress {

/// A rounding bound of this size or more says nothing about its pixel.
inline constexpr float kWidestBound = 0x1p-5f;

/// One cell's visibility, with how far rounding and other seeds can move it. All images have one size or are empty.
struct CellImages {
  images::Image visibility;
  images::UncertaintyImages uncertainty;
};

/// Coarsens rounding bounds to what a baseline keeps: 0 below 2^-14; the next power of two above; 1 from kWidestBound
/// on; images::kMayFlip stays.
images::Image coarsen_rounding(const images::Image& rounding);

/// How an image differs from the expected one.
struct PixelChange {
  std::int64_t compared = 0;          ///< pixels that were compared
  std::int64_t changed = 0;           ///< compared pixels that differ by more than their tolerance, or are not finite
  std::int64_t excused_flips = 0;     ///< left out: a comparison may flip there, or another texel be read
  std::int64_t excused_rounding = 0;  ///< left out: rounding alone may move them by kWidestBound or more
  std::int64_t excused_expected = 0;  ///< pixels that the baseline alone leaves out
  std::int64_t excused_changed = 0;   ///< pixels left out that do differ by more than the tolerance, of those that
                                      ///< rounding moves far by more than with two bounds of kWidestBound
  double excused_squares = 0.0;       ///< sum of the squared differences of the pixels left out
  double max = 0.0;                   ///< largest difference of a pixel that was compared
  int max_x = 0;                      ///< its column from the left and its row from the top
  int max_y = 0;
  double mean = 0.0;  ///< mean magnitude over the compared pixels
  double rms = 0.0;

  std::int64_t pixels() const { return compared + excused_flips + excused_rounding; }
  double share() const { return compared > 0 ? static_cast<double>(changed) / static_cast<double>(compared) : 0.0; }
};

/// Compares images of one size. A pixel may differ by `tolerance` and the rounding bounds of both, where one of 0
/// counts as the 2^-14 that it may stand for: `tolerance` is spent on how images are stored. On the processor depends
/// whether a product and a sum are rounded once or twice, which moves a map's coordinates by 2^-24, and the filtering
/// weights of 512 texels by 2^-15.
PixelChange compare_pixels(const CellImages& actual, const CellImages& expected, double tolerance);

/// The origin of a run's numbers: whether two can be compared depends on it.
struct Origin {
  std::uint64_t seed = 0;
  std::string renderer;      ///< GL_RENDERER
  std::string machine = {};  ///< processor and number of cores
  std::string commit;        ///< commit of the program

  bool operator==(const Origin&) const = default;
};

/// Which cell of a run it is.
struct CellName {
  std::string key = {};  ///< key of the cell's settings
  std::string scene = {};
  std::string view = {};
  std::string filter = {};
  std::string label = {};  ///< filter and the parameters that were asked for
};

CellName name_cell(const records::CellRecord& cell);

/// One cell of a baseline, without its images.
struct BaselineCell : CellName {
  int map_size = 0;
  int width = 0;
  int height = 0;
  Origin origin;
  ComparedValues values;
};

/// The area truth of one view, with its standard error.
struct TruthImages {
  images::Image area;
  images::Image standard_error;
};

/// Stands for the filter in comparisons of a view's truth.
inline constexpr const char* kTruthName = "truth";

/// Names a view's truth in a baseline by the settings that tell truths of one scene apart.
std::string truth_key(const records::CellRecord& cell);

/// The cells of one filter on one scene, with their images by key.
struct CellFile {
  std::vector<BaselineCell> cells;
  std::map<std::string, CellImages> images;
};

/// A folder of expected results:
///   baseline.toml            the tolerances
///   SCENE/FILTER.json, .exr  numbers and images of a filter's cells, one part per cell and image
///   SCENE/truth.area.exr     truths of the scene's views
class Baseline {
 public:
  explicit Baseline(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path tolerance_file() const { return folder_ / "baseline.toml"; }
  /// Throws Error(kInput) where the path is no folder.
  bool exists() const;

  /// Lists the cells of all filters. Throws Error(kInput) where a folder cannot be listed, or a file cannot be read.
  std::vector<BaselineCell> list_cells() const;

  /// Reads the cells of a filter, and their images; nothing where there are none.
  /// Throws Error(kInput) where they cannot be read.
  CellFile read_cells(const std::string& scene, const std::string& filter) const;

  /// Writes the cells of a filter, those without images too; removes the files where there are none left. Throws
  /// Error(kOutput).
  void write_cells(const std::string& scene, const std::string& filter, const CellFile& cells);

  /// Reads and writes the truths of a scene in the same way, by truth_key().
  std::map<std::string, TruthImages> read_truths(const std::string& scene) const;
  void write_truths(const std::string& scene, const std::map<std::string, TruthImages>& truths);

 private:
  std::filesystem::path folder_;

  std::filesystem::path stem(const std::string& scene, const std::string& filter) const;
};

}  // namespace shadowbench::regress
