#include "filters/moments.h"

namespace shadowbench::filters {

ScalarModel make_msm_packed32_model() {
  return make_templated_model<PackedMoments<packed_moments::Levels{2048, 2048, 64, 16}>::Filter>();
}

}  // namespace shadowbench::filters
