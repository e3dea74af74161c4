#pragma once

#include <cstdint>
#include <string_view>

#include "harness/gl/handle.h"

namespace shadowbench::gl {

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

}  // namespace shadowbench::gl
