#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shadowbench::gl {

/// Line numbers tell the files apart: line 14 of file 2 is `#line 200014 2`. The index alone is not enough, since Mesa
/// reports file 0 for all errors but those of syntax.
inline constexpr int kLinesPerFile = 100'000;

/// One shader stage, ready to compile.
struct ShaderSource {
  std::string text;                ///< GLSL from `#version` on; `#line` directives say file and line, see kLinesPerFile
  std::vector<std::string> files;  ///< names for messages; 0 is what the program itself puts on top
};

/// Text that stands in for a file, such as a filter's GLSL without its front matter.
struct Piece {
  std::string include_name;  ///< what `#include "..."` calls it
  std::string text;
  std::string display_name;  ///< what messages call it: the file that the user wrote
  int first_line = 1;        ///< the number of `text`'s first line in that file
};

/// What `build_source` is to build.
struct SourceOptions {
  std::vector<std::filesystem::path> roots;                  ///< folders that includes are looked up in, in order
  std::string main_file;                                     ///< relative to a root, or a piece's include name
  std::vector<std::pair<std::string, std::string>> defines;  ///< name, value; put right after `#version`
  std::vector<Piece> pieces;                                 ///< taken before files of the same name
};

/// Puts a shader together: `#version 450 core`, the defines, then `main_file` with every `#include "..."` replaced by
/// what it names, once each. Every piece keeps its own line numbers.
/// Throws Error with file and line of the include: kFilter inside a piece, kInput in a file of ours; for a name that no
/// root has or that leaves the roots, a circle of includes, a malformed include, a comment left open, a `#version` or a
/// `#line` in the text, a NUL byte, or a text of kLinesPerFile lines.
ShaderSource build_source(const SourceOptions& options);

/// Returns one of this folder's own shaders (`*.vert`, `*.frag`), which are compiled into the program: unlike those in
/// `shaders/` they belong to the GL layer, and it works without any folder at hand.
/// Throws std::logic_error for a name that is not there.
ShaderSource embedded_source(const std::string& name);

}  // namespace shadowbench::gl
