#include "filters/texel_pairs.h"

namespace shadowbench::filters {

ScalarModel make_tent4x4_model() { return make_templated_model<TrianglePairs<2>::Filter>(); }

}  // namespace shadowbench::filters
