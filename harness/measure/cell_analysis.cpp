#include "harness/measure/cell_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "harness/render/gbuffer.h"
#include "report/records/format.h"
#include "report/records/records.h"

namespace shadowbench::measure {
namespace {

/// So many images that filters are compared with are kept: a run's memory does not grow with its cells.
constexpr std::size_t kKeptClosers = 12;

std::vector<std::uint8_t> find_settled(const truth::TracedVisibility& traced) {
  std::vector<std::uint8_t> settled;
  for (const std::uint32_t rays : traced.rays) settled.push_back(rays == truth::kRaysOfSettledPixel ? 1 : 0);
  return settled;
}

void note(records::CellRecord& record, const char* field, std::optional<double>& to, const std::optional<double>& rate,
          const records::Absence& reason) {
  to = rate;
  if (!rate) records::explain(record, field, reason);
}

/// Which receivers there are too few of for a rate.
records::Absence too_few(const char* which) {
  return {fmt::format("fewer than {} receivers {}", metrics::kFewestReceivers, which), true};
}

metrics::ArtefactMasks make_masks(const Surroundings& around, const std::vector<TracedLayer>& layers,
                                  const SceneTruth& truth) {
  std::vector<float> blockers(truth.rays.first_blockers_ws);
  for (std::size_t i = 0; i < blockers.size(); ++i)
    blockers[i] /= static_cast<float>(layers[choose_layer(layers, i)].frustum.texel_size_ws);
  return metrics::make_artefact_masks({.counts = truth.mask,
                                       .area = truth.rays.area.visibility,
                                       .ratio = truth.rays.area.ratio,
                                       .area_settled = truth.settled,
                                       .surroundings = around.visibility,
                                       .surroundings_settled = around.settled,
                                       .first_blocker_texels = blockers});
}

/// Whether a point falls into the map of a cascade.
bool reaches(const scene::LightFrustum& cascade, const glm::vec3& point_ws) {
  const glm::vec4 clip = cascade.clip_from_world * glm::vec4(point_ws, 1.0f);
  return std::max(std::abs(clip.x), std::abs(clip.y)) <= clip.w;
}

std::optional<double> find_mean_rmse(const std::vector<metrics::ErrorStats>& phases) {
  double sum = 0.0;
  for (const metrics::ErrorStats& each : phases) sum += each.rmse;
  return phases.empty() ? std::nullopt : std::optional(sum / static_cast<double>(phases.size()));
}

}  // namespace

Surroundings trace_surroundings(truth::CachedTracer& tracer, const std::vector<TracedLayer>& layers,
                                const SceneTruth& truth, double widest_kernel_texels) {
  const double half_width = widest_kernel_texels + metrics::kArtefactLimits.guard_texels;
  truth::TracedVisibility traced =
      trace_layers(layers, truth.receivers.image, [&](const auto& receivers, const auto& grid, std::size_t) {
        return tracer.trace_surroundings(receivers, half_width, grid);
      });
  std::vector<std::uint8_t> settled = find_settled(traced);
  return {half_width, std::move(traced.visibility), std::move(settled)};
}

void note_attribution(MeasuredCell& cell, metrics::Attribution attribution) {
  records::CellRecord& record = cell.record;
  for (std::size_t p = 0; p < metrics::kErrorParts; ++p) {
    if (!attribution.stats[p]) continue;
    record.attribution.*
        records::list_error_parts()[p].record = {attribution.stats[p]->rms, attribution.stats[p]->share};
  }
  if (!attribution.stats.back())
    record.absent["attribution"] =
        attribution.not_finite > 0 ? "no pixel of the image is finite" : "there is no error to take apart";
  for (std::vector<float>& part : attribution.parts) {
    images::Image& to = cell.error_parts.emplace_back();
    if (part.empty()) continue;
    to = {cell.visibility.width, cell.visibility.height, 1};
    to.texels = std::move(part);
  }
}

metrics::ArtefactMasks find_artefact_masks(truth::CachedTracer& tracer, const std::vector<TracedLayer>& layers,
                                           const SceneTruth& truth, double widest_kernel_texels) {
  return make_masks(trace_surroundings(tracer, layers, truth, widest_kernel_texels), layers, truth);
}

CellAnalyser::CellAnalyser(const TaskRig& rig, const SceneTruth& truth)
    : rig_(rig), truth_(truth), light_(rig.light()), view_(rig.view()) {
  if (!truth_.absent.empty()) return;
  layers_ = list_traced_layers(rig.renderer.shaders, rig.gbuffer(),
                               make_unbiased_light(rig.options, rig.task.scene->light, light_.layers));
  around_ = trace_surroundings(rig_.assets.tracer(), layers_, truth_, widest_kernel_texels(rig_.options));
  masks_ = make_masks(around_, layers_, truth_);
  for (std::size_t i = 0; has_cascades() && i < layers_.size(); ++i) cascades_.push_back(mask_cascade(i));
}

/// Where all rays of a receiver's surroundings agree, those of a kernel within them are taken to agree with them.
KernelTruth CellAnalyser::trace_unsettled(double half_width_texels, const LayerTrace& trace) {
  truth::ReceiverImage receivers = truth_.receivers.image;
  const bool is_within = half_width_texels <= around_.half_width_texels;
  const auto is_known = [&](std::size_t i) { return is_within && around_.settled[i] != 0; };
  if (is_within && !receivers.content.empty())
    receivers.content += fmt::format(" unsettled within {} texels", around_.half_width_texels);
  for (std::size_t i = 0; i < receivers.points.size(); ++i)
    if (is_known(i)) receivers.points[i].counts = false;
  truth::TracedVisibility traced = trace_layers(layers_, receivers, trace);
  for (std::size_t i = 0; i < traced.visibility.size(); ++i)
    if (is_known(i)) traced.visibility[i] = around_.visibility[i];
  return {std::move(traced.visibility), std::move(traced.variance)};
}

const KernelTruth& CellAnalyser::kernel_truth(const filters::Kernel& kernel) {
  const auto [place, is_new] = kernels_.try_emplace(kernel.name());
  if (is_new && kernel.is_point())
    place->second.visibility = truth_.rays.hard;
  else if (is_new)
    place->second = trace_unsettled(kernel.half_width(), [&](const auto& receivers, const auto& grid, std::size_t) {
      return rig_.assets.tracer().trace_kernel(receivers, kernel, grid);
    });
  return place->second;
}

KernelTruth CellAnalyser::disks_truth(const std::vector<std::vector<float>>& radii_texels) {
  double widest = 0.0;
  for (const std::vector<float>& layer : radii_texels)
    widest = std::max(widest, static_cast<double>(*std::ranges::max_element(layer)));
  return trace_unsettled(filters::Kernel::make_disk(widest).half_width(),
                         [&](const auto& receivers, const auto& grid, std::size_t layer) {
                           return rig_.assets.tracer().trace_disks(receivers, radii_texels[layer], grid);
                         });
}

bool CellAnalyser::has_cascades() const { return std::holds_alternative<scene::ViewSlice>(light_.frustum().share); }

CellAnalyser::CascadeMasks CellAnalyser::mask_cascade(std::size_t cascade) const {
  const auto keep = [&](std::vector<std::uint8_t> mask) {
    for (std::size_t pixel = 0; pixel < mask.size(); ++pixel)
      if (mask[pixel] && choose_layer(layers_, pixel) != cascade) mask[pixel] = 0;
    return mask;
  };
  return {keep(truth_.mask),
          {keep(masks_->acne), keep(masks_->leak), keep(masks_->contact_gap), keep(masks_->wide_gap)}};
}

void CellAnalyser::note_cascades(MeasuredCell& cell) const {
  records::CellRecord& record = cell.record;
  if (cascades_.empty() || cell.visibility.empty()) {
    record.absent["error.rmse_cascade"] = !has_cascades() ? "the light has no cascades" : "nothing of them is known";
    return;
  }
  const std::vector<float>& image = cell.visibility.texels;
  const auto receivers = static_cast<double>(std::ranges::count(truth_.mask, 1));
  record.cascades.emplace();
  for (std::size_t i = 0; i < cascades_.size(); ++i) {
    const auto& [own, masks] = cascades_[i];
    const auto count = std::ranges::count(own, 1);
    records::CascadeRecord& cascade = record.cascades->emplace_back();
    cascade.end_m = std::get<scene::ViewSlice>(light_.layers[i].share).end_m;
    cascade.texels_per_m = 1.0 / light_.layers[i].texel_size_ws;
    cascade.share = receivers > 0.0 ? static_cast<double>(count) / receivers : 0.0;
    if (count == 0)
      record.warnings.push_back(
          fmt::format("{}: cascade {}, which ends at {} m, has no receiver, and its map is drawn for nothing: move "
                      "splits, near or far",
                      record.scene, i + 1, records::format_number(cascade.end_m)));
    if (count >= metrics::kFewestReceivers)
      cascade.rmse = find_mean_rmse(measure_phases(cell.visibility, cell.phases, truth_, own));
    cascade.acne = metrics::rate_acne(image, truth_.rays.area.visibility, masks.acne);
    cascade.leak = metrics::rate_leak(image, cell.unbiased.texels, masks.leak);
    cascade.contact_gap = metrics::rate_contact_gap(image, cell.unbiased.texels, masks);
    if (cascade.rmse) record.error.rmse_cascade = std::max(record.error.rmse_cascade.value_or(0.0), *cascade.rmse);
  }
  if (!record.error.rmse_cascade) records::explain(record, "error.rmse_cascade", too_few("are in any cascade"));
}

void CellAnalyser::analyse(MeasuredCell& cell) {
  records::CellRecord& record = cell.record;
  if (!masks_ || cell.visibility.empty()) {
    const std::string reason = truth_.absent.empty() ? record.message : truth_.absent;
    for (const char* group : {"artefact", "attribution", "error.kernel_rmse", "excused"})
      records::explain(record, group, {reason, truth_.nothing_to_see});
    return;
  }
  count_artefacts(cell);
  attribute(cell);
}

void CellAnalyser::count_artefacts(MeasuredCell& cell) const {
  records::CellRecord& record = cell.record;
  const std::vector<float>& image = cell.visibility.texels;
  note(record, "artefact.acne", record.artefact.acne,
       metrics::rate_acne(image, truth_.rays.area.visibility, masks_->acne),
       too_few("are wholly lit, with their surroundings"));
  note(record, "artefact.leak", record.artefact.leak, metrics::rate_leak(image, cell.unbiased.texels, masks_->leak),
       too_few("are wholly blocked, with their surroundings, by something that does not touch them"));
  const std::string no_seam = !has_cascades()         ? "the light has no cascades"
                              : cell.cascades.empty() ? "what the renderer makes of each cascade is not known"
                                                      : "";
  note(record, "artefact.seam", record.artefact.seam, no_seam.empty() ? measure_seam(cell) : std::nullopt,
       no_seam.empty() ? too_few("lie where a cascade takes over") : records::Absence{no_seam});
  const auto touching = std::ranges::count(masks_->contact_gap, 1);
  note(record, "artefact.contact_gap", record.artefact.contact_gap,
       metrics::rate_contact_gap(image, cell.unbiased.texels, *masks_),
       touching < metrics::kFewestReceivers
           ? too_few("are wholly blocked by something that touches them, or lit by bias behind something farther")
           : records::Absence{fmt::format(
                 "of {} receivers that touch what blocks them fewer than {} are dark without bias: the filter "
                 "lights the others itself, by its blur or by fading at contacts",
                 touching, metrics::kFewestReceivers)});
}

/// Compares what the cascades draw alone, for the receivers that fall into their maps.
std::optional<double> CellAnalyser::measure_seam(MeasuredCell& cell) const {
  const std::vector<truth::ReceiverPoint>& points = truth_.receivers.image.points;
  std::vector<metrics::LayerImage> layers;
  for (std::size_t i = 0; i < cell.cascades.size(); ++i) {
    std::vector<float>& texels = cell.cascades[i].texels;
    for (std::size_t pixel = 0; pixel < texels.size(); ++pixel)
      if (!reaches(light_.layers[i], points[pixel].position_ws))
        texels[pixel] = std::numeric_limits<float>::quiet_NaN();
    layers.push_back({texels, layers_[i].shares});
  }
  return metrics::measure_seam(layers, rig_.options.width,
                               [&](std::size_t a, std::size_t b) { return lie_on_one_surface(points[a], points[b]); });
}

std::vector<ModelLayer> CellAnalyser::read_layers(const std::vector<render::Bias>& biases) const {
  std::vector<ModelLayer> layers;
  for (std::size_t i = 0; i < biases.size(); ++i) {
    const scene::LightFrustum& layer = light_.layers[i];
    layers.push_back({light_.map.read(layer.layer),
                      render::read_receivers(rig_.renderer.shaders, rig_.gbuffer(),
                                             render::make_light_setup(layer, rig_.task.scene->light, biases[i],
                                                                      rig_.options.seed, rig_.options.range))});
  }
  return layers;
}

/// `layers` has the receivers with these biases, where they were read.
const std::vector<double>& CellAnalyser::compare(const filters::Kernel& kernel, const std::vector<render::Bias>& biases,
                                                 const std::vector<ModelLayer>* layers) {
  const std::string name = kernel.name();
  const auto known =
      std::ranges::find_if(closers_, [&](const Closer& each) { return each.kernel == name && each.biases == biases; });
  if (known != closers_.end()) return known->image;
  if (closers_.size() == kKeptClosers) closers_.erase(closers_.begin());
  std::vector<double> image =
      layers ? compare_kernel(kernel, *layers, view_) : compare_kernel(kernel, read_layers(biases), view_);
  return closers_.emplace_back(Closer{name, biases, std::move(image)}).image;
}

ModelImages CellAnalyser::evaluate(const MeasuredCell& cell) {
  const filters::FilterSpec& spec = cell.request.spec;
  const filters::ParamValues& values = cell.request.values;
  const auto kernel = filters::find_kernel(spec, values);
  std::vector<render::Bias> own, of_comparison;
  for (const scene::LightFrustum& layer : light_.layers) {
    own.push_back(render::resolve_bias(rig_.options.bias, layer, spec, values));
    if (kernel) of_comparison.push_back(render::resolve_comparison_bias(rig_.options.bias, layer, spec, values));
  }
  const std::vector<ModelLayer> layers = read_layers(own);
  ModelImages images = evaluate_model(cell.request, layers, view_);
  if (kernel) images.closer = compare(*kernel, of_comparison, own == of_comparison ? &layers : nullptr);
  return images;
}

void CellAnalyser::attribute(MeasuredCell& cell) {
  records::CellRecord& record = cell.record;
  const filters::FilterRequest& request = cell.request;
  const auto shape = filters::find_kernel(request.spec, request.values);
  if (!rig_.options.attribution || (!shape && !filters::find_model(request.spec))) {
    const char* reason = rig_.options.attribution ? filters::explain_no_kernel(request.spec, request.values)
                                                  : "the run was made with --no-attribution";
    for (const char* field : {"attribution", "artefact.noise", "error.kernel_rmse", "excused"})
      record.absent[field] = reason;
    return;
  }
  const ModelImages images = evaluate(cell);
  const KernelTruth kernel = shape ? kernel_truth(*shape) : disks_truth(images.disk_radii_texels);
  const std::vector<float>& image = cell.visibility.texels;
  metrics::Attribution attribution = metrics::attribute_error({.image = image,
                                                               .model = images.model,
                                                               .closer = images.closer,
                                                               .kernel = kernel.visibility,
                                                               .area = truth_.area.texels,
                                                               .mask = truth_.mask,
                                                               .kernel_variance = kernel.variance});
  if (images.model.empty()) {
    record.absent["excused"] = filters::kNoModel;
    record.absent["attribution.numeric"] = "the filter has no scalar model: numeric error is within the estimator's";
  } else {
    record.excused = images.excused;
    record.absent.erase("excused");
  }
  const auto to_kernel = metrics::measure_error(image, kernel.visibility, truth_.mask, kernel.variance);
  note(record, "error.kernel_rmse", record.error.kernel_rmse, to_kernel ? std::optional(to_kernel->rmse) : std::nullopt,
       {"no pixel of the image is finite"});
  const bool random = request.spec.kind == filters::FilterKind::kStochastic;
  note(record, "artefact.noise", record.artefact.noise,
       random ? metrics::rate_noise(image, images.closer, kernel.visibility, truth_.mask, rig_.options.width)
              : std::nullopt,
       random ? too_few("lie in the kernel's penumbra") : records::Absence{"the filter takes no random taps"});
  note_attribution(cell, std::move(attribution));
}

}  // namespace shadowbench::measure
