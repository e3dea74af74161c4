#include "filters/texel_pairs.h"

namespace shadowbench::filters {

ScalarModel make_castano5_model() { return make_templated_model<SlidingPairs<1, 3, 4, 3, 1>::Filter>(); }

}  // namespace shadowbench::filters
