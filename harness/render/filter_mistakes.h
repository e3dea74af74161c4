#pragma once

#include <vector>

#include "harness/gl/program.h"

namespace shadowbench::render {

/// Says what is wrong with a filter, in terms of its own file: for each complaint the file and line, what is meant, and
/// the line as it stands there. Unknown names are followed by near ones among those that a filter may use. What the
/// compiler concludes from an error before it in the same line is left out. `pieces` are those of filter_pieces(), and
/// `shader` is what was compiled of them.
Error explain_mistakes(const gl::CompileError& error, const std::vector<gl::Piece>& pieces,
                       const gl::ShaderSource& shader);

}  // namespace shadowbench::render
