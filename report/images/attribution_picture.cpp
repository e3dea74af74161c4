#include "report/images/attribution_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "report/images/color_values.h"
#include "report/images/grid.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::images {
namespace {

std::string join_texts(const std::string& a, const char* separator, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + separator + b;
}

GridTile make_error_tile(const std::string& label, const std::string& caption, const Image& error) {
  return {label, caption, {}, {}, error, {}};
}

// The largest of the images' own scales: no panel is saturated because another is nearly empty.
double choose_common_scale(const AttributionPicture& picture) {
  double scale = choose_error_scale({&picture.total});
  for (const Image& part : picture.parts) scale = std::max(scale, choose_error_scale({&part}));
  return scale;
}

Grid make_error_grid(const AttributionPicture& picture) {
  Grid grid;
  grid.title = picture.title;
  grid.subtitle = picture.subtitle;
  grid.tiles.push_back(make_error_tile("error", picture.total_caption, picture.total));
  for (std::size_t i = 0; i < metrics::kErrorParts; ++i) {
    assert(picture.parts[i].width == picture.total.width && picture.parts[i].height == picture.total.height);
    const records::ErrorPart& part = records::list_error_parts()[i];
    grid.tiles.push_back(
        make_error_tile(part.name, join_texts(picture.captions[i], " · ", part.meaning), picture.parts[i]));
  }
  grid.error_scale = picture.scale ? *picture.scale : choose_common_scale(picture);
  grid.error_name = "visibility less area truth, and its four parts";
  return grid;
}

}  // namespace

std::string caption_part(const records::AttributionPart& part) {
  return join_texts(part.rms ? "RMS " + records::format_number(*part.rms) : std::string(), ", ",
                    part.share ? "share " + records::format_share(*part.share) : std::string());
}

std::string caption_total(const records::ErrorRecord& error) {
  return join_texts(error.rmse ? "RMSE " + records::format_number(*error.rmse) : std::string(), ", ",
                    error.mean ? "mean signed " + records::format_number(*error.mean) : std::string());
}

Image draw_attribution_picture(const AttributionPicture& picture) { return draw_grid(make_error_grid(picture)); }

void write_attribution_picture(const std::filesystem::path& path, const AttributionPicture& picture) {
  write_display_png(path, draw_attribution_picture(picture));
}

}  // namespace shadowbench::images
