#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/scene/scene.h"
#include "reference/truth/occluders.h"
#include "reference/truth/visibility.h"

namespace shadowbench::scene {

/// How many pixels of a view show a surface, and how many of these touch the edge of a shadow.
struct EdgeCount {
  int pixels = 0;
  int surfaces = 0;  ///< lit, in a shadow, or turned away from the light
  int at_edge = 0;
  int lit = 0;  ///< the light's centre is seen from them

  /// The share of the surfaces that touch an edge, in [0,1]. They are taken for half the picture where they are fewer:
  /// a view that shows little does not win by a few pixels, and neither does one of sides that face away from the
  /// light.
  double share() const;

  EdgeCount& operator+=(const EdgeCount& other);  ///< of another view
};

/// A ray through a scene; its direction is of any length.
struct SceneRay {
  glm::dvec3 origin;
  glm::dvec3 direction;
};

/// The light's penumbra at a place on the edge of a shadow.
struct EdgePenumbra {
  glm::vec3 position_ws{0.0f};
  double width_ws = 0.0;  ///< from where all of the light is seen to where none is, across the light's way; metres
};

/// Finds the edges of shadows in coarse views of a scene, by one ray for each pixel and one to the light's centre.
class EdgeMeter {
 public:
  /// Cost: see truth::Occluders.
  explicit EdgeMeter(const Scene& scene);

  /// Takes a floor in place of the last one, or takes that away.
  void set_floor(const Mesh* floor);

  /// Points of the surfaces that a lamp shines on, but for those beyond twice their median distance.
  std::vector<glm::vec3> find_lit_points(const Beam& lamp) const;

  /// What each ray meets: a point that does not count where that is nothing.
  std::vector<truth::ReceiverPoint> trace(std::span<const SceneRay> rays) const;

  static constexpr int kCoarseWidth = 96;

  /// Counts in a picture of so many pixels across and the given width / height. Two pixels beside each other touch an
  /// edge where one is lit and the other is not, and both are receivers on the same smooth surface: their normals
  /// differ by less than about 25 degrees, and each lies near the other's plane. Safe to call from many threads.
  EdgeCount count(const Camera& camera, const Light& light, double aspect, int width = kCoarseWidth) const;

  /// The penumbrae of the pixels in shadow that touch an edge, as the light's size and the surface that the light meets
  /// first make them, by similar triangles; in a finer picture than count() takes. Cost: a third ray for each of them.
  std::vector<EdgePenumbra> list_penumbrae(const Camera& camera, const Light& light, double aspect) const;

 private:
  /// Surfaces that are traced together.
  struct Part {
    truth::Occluders surfaces;
    bool casts_shadow;
  };

  std::vector<Part> parts_;
  std::optional<Part> floor_;

  /// Pixels on either side of an edge.
  struct Edges {
    std::vector<bool> lit;
    std::vector<bool> dark;
    int lit_receivers = 0;  ///< at an edge or not
  };

  std::vector<const Part*> parts() const;
  truth::ReceiverImage look(const Camera& camera, double aspect, int width) const;
  Edges find_edges(truth::ReceiverImage& seen, const Light& light) const;
};

/// Whether any of these views, of the given width / height, shows a surface that the scene's one light reaches. Cost:
/// about that of building the scene's acceleration structure.
bool is_light_in_view(const Scene& lit, std::span<const Camera> views, double aspect);

/// Where a scene is seen from, and where its sun stands.
struct ViewAngles {
  SkyAngles camera;
  SkyAngles sun;
};

/// Returns the first view to try of a scene of these bounds: from three quarters (along a scene much longer than wide)
/// and 24 degrees above. The sun is 50 degrees high, to the right of the view and a little to the front, so that
/// shadows fall to the left.
ViewAngles usual_view(const Bounds& bounds);

/// Returns a camera that looks at the scene's meshes from a place around them, as near as it can while every vertex
/// stays inside a picture of the given width / height. Where `ground_y` is given, the shadows that the meshes throw on
/// that plane are inside as well.
/// Requires at least one vertex. Reads the meshes and the light of `scene` only.
Camera frame_camera(const Scene& scene, const SkyAngles& from, double aspect, std::optional<float> ground_y);

/// Returns a camera that stands in a scene, as one walks through it: at eye height above a floor of its own, from where
/// one sees farthest, looking along that way. Eyes are 1.7 m high, but 1/20 to 1/4 of the scene's height. Nothing where
/// the scene has no floor under most of its middle. Cost: 4096 rays.
std::optional<Camera> find_walk_through(const Scene& scene);

/// How many quads a floor has along each side.
inline constexpr int kFloorCells = 32;

/// Returns the mesh of a floor: that of a plane of this size and place in a scene file.
Mesh make_floor(const Floor& floor);

/// The view that was chosen for a scene, and what it shows.
struct ViewChoice {
  ViewAngles angles;
  EdgeCount edges{};
  bool is_usual = true;
  EdgeCount usual_edges{};            ///< in the usual view
  int tried = 0;                      ///< views; none in a scene of too many triangles
  std::vector<glm::vec3> near_light;  ///< what the camera frames; empty: the whole scene

  /// Whether the edge of any shadow is seen; of a view that was not tried nothing is known.
  bool shows_edges() const { return tried == 0 || edges.at_edge > 0; }
};

/// What may be chosen of a scene.
struct ViewFreedom {
  bool camera = false;              ///< else the cameras of the scene
  bool sun = false;                 ///< else the lights of the scene
  std::optional<float> ground_y{};  ///< of a floor that will be added
};

/// Chooses camera and sun so that edges of the light's shadows touch as many of the surfaces as they can
/// (EdgeCount::share): of eight directions of each in two heights, or what of it is free; of a lamp that stands in the
/// scene each also of what it shines on near by. Views towards the light and thin ones are left out. The usual view
/// stays unless another is better. Counts are of a picture of 16:9, so that the directions do not depend on a picture's
/// size; of all cameras of the scene, and of its first light. More than 2^20 triangles get the usual view.
/// Requires validated geometry, and cameras where they are not free. Cost: 0.6 s of CPU time for 300 000 triangles.
ViewChoice choose_view(const Scene& scene, const ViewFreedom& free);

/// The choice in words, for the user; where no edge is seen, with what to do. `light` names the one of several.
std::string describe_choice(const ViewChoice& choice, const ViewFreedom& free, const std::string& light = {});

/// What a scene gets beside its geometry.
struct Completion {
  bool needs_sun = false;            ///< it has no light
  bool ground = false;               ///< put a floor under it
  double aspect = 16.0 / 9.0;        ///< width / height of the picture that a chosen camera fills
  std::optional<SkyAngles> light{};  ///< put every light there
};

/// Returns a checked scene that has all it lacked: a sun, a camera for each light that has none, called as the light
/// where there are several (choose_view(), or find_walk_through() in a long scene with a floor of its own), and a
/// floor. What the scene has, and a place that was asked for, stays; lights of intensity 0 are left out with a warning.
/// Requires validated geometry. Throws kInput, at `where`, as validate() does.
Scene complete(Scene scene, Completion completion, const std::string& where);

}  // namespace shadowbench::scene
