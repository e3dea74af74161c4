#include "filters/moments.h"

namespace shadowbench::filters {

ScalarModel make_msm_packed64_model() {
  return make_templated_model<PackedMoments<packed_moments::Levels{65536, 65536, 65536, 65536}>::Filter>();
}

}  // namespace shadowbench::filters
