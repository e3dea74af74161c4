#include "filters/texel_pairs.h"

namespace shadowbench::filters {

ScalarModel make_tent3x3_model() { return make_templated_model<FourTaps<1>::Filter>(); }

}  // namespace shadowbench::filters
