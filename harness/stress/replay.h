#pragma once

#include <string>
#include <vector>

#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// A mistake that a comparison of filters can make: one filter in a set-up whose map overflows.
struct Mistake {
  std::string scene;                  ///< built-in
  std::string wrong;                  ///< as --filters reads it: the set-up that overflows
  std::vector<std::string> variants;  ///< of the same filter; the first is within its limits
  std::vector<std::string> others;    ///< what it is compared with
};

/// Replays a mistake on the scene's first view: the error of every set-up against the area truth, the texels of its map
/// that overflowed, its rank in the wrong comparison (`wrong` and `others`) and in the corrected one (the first of
/// `variants` and `others`), and a grid of pictures in inputs.out. Requires inputs.renderer. Throws Error(kOutput).
/// Cost: one traced view, kept in inputs.cache.
Exhibit replay(const AxisInputs& inputs, const Mistake& mistake, const std::string& id);

}  // namespace shadowbench::stress
