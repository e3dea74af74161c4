#include "filters/moments.h"

namespace shadowbench::filters {

std::unique_ptr<ScalarModel> make_teach_evsm_model() {
  return make_templated_model<WarpedVariance<1, false>::Filter>();
}

}  // namespace shadowbench::filters
