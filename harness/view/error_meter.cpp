#include "harness/view/error_meter.h"

#include <fmt/format.h>

#include "reference/metrics/error_stats.h"

namespace shadowbench::view {
namespace {

constexpr double kSecondsBeforeError = 0.1;

}  // namespace

void ErrorMeter::step(double now_s) {
  if (drawing_ != bench_.drawings()) {
    drawing_ = bench_.drawings();
    since_s_ = now_s;
    is_measured_ = false;
    rmse_ = {};
  }
  const auto& truth = bench_.truth().truth;
  if (is_measured_ || !truth || !truth->absent.empty() || now_s - since_s_ < kSecondsBeforeError) return;
  is_measured_ = true;
  for (std::size_t side = 0; side < kSides; ++side) {
    if (bench_.stage().passes(side) == nullptr) continue;
    const gl::Texture& drawn = bench_.stage().visibility(side, {0, bench_.state().options.width});
    const images::Image visibility = render::read_image(drawn, 1);
    if (const auto error = metrics::measure_error(visibility.texels, truth->area.texels, truth->mask))
      rmse_[side] = error->rmse;
  }
}

std::string ErrorMeter::describe(std::size_t side) const {
  if (bench_.state().sides[side].truth) return {};
  if (rmse_[side]) return fmt::format("RMSE {:.4f}", *rmse_[side]);
  const auto& truth = bench_.truth().truth;
  if (truth) return truth->absent.empty() ? "RMSE ..." : "no RMSE: " + truth->absent;
  return fmt::format("RMSE ... (truth {:.0f} %)", 100.0 * bench_.truth_part());
}

}  // namespace shadowbench::view
