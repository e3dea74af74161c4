#include "harness/render/prefilter.h"

#include <fmt/format.h>

#include "base/error.h"
#include "filters/kernel.h"
#include "harness/render/filter_glsl.h"

namespace shadowbench::render {
namespace {

constexpr GLuint kStoredUnit = 3;   // of lib/map_access.glsl
constexpr GLuint kSamplesUnit = 4;  // of encode.frag

GLenum store_format(const filters::ParamValues& values) {
  return gl::parse_pixel_format(filters::text_or(values, "store", "")).internal_format;
}

/// The kernel, one call of the macro `tap` per texel: "tap(-1.0, 0.25) tap(0.0, 0.5) tap(1.0, 0.25)".
Defines blur_defines(const filters::FilterRequest& request, int radius) {
  const std::vector<float> weights = filters::gaussian_weights(radius);
  std::string taps;
  for (int i = -radius; i <= radius; ++i)
    taps += fmt::format("tap({}.0, {:#.9g}) ", i, weights[static_cast<std::size_t>(i + radius)]);
  Defines defines = {{"TAPS(tap)", taps}};
  if (filters::combines_logs(request.values)) defines.emplace_back("COMBINE_LOGS", "1");
  return defines;
}

/// Throws Error(kFilter) with the line of `samples` where the GL gives fewer.
Defines add_samples(Defines defines, const filters::FilterRequest& request) {
  const int samples = filters::depth_samples(request.values);
  GLint most = 0;
  glGetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &most);
  if (samples > most) {
    throw Error(ErrorKind::kFilter,
                fmt::format("samples = {}: this GL gives at most {} samples of depth a texel", samples, most),
                fmt::format("{}:{}", request.spec.path, request.spec.samples_line));
  }
  if (samples > 1) defines.emplace_back("SAMPLES", std::to_string(samples));
  if (filters::combines_logs(request.values)) defines.emplace_back("COMBINE_LOGS", "1");
  return defines;
}

}  // namespace

Prefilter::Samples::Samples(const ShadowMap& map, int samples)
    : count(samples), depth("depth samples", map.settings().format, map.size(), map.size(), 1, samples) {
  framebuffer.attach_depth(depth);
}

Prefilter::Prefilter(ShaderLibrary& shaders, const filters::FilterRequest& request, const ShadowMap& map,
                     const LightSetup& light, Defines map_defines)
    : shaders_(&shaders),
      stored_(std::make_shared<ImageTarget>(request.spec.id + " map", store_format(request.values), map.size(),
                                            map.size())),
      encode_(shaders.compile_filter(request.spec.id + " encode", "encode.frag",
                                     add_samples(std::move(map_defines), request), filter_pieces(request))) {
  if (const int samples = filters::depth_samples(request.values); samples > 1) samples_.emplace(map, samples);
  encode_.set("map_texel_uv", 1.0f / static_cast<float>(map.size()));
  const bool nearest = filters::reads_nearest(request.values);
  sampler_.set_filter(nearest ? GL_NEAREST : GL_LINEAR, nearest ? GL_NEAREST : GL_LINEAR);
  sampler_.set_wrap(wrap_mode(light.range.border));
  blur_sampler_.set_wrap(wrap_mode(light.range.border));
  reads_border_ = light.range.border == filters::Border::kBorder;
  retune(shaders, request, light);
}

void Prefilter::retune(ShaderLibrary& shaders, const filters::FilterRequest& request, const LightSetup& light) {
  set_uniforms(encode_, request, light);
  set_border(encode_border(store_format(request.values)));
  radius_ = filters::prefilter_radius_texels(request.spec, request.values);
  if (radius_ == 0) return;
  blur_ = &shaders.fullscreen("blur.frag", blur_defines(request, radius_));
  if (scratch_) return;
  scratch_.emplace(request.spec.id + " blur", store_format(request.values), stored_->texture().width(),
                   stored_->texture().width());
}

glm::vec4 Prefilter::find_border(const LightSetup& light) {
  set_light(encode_, light);
  return encode_border(format());
}

void Prefilter::turn_to(const LightSetup& light, const glm::vec4& border, std::shared_ptr<ImageTarget> stored) {
  set_light(encode_, light);
  set_border(border);
  stored_ = std::move(stored);
}

/// The blur reads outside the map as the lookup does.
void Prefilter::set_border(const glm::vec4& border) {
  border_ = border;
  sampler_.set_border(border);
  blur_sampler_.set_border(border);
}

/// Outside the map lies the encoding of depth 1, stored in the map's own format.
glm::vec4 Prefilter::encode_border(GLenum format) {
  ImageTarget texel("encoded border", format, 1, 1);
  encode_.set("encode_border", 1);
  texel.bind();
  encode_.use();
  triangle_.draw();
  encode_.set("encode_border", 0);
  std::vector<float> value = texel.texture().read_floats(texel.texture().format().channels);
  value.resize(4, 0.0f);
  return {value[0], value[1], value[2], value[3]};
}

void Prefilter::encode(const ShadowMap& map, int layer, ImageTarget& to) {
  if (samples_) {
    map.draw_samples(*shaders_, samples_->framebuffer, layer);
    gl::Sampler::unbind(kSamplesUnit);
    samples_->depth.bind(kSamplesUnit);
  }
  map.bind(encode_, layer);
  to.bind();
  encode_.use();
  triangle_.draw();
}

void Prefilter::run(const ShadowMap& map, int layer) {
  encode(map, layer, *stored_);
  if (radius_ == 0) return;
  blur(stored_->texture(), *scratch_, {1.0f, 0.0f});
  blur(scratch_->texture(), *stored_, {0.0f, 1.0f});
}

void Prefilter::blur(const gl::Texture& from, ImageTarget& to, glm::vec2 direction) {
  to.bind();
  blur_->set("direction", direction);
  blur_->set("map_texel_uv", 1.0f / static_cast<float>(from.width()));
  blur_sampler_.bind(kStoredUnit);
  from.bind(kStoredUnit);
  blur_->use();
  triangle_.draw();
}

void Prefilter::bind() const {
  stored_->texture().bind(kStoredUnit);
  sampler_.bind(kStoredUnit);
}

EncodedTexels Prefilter::read(const ImageTarget& target) {
  const int channels = target.texture().format().channels;
  return {target.texture().width(), channels, target.texture().read_floats(channels)};
}

EncodedTexels Prefilter::read() const { return read(*stored_); }

EncodedTexels Prefilter::read_before_blur(const ShadowMap& map, int layer) {
  if (radius_ == 0) return read(*stored_);
  encode(map, layer, *scratch_);
  return read(*scratch_);
}

std::int64_t Prefilter::texels_written() const {
  const std::int64_t side = stored_->texture().width();
  return (passes() + (samples_ ? samples_->count - 1 : 0)) * side * side;
}

std::vector<DrawnPass> Prefilter::list_passes(int depth_bytes) const {
  const gl::PixelFormat& format = stored_->texture().format();
  const std::int64_t texels = std::int64_t{1} * stored_->texture().width() * stored_->texture().width();
  std::vector<DrawnPass> passes = {{.name = "encode",
                                    .fragment = encode_.last_stage(),
                                    .target = format,
                                    .texels = texels,
                                    .read_bytes = depth_bytes}};
  if (radius_ > 0)
    passes.push_back({.name = "blur",
                      .fragment = blur_->last_stage(),
                      .target = format,
                      .draws = 2,
                      .texels = 2 * texels,
                      .read_bytes = format.bytes_per_texel});
  return passes;
}

}  // namespace shadowbench::render
