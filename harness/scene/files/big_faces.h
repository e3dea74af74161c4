#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace shadowbench::scene {

/// Cuts a polygon into triangles: corners 3i to 3i+2 of the result are those of triangle i, in the polygon's own sense.
/// Shape: flat, more or less; one that touches or crosses itself gives triangles that overlap.
/// Cost: 3n tests for ears at most, each of which looks at the corners near the ear; for the usual shapes n log n.
/// Source: Eberly 2002, Triangulation by Ear Clipping; only the reflex corners are tested, and they lie in a grid.
std::vector<std::uint32_t> triangulate(const std::vector<glm::dvec3>& corners);

/// Writes the faces of an .obj file that have hundreds of corners as triangles, because the parser's time grows with
/// the square of their number; all other lines stay. Throws kInput, with the line, for an index of such a face that
/// names no vertex. Requires finite coordinates, and indices that are whole numbers.
std::string split_big_faces(std::string text, const std::string& where);

}  // namespace shadowbench::scene
