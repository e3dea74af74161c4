#include "filters/moments.h"

namespace shadowbench::filters {

ScalarModel make_teach_evsm_model() { return make_templated_model<WarpedVariance<1, false>::Filter>(); }

}  // namespace shadowbench::filters
