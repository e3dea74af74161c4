// The pictures that a page shows first, with 16 samples a pixel, are means of pictures with four times as many pixels
// along each axis, where the page shows them.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "harness/run/run_experiment.h"
#include "report/images/picture_io.h"
#include "report/pages/run_data.h"
#include "report/records/json_io.h"
#include "tests/harness/run/silent.h"

namespace shadowbench::test {
namespace {

struct MeasuredRun {
  std::filesystem::path folder;
  std::vector<records::CellRecord> cells;

  const records::CellRecord& of(const std::string& filter) const {
    return *std::ranges::find(cells, filter, &records::CellRecord::filter);
  }
  images::Image read(const std::optional<std::string>& path) const {
    return images::read_picture(folder / path.value());
  }
};

MeasuredRun measure_sized(const std::filesystem::path& folder, const images::Size& size) {
  options::RunOptions options;
  options.resources = options::find_resources();
  options.sizes = {{size.width, size.height}};
  options.rounds = options::RoundLimits::exactly(1);
  const filters::Catalogue catalogue(options.resources.filters);
  options.reference = catalogue.parse_requests("none").front();
  options.filters = catalogue.parse_requests("none,pcf2x2,tent5x5");
  options.scenes = {"ball"};
  options.map_sizes = {256};
  options.out = folder;
  options.command = {"test"};
  Silent progress;
  run::run_experiment(options, progress);
  return {folder, records::read_results(folder / "results.json").cells};
}

/// The rows that hold what the page shows: pictures as narrow as these are shown over their whole width.
struct Rows {
  int first = 0, end = 0;
};

Rows find_shown_rows(const std::vector<records::CellRecord>& cells) {
  Rows rows{1 << 30, 0};
  for (const records::CellRecord& cell : cells) {
    if (!cell.images.supersampled) continue;
    const auto [left, top, width, height] = pages::choose_part(cell);
    EXPECT_EQ(width, cell.width);
    rows.first = std::min(rows.first, static_cast<int>(std::floor(top)));
    rows.end = std::max(rows.end, static_cast<int>(std::ceil(top + height)));
  }
  return rows;
}

/// How far these rows are from the means in linear light of 4 x 4 pixels of a larger picture: on average, and at most.
std::pair<double, double> compare_means(const images::Image& small, const images::Image& large, const Rows& rows) {
  double sum = 0.0, most = 0.0;
  for (int y = rows.first; y < rows.end; ++y)
    for (int x = 0; x < small.width; ++x)
      for (int c = 0; c < small.channels; ++c) {
        double mean = 0.0;
        for (int i = 0; i < 16; ++i)
          mean += static_cast<double>(images::decode_srgb(large.at(4 * x + i % 4, 4 * y + i / 4)[c])) / 16.0;
        const double gap =
            std::abs(static_cast<double>(small.at(x, y)[c] - images::encode_srgb(static_cast<float>(mean))));
        sum += gap;
        most = std::max(most, gap);
      }
  return {sum / (static_cast<double>(rows.end - rows.first) * small.width * small.channels), most};
}

/// Expects two pictures to be the same but in these rows, which are not all.
void expect_equal_outside(const images::Image& a, const images::Image& b, const Rows& rows) {
  ASSERT_LT(rows.end - rows.first, a.height);
  for (int y = 0; y < a.height; ++y)
    if (y < rows.first || y >= rows.end)
      EXPECT_TRUE(std::equal(a.at(0, y), a.at(0, y) + a.channels * a.width, b.at(0, y))) << "row " << y;
}

TEST(Supersampled, Pictures_AreMeansOfLargerOnes) {
  const std::filesystem::path root =
      std::filesystem::temp_directory_path() / ("shadowbench.samples." + std::to_string(getpid()));
  const MeasuredRun run = measure_sized(root / "run", {96, 54}), large = measure_sized(root / "large", {384, 216});
  const Rows rows = find_shown_rows(run.cells);
  int shown = 0;
  for (const records::CellRecord& cell : run.cells) {
    EXPECT_EQ(cell.images.supersampled.has_value(), cell.images.samples.has_value());
    if (!cell.images.supersampled) continue;
    SCOPED_TRACE(cell.filter);
    ++shown;
    EXPECT_EQ(cell.images.samples, 16);
    const auto [mean, most] =
        compare_means(run.read(cell.images.supersampled), large.read(large.of(cell.filter).images.picture), rows);
    EXPECT_LT(most, 0.01) << "rounding to 8 bits of both";
    const auto [truth_mean, truth_most] =
        compare_means(run.read(cell.images.truth_supersampled), large.read(cell.images.truth_picture), rows);
    EXPECT_LT(truth_mean, 0.001);
    EXPECT_LT(truth_most, 0.05) << "rays are random, and fewer for each sample";
    const auto [measured_mean, measured_most] =
        compare_means(run.read(cell.images.picture), large.read(large.of(cell.filter).images.picture), rows);
    EXPECT_GT(measured_mean, 4.0 * mean) << "one sample a pixel is another picture";
    EXPECT_GT(measured_most, 0.1);
    expect_equal_outside(run.read(cell.images.supersampled), run.read(cell.images.picture), rows);
    expect_equal_outside(run.read(cell.images.truth_supersampled), run.read(cell.images.truth_picture), rows);
  }
  EXPECT_GT(shown, 0);
  std::filesystem::remove_all(root);
}

}  // namespace
}  // namespace shadowbench::test
