#pragma once

#include <optional>
#include <span>
#include <string>

#include "harness/scene/framing.h"
#include "harness/scene/shadow_edges.h"

namespace shadowbench::scene {

/// The view that was chosen for a scene, and what it shows.
struct ViewChoice {
  ViewAngles angles;
  EdgeCount edges{};
  bool is_usual = true;
  EdgeCount usual_edges{};  ///< in the usual view
  int tried = 0;            ///< views; none in a scene of too many triangles

  /// Whether the edge of any shadow is seen; of a view that was not tried nothing is known.
  bool shows_edges() const { return tried == 0 || edges.at_edge > 0; }
};

/// What may be chosen of a scene.
struct ViewFreedom {
  bool camera = false;              ///< else the cameras of the scene
  bool sun = false;                 ///< else the lights of the scene
  std::optional<float> ground_y{};  ///< of a floor that will be added
};

/// Chooses camera and sun so that edges of shadows touch as many of the receivers as they can (EdgeCount::share).
///
/// Tried are eight directions of the camera around the scene in two heights, and eight of the sun in two heights, each
/// with each, or what of it is free; the usual view (see usual_view) is the first of them, and stays the choice unless
/// another is better. The same view is chosen whatever the picture's size: what is counted is a picture of 16:9. Of
/// several cameras or lights of the scene itself all are counted. A scene of more than 2 million triangles gets the
/// usual view. Cost: 0.3 s for 134 000 triangles.
///
/// Requires validated geometry, and `scene.light` to be a sun where that is free.
ViewChoice choose_view(const Scene& scene, const ViewFreedom& free);

/// The choice in words, for the user; where no edge is seen, with what to do.
std::string describe_choice(const ViewChoice& choice, const ViewFreedom& free);

}  // namespace shadowbench::scene
