#pragma once

#include <filesystem>
#include <string>

#include "filters/filter_spec.h"

namespace shadowbench::filters {

/// Parses the text of a filter file: TOML between `/*+++` and `+++*/`, then GLSL.
///
/// Requires `path` for messages only; its stem becomes the filter's id.
/// Throws Error(kFilter) with file and line: no front matter, malformed TOML, an unknown key, a value of the wrong
/// type, a default outside its range, no `visibility`, `store` without `encode` or the reverse.
FilterSpec parse_filter(const std::string& text, const std::filesystem::path& path);

/// Reads and parses a filter file.
/// Throws as parse_filter, and Error(kFilter) when the file cannot be read or its stem is not an identifier.
FilterSpec load_filter(const std::filesystem::path& path);

}  // namespace shadowbench::filters
