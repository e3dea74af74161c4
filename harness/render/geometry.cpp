#include "harness/render/geometry.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace shadowbench::render {
namespace {

constexpr GLuint kBaseColorUnit = 12;  // of lib/material.glsl

/// Vertices before the first triangle, so that each vertex has two before it: a triangle's last corner reads the
/// others.
constexpr std::size_t kVerticesBefore = 2;

struct GpuVertex {
  glm::vec3 position_ws;
  glm::vec3 shading_normal_ws;
  glm::vec3 face_normal_ws;
  glm::vec2 uv;
};

glm::vec3 face_normal(const scene::Vertex& a, const scene::Vertex& b, const scene::Vertex& c) {
  // In double: slivers far from the origin lose their normal in single precision.
  const glm::dvec3 p(a.position_ws), q(b.position_ws), r(c.position_ws);
  return glm::vec3(glm::normalize(glm::cross(q - p, r - p)));
}

void append_mesh(std::vector<GpuVertex>& vertices, const scene::Mesh& mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const scene::Vertex& a = mesh.vertices[mesh.indices[i]];
    const scene::Vertex& b = mesh.vertices[mesh.indices[i + 1]];
    const scene::Vertex& c = mesh.vertices[mesh.indices[i + 2]];
    const glm::vec3 normal = face_normal(a, b, c);
    for (const scene::Vertex* v : {&a, &b, &c}) vertices.push_back({v->position_ws, v->normal_ws, normal, v->uv});
  }
}

void set_attributes(gl::VertexArray& array) {
  const auto set = [&](GLuint location, int components, std::size_t offset, std::size_t vertices_back = 0) {
    array.set_attribute(location, components, (kVerticesBefore - vertices_back) * sizeof(GpuVertex) + offset);
  };
  set(0, 3, offsetof(GpuVertex, position_ws));
  set(1, 3, offsetof(GpuVertex, shading_normal_ws));
  set(2, 3, offsetof(GpuVertex, face_normal_ws));
  set(3, 2, offsetof(GpuVertex, uv));
  set(4, 3, offsetof(GpuVertex, position_ws), 1);
  set(5, 3, offsetof(GpuVertex, position_ws), 2);
}

gl::Texture upload(const scene::Texture& texture) {
  int levels = 1;
  for (int side = std::max(texture.width, texture.height); side > 1; side /= 2) ++levels;
  gl::Texture result("texture " + texture.name, GL_SRGB8_ALPHA8, texture.width, texture.height, levels);
  result.upload_bytes(texture.rgba, 4);
  result.generate_mipmaps();
  result.set_filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
  result.set_wrap(GL_REPEAT);
  return result;
}

/// Turns rows that run bottom to top, as GL's do, into rows that run top to bottom, and back.
std::vector<float> flip_rows(const std::vector<float>& rows, std::ptrdiff_t stride) {
  std::vector<float> flipped(rows.size());
  const std::ptrdiff_t height = static_cast<std::ptrdiff_t>(rows.size()) / stride;
  for (std::ptrdiff_t y = 0; y < height; ++y) {
    const auto row = rows.begin() + stride * (height - 1 - y);
    std::copy(row, row + stride, flipped.begin() + stride * y);
  }
  return flipped;
}

}  // namespace

Geometry::Geometry(const scene::Scene& scene) {
  auto parts = std::make_shared<Parts>();
  parts->materials = scene.materials;
  std::vector<GpuVertex> vertices(kVerticesBefore);
  const auto count = [&] { return static_cast<int>(vertices.size() - kVerticesBefore); };
  for (const scene::Mesh& mesh : scene.meshes) {
    const int first = count();
    append_mesh(vertices, mesh);
    parts->ranges.push_back({.first = first,
                             .count = count() - first,
                             .material = mesh.material,
                             .casts = mesh.casts_shadow,
                             .may_cull_front = mesh.may_cull_front});
  }
  parts->triangles = count() / 3;
  for (const scene::Texture& texture : scene.textures) parts->textures.push_back(upload(texture));
  parts->buffer.emplace_back("scene vertices", std::as_bytes(std::span(vertices)));
  parts->array.set_vertices(parts->buffer.front(), sizeof(GpuVertex));
  set_attributes(parts->array);
  parts_ = std::move(parts);
}

Defines Geometry::variant(const scene::Material& material) const {
  Defines defines;
  if (material.base_color_texture >= 0) defines.emplace_back("HAS_TEXTURE", "1");
  if (material.alpha_mode == scene::AlphaMode::kMask) defines.emplace_back("ALPHA_MASK", "1");
  if (material.alpha_mode == scene::AlphaMode::kBlend) defines.emplace_back("ALPHA_BLEND", "1");
  return defines;
}

void Geometry::set_material(gl::Program& program, const scene::Material& material) const {
  program.set("base_color", material.base_color);
  if (material.alpha_mode == scene::AlphaMode::kMask) program.set("alpha_cutoff", material.alpha_cutoff);
  if (material.base_color_texture < 0) return;
  parts_->textures[static_cast<std::size_t>(material.base_color_texture)].bind(kBaseColorUnit);
}

bool Geometry::is_in(DrawSet set, const VertexRange& range) {
  switch (set) {
    case DrawSet::kAll: return true;
    case DrawSet::kCasters: return range.casts;
    case DrawSet::kCullableCasters: return range.casts && range.may_cull_front;
    case DrawSet::kUncullableCasters: return range.casts && !range.may_cull_front;
  }
  return false;
}

ImageTarget::ImageTarget(std::string_view label, GLenum internal_format, int width, int height, int samples)
    : texture_(label, internal_format, width, height, 1, samples), framebuffer_(label) {
  if (texture_.format().depth)
    framebuffer_.attach_depth(texture_);
  else
    framebuffer_.attach_color(0, texture_);
}

images::Image read_image(const gl::Texture& texture, int channels) {
  images::Image image(texture.width(), texture.height(), channels);
  image.texels = flip_rows(texture.read_floats(channels), static_cast<std::ptrdiff_t>(texture.width()) * channels);
  return image;
}

gl::Texture upload_image(const images::Image& image) {
  gl::Texture texture("uploaded image", GL_R32F, image.width, image.height);
  texture.upload_floats(flip_rows(image.texels, image.width), 1);
  return texture;
}

}  // namespace shadowbench::render
