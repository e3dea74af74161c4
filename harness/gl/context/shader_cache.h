#pragma once

#include <string>

namespace shadowbench::gl {

/// Switches Mesa's cache of shaders off where its disk is nearly full: Mesa maps its index into memory, and a page that
/// the disk cannot hold ends the program with SIGBUS. Returns why, or an empty text where the cache stays on. To be
/// called before the first context.
std::string disable_shader_cache_on_full_disk();

}  // namespace shadowbench::gl
