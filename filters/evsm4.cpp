#include "filters/moments.h"

namespace shadowbench::filters {

std::unique_ptr<ScalarModel> make_evsm4_model() { return make_templated_model<WarpedVariance<2>::Filter>(); }

}  // namespace shadowbench::filters
