// Stands in for webgl.cpp where SHADOWBENCH_WITH_LIVE_PAGE is off, or its libraries were not found.
#include "harness/spirv/webgl.h"

namespace shadowbench::spirv {

bool can_translate_to_webgl() { return false; }

std::string translate_to_webgl(const gl::ShaderSource&, Stage) { return {}; }

}  // namespace shadowbench::spirv
