#pragma once

#include "filters/format/front_matter_reader.h"

namespace shadowbench::filters {

/// Reads the tables `[pass.NAME]`, in the order of the file. `code` is the filter's GLSL without comments.
void read_passes(const FrontMatterReader& reader, const toml::table& root, std::string_view code, FilterSpec& spec);

}  // namespace shadowbench::filters
