#include "report/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "report/accuracy_words.h"
#include "report/cell_key.h"
#include "report/json_values.h"
#include "report/repeat.h"
#include "report/stability_words.h"

namespace shadowbench::report {
namespace {

std::string format_param(const ParamValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return dump_line(number_json(*number));
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "on" : "off";
  return std::get<std::string>(value);
}

const char* name_of(CellStatus status) {
  switch (status) {
    case CellStatus::kOk: return "ok";
    case CellStatus::kTimeout: return "timeout";
    case CellStatus::kCrashed: return "crashed";
    case CellStatus::kError: break;
  }
  return "error";
}

Interval lookup_interval(const CellRecord& cell, bool by_ratio) {
  return by_ratio ? cell.ratio_to_none.lookup->ci95 : Interval{cell.time_ms.lookup->q1, cell.time_ms.lookup->q3};
}

double lookup_median(const CellRecord& cell, bool by_ratio) {
  return by_ratio ? cell.ratio_to_none.lookup->median : cell.time_ms.lookup->median;
}

bool overlap(const Interval& a, const Interval& b) { return a.low <= b.high && b.low <= a.high; }

std::string join_tied(const CellGroup& group, const std::vector<std::size_t>& indices) {
  std::vector<std::string> names;
  for (const std::size_t i : indices) names.push_back(label_cell(group, group.cells[i]));
  return fmt::format("{}", fmt::join(names, " tied with "));
}

std::string describe_ranking(const CellGroup& group, const std::vector<std::vector<std::size_t>>& ranks) {
  std::string text = "Lookup, fastest first: ";
  for (std::size_t i = 0; i < ranks.size(); ++i) text += (i > 0 ? "; then " : "") + join_tied(group, ranks[i]);
  return text + ".";
}

std::string describe_extremes(const CellGroup& group, const CellRecord& fastest, const CellRecord& slowest,
                              const GlRecord& gl) {
  std::string text = fmt::format("In {}, the lookup of {} takes {} ms", describe_clock(gl), label_cell(group, fastest),
                                 format_number(fastest.time_ms.lookup->median));
  if (&fastest != &slowest) {
    text +=
        fmt::format(", that of {} {} ms", label_cell(group, slowest), format_number(slowest.time_ms.lookup->median));
    if (slowest.ratio_to_none.lookup)
      text += fmt::format(", which is {} times that of the filter none", format_ratio(slowest.ratio_to_none.lookup));
  }
  return text + ".";
}

std::vector<std::string> describe_prefilters(const CellGroup& group, const GlRecord& gl) {
  std::vector<std::string> parts;
  for (const CellRecord& cell : group.cells) {
    if (cell.time_ms.prefilter) {
      parts.push_back(fmt::format("{} {} {}", label_cell(group, cell), format_number(cell.time_ms.prefilter->median),
                                  time_unit(gl)));
    }
  }
  if (parts.empty()) return {};
  return {fmt::format("A prefilter comes on top, paid again whenever the map changes: {}.", fmt::join(parts, ", "))};
}

std::vector<std::string> describe_troubles(const CellGroup& group) {
  std::vector<std::string> sentences;
  for (const CellRecord& cell : group.cells) {
    if (cell.status != CellStatus::kOk)
      sentences.push_back(fmt::format("{} did not finish ({}).", label_cell(group, cell), describe_status(cell)));
    if (cell.nan.value_or(0) > 0)
      sentences.push_back(fmt::format("{} has {} pixels that are not finite.", label_cell(group, cell), *cell.nan));
  }
  return sentences;
}

std::string describe_experiment(const ExperimentRecord& experiment) {
  std::string text =
      fmt::format("{}{}{} cells", experiment.title, experiment.title.empty() ? "" : " · ", experiment.cells);
  if (experiment.shards > 1) text += fmt::format(", shard {} of {}", experiment.shard, experiment.shards);
  return text;
}

std::string describe_work(const WorkRecord& work) {
  std::string text = fmt::format(
      "{} shader variants compiled, {} passes run, {} passes skipped because no filter needed them, "
      "{} truths ray traced, {} truths read from the cache; {} s of timed passes in {} s",
      work.shader_variants_compiled, work.passes_run, work.passes_skipped, work.truths_traced, work.truths_cached,
      format_number(work.timed_s), format_number(work.elapsed_s));
  if (work.attribution_s) text += fmt::format(", of which attribution took {} s", format_number(*work.attribution_s));
  return text;
}

/// Writes a length in the units it was given in, then in all three where the map's scale is known.
std::string describe_amount(const BiasAmountRecord& amount, const MapScaleRecord& scale) {
  std::vector<std::string> given;
  if (amount.depth > 0.0) given.push_back(format_number(amount.depth) + " depth");
  if (amount.texels > 0.0) given.push_back(format_number(amount.texels) + " texels");
  if (amount.world > 0.0) given.push_back(format_number(amount.world) + " m");
  std::string text = fmt::format("{}", fmt::join(given, " + "));
  if (!scale.texel_m || !scale.depth_range_m) return text;
  const double metres = amount.depth * *scale.depth_range_m + amount.texels * *scale.texel_m + amount.world;
  return text + fmt::format(" (depth {}, {} texels, {} m)", format_number(metres / *scale.depth_range_m),
                            format_number(metres / *scale.texel_m), format_number(metres));
}

bool any(const BiasAmountRecord& amount) { return amount.depth > 0.0 || amount.texels > 0.0 || amount.world > 0.0; }

/// Lists the parts of a bias that are there.
std::string describe_bias(const BiasRecord& bias, const MapScaleRecord& scale) {
  std::vector<std::string> parts;
  if (any(bias.constant)) parts.push_back(describe_amount(bias.constant, scale));
  if (any(bias.slope)) parts.push_back("(1 − n·l) × " + describe_amount(bias.slope, scale));
  if (bias.plane_texels > 0.0) parts.push_back(fmt::format("plane over {} texels", format_number(bias.plane_texels)));
  if (bias.plane_kernels > 0.0)
    parts.push_back(fmt::format("plane over {} × (kernel half-width + 1) texels", format_number(bias.plane_kernels)));
  if (any(bias.normal_offset)) parts.push_back("normal offset of " + describe_amount(bias.normal_offset, scale));
  if (bias.receiver_plane) parts.push_back("receiver plane, per tap");
  if (bias.polygon_factor > 0.0 || bias.polygon_units > 0.0) {
    parts.push_back(
        fmt::format("polygon offset {}, {}", format_number(bias.polygon_factor), format_number(bias.polygon_units)));
  }
  if (bias.front_cull) parts.push_back("front faces culled");
  if (bias.midpoint) parts.push_back("midpoint map");
  return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, " + "));
}

