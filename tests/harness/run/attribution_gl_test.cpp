#include <nlohmann/json.hpp>

#include "harness/run/run_experiment.h"
#include "report/images/picture_io.h"
#include "report/pages/run_data.h"
#include "report/records/format.h"
#include "report/records/json_io.h"
#include "tests/harness/measure/stand.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

/// Says nothing of a run's progress.
class Silent final : public options::Progress {
  void begin(int, int) override {}
  void show(int, const std::string&) override {}
  void note(const std::string&) override {}
};

// Whole runs: every cell's error taken apart, and the parts add up in every pixel of the float images.

class Attributed : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write(".shadowbench-folder", "");  // scenes lie beside what the run writes
    options_.out = folder_.path();
    options_.command = {"test"};
    options_.all_parts = true;
    options_.phases = 1;
    options_.pictures = false;
  }

  /// Runs filters on a built-in scene and gives its cells.
  nlohmann::json run(const std::string& scene, const std::string& filters, int map_size = 1024) {
    options_.scenes = {scene};
    options_.filters = filters::built_in().parse_requests(filters);
    options_.map_sizes = {map_size};
    Silent progress;
    run::run_experiment(options_, progress);
    return nlohmann::json::parse(folder_.read("results.json"))["cells"];
  }

  /// A floor of this size and another object, both grey, under a light.
  std::string write_scene(const std::string& light, double floor_m, const std::string& object) const {
    const std::string text = fmt::format(
        "title = 'own'\n[camera]\nposition = [0, 5, 5]\ntarget = [0, 0, 0]\nvertical_fov_deg = 40\n[light]\n{0}\n"
        "[[material]]\nname = 'grey'\ncolor = [0.5, 0.5, 0.5]\n"
        "[[object]]\nname = 'floor'\nshape = 'plane'\nsize = [{1}, {1}]\ncenter = [0, 0, 0]\ncells = 22\n"
        "material = 'grey'\n[[object]]\nname = 'caster'\nmaterial = 'grey'\n{2}\n",
        light, floor_m, object);
    return folder_.write("own.toml", text).string();
  }

  /// A square over a floor that lies parallel to it, under a sun of this diameter that stands overhead.
  std::string write_parallel_planes(double sun_deg) const {
    return write_scene(fmt::format("direction = [0, -1, 0]\nangular_diameter_deg = {}", sun_deg), 4.0,
                       "shape = 'plane'\nsize = [1.5, 1.5]\ncenter = [0, 1, 0]");
  }

  /// Expects acne on a floor whose own plane hides a part of a light close to it, without a bias and with the default
  /// one, whose slope is bounded; and no more penumbra than the caster's.
  void expect_acne_under(const std::string& light) {
    options_.attribution = false;
    options_.phases = 1;
    const std::string scene = write_scene(light, 8.0, "shape = 'box'\nsize = [0.6, 0.6, 0.6]\ncenter = [0, 0.3, -1]");
    const nlohmann::json cell = run(scene, "none", 512)[0];
    const std::vector<float> area = part("truth.area"), acne = part("truth.mask.acne");
    std::size_t cut = 0;
    for (std::size_t i = 0; i < area.size(); ++i) cut += acne[i] == 1.0f && area[i] < 0.9f;
    EXPECT_GT(cut, area.size() / 4) << "their own plane hides a part of the light";
    EXPECT_GT(cell["artefact"]["acne"], 0.005);
    EXPECT_LT(cell["truth"]["penumbra"], cell["receivers"].get<double>() / 4.0);
    options_.bias = render::BiasRule::none();
    EXPECT_GT(run(scene, "none", 512)[0]["artefact"]["acne"], 0.005);
    options_.bias.constant.depth = 1.0;
    EXPECT_EQ(run(scene, "none", 512)[0]["artefact"]["acne"], 0.0) << "to show more light than the truth is no acne";
  }

  /// Expects the parts of a filter's error to sum to it in every pixel.
  void expect_sum(const std::string& filter) const {
    const std::vector<float> area = part("truth.area"), image = part(filter + ".visibility");
    std::vector<double> sum(image.size(), 0.0);
    for (const records::ErrorPart& error_part : records::list_error_parts()) {
      const std::vector<float> values = part(filter + ".error." + error_part.id);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(values[i]);
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      // Where a pixel does not count, image and truth are equal: dark, or background.
      ASSERT_NEAR(sum[i], static_cast<double>(image[i]) - static_cast<double>(area[i]), 1e-6);
    }
  }

  std::vector<float> part(const std::string& name) const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      if (entry.path().extension() != ".exr") continue;
      for (const images::Part& part : images::read_exr(entry.path()).parts)
        if (part.name == name) return part.image.texels;
    }
    ADD_FAILURE() << "no part " << name;
    return {};
  }

  const TestFolder folder_;
  options::RunOptions options_ = make_run_options(240, 135);
};

