#include "harness/flicker/motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtx/rotate_vector.hpp>

#include "base/error.h"
#include "base/split_list.h"
#include "filters/receiver.h"

namespace shadowbench::flicker {
namespace {

constexpr std::array<std::string_view, 2> kNames = {"light", "camera"};  // in the order of Motion

Motion parse_motion(const std::string& name) {
  const auto found = std::ranges::find(kNames, name);
  if (found != kNames.end()) return static_cast<Motion>(found - kNames.begin());
  throw Error(ErrorKind::kUsage,
              fmt::format("--motion: unknown motion '{}'; there are {}", name, fmt::join(kNames, ", ")));
}

bool lies_inside(const glm::dvec3& place, double map_size, double pad_texels) {
  // What is fitted lies on the padding's edge, where rounding decides.
  const double low = pad_texels - 1e-3, high = map_size - low;
  return place.x >= low && place.y >= low && place.x <= high && place.y <= high && place.z >= 0.0 && place.z <= 1.0;
}

double leave_out_whole(double texels) { return texels - std::round(texels); }

}  // namespace

std::string_view name_of(Motion motion) { return kNames[static_cast<std::size_t>(motion)]; }

std::vector<Motion> parse_motions(const std::string& text) {
  std::vector<Motion> motions;
  for (const std::string& name : split_list(text)) {
    const Motion motion = parse_motion(name);
    if (std::ranges::find(motions, motion) != motions.end())
      throw Error(ErrorKind::kUsage, fmt::format("--motion names '{}' twice", name_of(motion)));
    motions.push_back(motion);
  }
  return motions;
}

scene::FitMode fit_of(Motion motion) {
  return motion == Motion::kLight ? scene::FitMode::kTight : scene::FitMode::kView;
}

std::vector<Frame> make_frames(Motion motion, const scene::Scene& scene, double step, int count) {
  const scene::Camera& camera = scene.cameras.front();
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(camera.forward_ws), glm::dvec3(camera.up_ws)));
  std::vector<Frame> frames(static_cast<std::size_t>(count), Frame{scene.light, camera});
  for (int i = 1; i < count; ++i) {
    Frame& frame = frames[static_cast<std::size_t>(i)];
    if (motion == Motion::kLight)
      frame.light = scene::turn_about_vertical(scene.light, i * step);
    else
      frame.camera.position_ws = glm::vec3(glm::dvec3(camera.position_ws) + i * step * right);
  }
  return frames;
}

std::vector<scene::LightFrustum> fit_frames(Motion motion, const scene::Scene& scene, const std::vector<Frame>& frames,
                                            const MapFollowing& following) {
  std::vector<scene::LightFrustum> frusta;
  for (const Frame& frame : frames) {
    frusta.push_back(scene::fit_light(scene, {.mode = fit_of(motion),
                                              .map_size = following.map_size,
                                              .pad_texels = following.pad_texels,
                                              .snap = following.snap,
                                              .camera = &frame.camera,
                                              .aspect = following.aspect,
                                              .light = &frame.light}));
  }
  return frusta;
}

std::vector<std::uint8_t> mark_receivers(const truth::ReceiverImage& receivers,
                                         const std::vector<scene::LightFrustum>& frusta, int map_size,
                                         double pad_texels) {
  std::vector<std::uint8_t> marked;
  for (const truth::ReceiverPoint& point : receivers.points) {
    const bool counts =
        point.counts && std::ranges::all_of(frusta, [&](const scene::LightFrustum& frustum) {
          return glm::dot(glm::dvec3(point.normal_ws), frustum.to_light(glm::dvec3(point.position_ws))) >
                     double{filters::kFacesLight} &&
                 lies_inside(frustum.place(glm::dvec3(point.position_ws), map_size), map_size, pad_texels);
        });
    marked.push_back(counts ? 1 : 0);
  }
  return marked;
}

std::optional<double> measure_grid_move(const truth::ReceiverImage& receivers, const std::vector<std::uint8_t>& marked,
                                        const std::vector<scene::LightFrustum>& frusta, int map_size) {
  std::vector<double> moves;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (!marked[i]) continue;
    glm::dvec3 before = frusta.front().place(glm::dvec3(receivers.points[i].position_ws), map_size);
    for (std::size_t t = 1; t < frusta.size(); ++t) {
      const glm::dvec3 now = frusta[t].place(glm::dvec3(receivers.points[i].position_ws), map_size);
      moves.push_back(std::hypot(leave_out_whole(now.x - before.x), leave_out_whole(now.y - before.y)));
      before = now;
    }
  }
  if (moves.empty()) return std::nullopt;
  const auto middle = moves.begin() + static_cast<std::ptrdiff_t>(moves.size() / 2);
  std::ranges::nth_element(moves, middle);
  return *middle;
}

int count_resizes(const std::vector<scene::LightFrustum>& frusta) {
  int count = 0;
  for (std::size_t t = 1; t < frusta.size(); ++t)
    if (std::abs(frusta[t].texel_size_ws / frusta[t - 1].texel_size_ws - 1.0) > 1e-6) ++count;
  return count;
}

double choose_step(Motion motion, const scene::Scene& scene, const truth::ReceiverImage& receivers,
                   MapFollowing following) {
  constexpr double kTrial_rad = 1e-4;  // far below a texel's turn in any map that a GL can give
  following.snap = false;
  const bool light = motion == Motion::kLight;
  const auto frusta = fit_frames(motion, scene, make_frames(motion, scene, light ? kTrial_rad : 0.0, 2), following);
  if (!light) return kStepTexels * frusta.front().texel_size_ws;
  const auto moved =
      measure_grid_move(receivers, mark_receivers(receivers, frusta, following.map_size, following.pad_texels), frusta,
                        following.map_size);
  if (!moved)
    throw Error(ErrorKind::kInput,
                fmt::format("{}: no surface in view faces the light; choose another scene", scene.name));
  constexpr double kLeast = 1e-6;
  if (*moved < kLeast) {
    throw Error(ErrorKind::kInput, fmt::format("{}: turning the light about the vertical moves nothing, it stands "
                                               "overhead; choose another scene, or --motion camera",
                                               scene.name));
  }
  return kTrial_rad * kStepTexels / *moved;
}

}  // namespace shadowbench::flicker
