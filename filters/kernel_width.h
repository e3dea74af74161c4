#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "filters/filter_spec.h"

namespace shadowbench::filters {

// How wide a filter's kernel is: its standard deviation along an axis, reconstruction included, in texels. Filters are
// compared where their kernels are about equally wide; otherwise a comparison of filters would be one of widths.

/// Kernels that are about equally wide.
struct WidthClass {
  std::string_view name;
  double sigma_texels = 0.0;   ///< the width that it stands for
  double widest_texels = 0.0;  ///< the widest kernel that belongs to it
};

/// The classes, narrow before wide. *Sharp* is as wide as one hardware 2x2 fetch, *medium* as the 3x3 tent of four, and
/// *soft* as a disk with a radius of 3 texels, the customary one of Poisson-disk filters. A kernel belongs to the class
/// whose width is nearest to its own in ratio; soft ends where a class as far above it as it is above medium would
/// begin.
const std::array<WidthClass, 3>& width_classes();

/// The class of a kernel of this width; null where it is wider than the widest class reaches.
const WidthClass* find_width_class(double sigma_texels);

/// Lists the classes with their widths and limits: "sharp 0.41 texels, up to 0.51; ...".
std::string describe_classes();

/// The width of a filter's kernel; empty where find_kernel() finds none.
std::optional<double> find_kernel_sigma(const FilterSpec& spec, const ParamValues& values);

/// Finds the radius with which a filter's kernel is as wide as asked for, the other parameters being as in `values`.
/// `width` is the name of a class or a number of texels. Of whole-numbered radii, and of choices, it is the one whose
/// width is nearest in ratio, within the class where one is named; others are found to a thousandth of a texel.
/// Throws Error(kUsage) where the filter has no radius or no kernel, for a width that is neither, and, with the range
/// that can be reached, for one that no radius gives.
double solve_radius(const FilterSpec& spec, const ParamValues& values, const std::string& width);

}  // namespace shadowbench::filters
