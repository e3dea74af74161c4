#include "harness/render/prefilter.h"

#include <fmt/format.h>

#include "filters/gaussian.h"
#include "harness/render/filter_glsl.h"

namespace shadowbench::render {
namespace {

constexpr GLuint kStoredUnit = 3;  // of lib/map_access.glsl

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

}  // namespace

Prefilter::Prefilter(ShaderLibrary& shaders, const filters::FilterRequest& request, int map_size,
                     const LightSetup& light, const Defines& map_defines)
    : stored_(
          std::make_shared<ImageTarget>(request.spec.id + " map", store_format(request.values), map_size, map_size)),
      encode_(shaders.compile_filter(request.spec.id + " encode", "encode.frag", map_defines, filter_pieces(request))) {
  encode_.set("map_texel_uv", 1.0f / static_cast<float>(map_size));
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

void Prefilter::run(const ShadowMap& map) {
  map.bind();
  stored_->bind();
  encode_.use();
  triangle_.draw();
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

EncodedTexels Prefilter::read_before_blur(const ShadowMap& map) {
  if (radius_ == 0) return read(*stored_);
  map.bind();
  scratch_->bind();
  encode_.use();
  triangle_.draw();
  return read(*scratch_);
}

std::int64_t Prefilter::texels_written() const {
  const std::int64_t side = stored_->texture().width();
  return passes() * side * side;
}

}  // namespace shadowbench::render
