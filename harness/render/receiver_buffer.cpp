#include "harness/render/receiver_buffer.h"

#include "harness/gl/fullscreen.h"
#include "harness/render/gbuffer.h"

namespace shadowbench::render {
namespace {

constexpr GLuint kPlacesUnit = 5, kPlanesUnit = 6, kSharesUnit = 16;  // of lib/receiver.glsl

void set_share(gl::Program& prepare, const scene::LayerShare& share) {
  if (const auto* slice = std::get_if<scene::ViewSlice>(&share)) {
    prepare.set("layer_slice",
                glm::vec4(slice->fade_in_begin, slice->fade_in_end, slice->fade_out_begin, slice->fade_out_end));
  }
  if (const auto* face = std::get_if<scene::CubeFace>(&share)) prepare.set("layer_face", face->index);
}

}  // namespace

ReceiverBuffer::ReceiverBuffer(gl::Program& prepare, const GBuffer& gbuffer, const LightSetup& light)
    : light_(light),
      places_("receivers in the map", GL_RGBA32F, gbuffer.width(), gbuffer.height()),
      planes_("receiver planes", GL_RGBA32F, gbuffer.width(), gbuffer.height()) {
  gl::Framebuffer framebuffer("receivers");
  framebuffer.attach_color(0, places_);
  framebuffer.attach_color(1, planes_);
  if (light.frustum.is_layered()) {
    layer_.emplace(Layer{{"receivers' shares", GL_R32F, gbuffer.width(), gbuffer.height()},
                         {"receivers of a layer", GL_DEPTH_COMPONENT32F, gbuffer.width(), gbuffer.height()}});
    framebuffer.attach_color(2, layer_->shares);
    framebuffer.attach_depth(layer_->mask);
  }
  set_light(prepare, light);
  set_share(prepare, light.frustum.share);
  framebuffer.bind();
  gbuffer.bind();
  prepare.use();
  if (layer_)
    gl::FullscreenTriangle().draw_depth();
  else
    gl::FullscreenTriangle().draw();
}

bool ReceiverBuffer::is_of(const LightSetup& light) const {
  const scene::LightFrustum &own = light_.frustum, &other = light.frustum;
  return own.uv_depth_from_world == other.uv_depth_from_world && own.light_from_world == other.light_from_world &&
         own.direction_ws == other.direction_ws && own.texel_size_ws == other.texel_size_ws &&
         own.depth_range_ws == other.depth_range_ws && own.projective == other.projective && own.shape == other.shape &&
         own.log_curve == other.log_curve && own.paraboloid == other.paraboloid &&
         own.perspective.has_value() == other.perspective.has_value() && own.layer == other.layer &&
         own.share == other.share && light_.bias.normal_offset_texels == light.bias.normal_offset_texels &&
         light_.bias.max_tangent == light.bias.max_tangent && light_.range.far_test == light.range.far_test &&
         light_.range.behind_test == light.range.behind_test;
}

void ReceiverBuffer::bind() const {
  for (const GLuint unit : {kPlacesUnit, kPlanesUnit}) gl::Sampler::unbind(unit);
  places_.bind(kPlacesUnit);
  planes_.bind(kPlanesUnit);
  if (!layer_) return;
  gl::Sampler::unbind(kSharesUnit);
  layer_->shares.bind(kSharesUnit);
}

}  // namespace shadowbench::render
