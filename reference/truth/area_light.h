#pragma once

#include <glm/glm.hpp>

namespace shadowbench::truth {

/// A light with a size, for tracing: a disk at infinity (the sun), or a disk, rectangle or sphere in the scene.
class AreaLight {
 public:
  enum class Shape { kSun, kDisk, kRectangle, kSphere };

  /// The rays from one point: centre_direction() + x u + y v for (x, y) of map_sample(), unless `cap` bends them.
  struct Aim {
    glm::dvec3 u{0.0};
    glm::dvec3 v{0.0};
    float cap = 0.0f;  ///< see RayFan::cap; 1: the point lies inside a sphere
  };

  /// A disk at infinity. `to_light` need not be of unit length; diameter 0 is a point.
  static AreaLight make_sun(const glm::dvec3& to_light, double angular_diameter_deg);

  /// A disk of `radius_m` around `centre_ws`, perpendicular to `axis`.
  static AreaLight make_disk(const glm::dvec3& centre_ws, const glm::dvec3& axis, double radius_m);

  /// A rectangle around `centre_ws`, spanned by two half edges.
  static AreaLight make_rectangle(const glm::dvec3& centre_ws, const glm::dvec3& half_u, const glm::dvec3& half_v);

  /// A sphere of `radius_m` around `centre_ws`; radius 0 is a point. Its rays are spread evenly over the solid angle
  /// that it fills, and end where they meet its surface. A receiver inside sees all of it, whatever is around.
  static AreaLight make_sphere(const glm::dvec3& centre_ws, double radius_m);

  /// A point of the light in units of aim(); `sample` in [0,1)^2, equal areas for equal areas, of a sphere equal solid
  /// angles.
  glm::dvec2 map_sample(const glm::dvec2& sample) const;

  /// The way from a point to the light's centre.
  glm::dvec3 centre_direction(const glm::dvec3& from) const;

  /// Where the rays from a point go.
  Aim aim(const glm::dvec3& from) const;

  /// The axis of a flat light, unit length; of a sphere, and of a rectangle without an area, 0.
  const glm::dvec3& axis() const { return axis_; }

  Shape shape() const { return shape_; }
  const glm::dvec3& half_u() const { return u_; }  ///< from the centre to the edge
  const glm::dvec3& half_v() const { return v_; }

  /// Where the light's centre is, in units of centre_direction(): 1, or infinity.
  float reach() const;

 private:
  AreaLight(Shape shape, const glm::dvec3& centre, const glm::dvec3& axis, const glm::dvec3& u, const glm::dvec3& v)
      : shape_(shape), centre_(centre), axis_(axis), u_(u), v_(v) {}

  Shape shape_;
  glm::dvec3 centre_;  ///< direction for the sun, else a point
  glm::dvec3 axis_;
  glm::dvec3 u_;
  glm::dvec3 v_;
};

}  // namespace shadowbench::truth
