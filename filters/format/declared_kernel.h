#pragma once

#include "base/toml.h"
#include "filters/filter_spec.h"
#include "filters/kernel.h"

namespace shadowbench::filters {

/// Reads a declared kernel: "tent:2", "disk:radius", or a table with `shape` or `weights`, and perhaps `read`.
/// Requires a spec that has its parameters. Throws Error(kFilter) with the line: an unknown shape, a size that is
/// neither a number nor a numeric parameter, or out of the shape's range; weights that are negative, not symmetric, or
/// do not sum to 1.
DeclaredKernel read_kernel(const TomlValue& value, const FilterSpec& spec);

/// Makes a declared kernel. Requires complete values.
Kernel make_kernel(const DeclaredKernel& declared, const ParamValues& values);

}  // namespace shadowbench::filters
