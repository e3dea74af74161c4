#pragma once

#include <vector>

#include "filters/catalogue.h"
#include "harness/gl/program.h"
#include "harness/gl/shader_source.h"
#include "harness/render/light_setup.h"

namespace shadowbench::render {

/// The first texture unit of the maps of passes; shaders/lib has the units below.
inline constexpr GLuint kFirstPassUnit = 10;

/// The pieces "filter_parameters" and "filter" that lookup.frag and encode.frag include: constants for `const`
/// parameters (a choice becomes its index, with one name per choice, ROTATION_PER_PIXEL), uniforms for the others,
/// tables of points, and the filter's own GLSL with the line numbers of its file.
std::vector<gl::Piece> filter_pieces(const filters::FilterRequest& request);

/// Sets what every program that holds a filter's GLSL is told: the light, the seed, and the parameters that are not
/// `const`.
void set_uniforms(gl::Program& program, const filters::FilterRequest& request, const LightSetup& light);

}  // namespace shadowbench::render
