#include "harness/gl/query.h"

namespace shadowbench::gl {

Query::Query(std::string_view label, GLenum target) : handle_(label, target), target_(target) {}

void Query::begin() { glBeginQuery(target_, handle_.id()); }

void Query::end() { glEndQuery(target_); }

std::uint64_t Query::result() const {
  GLuint64 value = 0;
  glGetQueryObjectui64v(handle_.id(), GL_QUERY_RESULT, &value);
  return value;
}

}  // namespace shadowbench::gl
