#pragma once

#include <glm/glm.hpp>
#include <string_view>

#include "harness/gl/handle.h"

namespace shadowbench::gl {

/// Owns sampling state of its own, so that one texture can be compared on one unit and fetched plainly on another.
/// New ones filter nearest and clamp to the edge.
class Sampler {
 public:
  explicit Sampler(std::string_view label);

  void set_filter(GLenum minify, GLenum magnify);
  /// Sets the wrap mode of both axes, e.g. GL_CLAMP_TO_BORDER.
  void set_wrap(GLenum mode);
  void set_border(const glm::vec4& color);
  /// Compares on sampling, with GL_LEQUAL for instance; GL_NONE turns that off.
  void set_compare(GLenum function);

  /// Binds to texture unit `unit`, overriding the state of whatever texture is bound there.
  void bind(GLuint unit) const;
  /// Unbinds from a texture unit, where the texture's own state then holds again.
  static void unbind(GLuint unit);

  GLuint id() const { return handle_.id(); }

 private:
  Handle<GL_SAMPLER> handle_;
};

}  // namespace shadowbench::gl
