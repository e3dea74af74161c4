#pragma once

#include "report/images/figure.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/records.h"
#include "tests/test_files.h"

namespace shadowbench::records {

/// A test with a temporary folder.
class FolderTest : public ::testing::Test {
 protected:
  const TestFolder folder_;
};

/// Lists what a function or member returns for each element, in order.
template <typename Things, typename Get>
auto list_each(const Things& things, Get get) {
  std::vector<std::decay_t<decltype(std::invoke(get, *std::begin(things)))>> list;
  for (const auto& thing : things) list.push_back(std::invoke(get, thing));
  return list;
}

inline std::size_t count_files(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// An image of one value.
inline images::Image fill(images::Image image, float value) {
  std::ranges::fill(image.texels, value);
  return image;
}

/// A slanted shadow edge of the given softness, in pixels.
inline images::Image make_visibility(int width, int height, float softness) {
  images::Image image(width, height, 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float distance = static_cast<float>(x) - 0.4f * static_cast<float>(width) - 0.3f * static_cast<float>(y);
      *image.at(x, y) = std::clamp(0.5f + distance / softness, 0.0f, 1.0f);
    }
  }
  return image;
}

/// A bright floor under that shadow, linear RGB.
inline images::Image shade(const images::Image& visibility) {
  images::Image picture(visibility.width, visibility.height, 3);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const float light = 0.08f + 0.7f * *visibility.at(x, y);
      const bool dark = ((x * 16 / picture.width) + (y * 9 / picture.height)) % 2 != 0;
      picture.at(x, y)[0] = light * (dark ? 0.5f : 0.9f);
      picture.at(x, y)[1] = light * (dark ? 0.5f : 0.8f);
      picture.at(x, y)[2] = light * (dark ? 0.6f : 0.6f);
    }
  }
  return picture;
}

/// A figure, drawn as display values.
inline images::Image draw_figure(const images::Figure& figure) {
  const images::Layout layout = images::layout_figure(figure);
  return images::draw_rows(layout, 0, layout.canvas.height);
}

/// A finished cell with times and costs, and no truth.
inline CellRecord make_cell(const std::string& scene, const std::string& filter, double lookup_ms) {
  CellRecord cell;
  cell.scene = scene;
  cell.view = "main";
  cell.filter = filter;
  cell.params = {{"radius", 4.0}, {"store", std::string("rg32f")}};
  cell.kernel = {0.65, "medium"};
  cell.map_size = 1024;
  cell.map_format = "d32f";
  cell.width = 960;
  cell.height = 540;
  cell.receivers = 400000;
  cell.excused = 12;
  cell.nan = 0;
  cell.time_ms.map = Quartiles{3.5, 3.25, 3.75, 9};
  cell.time_ms.lookup = Quartiles{lookup_ms, lookup_ms * 0.98, lookup_ms * 1.02, 9};
  cell.time_ms.static_light = OwnTime{*cell.time_ms.lookup, {lookup_ms * 0.99, lookup_ms * 1.01}};
  const double frame_ms = 3.5 + lookup_ms;
  cell.time_ms.moving = OwnTime{{frame_ms, frame_ms * 0.98, frame_ms * 1.02, 9}, {frame_ms * 0.99, frame_ms * 1.01}};
  cell.ratio_to_none.lookup = Ratio{lookup_ms / 4.0, {lookup_ms / 4.0 * 0.99, lookup_ms / 4.0 * 1.01}};
  cell.cost.fetches = 4.0;
  cell.cost.bytes_per_texel = 4;
  cell.cost.passes = 1;
  cell.cost.map_bytes = 4194304;
  cell.images.picture = scene + "." + filter + ".png";
  cell.absent = {{"error", "no truth in this run"}, {"time_ms.prefilter", "this filter needs no prefilter"}};
  cell.key = cell_key(cell);
  return cell;
}

/// A cell without a prefilter, with an RMSE to a truth whose standard error is 0.001.
inline CellRecord make_scored_cell(const std::string& scene, const std::string& filter, double lookup_ms, double rmse) {
  CellRecord cell = make_cell(scene, filter, lookup_ms);
  cell.absent.erase("error");
  cell.cost.prefilter_texels = 0;
  cell.error.rmse = rmse;
  cell.truth.se = 0.001;
  return cell;
}

/// The same with further errors, and with the shares of their parts.
inline CellRecord make_attributed_cell(const std::string& filter, double rmse, const PartValues& shares) {
  CellRecord cell = make_scored_cell("cubes", filter, 4.0, rmse);
  cell.error.mae = rmse / 4.0;
  cell.error.p95 = 2.0 * rmse;
  cell.error.max = 1.0;
  cell.error.mean = -rmse / 8.0;
  cell.error.flip = 0.02;
  cell.error.kernel_rmse = rmse / 2.0;
  cell.error.flicker = rmse / 3.0;
  cell.truth.unanimous = 0.9;
  cell.truth.weight_rmse = 0.002;
  for (std::size_t i = 0; i < metrics::kErrorParts; ++i)
    cell.attribution.*list_error_parts()[i].record = {std::abs(shares[i]) * rmse, shares[i]};
  return cell;
}

inline RunRecord make_run() {
  RunRecord run;
  run.commit = "0123abc";
  run.command = {"shadowbench", "run"};
  run.seed = 7;
  run.gl = {"osmesa", "llvmpipe (LLVM 15.0.6, 256 bits)", "4.5 (Core Profile) Mesa 22.3.6", true,
            TimerKind::kWallClock};
  run.machine = {"Some CPU", 2, 0.25, "GCC 12.2.0", "Debian GNU/Linux 12"};
  run.work = {12, 40, 3, 5, 2, 1.5, 2.0, 0.5};
  run.scenes = {{"cubes", "Three cubes on a floor", {"cubes.toml", "--ground"}}};
  run.filter_files = {{"mine", "mine.glsl"}, {"yours", std::nullopt}};
  return run;
}

}  // namespace shadowbench::records
