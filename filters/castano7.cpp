#include "filters/texel_pairs.h"

namespace shadowbench::filters {

ScalarModel make_castano7_model() { return make_templated_model<SlidingPairs<1, 5, 12, 16, 12, 5, 1>::Filter>(); }

}  // namespace shadowbench::filters
