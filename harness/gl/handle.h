#pragma once

#include <string_view>
#include <utility>

#include "harness/gl/gl_api.h"

namespace shadowbench::gl {

/// Owns one GL object name and deletes it with `Deleter`; 0 owns nothing.
template <typename Deleter>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, 0);
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  GLuint id() const { return id_; }

 private:
  void reset() {
    if (id_ != 0) Deleter{}(id_);
    id_ = 0;
  }

  GLuint id_ = 0;
};

/// Gives a GL object the name under which debuggers and error messages show it; longer ones than GL allows are cut.
void set_label(GLenum identifier, GLuint id, std::string_view label);

}  // namespace shadowbench::gl
