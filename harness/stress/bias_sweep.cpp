#include "harness/stress/bias_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/files.h"
#include "filters/kernel.h"
#include "harness/measure/cell_analysis.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/bias.h"
#include "harness/render/filter_passes.h"
#include "harness/render/gbuffer.h"
#include "harness/render/picture_passes.h"
#include "harness/run/merge.h"
#include "harness/run/provenance.h"
#include "harness/run/run_plan.h"
#include "report/files/file_name.h"
#include "report/files/folder_lock.h"
#include "report/images/grid.h"
#include "report/pages/bias_page.h"
#include "report/pages/write_page.h"
#include "report/records/format.h"

namespace shadowbench::stress {
namespace {

constexpr double kFactors[] = {0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
constexpr double kTooLittle = 0.25, kTheory = 1.0, kTooMuch = 8.0;  // of the pictures
constexpr double kPercentile = 0.95;

/// The light's name; of the only one, which has none, what it is.
std::string name_light(const scene::Scene& scene) {
  return scene.light.name.empty() ? scene::describe_light(scene.light) : scene.light.name;
}

/// What a light's record says whether it has an answer or not.
records::BiasSweepRecord start_record(const options::RunOptions& options, const scene::Scene& scene) {
  records::BiasSweepRecord record;
  record.scene = scene.name;
  record.title = scene.title;
  record.light = name_light(scene);
  record.view = scene.cameras.front().name;
  record.map_size = options.map_sizes.front();
  record.fit = scene::describe_fit(options.fit);
  record.width = options.width;
  record.height = options.height;
  return record;
}

/// One image of a mode, for its grid.
struct Shot {
  records::BiasPoint point;
  images::Image visibility;
};

/// Says how far all lights have come.
struct Steps {
  options::Progress& progress;
  std::string light = {};
  int done = 0;

  void show(const std::string& what) { progress.show(done, light + " · " + what); }
};

/// One light of a scene.
class BiasSweep {
 public:
  BiasSweep(const options::RunOptions& options, const scene::Scene& scene, measure::Renderer& renderer,
            truth::TruthCache& cache, Steps& steps)
      : options_(options),
        steps_(steps),
        scene_(scene),
        renderer_(renderer),
        assets_(renderer_, options_, scene_, cache, measure::largest_padding_texels(options.filters)),
        light_(assets_.light_map(scene_.cameras.front(), options.map_sizes.front())),
        target_("visibility", GL_R32F, options.width, options.height),
        record_(start_record(options, scene)) {}

  /// Throws Error(kInput) where there is nothing to take a theoretical amount from.
  records::BiasSweepRecord run() {
    steps_.show("truth");
    make_masks();
    find_lit();
    describe();
    for (const render::SweptMode& mode : render::swept_modes()) record_.modes.push_back(sweep_mode(mode));
    renderer_.context->require_no_gl_errors();
    return std::move(record_);
  }

 private:
  options::RunOptions options_;  ///< with the bias that is drawn at present
  Steps& steps_;
  const scene::Scene& scene_;
  measure::Renderer& renderer_;
  measure::SceneAssets assets_;
  measure::LightMap& light_;
  render::ImageTarget target_;
  render::MapBias drawn_;  ///< what the map holds
  metrics::ArtefactMasks masks_;
  std::vector<filters::Receiver> lit_;             ///< those of the acne mask
  std::map<std::string, images::Image> unbiased_;  ///< by label
  records::BiasSweepRecord record_;

  const scene::Camera& camera() const { return scene_.cameras.front(); }

  void make_masks() {
    const measure::SceneTruth& truth = assets_.truth(camera());
    const measure::SceneTask task{&scene_, &camera(), options_.map_sizes.front(), options_.filters};
    const auto masks = measure::CellAnalyser({renderer_, options_, task, assets_}, truth).masks();
    if (!masks)
      throw Error(ErrorKind::kInput,
                  fmt::format("{}: no masks of artefacts: {}; choose another scene", scene_.name, truth.absent));
    masks_ = *masks;
  }

  /// Finds the lit receivers, for which theory is computed.
  void find_lit() {
    for (const render::LightSetup& layer : measure::make_unbiased_light(options_, scene_.light, light_.layers)) {
      const auto served = render::read_receivers(renderer_.shaders, assets_.gbuffer(camera()), layer);
      lit_.insert(lit_.end(), served.begin(), served.end());
    }
    std::erase_if(lit_, [&](const filters::Receiver& r) {
      return !masks_.acne[measure::find_pixel(r, options_.width, options_.height)];
    });
    if (static_cast<int>(lit_.size()) < metrics::kFewestReceivers) {
      throw Error(
          ErrorKind::kInput,
          fmt::format(
              "{}: {} receivers are wholly lit, and {} are needed to reckon a theoretical amount; choose a larger "
              "--size, a larger --map-size or another scene",
              scene_.name, lit_.size(), metrics::kFewestReceivers));
    }
    const render::SweptMode& constant = render::swept_modes().front();
    if (render::find_theory(constant, 1.0, lit_, kPercentile).slope_per_texel > 0.0) return;
    throw Error(
        ErrorKind::kInput,
        fmt::format(
            "{}: the lit surfaces face the light squarely, where theory asks for no bias at all; choose another "
            "scene",
            scene_.name));
  }

  void describe() {
    const records::GlRecord gl = run::describe_gl(renderer_);
    record_.renderer = fmt::format("{} ({}), program {}", gl.renderer, gl.backend, run::build_commit());
    for (const auto& request : options_.filters) record_.filters.push_back(request.label());
    const render::BiasTheory steep = render::find_theory(render::swept_modes().front(), 1.0, lit_, kPercentile);
    record_.slope_depth = steep.slope_per_texel;
    record_.angle_deg = glm::degrees(std::acos(steep.n_dot_l));
    record_.percentile = kPercentile;
    const auto [least, most] = std::ranges::minmax(lit_, {}, &filters::Receiver::texel_size_ws);
    record_.texel_m = {static_cast<double>(least.texel_size_ws), static_cast<double>(most.texel_size_ws)};
    record_.depth_range_m = light_.frustum().depth_range_ws;
    record_.gap_above = metrics::kArtefactLimits.contact_gap_above;
    record_.acne_below = metrics::kArtefactLimits.acne_below;
    record_.acne_receivers = std::ranges::count(masks_.acne, 1);
    record_.contact_receivers = std::ranges::count(masks_.contact_gap, 1);
    record_.fewest_receivers = metrics::kFewestReceivers;
  }

  void draw_map(const render::MapBias& bias) {
    if (drawn_ == bias) return;
    drawn_ = bias;
    assets_.redraw(light_, drawn_);
  }

  /// Why a filter is left out of a mode; empty where it is not.
  std::string explain_left_out(const render::BiasRule& rule, const filters::FilterSpec& spec) {
    draw_map(rule.map);
    if (rule.map.cull_front && !measure::SceneAssets::has_casters(light_))
      return "would read an empty map: all casters are open meshes, of which nothing stays";
    return render::explain_unusable(rule, spec);
  }

  images::Image draw(const filters::FilterRequest& request, const render::BiasRule& rule) {
    draw_map(rule.map);
    options_.bias = rule;
    const auto filter = measure::make_filter_passes(renderer_, options_, scene_, light_, request);
    return measure::draw_visibility(*filter, light_.map, assets_.gbuffer(camera()), target_);
  }

  /// A filter's visibility without any bias, drawn when it is first asked for.
  const images::Image& find_unbiased(const filters::FilterRequest& request) {
    const auto [place, is_new] = unbiased_.try_emplace(request.label());
    if (is_new) place->second = draw(request, render::BiasRule::none());
    return place->second;
  }

  Shot shoot(const render::SweptMode& mode, const filters::FilterRequest& request, std::optional<double> factor,
             double setting) {
    Shot shot;
    shot.visibility = draw(request, mode.make_rule(setting));
    shot.point.factor = factor;
    shot.point.setting = setting;
    const std::vector<float>& image = shot.visibility.texels;
    shot.point.acne = metrics::rate_acne(image, assets_.truth(camera()).rays.area.visibility, masks_.acne);
    shot.point.contact_gap = metrics::rate_contact_gap(image, find_unbiased(request).texels, masks_);
    return shot;
  }

  std::vector<Shot> shoot_curve(const render::SweptMode& mode, const filters::FilterRequest& request,
                                records::BiasCurve& curve) {
    std::vector<Shot> shots;
    if (mode.key.empty()) {
      shots.push_back(shoot(mode, request, std::nullopt, 0.0));
      return shots;
    }
    const render::BiasTheory theory =
        render::find_theory(mode, filters::bias_reach_texels(request.spec, request.values), lit_, kPercentile);
    curve.theory_setting = mode.amount(theory);
    curve.lift_depth = mode.lift_depth(theory);
    curve.lift_m = curve.lift_depth * light_.frustum().depth_range_ws;
    curve.lift_texels = curve.lift_m / theory.texel_m;
    for (const double factor : kFactors) shots.push_back(shoot(mode, request, factor, factor * curve.theory_setting));
    return shots;
  }

  /// The filter whose images are shown: the first that is wider than one fetch, for edges to be seen soft.
  const filters::FilterRequest* choose_shown(const std::vector<const filters::FilterRequest*>& usable) const {
    const auto is_wide = [](const filters::FilterRequest* request) {
      return filters::find_kernel_sigma(request->spec, request->values) >
             filters::width_classes().front().widest_texels;
    };
    const auto wide = std::ranges::find_if(usable, is_wide);
    return wide != usable.end() ? *wide : usable.empty() ? nullptr : usable.front();
  }

  records::BiasModeRecord sweep_mode(const render::SweptMode& mode) {
    records::BiasModeRecord record;
    record.mode = mode.name;
    record.key = mode.key;
    record.meaning = mode.meaning;
    std::vector<const filters::FilterRequest*> usable;
    for (const filters::FilterRequest& request : options_.filters) {
      const std::string reason = explain_left_out(mode.make_rule(0.0), request.spec);
      if (reason.empty())
        usable.push_back(&request);
      else
        record.left_out.push_back(fmt::format("Left out: {}, which {}.", request.label(), reason));
    }
    const filters::FilterRequest* shown = choose_shown(usable);
    for (const filters::FilterRequest* request : usable) {
      steps_.show(fmt::format("{} · {}", mode.name, request->label()));
      ++steps_.done;
      records::BiasCurve& curve = record.curves.emplace_back();
      curve.filter = request->label();
      curve.id = request->spec.id;
      curve.params = measure::record_params(request->values);
      std::vector<Shot> shots = shoot_curve(mode, *request, curve);
      for (const Shot& shot : shots) curve.points.push_back(shot.point);
      if (request == shown) write_pictures(record, curve, std::move(shots));
    }
    steps_.done += static_cast<int>(record.left_out.size());
    return record;
  }

  images::GridTile make_tile(const records::BiasModeRecord& mode, Shot& shot) {
    const records::BiasPoint& p = shot.point;
    const std::string which = p.factor == kTooLittle ? "too little: "
                              : p.factor == kTooMuch ? "too much: "
                                                     : "theory: ";
    images::GridTile tile;
    tile.label = p.factor ? which + pages::name_factor(*p.factor) : mode.mode;
    tile.caption =
        (p.factor ? fmt::format("{} {:.4g} · ", mode.key, p.setting) : std::string()) +
        fmt::format("acne {} · contact gap {}", records::format_rate(p.acne), records::format_rate(p.contact_gap));
    tile.picture = render::shade(renderer_.shaders, assets_.gbuffer(camera()), render::upload_image(shot.visibility),
                                 scene_, camera());
    tile.visibility = std::move(shot.visibility);
    return tile;
  }

  void write_pictures(records::BiasModeRecord& mode, const records::BiasCurve& curve, std::vector<Shot> shots) {
    std::erase_if(shots, [](const Shot& shot) {
      const auto factor = shot.point.factor;
      return factor && factor != kTooLittle && factor != kTheory && factor != kTooMuch;
    });
    images::Grid grid;
    grid.title = fmt::format("{}: {}", mode.mode, curve.filter);
    grid.subtitle = fmt::format("visibility on {}, map {}{}", scene_.name, options_.map_sizes.front(),
                                mode.key.empty() ? "" : "; amounts in theoretical ones");
    for (Shot& shot : shots) grid.tiles.push_back(make_tile(mode, shot));
    std::vector<const images::Image*> images;
    for (const images::GridTile& tile : grid.tiles) images.push_back(&tile.visibility);
    const measure::SceneTruth& scene_truth = assets_.truth(camera());
    const images::Image& truth = scene_truth.area;
    grid.mask = images::make_image(truth.width, truth.height, scene_truth.mask);
    images.push_back(&truth);
    grid.crop =
        images::find_hardest_edge(images, images.size() - 1, images::choose_crop_size({truth.width, truth.height}));
    grid.columns = static_cast<int>(grid.tiles.size());
    const std::string light = scene_.light.name.empty() ? "" : files::make_file_stem(scene_.light.name) + ".";
    mode.picture = fmt::format("bias.{}{}.png", light, mode.mode);
    mode.picture_caption = fmt::format(
        "{} under {}: picture and visibility{}, and the crop where it differs most; full size behind the link",
        curve.filter, mode.mode, mode.key.empty() ? "" : " at too little, as theory says, and too much");
    images::write_grid(options_.out / mode.picture, grid);
  }
};

/// The answer of the report that the folder lies in gets its row of the bias to ship.
void tell_report(const options::RunOptions& options, options::Progress& progress) {
  const std::filesystem::path folder = std::filesystem::absolute(options.out / "").lexically_normal().parent_path();
  if (folder.filename() != "bias" || !std::filesystem::exists(folder.parent_path() / "results.json")) return;
  try {
    run::rewrite_report(folder.parent_path());
  } catch (const Error& error) {
    progress.note(fmt::format("warning: the answer of the report in {} does not have the bias to ship yet: {}",
                              folder.parent_path().string(), error.what()));
  }
}

}  // namespace

void run_bias_sweep(const options::RunOptions& options, options::Progress& progress) {
  const std::vector<scene::Scene> lit = run::list_lit_scenes(options, run::load_scene(options, options.scenes.front()));
  if (lit.empty()) run::fail_unknown_light(options);
  measure::Renderer renderer = measure::make_renderer(options.backend, options.resources);
  truth::TruthCache cache(options.cache,
                          [&progress](const std::string& message) { progress.note("warning: " + message); });
  const files::FolderLock lock(options.out, options.force);  // a folder that cannot be written is better found now
  const int steps_of_light = static_cast<int>(render::swept_modes().size() * options.filters.size());
  progress.begin(static_cast<int>(lit.size()) * steps_of_light, 0);
  Steps steps{progress};
  std::vector<records::BiasSweepRecord> sweeps;
  for (const scene::Scene& scene : lit) {
    steps.light = name_light(scene);
    steps.done = static_cast<int>(sweeps.size()) * steps_of_light;
    try {
      sweeps.push_back(BiasSweep(options, scene, renderer, cache, steps).run());
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kInput || lit.size() == 1) throw;
      progress.note("warning: " + std::string(error.what()));
      sweeps.push_back(start_record(options, scene));
      sweeps.back().refused = error.what();
    }
  }
  if (std::ranges::all_of(sweeps, [](const auto& sweep) { return !sweep.refused.empty(); }))
    throw Error(ErrorKind::kInput, sweeps.front().refused);
  lock.require_in_place();
  pages::write_page(options.out, "bias", pages::make_bias_page(sweeps));
  write_text_file(options.out / "bias.csv", pages::make_bias_csv(sweeps));
  write_text_file(options.out / "bias.json", records::make_bias_json(pages::list_bias_to_ship(sweeps)));
  tell_report(options, progress);
  progress.show(static_cast<int>(lit.size()) * steps_of_light, "done");
}

}  // namespace shadowbench::stress
