#include "harness/render/receivers.h"

#include "harness/gl/fullscreen.h"

namespace shadowbench::render {
namespace {

/// The receiver pass as it was read back: three RGBA texels per pixel.
struct ReceiverTexels {
  int width;
  std::vector<float> map;    // uv, depth, depth_unbiased
  std::vector<float> light;  // texel_size_ws, light_size, light_nearness, the layer's share
  std::vector<float> plane;  // depth_per_texel, n_dot_l, view_depth (0: no receiver, negative: beyond the map's reach)

  std::size_t pixels() const { return map.size() / 4; }
  bool counts(std::size_t i) const { return plane[4 * i + 3] != 0.0f && plane[4 * i + 2] > filters::kFacesLight; }
  bool is_asked_about(std::size_t i) const { return counts(i) && plane[4 * i + 3] > 0.0f && light[4 * i + 3] > 0.0f; }
};

ReceiverTexels draw_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light) {
  const gl::Texture map("receivers in the map", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  const gl::Texture plane("receiver planes", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  const gl::Texture size("receivers and the light", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  gl::Framebuffer framebuffer("receivers");
  framebuffer.attach_color(0, map);
  framebuffer.attach_color(1, plane);
  framebuffer.attach_color(2, size);
  gl::Program& program = shaders.fullscreen("receiver.frag", receiver_defines(light));
  const ReceiverBuffer& receivers = gbuffer.receivers(shaders, light);
  set_light(program, light);
  framebuffer.bind();
  gbuffer.bind();
  receivers.bind();
  program.use();
  gl::FullscreenTriangle().draw();
  return {gbuffer.width(), map.read_floats(4), size.read_floats(4), plane.read_floats(4)};
}

/// As shaders/lib/receiver.glsl computes it.
glm::vec2 bias_per_texel(const glm::vec2& depth_per_texel, float texel_size_ws, const LightSetup& light) {
  const float steepest =
      static_cast<float>(light.bias.max_tangent) * texel_size_ws / static_cast<float>(light.frustum.depth_range_ws);
  return static_cast<float>(light.bias.plane_kernels) * glm::min(glm::abs(depth_per_texel), glm::vec2(steepest));
}

filters::Receiver make_receiver(const ReceiverTexels& texels, std::size_t i, const LightSetup& light) {
  const float* map = &texels.map[4 * i];
  const float* plane = &texels.plane[4 * i];
  filters::Receiver r;
  r.uv = {map[0], map[1]};
  r.depth = map[2];
  r.depth_unbiased = map[3];
  r.depth_per_texel = {plane[0], plane[1]};
  r.texel_size_ws = texels.light[4 * i];
  r.light_size = texels.light[4 * i + 1];
  r.light_nearness = texels.light[4 * i + 2];
  r.layer = light.frustum.layer;
  r.layer_share = texels.light[4 * i + 3];
  r.bias_per_texel = bias_per_texel(r.depth_per_texel, r.texel_size_ws, light);
  r.n_dot_l = plane[2];
  r.view_depth = plane[3];
  r.depth_range_ws = static_cast<float>(light.frustum.depth_range_ws);
  r.pixel = {static_cast<int>(i) % texels.width, static_cast<int>(i) / texels.width};
  return r;
}

}  // namespace

std::int64_t count_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightLayers& light) {
  const ReceiverTexels texels = draw_receivers(shaders, gbuffer, light.front());
  std::int64_t count = 0;
  for (std::size_t i = 0; i < texels.pixels(); ++i) count += texels.counts(i) ? 1 : 0;
  return count;
}

std::vector<float> read_layer_shares(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& layer) {
  const ReceiverTexels texels = draw_receivers(shaders, gbuffer, layer);
  const auto width = static_cast<std::size_t>(gbuffer.width()), height = static_cast<std::size_t>(gbuffer.height());
  std::vector<float> shares;
  for (std::size_t y = height; y-- > 0;)
    for (std::size_t x = 0; x < width; ++x) shares.push_back(texels.light[4 * (y * width + x) + 3]);
  return shares;
}

std::vector<filters::Receiver> read_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light) {
  const ReceiverTexels texels = draw_receivers(shaders, gbuffer, light);
  const std::vector<float> positions = gbuffer.position().read_floats(4), normals = gbuffer.normal().read_floats(4);
  std::vector<filters::Receiver> receivers;
  for (std::size_t i = 0; i < texels.pixels(); ++i) {
    if (!texels.is_asked_about(i)) continue;
    receivers.push_back(make_receiver(texels, i, light));
    receivers.back().position_ws = {positions[4 * i], positions[4 * i + 1], positions[4 * i + 2]};
    receivers.back().normal_ws = {normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]};
  }
  return receivers;
}

}  // namespace shadowbench::render
