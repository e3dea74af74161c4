#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/toml.h"
#include "filters/filter_spec.h"
#include "filters/kernel.h"

namespace shadowbench::filters {

/// The keys that front matter may have: by table, "" being the root.
const std::map<std::string, std::vector<std::string>>& front_matter_keys();

/// Parses the text of a filter file: TOML between `/*+++` and `+++*/`, then GLSL.
///
/// Requires `path` for messages only; its stem becomes the filter's id.
/// Throws Error(kFilter) with file and line: no front matter, malformed TOML, an unknown key, a value of the wrong
/// type, a default outside its range, no `visibility`, `store` without `encode` or the reverse.
FilterSpec parse_filter(const std::string& text, const std::filesystem::path& path);

/// Reads and parses a filter file.
/// Throws as parse_filter, and Error(kFilter) when the file cannot be read or its stem is not an identifier.
FilterSpec load_filter(const std::filesystem::path& path);

/// Reads a declared kernel: "tent:2", "disk:radius", or a table with `shape` or `weights`, and perhaps `read`.
/// Requires a spec that has its parameters. Throws Error(kFilter) with the line: an unknown shape, a size that is
/// neither a number nor a numeric parameter, or out of the shape's range; weights that are negative, not symmetric, or
/// do not sum to 1.
DeclaredKernel read_kernel(const TomlValue& value, const FilterSpec& spec);

/// Makes a declared kernel. Requires complete values.
Kernel make_kernel(const DeclaredKernel& declared, const ParamValues& values);

}  // namespace shadowbench::filters
