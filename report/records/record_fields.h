#pragma once

#include <concepts>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "reference/metrics/metric_table.h"
#include "report/records/records.h"

namespace shadowbench::records {

// One description of every record that is read again: writing, reading, `absent`, the schema and the CSV columns follow
// from it. `visit_fields(record, visit)` calls `visit(path, value, about)` for each field, or without the last where
// there is nothing to say; a dot in the path is a group.

/// What a description says of a field beside its name and type.
struct About {
  std::string_view text = {};                  ///< what the schema says of it
  std::optional<double> least = std::nullopt;  ///< of a number, or of the length of a list; counts are never negative
  std::optional<double> most = std::nullopt;   ///< of a number
  std::string_view pattern = {};               ///< that a text matches
  std::string_view one_of = {};                ///< texts that it may be, with commas
  bool filled = false;    ///< a text, or each of a list, is not empty; what may be null is filled where it is not
  bool is_path = false;   ///< in the report's folder, and does not leave it
  bool may_lack = false;  ///< what is not there is not written, and is no gap that needs a reason
  std::string_view column = {};       ///< what its column in CSV holds; empty: it has none
  bool as_number = false;             ///< its column holds 1 or 0, not on or off
  std::string_view column_name = {};  ///< empty: it follows from the path
  std::string_view unit = {};         ///< of a metric; empty: it is none
};

/// What is visited instead of a value where a description speaks of a group.
struct Group {};
inline constexpr Group kGroup;

/// A record of this type, constant or not.
template <class Given, class Record>
concept Is = std::same_as<std::remove_const_t<Given>, Record>;

/// A text that is null in JSON where it is empty.
inline std::optional<std::string> null_if_empty(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

/// Visits the fields of a record as a group: they are fields of the record that it is in.
void visit_group(const std::string& name, auto& record, auto&& visit, const About& about = {}) {
  visit(name, kGroup, about);
  visit_fields(record, [&](const std::string& member, auto& value, const About& field = {}) {
    visit(name + "." + member, value, field);
  });
}

inline constexpr About kPositive{.least = 0};

// What a cell costs on GPUs that were not there; see record_fields.h.

void visit_fields(Is<ShaderFacts> auto& facts, auto&& visit) {
  visit("instructions", facts.instructions);
  visit("code_bytes", facts.code_bytes);
  visit("vector_registers", facts.vector_registers);
  visit("scalar_registers", facts.scalar_registers);
  visit("spilled_registers", facts.spilled_registers);
  visit("scratch_bytes", facts.scratch_bytes);
  visit("waves_per_simd", facts.waves_per_simd);
  visit("latency_cycles", facts.latency_cycles);
  visit("busy_cycles", facts.busy_cycles);
  visit("samples", facts.samples);
  visit("compares", facts.compares);
  visit("gathers", facts.gathers);
  visit("loads", facts.loads);
  visit("loops", facts.loops);
}

void visit_fields(Is<GpuPassRecord> auto& pass, auto&& visit) {
  visit("pass", pass.pass, {.filled = true});
  visit("draws", pass.draws, {.text = "for one map", .least = 1});
  visit_fields(pass.facts, visit);
}

/// Visits the parts of an estimate alone: what bounds it stands beside them, in the record of the GPU.
void visit_fields(Is<GpuEstimateRecord> auto& parts, auto&& visit) {
  visit("lookup", parts.lookup_us, kPositive);
  visit("prefilter", parts.prefilter_us, kPositive);
  visit("map", parts.map_us, kPositive);
  visit("arithmetic", parts.arithmetic_us, kPositive);
  visit("sampling", parts.sampling_us, kPositive);
  visit("memory", parts.memory_us, kPositive);
}

void visit_fields(Is<GpuRecord> auto& gpu, auto&& visit) {
  const auto& estimate = gpu.estimate;
  const auto cost = [&](bool is_moving) {
    return estimate ? std::optional(frame_ms(*estimate, is_moving)) : std::nullopt;
  };
  std::optional<double> moving = cost(true), still = cost(false);  // files hold them for their readers; they follow
  std::optional<std::string> bound_by = estimate ? std::optional(estimate->bound_by) : std::nullopt;
  std::optional<std::string> refused = null_if_empty(gpu.refused);
  visit(
      "facts", gpu.facts,
      {.text = "what the GPU's compiler says of each pass; counts are of the machine code, in which the body of a loop "
               "stands once"});
  visit("frame_ms", kGroup,
        {.text = "of a frame of 1920x1080, each pixel a lookup, with one map; moving: with its prefilter and a lower "
                 "bound of drawing it. What every lookup pays is left out"});
  visit("frame_ms.moving", moving, {.least = 0});
  visit("frame_ms.static", still, {.least = 0});
  visit("parts_us", gpu.estimate,
        {.text = "lookup is of a million receivers, as dense as in that frame, and the largest of arithmetic, sampling "
                 "and memory, which is null where the filter's reads are not known; prefilter is of one map; map is a "
                 "lower bound of drawing it, from its triangles and texels"});
  visit("bound_by", bound_by, {.one_of = "arithmetic,sampling,memory"});
  visit("refused", refused);
  if constexpr (!std::is_const_v<std::remove_reference_t<decltype(gpu)>>) {
    gpu.refused = refused.value_or("");
    if (gpu.estimate && !bound_by) throw std::invalid_argument("an estimate with what bounds it");
    if (gpu.estimate) gpu.estimate->bound_by = *bound_by;
  }
}

void visit_fields(Is<Quartiles> auto& spread, auto&& visit) {
  visit("median", spread.median, kPositive);
  visit("q1", spread.q1, kPositive);
  visit("q3", spread.q3, kPositive);
  visit("n", spread.n, {.least = 1});
}

void visit_fields(Is<OwnTime> auto& time, auto&& visit) {
  visit("median", time.median);
  visit("q1", time.q1);
  visit("q3", time.q3);
  visit("n", time.n, {.least = 1});
  visit("ci95", time.ci95);
}

void visit_fields(Is<Ratio> auto& ratio, auto&& visit) {
  visit("median", ratio.median, kPositive);
  visit("ci95", ratio.ci95);
}

void visit_fields(Is<MachineKind> auto& kind, auto&& visit) {
  visit("cpu", kind.cpu);
  visit("cores", kind.cores);
  visit("renderer", kind.renderer, {.text = "GL_RENDERER"});
  visit("software", kind.software, {.text = "a rasteriser on the CPU"});
  visit("timer", kind.timer);
}

void visit_fields(Is<CascadeRecord> auto& cascade, auto&& visit) {
  visit("end_m", cascade.end_m, {.text = "depth along the camera's axis at which it ends"});
  visit("texels_per_m", cascade.texels_per_m, kPositive);
  visit("texels_per_pixel", cascade.texels_per_pixel, {.text = "median over its receivers", .least = 0});
  visit("share", cascade.share, {.text = "of all receivers", .least = 0, .most = 1});
  visit("rmse", cascade.rmse, {.text = "as error.rmse, over its receivers; null where they are too few", .least = 0});
  visit("acne", cascade.acne, {.text = "as artefact.acne", .least = 0, .most = 1});
  visit("leak", cascade.leak, {.text = "as artefact.leak", .least = 0, .most = 1});
  visit("contact_gap", cascade.contact_gap, {.text = "as artefact.contact_gap", .least = 0, .most = 1});
}

void visit_fields(Is<BiasRecord> auto& bias, auto&& visit) {
  visit("constant_depth", bias.constant.depth, {.column = "constant bias, depth in [0,1]"});
  visit("constant_texels", bias.constant.texels, {.column = "constant bias, texels; adds to the one before"});
  visit("constant_world", bias.constant.world, {.column = "constant bias, metres; adds to the two before"});
  visit("slope_depth", bias.slope.depth, {.column = "bias times 1 - n.l, depth in [0,1]"});
  visit("slope_texels", bias.slope.texels, {.column = "bias times 1 - n.l, texels"});
  visit("slope_world", bias.slope.world, {.column = "bias times 1 - n.l, metres"});
  visit("plane_texels", bias.plane_texels, {.column = "bias by the slope of the receiver's plane, texels"});
  visit("plane_kernels", bias.plane_kernels,
        {.column = "the same, in reaches of the filter: to the centre of the farthest texel that it compares"});
  visit("normal_offset_texels", bias.normal_offset.texels, {.column = "normal offset, texels"});
  visit("normal_offset_world", bias.normal_offset.world, {.column = "normal offset, metres"});
  visit("receiver_plane", bias.receiver_plane,
        {.column = "1: the receiver plane's gradient is added for every tap", .as_number = true});
  visit("polygon_factor", bias.map.polygon_factor, {.column = "glPolygonOffset in the depth pass, factor"});
  visit("polygon_units", bias.map.polygon_units, {.column = "glPolygonOffset in the depth pass, units"});
  visit("front_cull", bias.map.cull_front,
        {.column = "1: front faces are left out of the depth map", .as_number = true});
  visit("midpoint", bias.map.midpoint,
        {.column = "1: the depth map lies half-way between first and second surface", .as_number = true});
}

void visit_fields(Is<RangeRule> auto& range, auto&& visit) {
  visit("border", range.border,
        {.text = "what is read outside the map", .column = "what lookups read outside the map"});
  visit("far_test", range.far_test,
        {.text = "beyond the far plane is lit", .column = "on: what is beyond the map's far plane is lit"});
  visit("behind_test", range.behind_test,
        {.text = "behind the light of a projective map is lit",
         .column = "on: what is behind the light of a projective map is lit"});
}

void visit_fields(Is<KernelRecord> auto& kernel, auto&& visit) {
  visit("sigma_texels", kernel.sigma_texels,
        {.text = "standard deviation along an axis, reconstruction included",
         .least = 0,
         .column = "the kernel's standard deviation along an axis, texels"});
  visit(
      "class", kernel.width_class,
      {.text = "kernels of one class are about equally wide, or 'light' as wide as the scene's light asks for, and are "
               "compared with each other alone; null above the widest class",
       .one_of = "sharp,medium,soft,light",
       .column = "the class of kernels that are about as wide, with which alone it is compared"});
  constexpr About kByLight{.text = "the parameter that the light's width set", .may_lack = true};
  constexpr const char* kAsked = "the kernel's standard deviation that the scene's light asks for, texels";
  visit("by_light", kernel.by_light, kByLight);
  visit("light_texels", kernel.light_texels, {.text = kAsked, .least = 0, .may_lack = true, .column = kAsked});
}

void visit_fields(Is<TimeRecord> auto& time, auto&& visit) {
  visit("lookup", time.lookup, {.column = "filtered lookup of all pixels, screen passes included"});
  visit("screen", time.screen,
        {.text = "of the lookup the screen passes", .may_lack = true, .column = "screen passes"});
  visit("prefilter", time.prefilter, {.column = "encoding and blurring the map"});
  visit("map", time.map, {.column = "drawing the depth map"});
  visit("empty", time.empty,
        {.text = "a lookup that reads what the filter does of its receivers, and nothing of the map",
         .column = "lookup that reads nothing of the map"});
  visit("static", time.static_light,
        {.text = "the filter's own: the lookup less a lookup that reads nothing, per round",
         .column = "the filter's own: lookup less that"});
  visit("moving", time.moving,
        {.text = "map, prefilter and the filter's own, per round: what a moving light pays",
         .column = "map, prefilter and the filter's own"});
  visit("stopped", time.stopped,
        {.text = "why no more rounds were timed: as many as may be, the ratio's interval is narrow enough, the time is "
                 "spent",
         .one_of = "rounds,precise,budget",
         .column = "why no more rounds were timed: rounds, precise or budget"});
}

void visit_fields(Is<RatioRecord> auto& ratio, auto&& visit) {
  visit("lookup", ratio.lookup, {.column = "lookup against none", .column_name = "ratio_lookup"});
  visit("static", ratio.static_light,
        {.column = "frame with a cached map against none", .column_name = "ratio_static"});
  visit("moving", ratio.moving, {.column = "frame with a new map against none", .column_name = "ratio_moving"});
}

void visit_fields(Is<ExternalRecord> auto& external, auto&& visit) {
  visit("engine", external.engine, {.text = "as its user says, like version, driver, map, bias and fit"});
  visit("version", external.version);
  visit("driver", external.driver);
  visit("map", external.map);
  visit("bias", external.bias);
  visit("fit", external.fit);
  visit("ms", external.ms, {.text = "what it costs, as its user says", .least = 0});
  visit("timed", external.timed, {.text = "how that was timed"});
  visit("truth", external.truth, {.text = "names the scene, light, camera and size that it was scored against"});
  visit("undefined", external.undefined, {.text = "receivers without a visibility, which are left out"});
  visit("inside_rmse", external.inside_rmse, {.text = "over receivers that lie beside no silhouette", .least = 0});
  visit("aligned_by", external.aligned_by,
        {.text = "what the shift was found from", .one_of = "depth,coverage,nothing"});
  visit("shift_x", external.shift_x, {.text = "pixels, of its picture to the right of ours"});
  visit("shift_y", external.shift_y, {.text = "the same, down"});
  visit("shift_p99", external.shift_p99,
        {.text = "99th percentile over pixels of how far the two are apart, pixels", .least = 0});
  visit("unaligned", external.unaligned, {.text = "the pictures do not show the same, and it was scored all the same"});
  visit("nearest", external.nearest, {.text = "the filter of this run whose visibility is nearest"});
  visit("nearest_rmse", external.nearest_rmse, {.text = "between the two", .least = 0});
  visit("peers", external.peers,
        {.text = "RMSE of the run's filters, of the first phase alone, over the same receivers"});
}

void visit_fields(Is<TileRecord> auto& tile, auto&& visit) {
  constexpr About kPixels{.text = "pixels", .least = 0};
  visit("left", tile.left, kPixels);
  visit("top", tile.top, kPixels);
  visit("width", tile.width, kPixels);
  visit("height", tile.height, kPixels);
}

void visit_fields(Is<ImagesRecord> auto& images, auto&& visit) {
  constexpr About kPath{.text = "relative to the report folder", .is_path = true};
  const auto path = [](std::string_view text) { return About{.text = text, .is_path = true}; };
  visit("picture", images.picture, kPath);
  visit("visibility", images.visibility, kPath);
  visit("depth_map", images.depth_map, kPath);
  visit("grid", images.grid, kPath);
  visit("exr", images.exr, kPath);
  visit("parts", images.parts,
        {.text = "what the names of the cell's parts in `exr` begin with: '<parts>.visibility'"});
  visit("texel_density", images.texel_density,
        path("map texels per pixel, one per view and map; relative to the report folder"));
  visit("all_lights", images.all_lights,
        path("all lights of the scene at once, one per view and map; relative to the report folder"));
  visit("stability", images.stability,
        path("where the cell's numbers break, per texel and per pixel; relative to the report folder"));
  visit("values", images.values,
        path("relative to the report folder: a script with the cell's images as 16-bit numbers, for the page"));
  visit("truth_picture", images.truth_picture,
        path("relative to the report folder: the picture shaded with the area truth"));
  visit("truth_values", images.truth_values,
        path("relative to the report folder: a script with the truth as 16-bit numbers, for the page"));
  visit("frames", images.frames, path("relative to the report folder: how the page draws the cell again"));
  visit("hardest", images.hardest, {.text = "the tile where the picture's FLIP is largest"});
  // Of the cells that the page shows first.
  visit("supersampled", images.supersampled,
        {.text = "relative to the report folder: the picture with several samples a pixel",
         .is_path = true,
         .may_lack = true});
  visit("truth_supersampled", images.truth_supersampled,
        {.text = "relative to the report folder: the truth's picture with as many samples a pixel",
         .is_path = true,
         .may_lack = true});
  visit("samples", images.samples, {.text = "of each pixel of the supersampled pictures", .may_lack = true});
}

/// Visits a cell's metrics, and over what its errors are means.
void visit_metrics(Is<CellRecord> auto& cell, auto&& visit) {
  visit("cost", kGroup, {.text = "what does not depend on the machine"});
  visit("error", kGroup, {.text = "of visibility, against the ray-traced truth; mean is signed"});
  visit("coverage", kGroup,
        {.text = "how the map's texels are spent on the view; over pixels whose surface faces the light"});
  visit("artefact", kGroup, {.text = "rates, each over the receivers in which it can occur"});
  visit("attribution", kGroup, {.text = "the parts that the error is the sum of; shares sum to 1"});
  visit("stability", kGroup,
        {.text = "where numbers break, or come near to it; null unless the run was made with --stability"});
  for (const metrics::Metric& metric : metrics::metric_table())
    metrics::visit_metric(metric, cell, [&](const std::string& path, auto& value) {
      visit(path, value,
            {.text = metric.definition, .least = metric.range.min, .most = metric.range.max, .unit = metric.unit});
    });
  visit("phases", cell.phases,
        {.text = "places of the map's grid, moved by parts of a texel, that the errors of visibility are means over; "
                 "all else is of the first",
         .least = 1,
         .column = "places of the map's grid that errors of visibility are means over"});
  visit("error.rmse_ci95", cell.rmse_ci95,
        {.text = "95 % confidence interval of the mean over all places of the map's grid, by Student's t",
         .column = "rmse",
         .column_name = "rmse"});
  visit("error.rmse_replicates", cell.rmse_replicates,
        {.text = "means over groups of phases that are independent of each other, the same in every cell: two cells "
                 "are compared by their differences, group by group"});
  visit("error.flicker_ci95", cell.flicker_ci95,
        {.text = "95 % confidence interval, by the jackknife over the groups of phases",
         .column = "flicker",
         .column_name = "flicker"});
}

/// Visits the settings of a cell that its table shows.
void visit_settings(Is<CellRecord> auto& cell, auto&& visit) {
  visit("scene", cell.scene, {.filled = true, .column = "the scene's name"});
  visit("view", cell.view, {.filled = true, .column = "the camera's name"});
  visit("filter", cell.filter, {.filled = true, .column = "the filter's id"});
  visit("params", cell.params, {.column = "the filter's parameters as JSON"});
  visit("kernel_radius_texels", cell.kernel_radius_texels,
        {.text = "half-width of the filter's kernel, as its parameters make it", .least = 0});
  visit_group("kernel", cell.kernel, visit, {.text = "how wide the filter's kernel is; null where no model knows it"});
  visit("teaching", cell.teaching, {.text = "the filter shows a mistake, and is not advised"});
  visit("claims", cell.claims, {.text = "what the filter says of itself, such as contact-hardening"});
  visit("map_size", cell.map_size,
        {.text = "texels along a side", .least = 1, .column = "shadow map, texels along a side"});
  visit("map_format", cell.map_format,
        {.text = "how the map stores depth; perspective: as a projection whose far plane is so many times as far as "
                 "its near plane; reversed: 1 - depth; hashed, dither: how it holds transparent casters",
         .pattern = R"(^d(16|24|32f)( perspective [0-9.]+(e\+?[0-9]+)?)?( reversed)?( hashed| dither)?$)",
         .column = "the shadow map's format"});
  visit("fit", cell.fit,
        {.text = "of the light's frustum",
         .pattern = "^(sphere|tight|view|focused|lispsm|psm|tsm|logpsm|paraboloid|"
                    "cascades:count=[2-4],(split=[0-9.e-]+|splits=[0-9.e+/-]+),blend=[0-9.e-]+,depths=(all|seen)"
                    "(,near=[0-9.e+-]+)?(,far=[0-9.e+-]+)?)( snapped)?$",
         .column = "how the light's frustum is fitted; snapped: to whole texels"});
  visit("light", cell.light,
        {.text = "as the scene says, or azimuth and elevation in degrees",
         .pattern = "^(scene|[-+.0-9e]+,[-+.0-9e]+)$",
         .column = "where the light stands: as the scene says, or azimuth and elevation in degrees"});
  visit_group("bias", cell.bias, visit,
              {.text = "as asked for; lengths along the light in depth [0,1], shadow-map texels and metres (world), "
                       "whose parts add up"});
  visit_group("range", cell.range, visit, {.text = "what lookups did outside the map; border, true, true is right"});
  visit("size", kGroup, {.text = "pixels"});
  visit("size.width", cell.width, {.least = 1, .column = "picture, pixels"});
  visit("size.height", cell.height, {.least = 1, .column = "picture, pixels"});
}

void visit_fields(Is<ResolveRecord> auto& resolve, auto&& visit) {
  visit("rule", resolve.rule, {.text = "newest: the last frame; mean: of all; exponential, clamped: of weight 0.1"});
  visit("jitter", resolve.jitter,
        {.text = "the camera moved by parts of a pixel, and the truth is the mean over them"});
  visit("rmse", resolve.rmse, {.text = "to the truth, after each frame"});
  visit("noise", resolve.noise, {.text = "RMS difference from what very many frames converge to", .may_lack = true});
  visit("flicker", resolve.flicker, {.text = "RMS change from frame to frame, in the second half", .may_lack = true});
}

void visit_fields(Is<GhostRecord> auto& ghost, auto&& visit) {
  visit("texels", ghost.texels, {.text = "that shadows moved by in each frame"});
  visit("rule", ghost.rule);
  visit("pixels", ghost.pixels, {.text = "dark before the motion and lit after it"});
  visit("at_stop", ghost.at_stop, {.text = "their mean error in the last frame of the motion", .may_lack = true});
  visit("frames_until", ghost.frames_until, {.text = "that error was 0.02 or less", .may_lack = true});
}

void visit_fields(Is<AccumulationRecord> auto& accumulation, auto&& visit) {
  visit("resolves", accumulation.resolves);
  visit("ghosts", accumulation.ghosts);
  visit("no_ghosts", accumulation.no_ghosts, {.text = "why there are none; empty where there are"});
  visit("exponential_ms", accumulation.exponential_ms, {.text = "the pass that accumulates; in no other time"});
  visit("clamped_ms", accumulation.clamped_ms);
  visit("picture", accumulation.picture, {.text = "relative to the report folder", .is_path = true, .may_lack = true});
}

void visit_fields(Is<CellRecord> auto& cell, auto&& visit) {
  visit("key", cell.key,
        {.text = "hash of the cell's canonical settings",
         .pattern = "^[0-9a-f]{16}$",
         .column = "the cell's file is cells/<key>.json"});
  visit("content", cell.content,
        {.text = "names what it was made from beside its settings: program, scene, filter, options"});
  visit("machine", cell.machine,
        {.text = "the kind of machine that measured it: times of two kinds do not compare; null where that "
                 "is unknown",
         .column = "what measured the times: those of two kinds of machine do not compare"});
  visit(
      "measured_s", cell.measured_s,
      {.text = "seconds that measuring it took: its share of what cells did together, without the truth", .least = 0});
  visit_settings(cell, visit);
  visit("status", cell.status, {.column = "ok, suspect, timeout, crashed or error"});
  visit("message", cell.message,
        {.text = "why status is not ok; empty otherwise", .column = "why the status is not ok"});
  visit("suspect_of", cell.suspect_of,
        {.text = "what is wrong with the filter of a suspect cell, and what to do", .filled = true});
  visit("screen_reads", cell.screen_reads,
        {.text = "pixels of the picture that the filter's screen passes read for a receiver, mean",
         .least = 0,
         .may_lack = true});
  visit("excused", cell.excused, {.text = "pixels left out: on a tie or a texel's border"});
  visit_group(
      "time_ms", cell.time_ms, visit,
      {.text = "milliseconds of the clock that gl.timer names; static and moving may be below 0 where a difference is "
               "too small for it"});
  visit_group("ratio_to_none", cell.ratio_to_none, visit,
              {.text = "per-round ratios; static: map and prefilter cached, moving: paid in every frame"});
  visit("cascades", cell.cascades,
        {.text = "of a map of cascades: each with the receivers of which it serves the most, from near to far",
         .may_lack = true});
  visit("accumulation", cell.accumulation,
        {.text = "visibility accumulated over frames; missing where the run has one", .may_lack = true});
  visit("gpu", cell.gpu,
        {.text = "what the cell costs on GPUs that were not there, by name; null where none was named"});
  visit("external", cell.external,
        {.text = "of a row that another renderer drew: what is said of it, and whether it shows the same view; "
                 "missing for the program's own filters",
         .may_lack = true,
         .column = "of a row that another renderer drew: what is said of it, as JSON"});
  visit_group("images", cell.images, visit);
  visit("warnings", cell.warnings, {.text = "what makes this cell's numbers doubtful"});
  visit("absent", cell.absent, {.text = "dotted name of a null field or of a group of them: why it is null"});
  visit("nothing_to_see", cell.nothing_to_see,
        {.text = "names of `absent` whose fault cannot occur in the view: that is not a value that nobody measured"});
  visit_metrics(cell, visit);
}

void visit_fields(Is<GlRecord> auto& gl, auto&& visit) {
  visit("backend", gl.backend, {.filled = true});
  visit("renderer", gl.renderer);
  visit("version", gl.version);
  visit("software", gl.software, {.text = "a rasteriser on the CPU"});
  visit("timer", gl.timer);
}

void visit_fields(Is<MachineRecord> auto& machine, auto&& visit) {
  visit("cpu", machine.cpu);
  visit("cores", machine.cores);
  visit("load_at_start", machine.load_at_start, kPositive);
  visit("compiler", machine.compiler);
  visit("os", machine.os);
}

void visit_fields(Is<WorkRecord> auto& work, auto&& visit) {
  visit("shader_variants_compiled", work.shader_variants_compiled);
  visit("passes_run", work.passes_run);
  visit("passes_skipped", work.passes_skipped);
  visit("truths_traced", work.truths_traced, {.text = "ray-traced images computed in this run"});
  visit("truths_cached", work.truths_cached, {.text = "ray-traced images read from the cache"});
  visit("timed_s", work.timed_s,
        {.text = "seconds of the passes that were timed, rounds that warm up included", .least = 0});
  visit("elapsed_s", work.elapsed_s,
        {.text = "seconds from the first cell to the last, the report not included", .least = 0});
  visit("attribution_s", work.attribution_s,
        {.text = "seconds of elapsed_s that taking errors apart took: kernel truths, models; null without attribution",
         .least = 0});
}

void visit_fields(Is<ExperimentRecord> auto& experiment, auto&& visit) {
  visit("title", experiment.title);
  visit("settings", experiment.settings, {.text = "names all cells of the experiment and what they are made from"});
  visit("cells", experiment.cells, {.text = "of the whole experiment"});
  visit("shard", experiment.shard, {.text = "1 .. shards: every shards-th cell, from this one on", .least = 1});
  visit("shards", experiment.shards, {.least = 1});
}

void visit_fields(Is<SceneRecord> auto& scene, auto&& visit) {
  visit("name", scene.name, {.filled = true});
  visit("title", scene.title);
  visit("view_words", scene.view_words, {.text = "what opens it in the window; empty: not known"});
}

void visit_fields(Is<RunRecord> auto& run, auto&& visit) {
  visit("commit", run.commit);
  visit("command", run.command, {.text = "the command line, one entry per argument"});
  visit("seed", run.seed);
  visit_group("gl", run.gl, visit);
  visit_group("machine", run.machine, visit);
  visit_group("work", run.work, visit, {.text = "what was done, and the passes that no chosen filter needed"});
  visit_group("experiment", run.experiment, visit, {.text = "which cells of which experiment the run holds"});
  visit("scenes", run.scenes);
  visit("filter_files", run.filter_files, {.text = "of the user, as they were given; null: not known"});
  visit("warnings", run.warnings);
}

}  // namespace shadowbench::records
