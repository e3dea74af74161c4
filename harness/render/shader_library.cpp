#include "harness/render/shader_library.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "harness/gl/fullscreen.h"

namespace shadowbench::render {
namespace {

/// Names a variant for people and drivers, who do not need the values.
std::string variant_name(const std::string& file, const Defines& defines) {
  std::string name = file;
  for (const auto& [key, value] : defines) name += " " + key;
  return name;
}

/// The line of a filter that first has a word; its last one where none has.
std::ptrdiff_t find_line(const gl::Piece& filter, std::string_view word) {
  const auto end =
      filter.text.begin() + static_cast<std::ptrdiff_t>(std::min(filter.text.find(word), filter.text.size()));
  return filter.first_line + std::count(filter.text.begin(), end, '\n');
}

/// Drivers say which function calls itself, as in "function `float f(int)' has static recursion", but not where.
Error blame_recursion(const std::string& message, const gl::Piece& filter) {
  const std::size_t parenthesis = message.find('(', message.find('`'));
  const std::size_t blank = message.rfind(' ', parenthesis);
  const bool is_named = parenthesis != std::string::npos && blank != std::string::npos;
  const std::string name = is_named ? message.substr(blank + 1, parenthesis - blank - 1) : std::string();
  return Error(ErrorKind::kFilter,
               fmt::format("{} calls itself, directly or through others, and GLSL has no recursion: write a loop",
                           is_named ? "'" + name + "'" : "a function"),
               fmt::format("{}:{}", filter.display_name, find_line(filter, name)));
}

/// The compiler notices a missing brace only in the code after the filter's; the message names the end of the filter
/// instead.
Error blame_filter(const Error& error, const gl::Piece& filter) {
  if (error.kind() != ErrorKind::kFilter || error.where().rfind(filter.display_name, 0) == 0) return error;
  if (error.message().find("recursion") != std::string::npos) return blame_recursion(error.message(), filter);
  const auto lines = std::count(filter.text.begin(), filter.text.end(), '\n');
  return Error(
      ErrorKind::kFilter,
      fmt::format("the GLSL breaks the code after it, at or before this line (a missing brace, or a name that the "
                  "program uses itself?): {}",
                  error.message()),
      fmt::format("{}:{}", filter.display_name, filter.first_line + static_cast<int>(lines) - 1));
}

}  // namespace

gl::ShaderSource ShaderLibrary::source(const std::string& file, const Defines& defines,
                                       const std::vector<gl::Piece>& pieces) const {
  gl::SourceOptions options;
  options.roots = {folder_};
  options.main_file = file;
  options.defines = defines;
  options.pieces = pieces;
  return gl::build_source(options);
}

gl::Program& ShaderLibrary::fullscreen(const std::string& fragment_file, const Defines& defines) {
  return keep(
      fragment_file, defines,
      [&] {
        return gl::Program(variant_name(fragment_file, defines), gl::FullscreenTriangle::vertex_source(),
                           source(fragment_file, defines, {}));
      });
}

gl::Program& ShaderLibrary::geometry(const std::string& shader, const Defines& defines) {
  return keep(
      shader, defines,
      [&] {
        const bool has_third = std::ranges::find(defines, kExactEdges) != defines.end();
        const auto third = has_third ? std::optional(source(shader + ".geom", defines, {})) : std::nullopt;
        return gl::Program(variant_name(shader, defines), source(shader + ".vert", defines, {}),
                           source(shader + ".frag", defines, {}), std::nullopt, third);
      });
}

gl::Program& ShaderLibrary::keep(const std::string& name, const Defines& defines,
                                 const std::function<gl::Program()>& compile) {
  std::string key = name;
  for (const auto& [define, value] : defines) key += fmt::format("\n{} {}", define, value);
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  ++compiled_;
  return programs_.emplace(key, compile()).first->second;
}

gl::Program ShaderLibrary::compile_filter(const std::string& label, const std::string& fragment_file,
                                          const Defines& defines, const std::vector<gl::Piece>& pieces) {
  ++compiled_;
  try {
    return gl::Program(label, gl::FullscreenTriangle::vertex_source(), source(fragment_file, defines, pieces),
                       ErrorKind::kFilter);
  } catch (const Error& error) {
    throw blame_filter(error, pieces.back());
  }
}

}  // namespace shadowbench::render
