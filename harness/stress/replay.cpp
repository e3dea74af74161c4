#include "harness/stress/replay.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "harness/measure/filter_setup.h"
#include "harness/measure/map_limits.h"
#include "harness/measure/scene_assets.h"
#include "harness/render/shade_pass.h"
#include "harness/run/scene_loading.h"
#include "reference/metrics/error_stats.h"
#include "reference/truth/truth_cache.h"
#include "report/analysis/summary.h"
#include "report/images/grid.h"
#include "report/images/hardest_edge.h"
#include "report/records/format.h"
#include "report/records/text_table.h"

namespace shadowbench::stress {
namespace {

constexpr int kMapSize = 512, kWidth = 480, kHeight = 270;

/// What one set-up of the filters resulted in.
struct Result {
  std::string label;
  double rmse = 0.0;
  std::int64_t broken_texels = 0;
  std::int64_t broken_pixels = 0;
  images::Image visibility;
  images::Image picture;
};

std::vector<std::string> list_setups(const Mistake& mistake) {
  std::vector<std::string> setups = {mistake.wrong};
  setups.insert(setups.end(), mistake.variants.begin(), mistake.variants.end());
  setups.insert(setups.end(), mistake.others.begin(), mistake.others.end());
  return setups;
}

options::RunOptions make_options(const AxisInputs& inputs, const Mistake& mistake) {
  options::RunOptions options;
  options.resources = inputs.resources;
  options.scenes = {mistake.scene};
  const filters::Catalogue catalogue(inputs.resources.filters);
  for (const std::string& setup : list_setups(mistake))
    options.filters.push_back(catalogue.parse_requests(setup).front());
  options.map_sizes = {kMapSize};
  options.width = kWidth;
  options.height = kHeight;
  options.seed = inputs.seed;
  return options;
}

/// One view of the scene, with its truth.
class Stage {
 public:
  Stage(const AxisInputs& inputs, const Mistake& mistake)
      : renderer_(*inputs.renderer),
        options_(make_options(inputs, mistake)),
        scene_(run::load_scene(options_, mistake.scene)),
        cache_(inputs.cache,
               [progress = inputs.progress](const std::string& message) {
                 if (progress) progress->note("warning: " + message);
               }),
        assets_(renderer_, options_, scene_, cache_, measure::largest_padding_texels(options_.filters)),
        light_(assets_.light_map(camera(), kMapSize)),
        target_("replayed visibility", GL_R32F, kWidth, kHeight) {}

  std::vector<Result> draw_all() {
    std::vector<Result> results;
    for (const filters::FilterRequest& request : options_.filters) results.push_back(draw(request));
    return results;
  }

  const measure::SceneTruth& truth() { return assets_.truth(camera()); }

 private:
  measure::Renderer& renderer_;
  options::RunOptions options_;
  scene::Scene scene_;
  truth::TruthCache cache_;
  measure::SceneAssets assets_;
  measure::LightMap& light_;
  render::ImageTarget target_;

  const scene::Camera& camera() const { return scene_.cameras.front(); }

  Result draw(const filters::FilterRequest& request) {
    const auto passes = measure::make_filter_passes(renderer_, options_, scene_, light_, request);
    Result result;
    result.label = request.label();
    result.visibility = measure::draw_visibility(*passes, light_.map, assets_.gbuffer(camera()), target_);
    result.broken_texels = measure::count_broken_texels(*passes, light_.map);
    result.picture = render::shade(renderer_.shaders, assets_.gbuffer(camera()), target_.texture(), scene_, camera());
    score(result);
    return result;
  }

