#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/gl/gl_api.h"

namespace shadowbench::gl {

/// A sized internal format.
struct PixelFormat {
  GLenum internal_format = 0;
  std::string_view name;  ///< as scenes and results write it: "r32f", "rg16f", "d24"
  int channels = 0;
  int bytes_per_texel = 0;  ///< as stored; D24 counts 4, which is what every GL takes for it
  bool depth = false;

  /// Returns GL's transfer format for `count` channels of this format: GL_RED ... GL_RGBA or GL_DEPTH_COMPONENT.
  /// Throws std::logic_error for a count that the format does not have.
  GLenum transfer_format(int count) const;
};

/// Looks a format up. Throws std::logic_error for one that Shadowbench does not use.
const PixelFormat& pixel_format(GLenum internal_format);

/// Looks a format up by its name. Throws Error(kUsage) with the names there are.
const PixelFormat& parse_pixel_format(std::string_view name);

/// Looks a depth format up by its name. Throws Error(kUsage) with the depth formats there are.
const PixelFormat& parse_depth_format(std::string_view name);

/// Returns the token's name, e.g. "GL_OUT_OF_MEMORY".
std::string gl_error_name(GLenum error);

/// Returns and clears every pending glGetError code.
std::vector<GLenum> drain_gl_errors();

/// Checks for errors of the allocation that was just made; `what` names it ("texture 'depth map'"). Throws
/// Error(kContext) for GL_OUT_OF_MEMORY, std::logic_error for any other pending error.
void require_allocated(std::string_view what);

/// Makes a GL object of a kind: GL_BUFFER, GL_FRAMEBUFFER, GL_PROGRAM, GL_SAMPLER, GL_VERTEX_ARRAY; or GL_QUERY,
/// GL_SHADER, GL_TEXTURE with a `target` such as GL_TIME_ELAPSED. Debuggers and error messages show it by its label, of
/// which the GL may keep only the beginning.
GLuint create_object(GLenum kind, std::string_view label, GLenum target);

void delete_object(GLenum kind, GLuint id);

/// Owns one GL object, or none (id 0).
template <GLenum kKind>
class Handle {
 public:
  Handle() = default;
  explicit Handle(std::string_view label, GLenum target = 0) : id_(create_object(kKind, label, target)) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    Handle taken(std::move(other));
    std::swap(id_, taken.id_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ != 0) delete_object(kKind, id_);
  }

  GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

/// Throws Error(kUsage) for a size below 1 or above what this GL gives a texture; `label` says of what.
void require_texture_size(std::string_view label, int width, int height);

/// Owns a 2D texture of immutable size and format; new ones filter nearest and clamp to the edge.
/// Rows of all transfers run bottom to top, as GL's window coordinates do, and are not padded.
class Texture {
 public:
  /// Allocates `levels` mip levels of a sized format such as GL_R32F or GL_DEPTH_COMPONENT24. The texels are undefined.
  /// With `samples` above 0 it is a multisampled one of a single level, which shaders read by texelFetch alone.
  /// Throws Error(kUsage) for a size below 1 or above what this GL gives, Error(kContext) when memory runs out.
  Texture(std::string_view label, GLenum internal_format, int width, int height, int levels = 1, int samples = 0);

  void set_filter(GLenum minify, GLenum magnify);
  /// Sets the wrap mode of both axes, e.g. GL_CLAMP_TO_BORDER.
  void set_wrap(GLenum mode);
  /// Hides the mip levels above this one from reading.
  void set_last_level(int level);

  /// Overwrites level 0. Requires: width * height * channels values.
  void upload_floats(std::span<const float> texels, int channels);
  /// Overwrites level 0 with normalised bytes. Requires: width * height * channels values.
  void upload_bytes(std::span<const std::uint8_t> texels, int channels);
  /// Fills the levels above 0 from level 0.
  void generate_mipmaps();

  /// Waits for the GL and returns level 0 as floats, whatever the storage; depth has one channel.
  std::vector<float> read_floats(int channels) const;

  /// The same for the one texel at (x, y).
  std::vector<float> read_texel(int x, int y, int channels) const;

  /// Binds to a texture unit, where its own filter and wrap hold until a Sampler is bound there.
  void bind(GLuint unit) const;

  int width() const { return width_; }
  int height() const { return height_; }
  GLenum internal_format() const { return format_->internal_format; }
  const PixelFormat& format() const { return *format_; }
  int samples() const { return samples_; }

  /// The bits of depth that the GL really stores; 0 for a colour format.
  int depth_bits() const;
  /// Returns the memory of all levels in bytes, as the format stores them.
  std::size_t bytes() const;
  GLuint id() const { return handle_.id(); }

 private:
  void upload(std::size_t count, int channels, GLenum type, const void* texels);

  Handle<GL_TEXTURE> handle_;
  const PixelFormat* format_;
  int width_;
  int height_;
  int levels_;
  int samples_;
};

// GL objects, textures above among them. They are move-only, labelled, made by direct state access, and die with
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