TEST_F(Attributed, PartsAddUp_InEveryPixel_OfEveryFilter) {
  options_.pictures = true;
  options_.sizes = {{120, 68}};
  const nlohmann::json cells = run("cubes", "none,pcf2x2,tent3x3,poisson,vsm,esm");
  ASSERT_EQ(cells.size(), 6u);
  for (const auto& cell : cells) {
    const std::string filter = cell["filter"];
    SCOPED_TRACE(filter);
    expect_sum(filter);
    double shares = 0.0;
    for (const auto& [name, values] : cell["attribution"].items()) shares += values["share"].get<double>();
    EXPECT_NEAR(shares, 1.0, 1e-9);
    EXPECT_LT(cell["attribution"]["numeric"]["rms"], 1e-3);
    EXPECT_GT(cell["attribution"]["model"]["rms"], 0.001);
    EXPECT_GT(cell["error"]["kernel_rmse"], 0.0);
    EXPECT_EQ(cell["artefact"]["noise"].is_null(), filter != "poisson") << "the others take no random taps";
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / cell["images"]["values"].get<std::string>()));
  }
}

TEST_F(Attributed, FiltersThatCompareTheirKernel_HaveNoEstimatorError) {
  for (const auto& cell : run("steps", "none,pcf2x2,box3x3,tent3x3,teach4x4,box4x4,poisson")) {
    const double rms = cell["attribution"]["estimator"]["rms"];
    if (cell["filter"] == "poisson")
      EXPECT_GT(rms, 1e-3) << "16 taps are not a disk";
    else
      EXPECT_LT(rms, 1e-12) << cell["filter"];
  }
}

/// Between parallel planes the disk that pcss chooses is the light's penumbra.
TEST_F(Attributed, KernelsThatDifferFromPixelToPixel_AreThoseTheFilterChoseThere) {
  const nlohmann::json cells = run(write_parallel_planes(6.0), "pcf2x2,pcss:taps=32,search_taps=32");
  expect_sum("pcss (search_taps=32, taps=32)");
  const nlohmann::json &fixed = cells[0]["attribution"], &chosen = cells[1]["attribution"];
  EXPECT_LT(chosen["numeric"]["rms"], 1e-3);
  EXPECT_LT(chosen["model"]["rms"], 0.2 * fixed["model"]["rms"].get<double>());
  EXPECT_GT(chosen["estimator"]["rms"], 1e-3) << "32 taps are not a disk";
  EXPECT_LT(cells[1]["error"]["kernel_rmse"], 0.02);
  EXPECT_FALSE(cells[1]["artefact"]["noise"].is_null());
  EXPECT_TRUE(cells[1]["kernel"]["sigma_texels"].is_null());
}

TEST_F(Attributed, UnderALightOfNoSize_PcssIsOneFetch) {
  const nlohmann::json cells = run(write_parallel_planes(0.0), "pcf2x2,pcss");
  EXPECT_GT(cells[0]["error"]["rmse"], 0.01);
  for (const char* group : {"attribution", "excused"}) EXPECT_EQ(cells[1][group], cells[0][group]) << group;
  for (const char* metric : {"rmse", "kernel_rmse"}) EXPECT_EQ(cells[1]["error"][metric], cells[0]["error"][metric]);
}

TEST_F(Attributed, MoreTaps_HaveLessNoise) {
  const nlohmann::json cells = run("ball", "poisson:taps=4,poisson:taps=32");
  EXPECT_GT(cells[0]["artefact"]["noise"], 4.0 * cells[1]["artefact"]["noise"].get<double>());
  EXPECT_GT(cells[0]["attribution"]["estimator"]["rms"],
            2.0 * cells[1]["attribution"]["estimator"]["rms"].get<double>());
}

TEST_F(Attributed, OnStack_VsmFailsByItsEstimator_AndLeaks) {
  options_.sizes = {{480, 270}};
  const nlohmann::json cells = run("stack", "none,vsm:bleed_reduction=0,slope_variance=0");
  EXPECT_GT(cells[1]["attribution"]["estimator"]["share"], 0.5);
  EXPECT_GT(cells[1]["artefact"]["leak"], 0.1);
  EXPECT_EQ(cells[0]["artefact"]["leak"], 0.0);
}

TEST_F(Attributed, OnFence_WithASmallMap_NoneFailsByItsResolution) {
  const nlohmann::json cells = run("fence", "none", 256);
  EXPECT_GT(cells[0]["attribution"]["discretisation"]["share"], 0.5);
}

TEST_F(Attributed, WithoutBias_AcneIsSeen_AndIsDiscretisation) {
  options_.bias = render::BiasRule::none();
  const nlohmann::json cells = run("steps", "none,pcf2x2");
  for (const auto& cell : cells) {
    EXPECT_GT(cell["artefact"]["acne"], 0.05) << cell["filter"];
    EXPECT_GT(cell["attribution"]["discretisation"]["share"], 0.9) << cell["filter"];
  }
  options_.bias = {};
  for (const auto& cell : run("steps", "none,pcf2x2")) EXPECT_EQ(cell["artefact"]["acne"], 0.0) << cell["filter"];
}

TEST_F(Attributed, UnderAGrazingSun_AcneIsSeen) {
  expect_acne_under("azimuth_deg = 60\nelevation_deg = 0.1\nangular_diameter_deg = 0.53");
}

