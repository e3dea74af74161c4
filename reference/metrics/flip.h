#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace shadowbench::metrics {

/// A low-dynamic-range picture: linear RGB (Rec. 709 primaries, D65), clamped to [0,1], row by row.
struct LinearPicture {
  int width = 0;
  int height = 0;
  std::vector<glm::vec3> pixels;  ///< width * height
};

/// The viewing condition that FLIP is published for: a 0.7 m wide 4K display seen from 0.7 m.
inline constexpr double kDefaultPixelsPerDegree = 67.0;

/// What an observer sees of one picture: made once, it is compared with many.
struct FlipView {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec3> colors;  ///< blurred as by the eye, in Hunt-adjusted CIELAB
  std::vector<double> edges;       ///< strength of the luminance's first derivative
  std::vector<double> points;      ///< strength of its second derivative
};

/// Looks at a picture from a distance. Requires finite pixels. Cost: about 0.2 s per megapixel on one core.
FlipView view_for_flip(const LinearPicture& picture, double pixels_per_degree = kDefaultPixelsPerDegree);

/// The LDR-FLIP difference of two pictures per pixel, in [0,1]: 0 where an observer who flips between them at
/// this viewing distance sees no change. Symmetric in its arguments.
///
/// Source: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild 2020, FLIP: A Difference Evaluator for
/// Alternating Images, HPG; the constants are the published ones. Borders are replicated.
/// Requires two pictures of one size, seen from one distance.
std::vector<float> measure_flip(const FlipView& a, const FlipView& b);

}  // namespace shadowbench::metrics
