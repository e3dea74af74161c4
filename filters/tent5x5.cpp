#include "filters/texel_pairs.h"

namespace shadowbench::filters {

ScalarModel make_tent5x5_model() { return make_templated_model<TrianglePairs<3>::Filter>(); }

}  // namespace shadowbench::filters
