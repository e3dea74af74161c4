#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "report/regress/pixel_change.h"
#include "report/regress/tolerances.h"

namespace shadowbench::regress {

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

  /// Lists the cells of all filters, and files that cannot be read, with the reason.
  /// Throws Error(kInput) where a folder cannot be listed.
  struct Index {
    std::vector<BaselineCell> cells;
    std::map<std::string, std::string> unreadable;  ///< "SCENE/FILTER" to reason
  };
  Index read_index() const;

  /// Reads the cells of a filter without their images; nothing where there are none.
  /// Throws Error(kInput) where they cannot be read.
  std::vector<BaselineCell> read_numbers(const std::string& scene, const std::string& filter) const;

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
