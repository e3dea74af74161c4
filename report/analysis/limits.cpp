#include "report/analysis/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace shadowbench::analysis {
namespace {

template <class T>
std::optional<double> as_double(const std::optional<T>& value) {
  return value ? std::optional<double>(static_cast<double>(*value)) : std::nullopt;
}

std::optional<double> read_frame_time(const records::CellRecord& cell, LightMotion light) {
  const auto time = frame_time(cell, light);
  return time ? std::optional<double>(time->median) : std::nullopt;
}

constexpr LimitSpec kTable[] = {
    {"--max-rmse", "error.rmse", "root mean square error of visibility against the area truth",
     [](const records::CellRecord& cell, LightMotion) { return cell.error.rmse; }},
    {"--max-leak", "artefact.leak", "share of blocked receivers that are bright",
     [](const records::CellRecord& cell, LightMotion) { return cell.artefact.leak; }},
    {"--max-acne", "artefact.acne", "share of lit receivers that are dark",
     [](const records::CellRecord& cell, LightMotion) { return cell.artefact.acne; }},
    {"--max-contact-gap", "artefact.contact_gap", "share of receivers blocked by what touches them that are bright",
     [](const records::CellRecord& cell, LightMotion) { return cell.artefact.contact_gap; }},
    {"--max-flip", "error.flip", "LDR-FLIP of the shaded picture",
     [](const records::CellRecord& cell, LightMotion) { return cell.error.flip; }},
    {"--max-ms", "time_ms", "median time of a frame, ms; see --light", read_frame_time},
    {"--max-bytes", "cost.map_bytes", "bytes of the map that is looked up",
     [](const records::CellRecord& cell, LightMotion) { return as_double(cell.cost.map_bytes); }},
    {"--max-fetches", "cost.fetches", "mean texture fetches per receiver",
     [](const records::CellRecord& cell, LightMotion) { return cell.cost.fetches; }},
};

const LimitSpec& find_spec(const std::string& field) {
  return *std::find_if(
      std::begin(kTable), std::end(kTable), [&](const LimitSpec& spec) { return spec.field == field; });
}

void add(records::Quartiles& sum, const records::Quartiles& pass) {
  sum.median += pass.median;
  sum.q1 += pass.q1;
  sum.q3 += pass.q3;
  sum.n = std::min(sum.n, pass.n);
}

}  // namespace

std::span<const LimitSpec> limit_table() { return kTable; }

const LimitSpec& cost_spec(CostKind kind) {
  switch (kind) {
    case CostKind::kTime: return find_spec("time_ms");
    case CostKind::kBytes: return find_spec("cost.map_bytes");
    case CostKind::kFetches: break;
  }
  return find_spec("cost.fetches");
}

std::optional<records::Quartiles> frame_time(const records::CellRecord& cell, LightMotion light) {
  const records::TimeRecord& time = cell.time_ms;
  if (!time.lookup) return std::nullopt;
  records::Quartiles sum = *time.lookup;
  if (light == LightMotion::kStatic) return sum;
  // A filter that looks up the depth map itself has no prefilter to time.
  const bool prefilters = time.prefilter || cell.cost.prefilter_texels.value_or(0) > 0;
  if (!time.map || (prefilters && !time.prefilter)) return std::nullopt;
  add(sum, *time.map);
  if (prefilters) add(sum, *time.prefilter);
  return sum;
}

const std::optional<records::Ratio>& frame_ratio(const records::CellRecord& cell, LightMotion light) {
  return light == LightMotion::kStatic ? cell.ratio_to_none.static_map : cell.ratio_to_none.moving;
}

std::string explain_absence(const records::CellRecord& cell, const std::string& field) {
  std::string name = field;
  for (;;) {
    if (const auto found = cell.absent.find(name); found != cell.absent.end()) return found->second;
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) break;
    name.resize(dot);
  }
  const auto part = cell.absent.lower_bound(field + ".");
  return part != cell.absent.end() && part->first.starts_with(field + ".") ? part->second : "not measured";
}

std::string describe_demand(const Demand& demand) {
  return demand.spec ? fmt::format("{} {}", demand.spec->option, demand.most) : "--requires " + demand.claim;
}

}  // namespace shadowbench::analysis