/// Says what differs from the default.
std::string describe_fit_and_light(const CellRecord& cell) {
  const CellRecord usual;
  std::string text;
  if (cell.fit != usual.fit) text += " · fit " + cell.fit;
  if (cell.light != usual.light) text += fmt::format(" · light at {}° (azimuth, elevation)", cell.light);
  return text;
}

/// Names what is not as it should be, each with a separator before it; nothing for the right rule.
std::string describe_wrong_range(const RangeRecord& range) {
  std::string text;
  if (range.border != RangeRecord().border) text += " · outside the map: " + range.border;
  if (!range.far_test) text += " · far-plane test off";
  if (!range.behind_test) text += " · behind-the-light test off";
  return text;
}

}  // namespace

std::string describe_coverage(const CoverageRecord& coverage) {
  if (!coverage.texels_per_pixel || !coverage.fewest_texels_per_pixel || !coverage.map_used) return {};
  return fmt::format("{} map texels per pixel (worst {}), {:.0f} % of the map used",
                     format_number(*coverage.texels_per_pixel), format_number(*coverage.fewest_texels_per_pixel),
                     100.0 * *coverage.map_used);
}

std::string format_number(double value) {
  if (!std::isfinite(value)) return kNothing;
  const double size = std::abs(value);
  if (size >= 99.95 && size < 1e15) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

std::string describe_status(const CellRecord& cell) {
  return cell.message.empty() ? name_of(cell.status) : fmt::format("{}: {}", name_of(cell.status), cell.message);
}

std::string label_cell(const CellGroup& group, const CellRecord& cell) {
  const auto count = std::count_if(group.cells.begin(), group.cells.end(),
                                   [&](const CellRecord& other) { return other.filter == cell.filter; });
  return count > 1 && !cell.params.empty() ? fmt::format("{} ({})", cell.filter, describe_params(cell.params))
                                           : cell.filter;
}

std::string format_ratio(const std::optional<Ratio>& ratio) {
  return ratio ? fmt::format("{} [{}, {}]", format_number(ratio->median), format_number(ratio->ci95.low),
                             format_number(ratio->ci95.high))
               : kNothing;
}

std::string describe_clock(const GlRecord& gl) {
  const bool wall_clock = gl.timer == TimerKind::kWallClock;
  if (gl.software) return wall_clock ? "CPU time (software rasteriser)" : "GL timer query (software rasteriser)";
  return wall_clock ? "wall-clock time" : "GPU time (timer query)";
}

std::string time_unit(const GlRecord& gl) {
  if (gl.timer == TimerKind::kWallClock) return gl.software ? "ms (CPU)" : "ms";
  return gl.software ? "ms (GL timer)" : "ms (GPU)";
}

std::string describe_params(const ParamMap& params) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : params) parts.push_back(name + " " + format_param(value));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string describe_settings(const CellRecord& cell) {
  return fmt::format("view {} · map {} × {} {}{} · picture {} × {} · bias: {}{}", cell.view, cell.map_size,
                     cell.map_size, cell.map_format, describe_fit_and_light(cell), cell.width, cell.height,
                     describe_bias(cell.bias, cell.map_scale), describe_wrong_range(cell.range));
}

