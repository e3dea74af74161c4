#include "report/pages/comparison_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "report/document/blocks.h"
#include "report/images/hardest_edge.h"
#include "report/images/picture_io.h"
#include "report/images/value_file.h"

namespace shadowbench::pages {
namespace {

using nlohmann::json;

/// Writes a picture and its values beside the page, and says where they are.
json write_side(const std::filesystem::path& dir, const std::string& stem, const images::Image& rgb,
                const images::ValuePlanes& planes) {
  const std::string picture = "images/" + stem + ".png", values = "images/" + stem + ".values.js";
  images::write_value_file(dir / values, values, planes);
  if (rgb.empty()) return {{"picture", nullptr}, {"values", values}};
  images::write_picture_png(dir / picture, rgb);
  return {{"picture", picture}, {"values", values}};
}

/// The difference four times enlarged, where it is largest.
json find_view(const ComparedPictures& pictures) {
  const images::Image& grey = pictures.image_grey;
  const images::Rect part = images::find_hardest_edge({&grey, &pictures.truth_grey}, 1,
                                                      {std::max(1, grey.width / 4), std::max(1, grey.height / 4)});
  return {{"x", part.x + part.width / 2}, {"y", part.y + part.height / 2}, {"zoom", part.width > 0 ? 4 : 1}};
}

/// The greatest magnitude in two pictures, where all is darker than white: tiny values are seen then too.
double find_white(const ComparedPictures& pictures) {
  double greatest = 0.0;
  for (const images::Image* grey : {&pictures.image_grey, &pictures.truth_grey})
    for (const float value : grey->texels)
      if (std::isfinite(value)) greatest = std::max(greatest, static_cast<double>(std::abs(value)));
  return greatest > 0.0 ? std::min(greatest, 1.0) : 1.0;
}

}  // namespace

void write_comparison_page(const std::filesystem::path& dir, const ComparedPictures& pictures) {
  images::ValuePlanes planes = {{"visibility", pictures.image_grey}};
  if (!pictures.flip.empty()) planes.emplace_back("flip", pictures.flip);
  images::ValuePlanes truth_planes = {{"area", pictures.truth_grey}};
  if (!pictures.mask.empty()) truth_planes.emplace_back("mask", pictures.mask);
  json cell = write_side(dir, "first", pictures.image_rgb, planes);
  cell["configuration"] = cell["place"] = 0;
  document::Page page{"Two pictures compared", {}, {}};
  page.data = {{"places", {{{"title", "both"}}}},
               {"hatched", "left out by the mask, or not finite"},
               {"white", find_white(pictures)},
               {"opens", find_view(pictures)},
               {"configurations", {{{"label", pictures.image}}}},
               {"truths", {write_side(dir, "second", pictures.truth_rgb, truth_planes)}},
               {"cells", {std::move(cell)}}};
  page.sections = {
      {"numbers",
       "",
       {document::Paragraph{fmt::format("The first picture is {}. What stands for the truth is {}. Visibility "
                                        "is the mean over the channels of the values as stored.",
                                        pictures.image, pictures.truth)},
        document::Facts{pictures.numbers}}},
      {"viewer", "Look closer", {document::Mount{"viewer", {}}}}};
  write_text_file(dir / "index.html", document::write_html(page));
}

}  // namespace shadowbench::pages
