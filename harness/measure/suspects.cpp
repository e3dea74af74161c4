#include "harness/measure/suspects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/gl/survey.h"
#include "report/records/format.h"

namespace shadowbench::measure {
namespace {

using records::format_number;

constexpr float kRounding = 1e-5f;             // of a sum of weights in single precision
constexpr double kReachRoundingTexels = 0.01;  // of an offset that was turned or taken from a uv

void suspect(MeasuredCell& cell, const std::string& sentence) {
  records::CellRecord& record = cell.record;
  record.status = records::CellStatus::kSuspect;
  record.suspect_of.push_back(sentence);
  record.message = fmt::format("{}", fmt::join(record.suspect_of, "; "));
  record.warnings.push_back(fmt::format("{}: {} is suspect: {}", record.scene, cell.label, sentence));
}

/// The least and the largest finite value; in the wrong order where no value is finite.
struct ValueSpan {
  float least = std::numeric_limits<float>::max();
  float most = std::numeric_limits<float>::lowest();

  void add(float value) {
    if (!std::isfinite(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

void check_values(MeasuredCell& cell) {
  const std::int64_t broken = cell.record.nan.value_or(0);
  if (broken > 0) {
    suspect(cell, fmt::format("{} pixels are not finite; look for a division by 0, and for numbers too large for the "
                              "format of the map",
                              broken));
  }
  ValueSpan span;
  for (const float value : cell.visibility.texels) span.add(value);
  if (span.least >= -kRounding && span.most <= 1.0f + kRounding) return;
  if (span.least > span.most) return;
  suspect(cell,
          fmt::format("its visibility lies between {} and {}, which should be 0 for blocked and 1 for lit; divide "
                      "by the sum of the weights, or clamp",
                      format_number(static_cast<double>(span.least)), format_number(static_cast<double>(span.most))));
}

void check_reads(MeasuredCell& cell) {
  const render::FilterCost& cost = cell.cost;
  const filters::FilterSpec& spec = cell.request.spec;
  if (spec.reads_unwritten) {
    suspect(cell,
            "it reads the encoded map, but no encode() writes one; write encode(), or call fetch_depth or "
            "compare_nearest");
  }
  if (!cost.reach_texels) return;
  if (*cost.fetches == 0.0)
    suspect(cell,
            "it reads nothing from the map; call compare_nearest, compare_2x2, fetch_depth, fetch_map or a gather");
  const double declared = filters::reach_texels(spec, cell.request.values);
  if (*cost.reach_texels <= declared + kReachRoundingTexels) return;
  suspect(cell,
          fmt::format("it reads texels up to {} texels from the receiver, but its radius_texels declares {}: bias "
                      "and the map's margin are made for that; declare what it reads, a texel for the four of a "
                      "2x2 fetch included, or move the taps",
                      format_number(*cost.reach_texels), format_number(declared)));
}

/// A GL that ends a loop too early says nothing, and the image is wrong.
void check_loops(MeasuredCell& cell, gl::Context& context) {
  constexpr int kFewestOfAnyLimit = 10'000;
  if (cell.cost.most_turns < kFewestOfAnyLimit) return;
  const int limit = gl::measure_loop_turns(context);
  if (limit == 0 || cell.cost.most_turns < limit) return;
  suspect(cell, fmt::format("one of its loops goes on after {} turns, where this GL ends it without a word; write one "
                            "that ends sooner",
                            limit));
}

}  // namespace

void check_drawing(MeasuredCell& cell, gl::Context& context) {
  check_values(cell);
  check_reads(cell);
  check_loops(cell, context);
}

void check_against_truth(MeasuredCell& cell, const SceneTruth& truth) {
  if (!truth.absent.empty() || cell.visibility.empty()) return;
  ValueSpan span;
  int lit = 0, blocked = 0;
  for (std::size_t i = 0; i < truth.mask.size(); ++i) {
    if (!truth.mask[i]) continue;
    span.add(cell.visibility.texels[i]);
    lit += truth.ratio.texels[i] == 1.0f;
    blocked += truth.area.texels[i] == 0.0f;
  }
  if (std::min(lit, blocked) < metrics::kFewestReceivers || span.least > span.most) return;
  if (span.most - span.least > kRounding) return;
  suspect(cell, fmt::format("its visibility is {} at every receiver, though {} of them are wholly lit in truth and {} "
                            "wholly blocked; let it depend on how r.depth compares with the map, and check that --bias "
                            "is not larger than the scene",
                            format_number(static_cast<double>(span.least)), lit, blocked));
}

}  // namespace shadowbench::measure
