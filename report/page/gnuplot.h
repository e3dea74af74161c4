#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/front.h"
#include "report/page/plot_axis.h"

namespace shadowbench::page {

/// Says how a series' points are joined.
enum class PlotLine {
  kNone,
  kSteps,  ///< along x, then along y
  kSolid,
  kDashed
};

/// Is a point with its intervals and an optional text beside it.
struct PlotPoint {
  analysis::Estimate x;
  analysis::Estimate y;
  std::string label = {};
};

/// Is a set of points drawn alike.
struct PlotSeries {
  std::string title;   ///< in the key; empty: not in the key
  std::string color;   ///< "#rrggbb" or "#aarrggbb", aa = 0 opaque
  int point_type = 0;  ///< gnuplot's; 0: no points
  PlotLine line = PlotLine::kNone;
  bool whiskers = false;
  std::vector<PlotPoint> points;
};

/// Is one picture.
struct Plot {
  std::string file;  ///< relative to the report folder, ends in .svg; no quotes
  std::string title;
  std::string x_name;
  std::string y_name;
  PlotAxis x;
  PlotAxis y;
  std::vector<PlotSeries> series;
  std::vector<std::string> notes;  ///< lines below the key
};

/// Writes a gnuplot script that draws the plots as SVG, all texts quoted, so that none of them is taken for a command
/// or for markup. It stands alone: `gnuplot FILE` in the report folder draws the plots again.
std::string make_gnuplot_script(const std::vector<Plot>& plots);

/// Runs gnuplot on a script, in a folder; the user's own gnuplot settings are left out.
/// Returns why the plots were not drawn: gnuplot is missing, failed, or took longer than `timeout_s`; nothing on
/// success.
std::optional<std::string> run_gnuplot(const std::filesystem::path& dir, const std::filesystem::path& script,
                                       double timeout_s = 120.0);

}  // namespace shadowbench::page
