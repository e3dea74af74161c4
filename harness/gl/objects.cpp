#include "harness/gl/objects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <stdexcept>
#include <vector>

#include "base/error.h"

namespace shadowbench::gl {
namespace {

constexpr std::array kFormats = {
    PixelFormat{GL_R8, "r8", 1, 1, false},
    PixelFormat{GL_RG8, "rg8", 2, 2, false},
    PixelFormat{GL_RGBA8, "rgba8", 4, 4, false},
    PixelFormat{GL_SRGB8_ALPHA8, "srgb8_alpha8", 4, 4, false},
    PixelFormat{GL_R16, "r16", 1, 2, false},
    PixelFormat{GL_RG16, "rg16", 2, 4, false},
    PixelFormat{GL_RGBA16, "rgba16", 4, 8, false},
    PixelFormat{GL_R16F, "r16f", 1, 2, false},
    PixelFormat{GL_RG16F, "rg16f", 2, 4, false},
    PixelFormat{GL_RGBA16F, "rgba16f", 4, 8, false},
    PixelFormat{GL_R32F, "r32f", 1, 4, false},
    PixelFormat{GL_RG32F, "rg32f", 2, 8, false},
    PixelFormat{GL_RGBA32F, "rgba32f", 4, 16, false},
    PixelFormat{GL_R32UI, "r32ui", 1, 4, false},
    PixelFormat{GL_RG32UI, "rg32ui", 2, 8, false},
    PixelFormat{GL_RGBA32UI, "rgba32ui", 4, 16, false},
    PixelFormat{GL_DEPTH_COMPONENT16, "d16", 1, 2, true},
    PixelFormat{GL_DEPTH_COMPONENT24, "d24", 1, 4, true},
    PixelFormat{GL_DEPTH_COMPONENT32F, "d32f", 1, 4, true},
};

const PixelFormat& find_by_name(std::string_view name, const char* kind, bool depth_only) {
  std::vector<std::string_view> known;
  for (const PixelFormat& format : kFormats) {
    if (depth_only && !format.depth) continue;
    if (format.name == name) return format;
    known.push_back(format.name);
  }
  throw Error(ErrorKind::kUsage,
              fmt::format("unknown {} format '{}'; there are {}", kind, name, fmt::join(known, ", ")));
}

// Transfers depend on global state that other code may have changed.
void reset_transfer_state() {
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  for (const GLenum name : {GL_PACK_ALIGNMENT, GL_UNPACK_ALIGNMENT}) glPixelStorei(name, 1);
  for (const GLenum name : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_UNPACK_ROW_LENGTH,
                            GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS})
    glPixelStorei(name, 0);
}

}  // namespace

GLenum PixelFormat::transfer_format(int count) const {
  constexpr std::array<GLenum, 4> kColors = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
  if (count < 1 || count > channels)
    throw std::logic_error(fmt::format("{} channels asked of {}, which has {}", count, name, channels));
  return depth ? GL_DEPTH_COMPONENT : kColors[static_cast<std::size_t>(count - 1)];
}

const PixelFormat& pixel_format(GLenum internal_format) {
  const auto found = std::ranges::find(kFormats, internal_format, &PixelFormat::internal_format);
  if (found == kFormats.end())
    throw std::logic_error(fmt::format("internal format 0x{:04x} is not in the table of formats", internal_format));
  return *found;
}

const PixelFormat& parse_pixel_format(std::string_view name) { return find_by_name(name, "texture", false); }

const PixelFormat& parse_depth_format(std::string_view name) { return find_by_name(name, "depth", true); }

