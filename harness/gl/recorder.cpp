#include "harness/gl/recorder.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>

#include "harness/gl/objects.h"

namespace shadowbench::gl {
namespace {

/// Puts itself in place of a function without a result that the loader points to: calls it, and then `kThen` with the
/// same arguments.
template <auto* kSlot, auto kThen, class Function = std::remove_pointer_t<decltype(kSlot)>>
class Hook;

template <auto* kSlot, auto kThen, class... Arguments>
class Hook<kSlot, kThen, void (*)(Arguments...)> {
 public:
  /// Puts it in place, or takes it away: not where the loader has another function since, of another context.
  static void set(bool is_on) {
    if (is_on)
      original_ = std::exchange(*kSlot, call);
    else if (*kSlot == call)
      *kSlot = original_;
  }

 private:
  static inline void (*original_)(Arguments...) = nullptr;

  static void call(Arguments... arguments) {
    original_(arguments...);
    kThen(arguments...);
  }
};

Recorder* current_recorder = nullptr;

GLint read_integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

GLuint read_id(GLenum name) { return static_cast<GLuint>(read_integer(name)); }

GLint read_indexed(GLenum name, GLuint index) {
  GLint value = 0;
  glGetIntegeri_v(name, index, &value);
  return value;
}

bool is_sampler(GLenum type) {
  return type == GL_SAMPLER_2D || type == GL_SAMPLER_2D_SHADOW || type == GL_UNSIGNED_INT_SAMPLER_2D ||
         type == GL_SAMPLER_2D_MULTISAMPLE;
}

int count_components(GLenum type) {
  switch (type) {
    case GL_FLOAT_VEC2:
    case GL_INT_VEC2: return 2;
    case GL_FLOAT_VEC3: return 3;
    case GL_FLOAT_VEC4: return 4;
    case GL_FLOAT_MAT4: return 16;
    default: return 1;
  }
}

std::string read_source(GLuint shader) {
  GLint length = 0;
  glGetShaderiv(shader, GL_SHADER_SOURCE_LENGTH, &length);
  std::string text(static_cast<std::size_t>(length), '\0');
  glGetShaderSource(shader, length, &length, text.data());
  text.resize(static_cast<std::size_t>(length));
  return text;
}

std::string read_label(GLuint program) {
  std::array<char, 256> label{};
  glGetObjectLabel(GL_PROGRAM, program, static_cast<GLsizei>(label.size()), nullptr, label.data());
  return label.data();
}

/// A sampler's state where `sampler` is bound, or else the texture's own.
Sampling read_sampling(GLuint texture, GLuint sampler) {
  const auto read = [&](GLenum name) {
    GLint value = 0;
    if (sampler != 0)
      glGetSamplerParameteriv(sampler, name, &value);
    else
      glGetTextureParameteriv(texture, name, &value);
    return static_cast<GLenum>(value);
  };
  Sampling sampling{read(GL_TEXTURE_MIN_FILTER), read(GL_TEXTURE_MAG_FILTER), read(GL_TEXTURE_WRAP_S)};
  if (read(GL_TEXTURE_COMPARE_MODE) == GL_COMPARE_REF_TO_TEXTURE) sampling.compare = read(GL_TEXTURE_COMPARE_FUNC);
  if (sampling.wrap == GL_CLAMP_TO_BORDER && sampler != 0)
    glGetSamplerParameterfv(sampler, GL_TEXTURE_BORDER_COLOR, &sampling.border[0]);
  GLint last = 0;
  glGetTextureParameteriv(texture, GL_TEXTURE_MAX_LEVEL, &last);
  sampling.last_level = last;
  return sampling;
}

void read_state(DrawStep& draw) {
  glGetIntegerv(GL_VIEWPORT, &draw.viewport[0]);
  if (glIsEnabled(GL_DEPTH_TEST)) draw.depth_function = static_cast<GLenum>(read_integer(GL_DEPTH_FUNC));
  draw.writes_depth = draw.depth_function != GL_NONE && read_integer(GL_DEPTH_WRITEMASK) != 0;
  draw.adds = glIsEnabled(GL_BLEND) != 0;
  if (glIsEnabled(GL_CULL_FACE)) draw.culled = static_cast<GLenum>(read_integer(GL_CULL_FACE_MODE));
  if (!glIsEnabled(GL_POLYGON_OFFSET_FILL)) return;
  glGetFloatv(GL_POLYGON_OFFSET_FACTOR, &draw.offset.x);
  glGetFloatv(GL_POLYGON_OFFSET_UNITS, &draw.offset.y);
}

std::size_t bytes_per_texel(GLenum format, GLenum type) {
  const std::size_t channels = format == GL_RGBA ? 4 : format == GL_RGB ? 3 : format == GL_RG ? 2 : 1;
  return channels * (type == GL_FLOAT ? sizeof(float) : 1);
}

std::vector<std::byte> copy_bytes(const void* bytes, std::size_t count) {
  std::vector<std::byte> copy(count);
  if (count > 0) std::memcpy(copy.data(), bytes, count);
  return copy;
}

/// Whether nothing is left of what the targets held: the triangle that covers them is drawn without looking at them.
bool covers_all(const DrawStep& draw, const std::vector<StepTarget>& targets) {
  const bool is_unconditional = draw.depth_function == GL_NONE || draw.depth_function == GL_ALWAYS;
  if (draw.vertices || !draw.attributes.empty() || draw.adds || !is_unconditional || targets.empty()) return false;
  const StepTarget& target = targets.front();
  return draw.viewport == glm::ivec4(0, 0, std::max(1, target.texture->width >> target.level),
                                     std::max(1, target.texture->height >> target.level));
}

}  // namespace

/// The functions that the recorder listens to.
struct RecorderHooks {
  template <auto kThen>
  static constexpr auto kIfOn = [](auto... arguments) {
    if (current_recorder->paused_ == 0) kThen(*current_recorder, arguments...);
  };

