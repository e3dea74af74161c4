#include "filters/moments.h"

namespace shadowbench::filters {

ScalarModel make_evsm2_model() { return make_templated_model<WarpedVariance<1>::Filter>(); }

}  // namespace shadowbench::filters
