#include "filters/texel_pairs.h"

namespace shadowbench::filters {

ScalarModel make_teach4x4_model() { return make_templated_model<FourTaps<2>::Filter>(); }

}  // namespace shadowbench::filters
