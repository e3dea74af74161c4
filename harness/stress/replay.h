#pragma once

#include <string>
#include <vector>

#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// A mistake that a comparison of filters can make: one filter in a set-up whose map overflows.
struct Mistake {
  std::string scene;                ///< built-in
  std::vector<std::string> setups;  ///< as --filters reads them: the one that overflows, the corrected one, and more
  std::vector<std::string> others;  ///< what it is compared with
};

/// Replays a mistake on the scene's first view: the error of every set-up against the area truth, the texels of its map
/// that overflowed, its rank in the wrong comparison (the first of `setups` and `others`) and in the corrected one (the
/// second and `others`), and a grid of pictures in inputs.out. Requires inputs.renderer. Throws Error(kOutput).
/// Cost: one traced view, kept in inputs.cache.
Exhibit replay(const AxisInputs& inputs, const Mistake& mistake, const std::string& id);

}  // namespace shadowbench::stress