  static void set(bool is_on) {
    using Draw =
        Hook<&glad_glDrawArrays,
             kIfOn<[](Recorder& recorder, GLenum, GLint first, GLsizei count) { recorder.record_draw(first, count); }>>;
    using Clear = Hook<&glad_glClearNamedFramebufferfv,
                       kIfOn<[](Recorder& recorder, GLuint framebuffer, GLenum buffer, GLint place,
                                const GLfloat* value) { recorder.record_clear(framebuffer, buffer, place, value); }>>;
    using Upload =
        Hook<&glad_glTextureSubImage2D, kIfOn<[](Recorder& recorder, GLuint id, GLint, GLint, GLint, GLsizei width,
                                                 GLsizei height, GLenum format, GLenum type, const void* texels) {
          recorder.record_upload(id, width, height, format, type, texels);
        }>>;
    using Mipmaps =
        Hook<&glad_glGenerateTextureMipmap, kIfOn<[](Recorder& recorder, GLuint id) { recorder.record_mipmaps(id); }>>;
    using Storage = Hook<&glad_glTextureStorage2D,
                         [](GLuint id, GLsizei levels, GLenum format, GLsizei width, GLsizei height) {
                           current_recorder->add_texture(id, format, width, height, levels, 0);
                         }>;
    using Samples = Hook<&glad_glTextureStorage2DMultisample,
                         [](GLuint id, GLsizei samples, GLenum format, GLsizei width, GLsizei height, GLboolean) {
                           current_recorder->add_texture(id, format, width, height, 1, samples);
                         }>;
    using Bytes = Hook<&glad_glNamedBufferStorage,
                       [](GLuint id, GLsizeiptr size, const void* bytes, GLbitfield) {
                         const auto count = static_cast<std::size_t>(size);
                         const bool is_large = Recorder::kMostVertexBytes < count;
                         current_recorder->buffers_[id] = std::make_shared<RecordedBuffer>(
                             RecordedBuffer{copy_bytes(bytes, bytes && !is_large ? count : 0), bytes && is_large});
                       }>;
    using DeleteTextures = Hook<&glad_glDeleteTextures,
                                [](GLsizei count, const GLuint* ids) {
                                  for (GLsizei i = 0; i < count; ++i) current_recorder->textures_.erase(ids[i]);
                                }>;
    using DeleteBuffers = Hook<&glad_glDeleteBuffers, [](GLsizei count, const GLuint* ids) {
      for (GLsizei i = 0; i < count; ++i) current_recorder->buffers_.erase(ids[i]);
    }>;
    using Attach = Hook<&glad_glAttachShader,
                        [](GLuint program, GLuint shader) {
                          GLint type = 0;
                          glGetShaderiv(shader, GL_SHADER_TYPE, &type);
                          std::shared_ptr<RecordedProgram>& recorded = current_recorder->programs_[program];
                          if (!recorded || !recorded->label.empty()) recorded = std::make_shared<RecordedProgram>();
                          recorded->sources[static_cast<GLenum>(type)] = read_source(shader);
                        }>;
    using Link = Hook<&glad_glLinkProgram, [](GLuint program) { current_recorder->finish_program(program); }>;
    Draw::set(is_on);
    Clear::set(is_on);
    Upload::set(is_on);
    Mipmaps::set(is_on);
    Storage::set(is_on);
    Samples::set(is_on);
    Bytes::set(is_on);
    DeleteTextures::set(is_on);
    DeleteBuffers::set(is_on);
    Attach::set(is_on);
    Link::set(is_on);
  }
};

Recorder::Recorder() {
  assert(!current_recorder);
  current_recorder = this;
  RecorderHooks::set(true);
}

Recorder::~Recorder() {
  RecorderHooks::set(false);
  current_recorder = nullptr;
}

RecordedContent Recorder::content_of(const Texture& texture) const {
  const auto found = textures_.find(texture.id());
  return found == textures_.end() ? RecordedContent() : RecordedContent{found->second.texture, found->second.levels[0]};
}

bool Recorder::lacks_vertices() const {
  return std::ranges::any_of(
      buffers_, [](const auto& buffer) { return buffer.second->was_too_large; });
}

void Recorder::add_texture(GLuint id, GLenum format, int width, int height, int levels, int samples) {
  textures_[id] = {std::make_shared<RecordedTexture>(RecordedTexture{format, width, height, levels, samples}),
                   std::vector<StepPointer>(static_cast<std::size_t>(levels))};
}

void Recorder::finish_program(GLuint id) {
  RecordedProgram& program = *programs_[id];
  program.label = read_label(id);
  GLint count = 0;
  glGetProgramiv(id, GL_ACTIVE_UNIFORMS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    std::array<char, 256> name{};
    GLint size = 0;
    GLenum type = GL_NONE;
    glGetActiveUniform(id, i, static_cast<GLsizei>(name.size()), nullptr, &size, &type, name.data());
    const GLint location = glGetUniformLocation(id, name.data());
    if (location >= 0) program.uniforms.push_back({name.data(), type, location});
  }
}

/// Makes a step the writer of its targets.
void Recorder::write(Step step, const std::vector<GLuint>& textures) {
  const auto pointer = std::make_shared<const Step>(std::move(step));
  const auto* draw = std::get_if<DrawStep>(&pointer->what);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const StepTarget& target = pointer->targets[i];
    if (draw && !draw->writes_depth && target.place == StepTarget::kDepth) continue;  // it is looked at alone
    textures_.at(textures[i]).levels[static_cast<std::size_t>(target.level)] = pointer;
  }
  if (draw) newest_ = pointer;
}

