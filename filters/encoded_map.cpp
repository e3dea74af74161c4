#include "filters/encoded_map.h"

#include <tbb/parallel_for.h>

namespace shadowbench::filters {

void visit_rows(int rows, const std::function<void(int row)>& visit) { tbb::parallel_for(0, rows, visit); }

}  // namespace shadowbench::filters
