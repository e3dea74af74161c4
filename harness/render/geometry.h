#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "harness/gl/objects.h"
#include "harness/render/shader_library.h"
#include "harness/scene/scene.h"
#include "report/images/image.h"

namespace shadowbench::render {

/// Which of a scene's meshes a pass draws.
enum class DrawSet {
  kAll,
  kCasters,
  kCullableCasters,    ///< those whose front faces may be left out of the map
  kUncullableCasters,  ///< the other casters
};

/// A scene's triangles and textures in GL memory, which copies share; corners are not shared, so that each carries its
/// face's normal.
class Geometry {
 public:
  explicit Geometry(const scene::Scene& scene);

  /// Draws with the variants of `<shader>.vert/.frag` that the materials need, and `more` defines; `prepare` sets a
  /// variant's own uniforms. Requires the framebuffer and all other state to be set.
  template <class Prepare>
  void draw(ShaderLibrary& shaders, const std::string& shader, DrawSet set, Prepare prepare,
            const Defines& more = {}) const;

  std::int64_t triangle_count() const { return parts_->triangles; }

 private:
  struct VertexRange {
    int first = 0;
    int count = 0;
    int material = 0;
    bool casts = true;
    bool may_cull_front = true;
  };
  struct Parts {
    std::vector<VertexRange> ranges;
    std::vector<scene::Material> materials;
    std::vector<gl::Texture> textures;
    std::vector<gl::Buffer> buffer;  // one; a vector because it is made after the vertices are
    gl::VertexArray array{"scene"};
    std::int64_t triangles = 0;
  };
  std::shared_ptr<const Parts> parts_;

  Defines variant(const scene::Material& material) const;
  void set_material(gl::Program& program, const scene::Material& material) const;
  static bool is_in(DrawSet set, const VertexRange& range);
};

template <class Prepare>
void Geometry::draw(ShaderLibrary& shaders, const std::string& shader, DrawSet set, Prepare prepare,
                    const Defines& more) const {
  parts_->array.bind();
  for (const VertexRange& range : parts_->ranges) {
    if (!is_in(set, range)) continue;
    const scene::Material& material = parts_->materials[static_cast<std::size_t>(range.material)];
    Defines defines = variant(material);
    defines.insert(defines.end(), more.begin(), more.end());
    gl::Program& program = shaders.geometry(shader, defines);
    prepare(program);
    set_material(program, material);
    program.use();
    glDrawArrays(GL_TRIANGLES, range.first, range.count);
  }
}

/// One texture, of colours or depths, with the framebuffer that draws into it.
class ImageTarget {
 public:
  ImageTarget(std::string_view label, GLenum internal_format, int width, int height, int samples = 0);

  void bind() { framebuffer_.bind(); }
  void clear(const glm::vec4& color) { framebuffer_.clear_color(0, color); }
  void clear_depth(float depth) { framebuffer_.clear_depth(depth); }
  const gl::Texture& texture() const { return texture_; }
  gl::Texture& texture() { return texture_; }

 private:
  gl::Texture texture_;
  gl::Framebuffer framebuffer_;
};

/// Reads a texture back as an image, rows top to bottom.
images::Image read_image(const gl::Texture& texture, int channels);

/// Makes an R32F texture of a one-channel image, rows top to bottom.
gl::Texture upload_image(const images::Image& image);

}  // namespace shadowbench::render
