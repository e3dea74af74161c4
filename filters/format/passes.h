#pragma once

#include "filters/format/front_matter_reader.h"

namespace shadowbench::filters {

/// Reads the tables `[pass.NAME]`, in the order of the file. `code` is the filter's GLSL without comments, and `taken`
/// has the names of its parameters and tables of points.
void read_passes(const FrontMatterReader& reader, const toml::table& root, std::string_view code,
                 std::vector<std::string> taken, FilterSpec& spec);

}  // namespace shadowbench::filters
