#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/gl/gl_api.h"

namespace shadowbench::gl {

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

}  // namespace shadowbench::gl
