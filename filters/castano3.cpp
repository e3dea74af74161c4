#include "filters/texel_pairs.h"

namespace shadowbench::filters {

ScalarModel make_castano3_model() { return make_templated_model<SlidingPairs<1, 2, 1>::Filter>(); }

}  // namespace shadowbench::filters