GLuint create_object(GLenum kind, std::string_view label, GLenum target) {
  GLuint id = 0;
  switch (kind) {
    case GL_BUFFER: glCreateBuffers(1, &id); break;
    case GL_FRAMEBUFFER: glCreateFramebuffers(1, &id); break;
    case GL_PROGRAM: id = glCreateProgram(); break;
    case GL_QUERY: glCreateQueries(target, 1, &id); break;
    case GL_SAMPLER: glCreateSamplers(1, &id); break;
    case GL_SHADER: id = glCreateShader(target); break;
    case GL_TEXTURE: glCreateTextures(target, 1, &id); break;
    case GL_VERTEX_ARRAY: glCreateVertexArrays(1, &id); break;
    default: assert(false);
  }
  GLint limit = 256;
  glGetIntegerv(GL_MAX_LABEL_LENGTH, &limit);
  glObjectLabel(kind, id, std::min(static_cast<GLsizei>(label.size()), limit - 1), label.data());
  return id;
}

void delete_object(GLenum kind, GLuint id) {
  switch (kind) {
    case GL_BUFFER: return glDeleteBuffers(1, &id);
    case GL_FRAMEBUFFER: return glDeleteFramebuffers(1, &id);
    case GL_PROGRAM: return glDeleteProgram(id);
    case GL_QUERY: return glDeleteQueries(1, &id);
    case GL_SAMPLER: return glDeleteSamplers(1, &id);
    case GL_SHADER: return glDeleteShader(id);
    case GL_TEXTURE: return glDeleteTextures(1, &id);
    case GL_VERTEX_ARRAY: return glDeleteVertexArrays(1, &id);
    default: assert(false);
  }
}

std::string gl_error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM: return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE: return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION: return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION: return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY: return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST: return "GL_CONTEXT_LOST";
    default: return fmt::format("GL error 0x{:04x}", error);
  }
}

std::vector<GLenum> drain_gl_errors() {
  constexpr int kMost = 64;  // a lost context reports an error for ever
  std::vector<GLenum> errors;
  for (int i = 0; i < kMost; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    errors.push_back(error);
  }
  return errors;
}

void require_allocated(std::string_view what) {
  const auto errors = drain_gl_errors();
  for (const GLenum error : errors)
    if (error == GL_OUT_OF_MEMORY)
      throw Error(ErrorKind::kInput, fmt::format("{}: the GL has not enough memory; choose smaller sizes", what));
  if (!errors.empty())
    throw std::logic_error(fmt::format("{}: {} in making it, or before", what, gl_error_name(errors.front())));
}

void require_texture_size(std::string_view label, int width, int height) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (width < 1 || height < 1) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: a size of {}x{} was asked for; both sides must be 1 or more", label, width, height));
  }
  if (width > limit || height > limit) {
    throw Error(ErrorKind::kUsage, fmt::format("{}: a size of {}x{} was asked for; this GL gives at most {}x{}", label,
                                               width, height, limit, limit));
  }
}

Texture::Texture(std::string_view label, GLenum internal_format, int width, int height, int levels, int samples)
    : format_(&pixel_format(internal_format)), width_(width), height_(height), levels_(levels), samples_(samples) {
  require_texture_size(label, width, height);
  handle_ = Handle<GL_TEXTURE>(label, samples > 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D);
  if (samples > 0)
    glTextureStorage2DMultisample(id(), samples, internal_format, width, height, GL_TRUE);
  else
    glTextureStorage2D(id(), levels, internal_format, width, height);
  require_allocated(fmt::format("texture '{}' of {}x{} {}", label, width, height, format_->name));
  if (samples > 0) return;
  set_filter(GL_NEAREST, GL_NEAREST);
  set_wrap(GL_CLAMP_TO_EDGE);
}

void Texture::set_filter(GLenum minify, GLenum magnify) {
  glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
}

void Texture::set_wrap(GLenum mode) {
  glTextureParameteri(id(), GL_TEXTURE_WRAP_S, static_cast<GLint>(mode));
  glTextureParameteri(id(), GL_TEXTURE_WRAP_T, static_cast<GLint>(mode));
}

void Texture::set_last_level(int level) { glTextureParameteri(id(), GL_TEXTURE_MAX_LEVEL, level); }

void Texture::upload_floats(std::span<const float> texels, int channels) {
  upload(texels.size(), channels, GL_FLOAT, texels.data());
}