  /// A pixel that is not finite counts as wholly wrong.
  void score(Result& result) {
    std::vector<float> image = result.visibility.texels;
    const measure::SceneTruth& known = truth();
    for (std::size_t i = 0; i < image.size(); ++i) {
      if (std::isfinite(image[i])) continue;
      image[i] = known.area.texels[i] > 0.5f ? 0.0f : 1.0f;
      result.broken_pixels += known.mask[i];
    }
    const auto stats = metrics::measure_error(image, known.area.texels, known.mask);
    result.rmse = stats ? stats->rmse : 1.0;
  }
};

/// Ranks a set-up among those that it is compared with: "3 of 3".
std::string rank(const Result& result, const std::vector<const Result*>& others) {
  const auto better = std::ranges::count_if(others, [&](const Result* other) { return other->rmse < result.rmse; });
  return fmt::format("{} of {}", better + 1, others.size() + 1);
}

/// The set-ups by their part in the mistake; they point into the results.
struct Parts {
  const Result* wrong = nullptr;
  std::vector<const Result*> variants;
  std::vector<const Result*> others;
};

Parts split(const std::vector<Result>& results, const Mistake& mistake) {
  Parts parts;
  parts.wrong = &results.front();
  for (std::size_t i = 1; i < results.size(); ++i)
    (i <= mistake.variants.size() ? parts.variants : parts.others).push_back(&results[i]);
  return parts;
}

records::TextTable make_table(const std::vector<Result>& results, const Parts& parts) {
  records::TextTable table{
      {"set-up", "overflown texels", "RMSE to area truth", "rank with the wrong set-up", "rank, corrected"}, {}};
  for (const Result& result : results) {
    const bool other = std::ranges::find(parts.others, &result) != parts.others.end();
    std::vector<const Result*> rivals = parts.others;
    std::erase(rivals, &result);
    const auto against = [&](const Result* rival) {
      std::vector<const Result*> all = rivals;
      if (other) all.push_back(rival);
      return rank(result, all);
    };
    const bool wrong = &result == parts.wrong, corrected = &result == parts.variants.front();
    table.rows.push_back({result.label, fmt::format("{} of {}", result.broken_texels, kMapSize * kMapSize),
                          records::format_number(result.rmse),
                          other || wrong ? against(parts.wrong) : std::string(records::kNothing),
                          other || corrected ? against(parts.variants.front()) : std::string(records::kNothing)});
  }
  return table;
}

std::vector<std::string> describe(const Parts& parts, const Mistake& mistake) {
  std::vector<std::string> words = {
      fmt::format("On '{}', {} ranks {} by its error (RMSE {}), and {} of the {} texels of its map overflowed: that "
                  "number, which every run reports as a "
                  "warning, says that the comparison is of an overflow, not of a filter.",
                  mistake.scene, parts.wrong->label, rank(*parts.wrong, parts.others),
                  records::format_number(parts.wrong->rmse), parts.wrong->broken_texels, kMapSize * kMapSize)};
  for (const Result* variant : parts.variants) {
    words.push_back(fmt::format("{} ranks {} (RMSE {}), with {} overflown texels.", variant->label,
                                rank(*variant, parts.others), records::format_number(variant->rmse),
                                variant->broken_texels));
  }
  return words;
}

void write_pictures(const std::filesystem::path& file, std::vector<Result> results, const measure::SceneTruth& truth,
                    const Mistake& mistake) {
  images::Grid grid;
  grid.columns = 4;
  grid.title = "A famous mistake, replayed";
  grid.subtitle = fmt::format("scene {}, map {}", mistake.scene, kMapSize);
  for (Result& result : results) {
    images::GridTile tile;
    tile.label = result.label;
    tile.caption =
        fmt::format("RMSE {} · {} overflown texels", records::format_number(result.rmse), result.broken_texels);
    tile.error = measure::make_error_image(result.visibility, truth);
    tile.picture = std::move(result.picture);
    tile.visibility = std::move(result.visibility);
    grid.tiles.push_back(std::move(tile));
  }
  images::write_grid(file, grid);
}

}  // namespace

Exhibit replay(const AxisInputs& inputs, const Mistake& mistake, const std::string& id) {
  Stage stage(inputs, mistake);
  std::vector<Result> results = stage.draw_all();
  const Parts parts = split(results, mistake);
  Exhibit exhibit;
  exhibit.id = id;
  exhibit.title = "A famous mistake, replayed";
  exhibit.sentences = describe(parts, mistake);
  exhibit.table = make_table(results, parts);
  exhibit.pictures.push_back({fmt::format("stress.{}.png", id),
                              fmt::format("picture, visibility and error of each set-up on {}", mistake.scene)});
  write_pictures(inputs.out / exhibit.pictures.front().file, std::move(results), stage.truth(), mistake);
  return exhibit;
}

}  // namespace shadowbench::stress
