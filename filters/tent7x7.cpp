#include "filters/texel_pairs.h"

namespace shadowbench::filters {

ScalarModel make_tent7x7_model() { return make_templated_model<TrianglePairs<4>::Filter>(); }

}  // namespace shadowbench::filters
