#pragma once

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Whether a mesh encloses a volume: every edge belongs to two triangles that run along it in opposite directions.
/// Corners at the same place count as one; triangles without area are passed over. Only of such a mesh does something
/// stay in a shadow map when the faces towards the light are culled. Cost: one hash table entry per edge.
bool is_closed(const Mesh& mesh);

}  // namespace shadowbench::scene