void Texture::upload_bytes(std::span<const std::uint8_t> texels, int channels) {
  upload(texels.size(), channels, GL_UNSIGNED_BYTE, texels.data());
}

void Texture::upload(std::size_t count, int channels, GLenum type, const void* texels) {
  if (count !=
      static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * static_cast<std::size_t>(channels))
    throw std::logic_error(fmt::format("{} values for a texture of {}x{}x{}", count, width_, height_, channels));
  reset_transfer_state();
  glTextureSubImage2D(id(), 0, 0, 0, width_, height_, format_->transfer_format(channels), type, texels);
}

void Texture::generate_mipmaps() { glGenerateTextureMipmap(id()); }

std::vector<float> Texture::read_floats(int channels) const {
  const GLenum transfer = format_->transfer_format(channels);
  std::vector<float> texels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
                            static_cast<std::size_t>(channels));
  reset_transfer_state();
  // glGetTextureImage takes its buffer's size as an int: rows are read in slabs that fit one.
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  const std::size_t row = texels.size() / static_cast<std::size_t>(height_);
  const auto slab = static_cast<int>(std::max<std::size_t>(1, kMostBytes / (row * sizeof(float))));
  for (int y = 0; y < height_; y += slab) {
    const int rows = std::min(slab, height_ - y);
    glGetTextureSubImage(id(), 0, 0, y, 0, width_, rows, 1, transfer, GL_FLOAT,
                         static_cast<GLsizei>(row * static_cast<std::size_t>(rows) * sizeof(float)),
                         texels.data() + row * static_cast<std::size_t>(y));
  }
  return texels;
}

std::vector<float> Texture::read_texel(int x, int y, int channels) const {
  std::vector<float> texel(static_cast<std::size_t>(channels));
  reset_transfer_state();
  glGetTextureSubImage(id(), 0, x, y, 0, 1, 1, 1, format_->transfer_format(channels), GL_FLOAT,
                       static_cast<GLsizei>(texel.size() * sizeof(float)), texel.data());
  return texel;
}

int Texture::depth_bits() const {
  GLint bits = 0;
  glGetTextureLevelParameteriv(id(), 0, GL_TEXTURE_DEPTH_SIZE, &bits);
  return bits;
}

void Texture::bind(GLuint unit) const {
  glBindSampler(unit, 0);
  glBindTextureUnit(unit, id());
}

std::size_t Texture::bytes() const {
  std::size_t total = 0;
  for (int level = 0; level < levels_; ++level) {
    const auto width = static_cast<std::size_t>(std::max(1, width_ >> level));
    const auto height = static_cast<std::size_t>(std::max(1, height_ >> level));
    total += width * height * static_cast<std::size_t>(format_->bytes_per_texel);
  }
  return total * static_cast<std::size_t>(std::max(1, samples_));
}

Buffer::Buffer(std::string_view label, std::span<const std::byte> bytes) : handle_(label), size_(bytes.size()) {
  // GL has no empty buffers: an empty one holds one byte that nobody reads.
  const auto stored = static_cast<GLsizeiptr>(size_ == 0 ? 1 : size_);
  glNamedBufferStorage(id(), stored, size_ == 0 ? nullptr : bytes.data(), 0);
  require_allocated(fmt::format("buffer '{}' of {} bytes", label, size_));
}

Framebuffer::Framebuffer(std::string_view label) : handle_(label), label_(label) {
  draw_buffers_.fill(GL_NONE);
  glNamedFramebufferDrawBuffers(id(), kMaxColors, draw_buffers_.data());
  glNamedFramebufferReadBuffer(id(), GL_NONE);
}

void Framebuffer::attach_color(int index, const Texture& texture, int level) {
  if (index < 0 || index >= kMaxColors) throw std::logic_error(fmt::format("{}: colour {} of 8", label_, index));
  const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index);
  glNamedFramebufferTexture(id(), attachment, texture.id(), level);
  draw_buffers_[static_cast<std::size_t>(index)] = attachment;
  glNamedFramebufferDrawBuffers(id(), kMaxColors, draw_buffers_.data());
  adopt_size(std::max(1, texture.width() >> level), std::max(1, texture.height() >> level));
}

