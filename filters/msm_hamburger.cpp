#include "filters/moments.h"

namespace shadowbench::filters {

ScalarModel make_msm_hamburger_model() { return make_templated_model<FourMoments<Depths::kAny>::Filter>(); }

}  // namespace shadowbench::filters
