#include "report/images/figures/difference_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/images/color_values.h"
#include "report/images/figures/heat_panels.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::images {
namespace {

constexpr Rgb kMissing{1.0f, 0.0f, 1.0f};
constexpr Rgb kNotCounted{0.72f, 0.74f, 0.77f};

float rank(float value) {
  if (std::isinf(value)) return -1.0f;
  return std::isnan(value) ? std::numeric_limits<float>::infinity() : std::abs(value);
}

HeatPanel make_difference_panel(const DifferencePicture& picture) {
  const double scale = choose_error_scale({&picture.difference});
  const auto color_of = [scale](float value) {
    return std::isnan(value)   ? kMissing
           : std::isinf(value) ? kNotCounted
                               : map_diverging(value, static_cast<float>(scale));
  };
  return {"signed difference, mean over the channels",
          "red: the first is larger; magenta: not finite; grey: left out by the mask",
          color_values(fit_heat_panel(picture.difference, rank), color_of),
          color_values(make_color_bar(), [](float t) { return map_diverging(2.0f * t - 1.0f, 1.0f); }),
          list_signed_ticks(scale)};
}

HeatPanel make_flip_panel(const Image& flip) {
  const float most = std::max(0.01f, *std::ranges::max_element(flip.texels));
  Image places = fit_heat_panel(flip, rank);
  for (float& value : places.texels) value = std::clamp(value / most, 0.0f, 1.0f);
  HeatPanel panel{"FLIP",
                  "0: an observer who flips between the pictures sees no change",
                  color_values(places, "magma"),
                  color_values(make_color_bar(), "magma"),
                  {}};
  for (const float part : {0.0f, 0.5f, 1.0f})
    panel.ticks.emplace_back(part, records::format_number(static_cast<double>(part * most)));
  return panel;
}

}  // namespace

void write_difference_picture(const std::filesystem::path& path, const DifferencePicture& picture) {
  std::vector<HeatPanel> panels = {make_difference_panel(picture)};
  if (!picture.flip.empty()) panels.push_back(make_flip_panel(picture.flip));
  const std::string note = picture.flip.empty() ? picture.note + "; no FLIP: " + picture.no_flip : picture.note;
  write_display_png(path, draw_heat_panels(picture.title, note, panels));
}

}  // namespace shadowbench::images
