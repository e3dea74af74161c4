#include "report/records/format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "filters/kernel.h"

namespace shadowbench::records {
namespace {

/// Six digits tell values of a sweep apart, and can be read.
std::string format_param(const records::ParamValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.6g}", *number);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "on" : "off";
  return std::get<std::string>(value);
}

/// Writes a length in the units it was given in, then in all three where the map's scale is known.
std::string describe_amount(const records::BiasAmount& amount, const records::MapScaleRecord& scale) {
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

bool any(const records::BiasAmount& amount) { return amount.depth > 0.0 || amount.texels > 0.0 || amount.world > 0.0; }

/// Names the fit and the light where they are not the default.
std::string describe_fit_and_light(const records::CellRecord& cell) {
  const records::CellRecord usual;
  std::string text;
  if (cell.fit != usual.fit) text += " · fit " + cell.fit;
  if (cell.light != usual.light) text += fmt::format(" · light at {}° (azimuth, elevation)", cell.light);
  return text;
}

constexpr auto kNumeric = static_cast<std::size_t>(metrics::ErrorPart::kNumeric);

}  // namespace

std::string format_number(double value) {
  if (!std::isfinite(value)) return kNothing;
  const double size = std::abs(value);
  if (size >= 99.95 && size < 1e15) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

std::string format_bytes(double bytes) {
  const char* const units[] = {"B", "KiB", "MiB", "GiB"};
  std::size_t unit = 0;
  for (; bytes >= 1024.0 && unit + 1 < std::size(units); ++unit) bytes /= 1024.0;
  return fmt::format("{} {}", format_number(bytes), units[unit]);
}

std::string format_share(double share) {
  const double percent = std::round(100.0 * share);
  return fmt::format("{:.0f} %", percent == 0.0 ? 0.0 : percent);  // no "-0 %"
}

std::string format_rate(double rate) { return format_number(100.0 * rate) + " %"; }
std::string format_rate(const std::optional<double>& rate) { return rate ? format_rate(*rate) : kNothing; }

std::string format_interval(double value, const Interval& interval) {
  return fmt::format("{} [{}, {}]", format_number(value), format_number(interval.low), format_number(interval.high));
}

std::string format_ratio(const std::optional<records::Ratio>& ratio) {
  return ratio ? format_interval(ratio->median, ratio->ci95) : kNothing;
}

std::string describe_clock(const records::GlRecord& gl) { return describe_clock(kind_of({}, gl)); }

std::string describe_clock(const MachineKind& kind) {
  const bool wall_clock = kind.timer == records::TimerKind::kWallClock;
  if (kind.software) return wall_clock ? "CPU time (software rasteriser)" : "GL timer query (software rasteriser)";
  return wall_clock ? "wall-clock time" : "GPU time (timer query)";
}

std::string time_unit(const records::GlRecord& gl) {
  if (gl.timer == records::TimerKind::kWallClock) return gl.software ? "ms (CPU)" : "ms";
  return gl.software ? "ms (GL timer)" : "ms (GPU)";
}

std::string describe_machine_kind(const MachineKind& kind) {
  return fmt::format("{}, {} core{}, {}, {}", kind.cpu, kind.cores, kind.cores == 1 ? "" : "s", kind.renderer,
                     describe_clock(kind));
}

std::string describe_params(const records::ParamMap& params) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : params) parts.push_back(name + " " + format_param(value));
  return fmt::format("{}", fmt::join(parts, ", "));
}

KernelRecord make_kernel_record(std::optional<double> sigma_texels) {
  KernelRecord kernel;
  kernel.sigma_texels = sigma_texels;
  const filters::WidthClass* found = sigma_texels ? filters::find_width_class(*sigma_texels) : nullptr;
  if (found) kernel.width_class = found->name;
  return kernel;
}

std::string describe_kernel(const KernelRecord& kernel) {
  if (!kernel.sigma_texels) return kNothing;
  return fmt::format("{} texels{}", format_number(*kernel.sigma_texels),
                     kernel.width_class ? fmt::format(" ({})", *kernel.width_class) : std::string());
}

std::string describe_coverage(const records::CoverageRecord& coverage) {
  if (!coverage.texels_per_pixel || !coverage.fewest_texels_per_pixel || !coverage.map_used) return {};
  return fmt::format("{} map texels per pixel (worst {}), {:.0f} % of the map used",
                     format_number(*coverage.texels_per_pixel), format_number(*coverage.fewest_texels_per_pixel),
                     100.0 * *coverage.map_used);
}