void Recorder::read_uniforms(GLuint program, DrawStep& draw) const {
  for (const RecordedProgram::Uniform& uniform : draw.program->uniforms) {
    if (!is_sampler(uniform.type)) {
      std::vector<double> values(16);
      glGetUniformdv(program, uniform.location, values.data());
      values.resize(static_cast<std::size_t>(count_components(uniform.type)));
      draw.uniforms[uniform.name] = std::move(values);
      continue;
    }
    GLint unit = 0;
    glGetUniformiv(program, uniform.location, &unit);
    const auto index = static_cast<GLuint>(unit);
    const bool is_multisampled = uniform.type == GL_SAMPLER_2D_MULTISAMPLE;
    const auto id = static_cast<GLuint>(
        read_indexed(is_multisampled ? GL_TEXTURE_BINDING_2D_MULTISAMPLE : GL_TEXTURE_BINDING_2D, index));
    const auto found = textures_.find(id);
    if (found == textures_.end()) continue;
    const auto sampler = static_cast<GLuint>(read_indexed(GL_SAMPLER_BINDING, index));
    draw.inputs.push_back({uniform.name, found->second.texture, read_sampling(id, sampler), found->second.levels});
  }
}

void Recorder::read_vertices(DrawStep& draw) const {
  const GLuint array = read_id(GL_VERTEX_ARRAY_BINDING);
  constexpr GLuint kMostAttributes = 8;
  for (GLuint location = 0; location < kMostAttributes; ++location) {
    const auto read = [&](GLenum name) {
      GLint value = 0;
      glGetVertexArrayIndexediv(array, location, name, &value);
      return value;
    };
    if (read(GL_VERTEX_ATTRIB_ARRAY_ENABLED) != 0)
      draw.attributes.push_back(
          {static_cast<int>(location), read(GL_VERTEX_ATTRIB_ARRAY_SIZE), read(GL_VERTEX_ATTRIB_RELATIVE_OFFSET)});
  }
  if (draw.attributes.empty()) return;
  draw.stride = read_indexed(GL_VERTEX_BINDING_STRIDE, 0);
  const auto buffer = buffers_.find(static_cast<GLuint>(read_indexed(GL_VERTEX_BINDING_BUFFER, 0)));
  if (buffer != buffers_.end()) draw.vertices = buffer->second;
}

