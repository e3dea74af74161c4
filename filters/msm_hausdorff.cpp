#include "filters/moments.h"

namespace shadowbench::filters {

std::unique_ptr<ScalarModel> make_msm_hausdorff_model() {
  return make_templated_model<FourMoments<Depths::kInRange>::Filter>();
}

}  // namespace shadowbench::filters
