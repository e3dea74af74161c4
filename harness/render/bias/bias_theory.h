#pragma once

#include <functional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "filters/receiver.h"
#include "harness/render/bias/bias_rule.h"

namespace shadowbench::render {

/// What theory asks of a kernel that reaches so many texels, on a plane.
struct BiasTheory {
  double reach_texels = 0.0;     ///< from the receiver to the centre of the farthest texel that counts, per axis
  double slope_per_texel = 0.0;  ///< |dz/du| + |dz/dv|, in depth
  double larger_slope = 0.0;     ///< the larger of the two
  double n_dot_l = 1.0;
  double texel_m = 0.0;  ///< at the receiver: under a lamp it grows with the distance

  /// How far the plane's depth changes within the kernel; what an offset along the light has to cover.
  double depth() const { return reach_texels * slope_per_texel; }
};

/// The theory of a kernel with this reach on a receiver's plane.
BiasTheory make_theory(double reach_texels, const filters::Receiver& receiver);

/// One mode of bias as it is swept.
struct SweptMode {
  std::string name;                                     ///< as `--bias` has it
  std::string key;                                      ///< whose amount is swept; empty: the mode takes none
  std::string meaning;                                  ///< one sentence
  std::function<double(const BiasTheory&)> amount;      ///< theoretical, in the key's unit
  std::function<double(const BiasTheory&)> lift_depth;  ///< how far that moves a receiver with these slopes, in depth

  /// The rule that `--bias NAME:KEY=amount` stands for; `amount` is not used where the mode takes none.
  BiasRule make_rule(double amount) const;
};

/// The theory of the receiver that needs more of a mode than a `share` of all receivers do. Of two that need the same,
/// the one on the steeper plane counts as needing more. Requires a mode with an amount, and receivers.
BiasTheory find_theory(const SweptMode& mode, double reach_texels, const std::vector<filters::Receiver>& receivers,
                       double share);

/// Lists all modes: those with an amount first.
const std::vector<SweptMode>& swept_modes();

}  // namespace shadowbench::render