/// Returns the ids of the textures of `targets`.
std::vector<GLuint> Recorder::read_targets(GLuint framebuffer, bool with_depth,
                                           std::vector<StepTarget>& targets) const {
  std::vector<GLuint> ids;
  const auto add = [&](GLenum attachment, int place) {
    const auto read = [&](GLenum name) {
      GLint value = 0;
      glGetNamedFramebufferAttachmentParameteriv(framebuffer, attachment, name, &value);
      return value;
    };
    if (read(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) != GL_TEXTURE) return;
    const auto id = static_cast<GLuint>(read(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
    const auto found = textures_.find(id);
    if (found == textures_.end()) return;
    const int level = read(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL);
    targets.push_back({place, found->second.texture, level, found->second.levels[static_cast<std::size_t>(level)]});
    ids.push_back(id);
  };
  for (int i = 0; i < Framebuffer::kMaxColors; ++i) add(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i), i);
  if (with_depth) add(GL_DEPTH_ATTACHMENT, StepTarget::kDepth);
  return ids;
}

void Recorder::record_draw(int first, int count) {
  const auto framebuffer = read_id(GL_DRAW_FRAMEBUFFER_BINDING), id = read_id(GL_CURRENT_PROGRAM);
  const auto program = programs_.find(id);
  if (framebuffer == 0 || program == programs_.end()) return;
  DrawStep draw;
  draw.program = program->second;
  draw.first = first;
  draw.count = count;
  read_state(draw);
  read_vertices(draw);
  read_uniforms(id, draw);
  Step step;
  const std::vector<GLuint> ids = read_targets(framebuffer, draw.depth_function != GL_NONE, step.targets);
  // What a draw would read of its own target is undefined: such a sampler is bound, and not used.
  std::erase_if(draw.inputs, [&](const StepInput& input) {
    return std::ranges::any_of(step.targets, [&](const StepTarget& target) {
      return target.texture == input.texture && target.level <= input.sampling.last_level;
    });
  });
  if (covers_all(draw, step.targets))
    for (StepTarget& target : step.targets) target.before = nullptr;
  step.what = std::move(draw);
  write(std::move(step), ids);
}

void Recorder::record_clear(GLuint framebuffer, GLenum buffer, int place, const float* value) {
  ClearStep clear;
  const bool is_depth = buffer == GL_DEPTH;
  clear.value = is_depth ? glm::vec4(value[0], 0.0f, 0.0f, 0.0f) : glm::make_vec4(value);
  std::vector<StepTarget> targets;
  const std::vector<GLuint> ids = read_targets(framebuffer, is_depth, targets);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (targets[i].place != (is_depth ? StepTarget::kDepth : place)) continue;
    targets[i].before = nullptr;
    write({clear, {targets[i]}}, {ids[i]});
  }
}

void Recorder::record_upload(GLuint id, int width, int height, GLenum format, GLenum type, const void* texels) {
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * bytes_per_texel(format, type);
  const auto found = textures_.find(id);
  if (found != textures_.end())
    write({UploadStep{format, type, copy_bytes(texels, count)}, {{0, found->second.texture, 0, nullptr}}}, {id});
}

void Recorder::record_mipmaps(GLuint id) {
  const auto found = textures_.find(id);
  if (found == textures_.end()) return;
  Step step{MipmapStep{}, {}};
  std::vector<GLuint> ids;
  for (int level = 0; level < found->second.texture->levels; ++level, ids.push_back(id))
    step.targets.push_back({0, found->second.texture, level, level == 0 ? found->second.levels[0] : nullptr});
  write(std::move(step), ids);
}

}  // namespace shadowbench::gl
