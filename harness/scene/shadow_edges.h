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

}  // namespace shadowbench::scene
