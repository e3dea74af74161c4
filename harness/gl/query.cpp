#include "harness/gl/query.h"

namespace shadowbench::gl {
namespace {

GLuint create_query(std::string_view label, GLenum target) {
  GLuint id = 0;
  glCreateQueries(target, 1, &id);
  set_label(GL_QUERY, id, label);
  return id;
}

}  // namespace

Query::Query(std::string_view label, GLenum target) : handle_(create_query(label, target)), target_(target) {}

void Query::begin() { glBeginQuery(target_, handle_.id()); }

void Query::end() { glEndQuery(target_); }

std::uint64_t Query::result() const {
  GLuint64 value = 0;
  glGetQueryObjectui64v(handle_.id(), GL_QUERY_RESULT, &value);
  return value;
}

}  // namespace shadowbench::gl
