#pragma once

#include <glm/glm.hpp>

#include "harness/scene/scene.h"

namespace shadowbench::view {

// How the mouse and the keys move a camera and a light. Angles in radians, lengths in metres; a camera that was moved
// stands upright (+y), and looks nowhere straighter up or down than 89 degrees.

/// Turns a camera about a point that it goes on to show at the same place: to the right, and up over it.
scene::Camera orbit(scene::Camera camera, const glm::vec3& pivot_ws, float right_rad, float up_rad);

/// Turns a camera where it stands: to the right, and up.
scene::Camera look_around(scene::Camera camera, float right_rad, float up_rad);

/// Moves a camera along its own axes: right, up, ahead.
scene::Camera fly(scene::Camera camera, const glm::vec3& way_m);

/// Moves a camera towards a point until its distance is `factor` times what it was; an orthographic one shows so much
/// more or less.
scene::Camera approach(scene::Camera camera, const glm::vec3& pivot_ws, float factor);

/// Where a light stands in the sky, seen from what it goes round.
scene::SkyAngles find_in_sky(const scene::Light& light);

/// Moves a light across the sky by so many degrees; not beyond straight above or below.
scene::Light move_in_sky(const scene::Light& light, double azimuth_deg, double elevation_deg);

}  // namespace shadowbench::view
