#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>

#include "harness/gl/texture.h"

namespace shadowbench::gl {

// The GL objects, with those of texture.h. They are move-only, labelled, made by direct state access, and die with
// their scope, which must lie inside the life of their context. Ids are for harness/gl and harness/render; they cross
// no other folder's signatures.

/// Owns a buffer of fixed size and contents in GL memory.
class Buffer {
 public:
  /// Makes a buffer that holds a copy of `bytes`, e.g. `std::as_bytes(std::span(vertices))`.
  /// Throws Error(kContext) when memory runs out.
  Buffer(std::string_view label, std::span<const std::byte> bytes);

  std::size_t size() const { return size_; }
  GLuint id() const { return handle_.id(); }

 private:
  Handle<GL_BUFFER> handle_;
  std::size_t size_ = 0;
};

/// Owns a set of textures to draw into. Requires: the textures live as long as it is drawn into.
class Framebuffer {
 public:
  static constexpr int kMaxColors = 8;

  explicit Framebuffer(std::string_view label);

  /// Draws fragment output `index` (0 to 7) into `texture`.
  void attach_color(int index, const Texture& texture, int level = 0);
  void attach_depth(const Texture& texture);

  /// Makes it the draw target and sets the viewport to the whole of it.
  /// Throws std::logic_error when it is incomplete, Error(kContext) when this GL cannot draw into such textures.
  void bind();

  /// Clears one colour texture. Requires: colour mask open, scissor test off.
  void clear_color(int index, const glm::vec4& color);
  /// Clears the depth texture. Requires: depth mask open, scissor test off.
  void clear_depth(float depth);

  int width() const { return width_; }
  int height() const { return height_; }
  GLuint id() const { return handle_.id(); }

 private:
  void adopt_size(int width, int height);
  void require_complete();

  Handle<GL_FRAMEBUFFER> handle_;
  std::string label_;
  std::array<GLenum, kMaxColors> draw_buffers_{};
  int width_ = 0;
  int height_ = 0;
  bool complete_ = false;
};

/// Owns a query such as GL_TIME_ELAPSED or GL_SAMPLES_PASSED.
class Query {
 public:
  Query(std::string_view label, GLenum target);

  void begin();
  void end();

  /// Waits for the GL and returns what was counted between begin and end; time is in nanoseconds.
  std::uint64_t result() const;

 private:
  Handle<GL_QUERY> handle_;
  GLenum target_;
};

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

/// Owns a vertex layout: where the attributes of one interleaved vertex buffer lie.
/// Requires: the buffers live as long as the array is drawn.
class VertexArray {
 public:
  explicit VertexArray(std::string_view label);

  /// Takes vertices from `buffer`, `stride` bytes apart.
  void set_vertices(const Buffer& buffer, int stride);

  /// Feeds attribute `location` with `components` floats found `offset` bytes into each vertex.
  void set_attribute(GLuint location, int components, std::size_t offset);

  /// Binds the array for the next draw.
  void bind() const;

  GLuint id() const { return handle_.id(); }

 private:
  Handle<GL_VERTEX_ARRAY> handle_;
};

}  // namespace shadowbench::gl
