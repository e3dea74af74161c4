#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "harness/gl/objects.h"

namespace shadowbench::gl {

/// A buffer of vertices, with a copy of its bytes.
struct RecordedBuffer {
  std::vector<std::byte> bytes;
  bool was_too_large = false;  ///< to be copied
};

/// A texture by its storage; two textures that lived one after the other under the same id are two of these.
struct RecordedTexture {
  GLenum format = GL_NONE;
  int width = 0;
  int height = 0;
  int levels = 1;
  int samples = 0;
};

/// A linked program.
struct RecordedProgram {
  struct Uniform {
    std::string name;
    GLenum type = GL_NONE;
    GLint location = -1;
  };
  std::string label;
  std::map<GLenum, std::string> sources;  ///< GLSL by the kind of shader
  std::vector<Uniform> uniforms;          ///< those that the compiler kept, samplers among them
};

/// How a shader sees a texture: its sampler's state, or the texture's own.
struct Sampling {
  GLenum minify = GL_NEAREST;
  GLenum magnify = GL_NEAREST;
  GLenum wrap = GL_CLAMP_TO_EDGE;
  GLenum compare = GL_NONE;  ///< a function such as GL_LEQUAL
  glm::vec4 border{0.0f};
  int last_level = 0;  ///< the levels above are hidden
};

struct Step;
using StepPointer = std::shared_ptr<const Step>;
using TexturePointer = std::shared_ptr<const RecordedTexture>;

/// What a draw reads through one sampler.
struct StepInput {
  std::string sampler;
  TexturePointer texture;
  Sampling sampling;
  std::vector<StepPointer> levels;  ///< who wrote each level; null where nobody did
};

/// Where a step writes to.
struct StepTarget {
  static constexpr int kDepth = -1;
  int place = 0;  ///< the fragment shader's output, or kDepth
  TexturePointer texture;
  int level = 0;
  StepPointer before;  ///< who wrote what the step leaves or adds to; null where it overwrites everything
};

/// Draws triangles.
struct DrawStep {
  struct Attribute {
    int location = 0;
    int components = 0;
    int offset = 0;  ///< bytes
  };
  std::shared_ptr<const RecordedProgram> program;
  std::map<std::string, std::vector<double>> uniforms;  ///< samplers are not among them
  std::vector<StepInput> inputs;
  std::shared_ptr<const RecordedBuffer> vertices;  ///< null: the shader makes the corners of one triangle
  int stride = 0;                                  ///< bytes
  std::vector<Attribute> attributes;
  int first = 0;
  int count = 0;
  glm::ivec4 viewport{0};           ///< x, y, width, height
  GLenum depth_function = GL_NONE;  ///< GL_NONE: no test, and depth is not written
  bool writes_depth = false;
  bool adds = false;        ///< what is drawn is added to what is there
  GLenum culled = GL_NONE;  ///< GL_FRONT, GL_BACK
  glm::vec2 offset{0.0f};   ///< of polygons: factor, units
};

struct ClearStep {
  glm::vec4 value{0.0f};  ///< depth in x
};

struct UploadStep {
  GLenum format = GL_NONE;
  GLenum type = GL_NONE;
  std::vector<std::byte> texels;
};

/// Makes the levels above 0 from it.
struct MipmapStep {};

/// One thing that OpenGL did to textures, with all that it depended on: a frame is the graph that its last step leads.
struct Step {
  std::variant<DrawStep, ClearStep, UploadStep, MipmapStep> what;
  std::vector<StepTarget> targets;
};

/// What a texture's level holds: who wrote it.
struct RecordedContent {
  TexturePointer texture;
  StepPointer step;
};

/// Writes down what is drawn, by what and from what, so that it can be drawn again elsewhere. Nothing is kept of what
/// was overwritten. While one lives, OpenGL's functions go through it; there can be one at a time.
class Recorder {
 public:
  /// Buffers of more bytes than this are not copied: what is drawn of them has no vertices, and cannot be drawn again.
  static constexpr std::size_t kMostVertexBytes = std::size_t{64} << 20;

  /// Requires: a current context, in which the textures and programs that matter are made later, and no other recorder.
  Recorder();
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// What the newest draw wrote, with all that led to it; null where nothing was drawn yet.
  StepPointer newest_draw() const { return newest_; }

  /// What is in level 0 of a texture; nothing where it was made before the recorder.
  RecordedContent content_of(const Texture& texture) const;

  /// Whether a buffer that lives was too large to be copied.
  bool lacks_vertices() const;

  /// While one lives, what is drawn is not written down, and what it does to textures is taken to change nothing.
  class Pause {
   public:
    explicit Pause(Recorder* recorder) : recorder_(recorder) {
      if (recorder_) ++recorder_->paused_;
    }
    ~Pause() {
      if (recorder_) --recorder_->paused_;
    }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    Recorder* recorder_;
  };

 private:
  friend struct RecorderHooks;
  struct Content {
    std::shared_ptr<RecordedTexture> texture;
    std::vector<StepPointer> levels;
  };
  std::map<GLuint, Content> textures_;
  std::map<GLuint, std::shared_ptr<RecordedProgram>> programs_;
  std::map<GLuint, std::shared_ptr<RecordedBuffer>> buffers_;
  StepPointer newest_;
  int paused_ = 0;

  void write(Step step, const std::vector<GLuint>& textures);
  void add_texture(GLuint id, GLenum format, int width, int height, int levels, int samples);
  void finish_program(GLuint id);
  void record_draw(int first, int count);
  void record_clear(GLuint framebuffer, GLenum buffer, int place, const float* value);
  void record_upload(GLuint id, int width, int height, GLenum format, GLenum type, const void* texels);
  void record_mipmaps(GLuint id);
  void read_uniforms(GLuint program, DrawStep& draw) const;
  void read_vertices(DrawStep& draw) const;
  std::vector<GLuint> read_targets(GLuint framebuffer, bool with_depth, std::vector<StepTarget>& targets) const;
};

}  // namespace shadowbench::gl
