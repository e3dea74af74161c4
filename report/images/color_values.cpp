#include "report/images/color_values.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>

namespace shadowbench::images {

Image color_values(const Image& values, const std::function<Rgb(float)>& color_of) {
  Image colors(values.width, values.height, 3);
  for (std::size_t i = 0; i < values.texels.size(); ++i) {
    const Rgb rgb = color_of(values.texels[i]);
    std::copy(rgb.begin(), rgb.end(), colors.texels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return colors;
}

Image color_values(const Image& values, const std::string& map) {
  const OIIO::ImageSpec spec(values.width, values.height, 1, OIIO::TypeDesc::FLOAT);
  const OIIO::ImageBuf source(spec, const_cast<float*>(values.texels.data()));
  Image colors(values.width, values.height, 3);
  OIIO::ImageBufAlgo::color_map(source, 0, map)
      .get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, colors.texels.data());
  return colors;
}

Image make_ramp(int width, int height) {
  Image ramp(width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) *ramp.at(x, y) = static_cast<float>(x) / static_cast<float>(width - 1);
  return ramp;
}

}  // namespace shadowbench::images
