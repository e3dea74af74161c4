#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"

namespace shadowbench::flicker {

/// What moves.
enum class Motion {
  kLight,   ///< the sun turns about the vertical; the map is fitted tightly, to the scene as the light sees it
  kCamera,  ///< the camera moves to its right; the map is fitted to what it sees
};

/// Names a motion as the command line does: "light".
std::string_view name_of(Motion motion);

/// Reads names, separated by commas, as the option `--motion`; each once, in the order of the text.
/// Throws Error(kUsage) with the names there are.
std::vector<Motion> parse_motions(const std::string& text);

/// The fit of the light's map that a motion is measured with.
scene::FitMode fit_of(Motion motion);

/// What stands where in one frame.
struct Frame {
  scene::Light light;
  scene::Camera camera;
};

/// Gives `count` frames, the first as the scene has it. `step` is in radians for the light, in metres for the camera.
std::vector<Frame> make_frames(Motion motion, const scene::Scene& scene, double step, int count);

/// How the light's map follows the frames.
struct MapFollowing {
  int map_size = 512;
  double pad_texels = 0.0;
  double aspect = 1.0;  ///< of the picture
  bool snap = false;
};

/// Fits the light's map to each frame.
/// Throws as scene::fit_light.
std::vector<scene::LightFrustum> fit_frames(Motion motion, const scene::Scene& scene, const std::vector<Frame>& frames,
                                            const MapFollowing& following);

/// Marks, with 1, the receivers that face the light and lie in the map, `pad_texels` from its edge, in every frame.
std::vector<std::uint8_t> mark_receivers(const truth::ReceiverImage& receivers,
                                         const std::vector<scene::LightFrustum>& frusta, int map_size,
                                         double pad_texels);

/// The median, over marked receivers and steps, of how far a receiver moves against the map's grid, in texels;
/// whole texels, which change no filter's weights, are left out along each axis. Nothing where no receiver is marked.
std::optional<double> measure_grid_move(const truth::ReceiverImage& receivers, const std::vector<std::uint8_t>& marked,
                                        const std::vector<scene::LightFrustum>& frusta, int map_size);

/// Counts the steps in which the texel's size changes by more than a millionth of it.
int count_resizes(const std::vector<scene::LightFrustum>& frusta);

/// Texels that a step moves the grid by: small enough for a shadow's edge to be seen at several places within a texel.
inline constexpr double kStepTexels = 0.125;

/// The step at which the grid moves by kStepTexels: for the light, at the median receiver that faces it; for the
/// camera, which moves by that share of a texel. `following.snap` is not used. Throws Error(kInput) where turning the
/// light moves nothing: no receiver faces it, or it stands overhead.
double choose_step(Motion motion, const scene::Scene& scene, const truth::ReceiverImage& receivers,
                   MapFollowing following);

}  // namespace shadowbench::flicker