TEST_F(Attributed, UnderALampPartlyBelowTheFloor_AcneIsSeen) {
  expect_acne_under("type = 'point'\nposition = [-3.5, 0.06, 0]\nradius = 0.25");
}

/// Under a lamp and under the sun: few receivers are within 8 texels of what blocks them.
TEST_F(Attributed, AGapWiderThanAContact_IsAGap_AndNoLeak) {
  options_.sizes = {{480, 270}};
  options_.attribution = false;
  options_.phases = 1;
  options_.bias = render::BiasRule::none();
  options_.bias.constant.depth = 0.1;
  for (const char* scene : {"lamp", "cubes"}) {
    const nlohmann::json artefact = run(scene, "pcf2x2")[0]["artefact"];
    EXPECT_GT(artefact["contact_gap"], 0.9) << scene;
    EXPECT_LT(artefact["leak"], 0.001) << scene;
  }
}

TEST_F(Attributed, TooMuchBias_OpensContactGaps) {
  options_.sizes = {{480, 270}};
  EXPECT_LT(run("fence", "none")[0]["artefact"]["contact_gap"], 0.5);
  options_.bias.constant.depth = 0.02;
  EXPECT_GT(run("fence", "none")[0]["artefact"]["contact_gap"], 0.95);
}

/// They blur thin bars, and VSM and ESM fade towards contacts: neither comes from bias.
TEST_F(Attributed, AlmostNoBias_LeavesWideFiltersWithoutContactGaps) {
  options_.sizes = {{480, 270}};
  options_.attribution = false;
  options_.bias = render::BiasRule::none();
  options_.bias.constant.depth = 2e-5;
  for (const auto& cell : run("fence", "none,poisson:radius=8,vsm:radius=1,vsm,esm")) {
    const auto& gap = cell["artefact"]["contact_gap"];
    if (gap.is_null())
      EXPECT_THAT(cell["absent"]["artefact.contact_gap"].get<std::string>(), HasSubstr("dark without bias"));
    else
      EXPECT_LT(gap, 0.01) << cell["filter"];
  }
  options_.bias.constant.depth = 0.02;
  const nlohmann::json cells = run("fence", "none,poisson:radius=2");
  EXPECT_GT(cells[0]["artefact"]["contact_gap"], 0.95);
  EXPECT_GT(cells[1]["artefact"]["contact_gap"], 0.9);
}

/// A polygon offset is drawn into the map: the map without it is drawn for comparison, and then put back.
TEST_F(Attributed, BiasInTheMap_OpensContactGapsToo) {
  options_.sizes = {{480, 270}};
  options_.bias = render::BiasRule::none();
  options_.bias.map.polygon_units = 3e5;
  const nlohmann::json cells = run("fence", "none,vsm:radius=1");
  EXPECT_GT(cells[0]["artefact"]["contact_gap"], 0.9);
}

TEST_F(Attributed, InACoarseMap_FiltersThatCompareDoNotLeak_BesideAnEdge) {
  // The surroundings follow from the run's widest kernel, the tent's.
  const nlohmann::json cells = run("steps", "none,pcf2x2,tent3x3", 128);
  EXPECT_EQ(cells[0]["artefact"]["leak"], 0.0);
  EXPECT_EQ(cells[1]["artefact"]["leak"], 0.0);
}

TEST_F(Attributed, PixelsBesideAnEdge_AreInNoMask) {
  // So few pixels that most blocked ones have a neighbour that is not.
  options_.sizes = {{60, 34}};
  for (const auto& cell : run("stack", "none,vsm")) {
    EXPECT_TRUE(cell["artefact"]["leak"].is_null()) << cell["filter"];
    EXPECT_TRUE(cell["absent"].contains("artefact.leak")) << cell["filter"];
  }
}

TEST_F(Attributed, WithoutAttribution_ArtefactsAreStillCounted) {
  options_.attribution = false;
  const nlohmann::json cells = run("cubes", "none");
  EXPECT_TRUE(cells[0]["attribution"]["model"]["share"].is_null());
  EXPECT_EQ(cells[0]["absent"]["attribution"], "the run was made with --no-attribution");
  EXPECT_EQ(cells[0]["artefact"]["acne"], 0.0);
}

TEST_F(Attributed, WithoutTruth_ReceiversAreKeptAllTheSame) {
  run("cubes", "none", 64);
  const std::vector<float> with = part("receiver.position");
  options_.truth = options_.attribution = false;
  run("cubes", "none", 64);
  EXPECT_EQ(part("receiver.position"), with);
}

// The pictures that a page shows first, with 16 samples a pixel, are means of pictures with four times as many pixels
// along each axis, where the page shows them.

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
  options::RunOptions options = make_run_options(size.width, size.height);
  options.filters = filters::built_in().parse_requests("none,pcf2x2,tent5x5");
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
  const TestFolder folder;
  const std::filesystem::path root = folder.path();
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
}

}  // namespace
}  // namespace shadowbench::test
