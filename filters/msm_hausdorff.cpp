#include "filters/moments.h"

namespace shadowbench::filters {

ScalarModel make_msm_hausdorff_model() { return make_templated_model<FourMoments<Depths::kInRange>::Filter>(); }

}  // namespace shadowbench::filters