std::vector<CellGroup> group_cells(const std::vector<CellRecord>& cells) {
  std::vector<CellGroup> groups;
  std::map<std::string, std::size_t> places;
  for (const CellRecord& cell : cells) {
    auto settings = cell_settings(cell);
    settings.erase("filter");
    settings.erase("params");
    const auto [place, is_new] = places.emplace(dump_line(settings), groups.size());
    if (is_new) groups.push_back({cell.scene, {}});
    groups[place->second].cells.push_back(cell);
  }
  return groups;
}

std::vector<std::vector<std::size_t>> rank_lookups(const std::vector<CellRecord>& cells) {
  std::vector<std::size_t> order;
  bool by_ratio = true;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].time_ms.lookup) {
      order.push_back(i);
      by_ratio = by_ratio && cells[i].ratio_to_none.lookup.has_value();
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return lookup_median(cells[a], by_ratio) < lookup_median(cells[b], by_ratio);
  });
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t i : order) {
    const bool tied = !groups.empty() && overlap(lookup_interval(cells[groups.back().front()], by_ratio),
                                                 lookup_interval(cells[i], by_ratio));
    if (!tied) groups.emplace_back();
    groups.back().push_back(i);
  }
  return groups;
}

std::vector<std::string> describe_group(const CellGroup& group, const GlRecord& gl) {
  std::vector<std::string> sentences;
  const auto ranks = rank_lookups(group.cells);
  if (!ranks.empty()) {
    sentences.push_back(describe_ranking(group, ranks));
    sentences.push_back(
        describe_extremes(group, group.cells[ranks.front().front()], group.cells[ranks.back().back()], gl));
  }
  const std::string coverage = describe_coverage(group.cells.front().coverage);
  if (!coverage.empty()) sentences.push_back("Over the receivers in view: " + coverage + ".");
  for (const auto& more :
       {describe_prefilters(group, gl), describe_accuracy(group), describe_stability(group), describe_troubles(group)})
    sentences.insert(sentences.end(), more.begin(), more.end());
  return sentences;
}

std::vector<std::pair<std::string, std::string>> list_run_facts(const RunRecord& run) {
  std::vector<std::pair<std::string, std::string>> facts = {
      {"experiment", describe_experiment(run.experiment)},
      {"command", fmt::format("{}", fmt::join(run.command, " "))},
      {"commit", run.commit},
      {"seed", fmt::format("{}", run.seed)},
      {"times", describe_clock(run.gl)},
      {"GL", fmt::format("{} · {} · {}", run.gl.backend, run.gl.renderer, run.gl.version)},
      {"machine", fmt::format("{} · {} cores · load {} at the start", run.machine.cpu, run.machine.cores,
                              run.machine.load_at_start ? format_number(*run.machine.load_at_start) : kNothing)},
      {"system", fmt::format("{} · {}", run.machine.os, run.machine.compiler)},
      {"work", describe_work(run.work)}};
  if (run.repeat.of.value_or(0) > 0) {
    facts.emplace_back("repeat", fmt::format("{} those of the run that this one replaced ({} cells)",
                                             describe_overlap(run.repeat), run.repeat.cells.value_or(0)));
  }
  return facts;
}

std::map<std::string, int> count_absences(const std::vector<CellRecord>& cells) {
  std::map<std::string, int> counts;
  for (const CellRecord& cell : cells)
    for (const auto& [field, reason] : cell.absent) ++counts[field + ": " + reason];
  return counts;
}

}  // namespace shadowbench::report
