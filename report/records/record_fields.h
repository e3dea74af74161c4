#pragma once

#include <array>
#include <string_view>

#include "reference/metrics/metric_table.h"
#include "report/records/records.h"

namespace shadowbench::records {

/// Names the fields that older files of this schema version lack; they are read as null or empty there.
inline constexpr std::string_view kLaterFields[] = {"time_ms.empty",
                                                    "error.rmse_ci95",
                                                    "phases",
                                                    "time_ms.filter",
                                                    "time_ms.moving",
                                                    "images.parts",
                                                    "images.values",
                                                    "images.truth_picture",
                                                    "images.truth_values",
                                                    "work.attribution_s",
                                                    "claims",
                                                    "lights",
                                                    "repeat.cells",
                                                    "repeat.overlapping",
                                                    "repeat.of",
                                                    "suspect_of",
                                                    "kernel.sigma_texels",
                                                    "kernel.class",
                                                    "teaching",
                                                    "gpu",
                                                    "machine",
                                                    "measured_s"};

/// Calls `visit(name, value)` for every field of a bias.
template <class Bias, class Visitor>
void visit_bias_fields(Bias& bias, Visitor&& visit) {
  visit("constant_depth", bias.constant.depth);
  visit("constant_texels", bias.constant.texels);
  visit("constant_world", bias.constant.world);
  visit("slope_depth", bias.slope.depth);
  visit("slope_texels", bias.slope.texels);
  visit("slope_world", bias.slope.world);
  visit("plane_texels", bias.plane_texels);
  visit("plane_kernels", bias.plane_kernels);
  visit("normal_offset_texels", bias.normal_offset.texels);
  visit("normal_offset_world", bias.normal_offset.world);
  visit("receiver_plane", bias.receiver_plane);
  visit("polygon_factor", bias.polygon_factor);
  visit("polygon_units", bias.polygon_units);
  visit("front_cull", bias.front_cull);
  visit("midpoint", bias.midpoint);
}

/// Calls `visit(path, value)` for every field of a cell, its metrics included: the one list that writing, reading and
/// `absent` follow.
/// A dot in the path is a group; optional values may be null in the JSON.
template <class Cell, class Visitor>
void visit_cell_fields(Cell& cell, Visitor&& visit) {
  visit("key", cell.key);
  visit("content", cell.content);
  visit("machine", cell.machine);
  visit("measured_s", cell.measured_s);
  visit("status", cell.status);
  visit("message", cell.message);
  visit("suspect_of", cell.suspect_of);
  visit("scene", cell.scene);
  visit("view", cell.view);
  visit("filter", cell.filter);
  visit("params", cell.params);
  visit("kernel_radius_texels", cell.kernel_radius_texels);
  visit("kernel.sigma_texels", cell.kernel.sigma_texels);
  visit("kernel.class", cell.kernel.width_class);
  visit("teaching", cell.teaching);
  visit("claims", cell.claims);
  visit("map_size", cell.map_size);
  visit("map_format", cell.map_format);
  visit("fit", cell.fit);
  visit("light", cell.light);
  visit("bias", cell.bias);
  visit("range.border", cell.range.border);
  visit("range.far_test", cell.range.far_test);
  visit("range.behind_test", cell.range.behind_test);
  visit("size.width", cell.width);
  visit("size.height", cell.height);
  visit("excused", cell.excused);
  visit("phases", cell.phases);
  visit("error.rmse_ci95", cell.rmse_ci95);
  visit("time_ms.map", cell.time_ms.map);
  visit("time_ms.prefilter", cell.time_ms.prefilter);
  visit("time_ms.lookup", cell.time_ms.lookup);
  visit("time_ms.empty", cell.time_ms.empty);
  visit("time_ms.filter", cell.time_ms.filter);
  visit("time_ms.moving", cell.time_ms.moving);
  visit("time_ms.stopped", cell.time_ms.stopped);
  visit("ratio_to_none.lookup", cell.ratio_to_none.lookup);
  visit("ratio_to_none.static", cell.ratio_to_none.static_map);
  visit("ratio_to_none.moving", cell.ratio_to_none.moving);
  visit("lights", cell.lights);
  visit("gpu", cell.gpu);
  visit("images.picture", cell.images.picture);
  visit("images.visibility", cell.images.visibility);
  visit("images.depth_map", cell.images.depth_map);
  visit("images.grid", cell.images.grid);
  visit("images.exr", cell.images.exr);
  visit("images.parts", cell.images.parts);
  visit("images.texel_density", cell.images.texel_density);
  visit("images.texel_grid", cell.images.texel_grid);
  visit("images.all_lights", cell.images.all_lights);
  visit("images.stability", cell.images.stability);
  visit("images.values", cell.images.values);
  visit("images.truth_picture", cell.images.truth_picture);
  visit("images.truth_values", cell.images.truth_values);
  visit("warnings", cell.warnings);
  visit("absent", cell.absent);
  for (const metrics::Metric& metric : metrics::metric_table()) metrics::visit_metric(metric, cell, visit);
}

/// Calls `visit(path, value)` for every field of a run.
template <class Run, class Visitor>
void visit_run_fields(Run& run, Visitor&& visit) {
  visit("commit", run.commit);
  visit("command", run.command);
  visit("seed", run.seed);
  visit("gl.backend", run.gl.backend);
  visit("gl.renderer", run.gl.renderer);
  visit("gl.version", run.gl.version);
  visit("gl.software", run.gl.software);
  visit("gl.timer", run.gl.timer);
  visit("machine.cpu", run.machine.cpu);
  visit("machine.cores", run.machine.cores);
  visit("machine.load_at_start", run.machine.load_at_start);
  visit("machine.compiler", run.machine.compiler);
  visit("machine.os", run.machine.os);
  visit("work.shader_variants_compiled", run.work.shader_variants_compiled);
  visit("work.passes_run", run.work.passes_run);
  visit("work.passes_skipped", run.work.passes_skipped);
  visit("work.truths_traced", run.work.truths_traced);
  visit("work.truths_cached", run.work.truths_cached);
  visit("work.timed_s", run.work.timed_s);
  visit("work.elapsed_s", run.work.elapsed_s);
  visit("work.attribution_s", run.work.attribution_s);
  visit("experiment.title", run.experiment.title);
  visit("experiment.settings", run.experiment.settings);
  visit("experiment.cells", run.experiment.cells);
  visit("experiment.shard", run.experiment.shard);
  visit("experiment.shards", run.experiment.shards);
  visit("repeat.cells", run.repeat.cells);
  visit("repeat.overlapping", run.repeat.overlapping);
  visit("repeat.of", run.repeat.of);
  visit("scenes", run.scenes);
  visit("warnings", run.warnings);
}

}  // namespace shadowbench::records
