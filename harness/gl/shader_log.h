#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shadowbench::gl {

/// One line of a compiler's log.
struct Complaint {
  std::string file = {};  ///< of ShaderSource::files; empty where the driver named none
  int line = 0;
  std::string text = {};  ///< without the word error
  bool is_error = false;

  /// "file:line"
  std::string where() const;
};

/// A compiler's complaints in terms of the user's own files.
struct ShaderLog {
  std::string where;    ///< "file:line" of the first error, or empty where the driver named none
  std::string message;  ///< the first error without its place, then the other lines as "file:line: error: ..."
  std::vector<Complaint> complaints;  ///< all lines, in their order
};

/// Translates a driver's info log: "2:14(5): error: x" (Mesa), "2(14) : error C1: x" (NVIDIA) and
/// "ERROR: 2:14: x" (AMD, Intel, glslang), where 2 indexes `files` unless the line itself
/// does (kLinesPerFile in shader_source.h). Lines in no such form are kept as they are.
ShaderLog translate_log(std::string_view log, const std::vector<std::string>& files);

}  // namespace shadowbench::gl
