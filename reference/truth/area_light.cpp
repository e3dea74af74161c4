#include "reference/truth/area_light.h"

#include <cmath>
#include <limits>

#include "filters/random.h"

namespace shadowbench::truth {
namespace {

/// Two unit vectors perpendicular to an axis and to each other.
struct Tangents {
  glm::dvec3 u;
  glm::dvec3 v;
};

Tangents make_tangents(const glm::dvec3& axis) {
  const glm::dvec3 n = glm::normalize(axis), a = glm::abs(n);
  const glm::dvec3 least = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
                           : a.y <= a.z             ? glm::dvec3(0, 1, 0)
                                                    : glm::dvec3(0, 0, 1);
  const glm::dvec3 u = glm::normalize(glm::cross(n, least));
  return {u, glm::cross(n, u)};
}

}  // namespace

AreaLight AreaLight::make_sun(const glm::dvec3& to_light, double angular_diameter_deg) {
  const Tangents tangents = make_tangents(to_light);
  const double radius = std::tan(0.5 * glm::radians(angular_diameter_deg));
  const glm::dvec3 axis = glm::normalize(to_light);
  return {Shape::kSun, axis, axis, radius * tangents.u, radius * tangents.v};
}

AreaLight AreaLight::make_disk(const glm::dvec3& centre_ws, const glm::dvec3& axis, double radius_m) {
  const Tangents tangents = make_tangents(axis);
  return {Shape::kDisk, centre_ws, glm::normalize(axis), radius_m * tangents.u, radius_m * tangents.v};
}

AreaLight AreaLight::make_rectangle(const glm::dvec3& centre_ws, const glm::dvec3& half_u, const glm::dvec3& half_v) {
  const glm::dvec3 normal = glm::cross(half_u, half_v);
  const double area = glm::length(normal);
  return {Shape::kRectangle, centre_ws, area > 0.0 ? normal / area : glm::dvec3(0.0), half_u, half_v};
}

AreaLight AreaLight::make_sphere(const glm::dvec3& centre_ws, double radius_m) {
  return {Shape::kSphere, centre_ws, glm::dvec3(0.0), {radius_m, 0.0, 0.0}, {0.0, radius_m, 0.0}};
}

glm::dvec2 AreaLight::map_sample(const glm::dvec2& sample) const {
  return shape_ == Shape::kRectangle ? 2.0 * sample - 1.0 : filters::map_to_disk(sample);
}

glm::dvec3 AreaLight::centre_direction(const glm::dvec3& from) const {
  return shape_ == Shape::kSun ? centre_ : centre_ - from;
}

AreaLight::Aim AreaLight::aim(const glm::dvec3& from) const {
  if (shape_ != Shape::kSphere) return {u_, v_};
  const glm::dvec3 to_centre = centre_ - from;
  const double distance = glm::length(to_centre), sine = u_.x / distance;
  if (!(sine < 1.0)) return {.cap = 1.0f};
  const double cap = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
  const Tangents tangents = make_tangents(to_centre);
  const double half = distance * std::sqrt(2.0 * cap);
  return {half * tangents.u, half * tangents.v, static_cast<float>(cap)};
}

float AreaLight::reach() const { return shape_ == Shape::kSun ? std::numeric_limits<float>::infinity() : 1.0f; }

}  // namespace shadowbench::truth
