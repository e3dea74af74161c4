#pragma once

#include <cstdint>
#include <vector>

#include "harness/render/gbuffer.h"
#include "harness/scene/lights/light.h"
#include "reference/truth/visibility.h"
#include "report/images/image.h"

namespace shadowbench::measure {

/// The receivers of a view, for the truth; rows run top to bottom as in every image of a report.
struct ViewReceivers {
  truth::ReceiverImage image;
  std::vector<std::uint8_t> is_surface;  ///< 0: background

  bool any_counts() const;

  /// Visibility as the lookup pass writes it: surfaces turned away from the light are dark, the background is lit.
  images::Image to_image(const std::vector<float>& visibility) const;

  /// 1 where a pixel counts: a surface that faces the light.
  std::vector<std::uint8_t> mask() const;
};

/// Whether two receivers close by count, and lie on one surface, which is nearly flat between them.
bool lie_on_one_surface(const truth::ReceiverPoint& a, const truth::ReceiverPoint& b);

/// The surfaces that a view's pixels show, as a G-buffer holds them: four channels, rows top to bottom.
struct ViewSurfaces {
  images::Image positions;  ///< world space; the fourth channel is 0 on the background
  images::Image normals;    ///< geometric, flipped to the viewer
};

ViewSurfaces read_view_surfaces(const render::GBuffer& gbuffer);

/// The receivers of a view; those count that face the light. Cost: 0.03 s for half a million pixels.
ViewReceivers make_view_receivers(const ViewSurfaces& surfaces, const scene::Light& light);

/// Reads the receivers that a G-buffer holds; those count that face the light.
ViewReceivers read_view_receivers(const render::GBuffer& gbuffer, const scene::Light& light);

}  // namespace shadowbench::measure
