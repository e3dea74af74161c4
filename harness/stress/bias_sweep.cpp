#include "harness/stress/bias_sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "base/error.h"
#include "base/files.h"
#include "base/folder_lock.h"
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
#include "report/images/crop.h"
#include "report/images/heat_figures.h"
#include "report/pages/bias_page.h"
#include "report/pages/write_page.h"
#include "report/records/format.h"

namespace shadowbench::stress {
namespace {

constexpr double kFactors[] = {0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
constexpr double kShownFactors[] = {0.25, 1.0, 8.0};  // too little, theory, too much
constexpr double kPercentile = 0.95;

/// The light's name; of the only one, which has none, what it is.
std::string name_light(const scene::Scene& scene) {
  return scene.light.name.empty() ? scene::describe_light(scene.light) : scene.light.name;
}

using Requests = std::vector<const filters::FilterRequest*>;

/// The filter whose images are shown: the first that is wider than one fetch, for edges to be seen soft.
const filters::FilterRequest* choose_shown(const Requests& usable) {
  const auto wide = std::ranges::find_if(usable, [](const filters::FilterRequest* each) {
    return filters::find_kernel_sigma(each->spec, each->values) > filters::width_classes().front().widest_texels;
  });
  return wide != usable.end() ? *wide : usable.empty() ? nullptr : usable.front();
}

/// One light of a scene.
class BiasSweep {
 public:
  BiasSweep(const options::RunOptions& options, const scene::Scene& scene, measure::Renderer& renderer,
            truth::TruthCache& cache, const options::StepListener& listener)
      : options_(options),
        listener_(listener),
        scene_(scene),
        task_{&scene_, &scene_.cameras.front(), options.map_sizes.front(), options.filters},
        assets_(renderer, options_, scene_, cache, measure::largest_padding_texels(options.filters)),
        rig_{renderer, options_, task_, assets_},
        target_("visibility", GL_R32F, options.width, options.height) {}

  /// Throws Error(kInput) where there is nothing to take a theoretical amount from.
  records::BiasSweepRecord run() {
    listener_("truth");
    make_masks();
    find_lit();
    describe();
    for (const render::BiasMode& mode : render::swept_modes()) sweep_mode(mode);
    rig_.renderer.context->require_no_gl_errors();
    return std::move(record_);
  }

 private:
  options::RunOptions options_;  ///< with the bias that is drawn at present
  const options::StepListener& listener_;
  const scene::Scene& scene_;
  const measure::SceneTask task_;
  measure::SceneAssets assets_;
  const measure::TaskRig rig_;
  render::ImageTarget target_;
  render::MapBias drawn_;  ///< what the map holds
  metrics::ArtefactMasks masks_;
  std::vector<filters::Receiver> lit_;             ///< those of the acne mask
  std::map<std::string, images::Image> unbiased_;  ///< by label
  records::BiasSweepRecord record_{.light = name_light(scene_)};

  void make_masks() {
    const auto masks = measure::CellAnalyser(rig_, rig_.truth()).masks();
    if (!masks)
      throw Error(ErrorKind::kInput,
                  fmt::format("{}: no masks of artefacts: {}; choose another scene", scene_.name, rig_.truth().absent));
    masks_ = *masks;
  }

  /// Finds the lit receivers, for which theory is computed.
  void find_lit() {
    for (const render::LightSetup& layer : measure::make_unbiased_light(options_, scene_.light, rig_.light().layers)) {
      const auto served = render::read_receivers(rig_.renderer.shaders, rig_.gbuffer(), layer);
      lit_.insert(lit_.end(), served.begin(), served.end());
    }
    std::erase_if(lit_, [&](const filters::Receiver& r) {
      return !masks_.acne[measure::find_pixel(r, options_.width, options_.height)];
    });
    if (static_cast<int>(lit_.size()) < metrics::kFewestReceivers)
      throw Error(
          ErrorKind::kInput,
          fmt::format(
              "{}: {} receivers are wholly lit, and {} are needed to reckon a theoretical amount; choose a larger "
              "--size, a larger --map-size or another scene",
              scene_.name, lit_.size(), metrics::kFewestReceivers));
    if (find_theory(render::swept_modes().front(), 1.0).slope_per_texel == 0.0)
      throw Error(
          ErrorKind::kInput,
          fmt::format(
              "{}: the lit surfaces face the light squarely, where theory asks for no bias at all; choose another "
              "scene",
              scene_.name));
  }

  render::BiasTheory find_theory(const render::BiasMode& mode, double reach_texels) const {
    return render::find_theory(mode, reach_texels, lit_, kPercentile);
  }

  void describe() {
    for (const auto& request : options_.filters) record_.filters.push_back(request.label());
    const render::BiasTheory steep = find_theory(render::swept_modes().front(), 1.0);
    record_.angle_deg = glm::degrees(std::acos(steep.n_dot_l));
    const auto [least, most] = std::ranges::minmax(lit_, {}, &filters::Receiver::texel_size_ws);
    record_.texel_m = {static_cast<double>(least.texel_size_ws), static_cast<double>(most.texel_size_ws)};
    const records::GlRecord gl = run::describe_gl(rig_.renderer);
    record_.facts = {
        {"scene", scene_.name + ": " + scene_.title},
        {"light", record_.light},
        {"view", fmt::format("{}, {} x {} pixels", task_.camera->name, options_.width, options_.height)},
        {"shadow map", fmt::format("{0} x {0} texels of {1:.3g} to {2:.3g} m, fit {3}, depth range {4:.3g} m",
                                   task_.map_size, record_.texel_m.low, record_.texel_m.high,
                                   scene::describe_fit(options_.fit), rig_.light().frustum().depth_range_ws)},
        {"steepest lit surfaces",
         fmt::format("{:.3g}th percentile of slope: |dz/du| + |dz/dv| = {:.3g} of depth per texel, {:.3g} degrees "
                     "between normal and light",
                     100.0 * kPercentile, steep.slope_per_texel, record_.angle_deg)},
        {"receivers rated",
         fmt::format("{} for acne, {} for the contact gap; a rate needs {}", std::ranges::count(masks_.acne, 1),
                     std::ranges::count(masks_.contact_gap, 1), metrics::kFewestReceivers)},
        {"drawn by", fmt::format("{} ({}), program {}", gl.renderer, gl.backend, run::build_commit())}};
  }

  void draw_map(const render::MapBias& bias) {
    if (drawn_ == bias) return;
    drawn_ = bias;
    assets_.redraw(rig_.light(), drawn_);
  }

  /// Why a filter is left out of a mode; empty where it is not.
  std::string explain_left_out(const render::BiasRule& rule, const filters::FilterSpec& spec) {
    draw_map(rule.map);
    if (rule.map.cull_front && !measure::SceneAssets::has_casters(rig_.light()))
      return "would read an empty map: all casters are open meshes, of which nothing stays";
    return render::explain_unusable(rule, spec);
  }

  images::Image draw(const filters::FilterRequest& request, const render::BiasRule& rule) {
    draw_map(rule.map);
    options_.bias = rule;
    return measure::draw_visibility(*rig_.make_passes(request), rig_.light().map, rig_.gbuffer(), target_);
  }

  /// A filter's visibility without any bias, drawn when it is first asked for.
  const images::Image& find_unbiased(const filters::FilterRequest& request) {
    const auto [place, is_new] = unbiased_.try_emplace(request.label());
    if (is_new) place->second = draw(request, render::BiasRule::none());
    return place->second;
  }

  /// The cells of a filter under a mode, with nothing measured yet.
  std::vector<records::BiasCell> plan_cells(const render::BiasMode& mode, const filters::FilterRequest& request) {
    records::BiasCell cell{.scene = scene_.name,
                           .light = record_.light,
                           .view = task_.camera->name,
                           .map_size = task_.map_size,
                           .fit = scene::describe_fit(options_.fit),
                           .filter = request.label(),
                           .id = request.spec.id,
                           .params = request.values,
                           .mode = mode.name,
                           .key = mode.key,
                           .bias = mode.name};
    if (mode.key.empty()) return {cell};
    const render::BiasTheory theory = find_theory(mode, filters::bias_reach_texels(request.spec, request.values));
    std::vector<records::BiasCell> cells;
    for (const double factor : kFactors) {
      cell.factor = factor;
      cell.setting = factor * mode.amount(theory);
      cell.bias = fmt::format("{}:{}={:.4g}", mode.name, mode.key, *cell.setting);
      cell.lift_depth = factor * mode.lift_depth(theory);
      cell.lift_m = *cell.lift_depth * rig_.light().frustum().depth_range_ws;
      cell.lift_texels = *cell.lift_m / theory.texel_m;
      cells.push_back(cell);
    }
    return cells;
  }

  void sweep_mode(const render::BiasMode& mode) {
    records::BiasModeRecord record{mode.name, mode.meaning};
    Requests usable;
    for (const filters::FilterRequest& request : options_.filters) {
      const std::string reason = explain_left_out(mode.make_rule(0.0), request.spec);
      if (reason.empty())
        usable.push_back(&request);
      else
        record.left_out.push_back(fmt::format("{}, which {}.", request.label(), reason));
    }
    const filters::FilterRequest* shown = choose_shown(usable);
    for (const filters::FilterRequest* request : usable) {
      listener_(fmt::format("{} · {}", mode.name, request->label()));
      std::vector<ShownAmount> amounts;
      for (records::BiasCell& cell : plan_cells(mode, *request)) {
        images::Image visibility = draw(*request, mode.make_rule(cell.setting.value_or(0.0)));
        cell.acne = metrics::rate_acne(visibility.texels, rig_.truth().rays.area.visibility, masks_.acne);
        cell.contact_gap = metrics::rate_contact_gap(visibility.texels, find_unbiased(*request).texels, masks_);
        if (request == shown && (!cell.factor || std::ranges::count(kShownFactors, *cell.factor) > 0))
          amounts.push_back(show_amount(cell, std::move(visibility)));
        record_.cells.push_back(std::move(cell));
      }
      if (request == shown) write_pictures(record, request->label(), amounts);
    }
    record_.modes.push_back(std::move(record));
  }

  /// What an amount draws.
  struct ShownAmount {
    images::Cell picture;
    images::Image visibility;  ///< infinite where no receiver is
  };

  ShownAmount show_amount(const records::BiasCell& cell, images::Image visibility) {
    const images::Image picture =
        render::shade(rig_.renderer.shaders, rig_.gbuffer(), render::upload_image(visibility), scene_, *task_.camera);
    for (std::size_t i = 0; i < visibility.texels.size(); ++i)
      if (!rig_.truth().mask[i]) visibility.texels[i] = HUGE_VALF;
    return {{cell.factor ? pages::name_factor(*cell.factor) + " of theory" : cell.mode,
             fmt::format("{} · acne {} · contact gap {}", cell.bias, records::format_rate(cell.acne),
                         records::format_rate(cell.contact_gap)),
             images::show_picture(picture)},
            std::move(visibility)};
  }

  void write_pictures(records::BiasModeRecord& mode, const std::string& filter,
                      const std::vector<ShownAmount>& amounts) {
    const images::Image& truth = rig_.truth().area;
    std::vector<const images::Image*> images = {&truth};
    for (const ShownAmount& amount : amounts) images.push_back(&amount.visibility);
    const images::Rect part =
        images::find_disputed_edge(images, 0, images::choose_crop_size({truth.width, truth.height}));
    images::Figure figure{fmt::format("{}: {}", mode.mode, filter),
                          fmt::format("picture and visibility on {}, map {}; grey: no receiver; below, magnified: the "
                                      "outlined part",
                                      scene_.name, task_.map_size)};
    figure.columns = static_cast<int>(amounts.size());
    const auto color = [](float value) { return std::isinf(value) ? images::kFrame : images::map_grey(value); };
    const auto badness = [](float value) { return std::isinf(value) ? -1.0f : images::distance_from_lit(value); };
    for (const ShownAmount& amount : amounts) {
      images::Stack& stack = figure.stacks.emplace_back(images::Stack{amount.picture});
      std::ranges::move(images::show_part({}, amount.visibility, part, badness, color), std::back_inserter(stack));
    }
    const std::string light = scene_.light.name.empty() ? "" : make_file_stem(scene_.light.name) + ".";
    mode.picture = fmt::format("bias.{}{}.png", light, mode.mode);
    mode.picture_caption = fmt::format(
        "{} under {}: picture, visibility, and the part where it differs most; full "
        "size behind the link",
        filter, mode.mode);
    images::write_figure(options_.out / mode.picture, figure);
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
  const scene::Scene whole = run::load_scene(options, options.scenes.front());
  const std::vector<scene::Scene> lit = run::list_lit_scenes(options, whole);
  if (lit.empty()) run::fail_unknown_light(options);
  measure::Renderer renderer = measure::make_renderer(options.backend, options.resources);
  truth::TruthCache cache(options.cache,
                          [&progress](const std::string& message) { progress.note("warning: " + message); });
  const FolderLock lock(options.out, options.force);  // a folder that cannot be written is better found now
  const auto steps_of_light = static_cast<int>(1 + render::swept_modes().size() * options.filters.size());
  progress.begin(static_cast<int>(lit.size()) * steps_of_light, 0);
  std::vector<records::BiasSweepRecord> sweeps;
  std::vector<std::string> lights;
  for (const scene::Scene& scene : lit) {
    const std::string& light = lights.emplace_back(name_light(scene));
    int done = static_cast<int>(sweeps.size()) * steps_of_light;
    const auto listen = [&](const std::string& what) { progress.show(done++, light + " · " + what); };
    try {
      sweeps.push_back(BiasSweep(options, scene, renderer, cache, listen).run());
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kInput || lit.size() == 1) throw;
      progress.note("warning: " + std::string(error.what()));
      sweeps.push_back({.light = light, .refused = error.what()});
    }
  }
  if (std::ranges::none_of(sweeps, &std::string::empty, &records::BiasSweepRecord::refused))
    throw Error(ErrorKind::kInput, sweeps.front().refused);
  lock.require_in_place();
  const std::string title =
      fmt::format("Depth bias on {} under {}, map {}, {} x {}", whole.name, fmt::join(lights, ", "),
                  options.map_sizes.front(), options.width, options.height);
  pages::write_page(options.out, "bias", pages::make_bias_page(title, sweeps));
  write_text_file(options.out / "bias.csv", records::make_bias_csv(sweeps));
  write_text_file(options.out / "bias.json", records::make_bias_json(pages::recommend_biases(sweeps)));
  tell_report(options, progress);
  progress.show(static_cast<int>(lit.size()) * steps_of_light, "done");
}

}  // namespace shadowbench::stress
