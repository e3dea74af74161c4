#include "filters/moments.h"

namespace shadowbench::filters {

ScalarModel make_evsm4_model() { return make_templated_model<WarpedVariance<2>::Filter>(); }

}  // namespace shadowbench::filters
