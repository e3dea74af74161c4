#include "filters/moments.h"

namespace shadowbench::filters {

std::unique_ptr<ScalarModel> make_evsm2_model() { return make_templated_model<WarpedVariance<1>::Filter>(); }

}  // namespace shadowbench::filters
