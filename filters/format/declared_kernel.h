#pragma once

#include "filters/filter_spec.h"
#include "filters/kernel.h"

namespace shadowbench::filters {

/// Makes a declared kernel. Requires complete values.
Kernel make_kernel(const DeclaredKernel& declared, const ParamValues& values);

}  // namespace shadowbench::filters
