#include "harness/run/frames.h"

#include <algorithm>
#include <utility>

#include "harness/live/frame_file.h"
#include "harness/measure/filter_setup.h"
#include "harness/run/task_images.h"

namespace shadowbench::run {
namespace {

/// Texels around those that receivers lie in, which kernels and penumbrae read.
constexpr int kMarginTexels = 64;

/// A rectangle with its rows counted from below, as OpenGL counts them.
images::Rect flip(const images::Rect& rect, int height) {
  return {rect.x, height - rect.y - rect.height, rect.width, rect.height};
}

std::vector<float> cut(const std::vector<float>& texels, int width, int channels, const images::Rect& rect) {
  std::vector<float> part;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    const auto row = texels.begin() + channels * (std::ptrdiff_t{y} * width + rect.x);
    part.insert(part.end(), row, row + std::ptrdiff_t{channels} * rect.width);
  }
  return part;
}

/// The texels of a map of `size` that hold these receivers, as far as they lie in `rect` of the picture, and a margin.
images::Rect find_texels(const std::vector<filters::Receiver>& receivers, const images::Rect& rect, int size) {
  int left = size, right = -1, bottom = size, top = -1;
  for (const filters::Receiver& receiver : receivers) {
    const glm::ivec2 within = receiver.pixel - glm::ivec2(rect.x, rect.y);
    if (within.x < 0 || within.y < 0 || within.x >= rect.width || within.y >= rect.height) continue;
    const glm::ivec2 texel(receiver.uv * static_cast<float>(size));
    left = std::min(left, texel.x);
    right = std::max(right, texel.x);
    bottom = std::min(bottom, texel.y);
    top = std::max(top, texel.y);
  }
  if (right < left) return {};
  left = std::clamp(left - kMarginTexels, 0, size - 1);
  bottom = std::clamp(bottom - kMarginTexels, 0, size - 1);
  return {left, bottom, std::clamp(right + kMarginTexels, left, size - 1) + 1 - left,
          std::clamp(top + kMarginTexels, bottom, size - 1) + 1 - bottom};
}

live::Check make_check(measure::Renderer& renderer, const options::RunOptions& options, const measure::SceneTask& task,
                       measure::SceneAssets& assets, const images::Rect& hardest) {
  const render::GBuffer& gbuffer = assets.gbuffer(*task.camera);
  const measure::LightMap& light = assets.light_map(*task.camera, task.map_size);
  const bool is_whole = renderer.recorder->lacks_vertices();
  const images::Rect rect = is_whole ? images::Rect{0, 0, gbuffer.width(), gbuffer.height()} : hardest;
  live::Check check{rect, {}, is_whole};
  const images::Rect below = flip(rect, gbuffer.height());
  const auto add = [&](const gl::Texture& texture, const std::vector<float>& texels, int channels,
                       const images::Rect& part, float fill) {
    check.known.push_back(
        {renderer.recorder->content_of(texture), part, channels, fill, cut(texels, texture.width(), channels, part)});
  };
  std::vector<const gl::Texture*> receivers = {&gbuffer.position(), &gbuffer.normal()};
  if (is_whole) receivers.insert(receivers.end(), {&gbuffer.shading_normal(), &gbuffer.albedo()});
  for (const gl::Texture* texture : receivers) add(*texture, texture->read_floats(4), 4, below, 0.0f);
  for (const render::LightSetup& layer : measure::make_unbiased_light(options, task.scene->light, light.layers)) {
    const int index = layer.frustum.layer;
    const int size = light.map.size();
    const images::Rect part = is_whole
                                  ? images::Rect{0, 0, size, size}
                                  : find_texels(render::read_receivers(renderer.shaders, gbuffer, layer), below, size);
    add(light.map.texture(index), light.map.read(index).stored, 1, part, light.map.settings().curve.far_plane());
  }
  return check;
}

}  // namespace

void write_frames(measure::Renderer& renderer, const options::RunOptions& options, const measure::SceneTask& task,
                  measure::SceneAssets& assets, measure::SceneMeasurement& measured) {
  std::map<std::string, live::Frame> frames;
  for (measure::MeasuredCell& cell : measured.cells)
    if (cell.frame)
      frames[cell.record.key] = {std::exchange(cell.frame, nullptr), std::exchange(cell.empty_frame, nullptr),
                                 cell.request, cell.light.front().light_size};
  if (frames.empty()) return;
  const live::Check check =
      make_check(renderer, options, task, assets,
                 choose_crop(measured.cells, {std::max(1, options.width / 4), std::max(1, options.height / 4)}));
  const std::string path = live::write_frames(options.out, frames, check);
  for (measure::MeasuredCell& cell : measured.cells)
    if (frames.contains(cell.record.key)) cell.record.images.frames = path;
}

}  // namespace shadowbench::run