std::string describe_bias(const records::BiasRecord& bias, const records::MapScaleRecord& scale) {
  std::vector<std::string> parts;
  if (any(bias.constant)) parts.push_back(describe_amount(bias.constant, scale));
  if (any(bias.slope)) parts.push_back("(1 − n·l) × " + describe_amount(bias.slope, scale));
  if (bias.plane_texels > 0.0) parts.push_back(fmt::format("plane over {} texels", format_number(bias.plane_texels)));
  if (bias.plane_kernels > 0.0)
    parts.push_back(fmt::format("plane over {} × the filter's reach", format_number(bias.plane_kernels)));
  if (any(bias.normal_offset)) parts.push_back("normal offset of " + describe_amount(bias.normal_offset, scale));
  if (bias.receiver_plane) parts.push_back("receiver plane, per tap");
  if (bias.map.polygon_factor > 0.0 || bias.map.polygon_units > 0.0) {
    parts.push_back(fmt::format("polygon offset {}, {}", format_number(bias.map.polygon_factor),
                                format_number(bias.map.polygon_units)));
  }
  if (bias.map.cull_front) parts.push_back("front faces culled");
  if (bias.map.midpoint) parts.push_back("midpoint map");
  return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, " + "));
}

std::string describe_range(const RangeRule& range) {
  std::vector<std::string> parts;
  if (range.border != RangeRule().border) parts.push_back(fmt::format("outside the map: {}", name_of(range.border)));
  if (!range.far_test) parts.emplace_back("far-plane test off");
  if (!range.behind_test) parts.emplace_back("behind-the-light test off");
  return fmt::format("{}", fmt::join(parts, " · "));
}

std::string describe_settings(const records::CellRecord& cell) {
  const std::string range = describe_range(cell.range);
  return fmt::format("view {} · map {} × {} {}{} · picture {} × {} · bias: {}{}{}", cell.view, cell.map_size,
                     cell.map_size, cell.map_format, describe_fit_and_light(cell), cell.width, cell.height,
                     describe_bias(cell.bias, cell.map_scale), range.empty() ? "" : " · ", range);
}

std::string describe_status(const records::CellRecord& cell) {
  return cell.message.empty() ? records::name_of(cell.status)
                              : fmt::format("{}: {}", records::name_of(cell.status), cell.message);
}

const std::array<ErrorPart, metrics::kErrorParts>& list_error_parts() {
  static const std::array<ErrorPart, metrics::kErrorParts> kParts = {
      ErrorPart{"numeric", "numeric", "arithmetic precision", {0.20f, 0.20f, 0.20f}, &AttributionRecord::numeric},
      ErrorPart{"estimator",
                "estimator",
                "light bleeding of a bound, or noise of few taps",
                {0.94f, 0.75f, 0.19f},
                &AttributionRecord::estimator},
      ErrorPart{"discretisation",
                "discretisation and bias",
                "the map's resolution and the bias",
                {0.00f, 0.45f, 0.35f},
                &AttributionRecord::discretisation},
      ErrorPart{"model",
                "model",
                "the filter's kernel is not this light's penumbra",
                {0.80f, 0.47f, 0.65f},
                &AttributionRecord::model}};
  return kParts;
}

std::optional<PartShares> list_shares(const CellRecord& cell) {
  PartShares shares;
  for (std::size_t i = 0; i < metrics::kErrorParts; ++i) {
    shares[i] = (cell.attribution.*list_error_parts()[i].record).share;
    if (shares[i] ? !std::isfinite(*shares[i]) : i != kNumeric) return std::nullopt;
  }
  return shares;
}

bool has_offsets(const PartShares& shares) {
  return std::ranges::any_of(
      shares,
      [](const auto& share) {
        const double percent = std::round(100.0 * share.value_or(0.0));  // as format_share() shows it
        return percent < 0.0 || percent > 100.0;
      });
}

std::string describe_shares(const PartShares& shares) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < metrics::kErrorParts; ++i)
    if (shares[i]) texts.push_back(fmt::format("{} {}", list_error_parts()[i].id, format_share(*shares[i])));
  if (!shares[kNumeric]) texts.front() = "numeric and " + texts.front();
  const std::string note = has_offsets(shares) ? fmt::format("; {}", kOffsets) : "";
  return fmt::format("{}{}", fmt::join(texts, ", "), note);
}

std::string explain_no_attribution(const CellRecord& cell) {
  if (cell.status == CellStatus::kSuspect) return "the filter is suspect";
  for (const auto& [field, reason] : cell.absent)
    if (field == "attribution" || field.rfind("attribution.", 0) == 0) return reason;
  const auto found = cell.absent.find("error");
  return found == cell.absent.end() ? "not measured" : found->second;
}

}  // namespace shadowbench::records