void Framebuffer::attach_depth(const Texture& texture) {
  glNamedFramebufferTexture(id(), GL_DEPTH_ATTACHMENT, texture.id(), 0);
  adopt_size(texture.width(), texture.height());
}

void Framebuffer::bind() {
  if (!complete_) require_complete();
  glBindFramebuffer(GL_FRAMEBUFFER, id());
  glViewport(0, 0, width_, height_);
}

void Framebuffer::clear_color(int index, const glm::vec4& color) {
  glClearNamedFramebufferfv(id(), GL_COLOR, index, &color[0]);
}

void Framebuffer::clear_depth(float depth) { glClearNamedFramebufferfv(id(), GL_DEPTH, 0, &depth); }

// GL draws to the intersection of unequal attachments; every pass here fills whole ones.
void Framebuffer::adopt_size(int width, int height) {
  if (width_ != 0 && (width != width_ || height != height_))
    throw std::logic_error(fmt::format("framebuffer '{}': {}x{} joins {}x{}", label_, width, height, width_, height_));
  width_ = width;
  height_ = height;
  complete_ = false;
}

void Framebuffer::require_complete() {
  const GLenum status = glCheckNamedFramebufferStatus(id(), GL_DRAW_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_UNSUPPORTED)
    throw Error(ErrorKind::kContext, fmt::format("framebuffer '{}': this GL cannot draw into its textures", label_));
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw std::logic_error(fmt::format("framebuffer '{}' is incomplete: 0x{:04x}", label_, status));
  complete_ = true;
}

Query::Query(std::string_view label, GLenum target) : handle_(label, target), target_(target) {}

void Query::begin() { glBeginQuery(target_, handle_.id()); }

void Query::end() { glEndQuery(target_); }

std::uint64_t Query::result() const {
  GLuint64 value = 0;
  glGetQueryObjectui64v(handle_.id(), GL_QUERY_RESULT, &value);
  return value;
}

Sampler::Sampler(std::string_view label) : handle_(label) {
  set_filter(GL_NEAREST, GL_NEAREST);
  set_wrap(GL_CLAMP_TO_EDGE);
}

void Sampler::set_filter(GLenum minify, GLenum magnify) {
  glSamplerParameteri(id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glSamplerParameteri(id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
}

void Sampler::set_wrap(GLenum mode) {
  glSamplerParameteri(id(), GL_TEXTURE_WRAP_S, static_cast<GLint>(mode));
  glSamplerParameteri(id(), GL_TEXTURE_WRAP_T, static_cast<GLint>(mode));
}

void Sampler::set_border(const glm::vec4& color) { glSamplerParameterfv(id(), GL_TEXTURE_BORDER_COLOR, &color[0]); }

void Sampler::set_compare(GLenum function) {
  const bool on = function != GL_NONE;
  glSamplerParameteri(id(), GL_TEXTURE_COMPARE_MODE, on ? GL_COMPARE_REF_TO_TEXTURE : GL_NONE);
  if (on) glSamplerParameteri(id(), GL_TEXTURE_COMPARE_FUNC, static_cast<GLint>(function));
}

void Sampler::bind(GLuint unit) const { glBindSampler(unit, id()); }

VertexArray::VertexArray(std::string_view label) : handle_(label) {}

void VertexArray::set_vertices(const Buffer& buffer, int stride) {
  glVertexArrayVertexBuffer(id(), 0, buffer.id(), 0, stride);
}

void VertexArray::set_attribute(GLuint location, int components, std::size_t offset) {
  glEnableVertexArrayAttrib(id(), location);
  glVertexArrayAttribFormat(id(), location, components, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(id(), location, 0);
}

void VertexArray::bind() const { glBindVertexArray(id()); }

}  // namespace shadowbench::gl
