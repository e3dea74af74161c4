#include "reference/truth/visibility.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>

#include "filters/random.h"
#include "reference/truth/adaptive_tracer.h"

namespace shadowbench::truth {
namespace {

/// Steps of one texel on a receiver's plane.
struct Steps {
  glm::dvec3 right;
  glm::dvec3 up;
};

Steps step_along_texels(const TexelGradients& along, const glm::dvec3& normal) {
  const double area = glm::dot(normal, glm::cross(along.u, along.v));
  return {glm::cross(along.v, normal) / area, glm::cross(normal, along.u) / area};
}

/// A kernel's fan: rays to the light's centre that start on the receiver's tangent plane, below the texels that they
/// stand for.
RayFan make_kernel_fan(const Occluders& occluders, const ReceiverPoint& point, const MapGrid& grid, double half_width) {
  const glm::dvec3 normal(point.normal_ws), position(point.position_ws);
  const glm::dvec3 to_light = grid.lamp ? grid.lamp->position_ws - position : grid.to_light;
  const double texel_ws =
      grid.lamp ? grid.texel_size_ws * glm::dot(to_light, grid.to_light) / grid.lamp->reference_m : grid.texel_size_ws;
  const double n_dot_l = glm::dot(normal, to_light);
  // A step of one texel, slid along the light until it lies in the plane.
  const auto slide = [&](const glm::dvec3& axis) {
    return texel_ws * (axis - to_light * (glm::dot(normal, axis) / n_dot_l));
  };
  const auto [right, up] = grid.curved ? step_along_texels(grid.curved->gradients(position), normal)
                                       : Steps{slide(grid.right), slide(grid.up)};
  RayFan fan;
  fan.origin = occluders.offset_origin(point.position_ws, point.normal_ws,
                                       static_cast<float>(half_width * (glm::length(right) + glm::length(up))));
  fan.origin_x = right;
  fan.origin_y = up;
  fan.direction = grid.to_light;
  fan.normal = point.normal_ws;
  fan.reach = std::numeric_limits<float>::infinity();
  fan.direction_moves = false;
  if (!grid.lamp) return fan;
  fan.direction = grid.lamp->position_ws - glm::dvec3(fan.origin);
  fan.direction_x = -fan.origin_x;
  fan.direction_y = -fan.origin_y;
  fan.direction_moves = true;
  fan.reach = 1.0f;
  return fan;
}

/// Calls `work` with up to a packet's number of receivers that count, row by row.
template <class Work>
void for_each_group(const ReceiverImage& receivers, Work work) {
  tbb::parallel_for(
      0, receivers.height,
      [&](int y) {
        std::vector<std::size_t> group;
        for (int x = 0; x < receivers.width; ++x) {
          const std::size_t i =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(receivers.width) + static_cast<std::size_t>(x);
          if (receivers.points[i].counts) group.push_back(i);
          const bool is_last = x + 1 == receivers.width;
          if (group.size() < RayPacket::kSize && !(is_last && !group.empty())) continue;
          work(group);
          group.clear();
        }
      });
}

}  // namespace

TracedVisibility trace_area(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light,
                            const TraceSettings& settings) {
  return trace_area(occluders, receivers, light, settings, make_light_samples(light, settings));
}

SampleSets make_light_samples(const AreaLight& light, const TraceSettings& settings) {
  return {settings.max_points, settings.seed,
          [&](const glm::dvec2& u, const glm::dvec2&) { return light.map_sample(u); }};
}

TracedVisibility trace_area(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light,
                            const TraceSettings& settings, const SampleSets& samples) {
  return trace_fans(
      occluders, receivers, samples, settings,
      [&](std::size_t i) {
        const ReceiverPoint& point = receivers.points[i];
        RayFan fan;
        fan.origin = occluders.offset_origin(point.position_ws, point.normal_ws);
        fan.direction = light.centre_direction(glm::dvec3(fan.origin));
        const AreaLight::Aim aim = light.aim(glm::dvec3(fan.origin));
        fan.direction_x = aim.u;
        fan.direction_y = aim.v;
        fan.cap = aim.cap;
        fan.normal = point.normal_ws;
        fan.light_axis = light.axis();
        fan.weighs = true;
        fan.reach = light.reach();
        fan.origin_moves = false;
        if (aim.cap < 1.0f) return fan;
        // Inside a sphere: the rays end where they start.
        fan.direction = point.normal_ws;
        fan.direction_moves = false;
        fan.reach = 0.0f;
        return fan;
      });
}

TracedVisibility trace_kernel(const Occluders& occluders, const ReceiverImage& receivers, const filters::Kernel& kernel,
                              const MapGrid& grid, const TraceSettings& settings) {
  const SampleSets samples(
      settings.max_points, settings.seed,
      [&](const glm::dvec2& shape, const glm::dvec2& between) { return kernel.sample(shape, between); });
  return trace_fans(occluders, receivers, samples, settings, [&](std::size_t i) {
    return make_kernel_fan(occluders, receivers.points[i], grid, kernel.half_width());
  });
}

TracedVisibility trace_disks(const Occluders& occluders, const ReceiverImage& receivers,
                             std::span<const float> radii_texels, const MapGrid& grid, const TraceSettings& settings) {
  const filters::Kernel fetch = filters::Kernel::make_point(filters::Reconstruction::kBilinear);
  const SampleSets fetches(
      settings.max_points, settings.seed,
      [&](const glm::dvec2& disk, const glm::dvec2& between) { return fetch.sample(disk, between); });
  const SampleSets disks(settings.max_points, settings.seed,
                         [](const glm::dvec2& disk, const glm::dvec2&) { return filters::map_to_disk(disk); });
  const auto make_fan = [&](std::size_t i) {
    const double half_width = fetch.half_width() + static_cast<double>(radii_texels[i]);
    RayFan fan = make_kernel_fan(occluders, receivers.points[i], grid, half_width);
    fan.scale = radii_texels[i];
    return fan;
  };
  return trace_fans(occluders, receivers, fetches, settings, make_fan, &disks);
}

TracedVisibility trace_square(const Occluders& occluders, const ReceiverImage& receivers, double half_width_texels,
                              const MapGrid& grid, const TraceSettings& settings) {
  const SampleSets samples(
      settings.max_points, settings.seed,
      [&](const glm::dvec2& u, const glm::dvec2&) { return half_width_texels * (2.0 * u - 1.0); });
  return trace_fans(occluders, receivers, samples, settings, [&](std::size_t i) {
    return make_kernel_fan(occluders, receivers.points[i], grid, half_width_texels);
  });
}

std::vector<float> trace_hard(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light) {
  std::vector<float> visibility(receivers.points.size(), 1.0f);
  for_each_group(receivers, [&](const std::vector<std::size_t>& group) {
    RayPacket packet;
    for (std::size_t lane = 0; lane < group.size(); ++lane) {
      const ReceiverPoint& point = receivers.points[group[lane]];
      const glm::vec3 origin = occluders.offset_origin(point.position_ws, point.normal_ws);
      const glm::vec3 direction = light.centre_direction(glm::dvec3(origin));
      packet.set(lane, origin, direction, light.reach());
      if (!(glm::dot(direction, point.normal_ws) > 0.0f)) packet.active[lane] = 0;  // below the receiver's own plane
    }
    occluders.find_blocked(packet);
    for (std::size_t lane = 0; lane < group.size(); ++lane)
      visibility[group[lane]] = packet.active[lane] != 0 ? packet.transmittance[lane] : 0.0f;
  });
  return visibility;
}

std::vector<float> trace_first_blockers(const Occluders& occluders, const ReceiverImage& receivers,
                                        const AreaLight& light) {
  std::vector<float> distances(receivers.points.size(), std::numeric_limits<float>::infinity());
  for_each_group(receivers, [&](const std::vector<std::size_t>& group) {
    RayPacket packet;
    RayPacket::Lanes lengths{};
    for (std::size_t lane = 0; lane < group.size(); ++lane) {
      const ReceiverPoint& point = receivers.points[group[lane]];
      const glm::vec3 origin = occluders.offset_origin(point.position_ws, point.normal_ws);
      // The ray starts at the light, or beyond everything, and runs back to the receiver.
      const glm::vec3 to_light(light.centre_direction(glm::dvec3(origin)));
      const bool is_lamp = std::isfinite(light.reach());
      lengths[lane] = is_lamp ? glm::length(to_light) : 1.01f * (glm::length(origin) + occluders.farthest());
      const glm::vec3 way = is_lamp ? to_light : to_light * lengths[lane];
      packet.set(lane, origin + way, -way, 1.0f);
    }
    const RayPacket::Lanes hits = occluders.find_nearest(packet).distances;
    for (std::size_t lane = 0; lane < group.size(); ++lane)
      if (std::isfinite(hits[lane])) distances[group[lane]] = lengths[lane] * (1.0f - hits[lane]);
  });
  return distances;
}

}  // namespace shadowbench::truth
