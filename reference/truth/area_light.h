#pragma once

#include <glm/glm.hpp>

namespace shadowbench::truth {

/// A light with a size, for tracing: a disk at infinity (the sun), or a disk or rectangle in the scene.
class AreaLight {
 public:
  /// A disk at infinity. `to_light` need not be of unit length; diameter 0 is a point.
  static AreaLight make_sun(const glm::dvec3& to_light, double angular_diameter_deg);

  /// A disk of `radius_m` around `centre_ws`, perpendicular to `axis`.
  static AreaLight make_disk(const glm::dvec3& centre_ws, const glm::dvec3& axis, double radius_m);

  /// A rectangle around `centre_ws`, spanned by two half edges.
  static AreaLight make_rectangle(const glm::dvec3& centre_ws, const glm::dvec3& half_u, const glm::dvec3& half_v);

  /// A point of the light in units of half_u() and half_v(); `sample` in [0,1)^2, equal areas for equal areas.
  glm::dvec2 map_sample(const glm::dvec2& sample) const;

  /// The way from a point to the light's centre.
  glm::dvec3 centre_direction(const glm::dvec3& from) const;

  const glm::dvec3& half_u() const { return u_; }  ///< from the centre to the edge
  const glm::dvec3& half_v() const { return v_; }

  /// Where the light ends, in units of centre_direction(): 1, or infinity.
  float reach() const;

 private:
  enum class Shape { kSun, kDisk, kRectangle };
  Shape shape_ = Shape::kSun;
  glm::dvec3 centre_{0.0, 1.0, 0.0};  ///< direction for the sun, else a point
  glm::dvec3 u_{0.0};
  glm::dvec3 v_{0.0};
};

}  // namespace shadowbench::truth
