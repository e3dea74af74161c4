#include "harness/measure/view_receivers.h"

#include <algorithm>

#include "base/bytes.h"
#include "filters/receiver.h"
#include "harness/measure/receiver_pixels.h"
#include "harness/render/geometry.h"

namespace shadowbench::measure {

bool ViewReceivers::any_counts() const { return std::ranges::any_of(image.points, &truth::ReceiverPoint::counts); }

images::Image ViewReceivers::to_image(const std::vector<float>& visibility) const {
  images::Image result(image.width, image.height, 1);
  for (std::size_t i = 0; i < visibility.size(); ++i)
    result.texels[i] = image.points[i].counts ? visibility[i] : is_surface[i] ? 0.0f : 1.0f;
  return result;
}

std::vector<std::uint8_t> ViewReceivers::mask() const {
  std::vector<std::uint8_t> result;
  for (const truth::ReceiverPoint& point : image.points) result.push_back(point.counts ? 1 : 0);
  return result;
}

bool lie_on_one_surface(const truth::ReceiverPoint& a, const truth::ReceiverPoint& b) {
  constexpr float kOffPlane = 0.05f, kCosine = 0.99f;
  const glm::vec3 way = b.position_ws - a.position_ws;
  return a.counts && b.counts && glm::dot(a.normal_ws, b.normal_ws) > kCosine &&
         std::abs(glm::dot(way, a.normal_ws)) <= kOffPlane * glm::length(way);
}

namespace {

bool faces(const scene::Light& light, const glm::vec3& position, const glm::vec3& normal) {
  return glm::dot(normal, scene::to_light(light, position)) > filters::kFacesLight && scene::shines_on(light, position);
}

}  // namespace

ViewSurfaces read_view_surfaces(const render::GBuffer& gbuffer) {
  return {render::read_image(gbuffer.position(), 4), render::read_image(gbuffer.normal(), 4)};
}

ViewReceivers make_view_receivers(const ViewSurfaces& surfaces, const scene::Light& light) {
  const auto& [positions, normals] = surfaces;
  const std::size_t pixels = positions.texels.size() / 4;
  ViewReceivers receivers{{positions.width, positions.height, std::vector<truth::ReceiverPoint>(pixels)},
                          std::vector<std::uint8_t>(pixels)};
  visit_in_parallel(pixels, [&](std::size_t i) {
    const float* p = &positions.texels[4 * i];
    const float* n = &normals.texels[4 * i];
    const glm::vec3 position(p[0], p[1], p[2]), normal(n[0], n[1], n[2]);
    const bool is_surface = p[3] != 0.0f;
    receivers.is_surface[i] = is_surface ? 1 : 0;
    receivers.image.points[i] = {position, normal, is_surface && faces(light, position, normal)};
  });
  ContentHash hash;
  hash.add_values(std::span<const float>(positions.texels));
  hash.add_values(std::span<const float>(normals.texels));
  hash.add_values(std::span<const std::uint8_t>(receivers.mask()));
  receivers.image.content = hash.name();
  return receivers;
}

ViewReceivers read_view_receivers(const render::GBuffer& gbuffer, const scene::Light& light) {
  return make_view_receivers(read_view_surfaces(gbuffer), light);
}

}  // namespace shadowbench::measure
