#include "harness/render/screen_passes.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace shadowbench::render {
namespace {

constexpr GLuint kScreenUnit = 4;  // of lib/screen_input.glsl

}  // namespace

ScreenPasses::ScreenPasses(ShaderLibrary& shaders, const filters::FilterRequest& request, const LightSetup& light,
                           const Defines& map_defines)
    : request_(request), map_defines_(map_defines), passes_(compile(shaders, light, nullptr)) {
  std::vector<std::string> maps = {"map_depth", "map_compare", "map_compare_nearest", "map_stored"};
  for (const filters::PassSpec& own : request.spec.passes) maps.push_back("map_" + own.name);
  for (const Pass& pass : passes_) {
    if (std::ranges::any_of(maps, [&](const std::string& map) { return pass.program.has(map); }))
      throw Error(ErrorKind::kFilter,
                  fmt::format("the screen pass '{}' reads the shadow map: only visibility() may; hand on what it finds "
                              "as screen_value",
                              pass.spec.name),
                  fmt::format("{}:{}", request.spec.path, pass.spec.line));
  }
}

std::vector<ScreenPasses::Pass> ScreenPasses::compile(ShaderLibrary& shaders, const LightSetup& light,
                                                      const CountingSource* counting) const {
  std::vector<Pass> compiled;
  std::vector<gl::Piece> pieces = filter_pieces(request_);
  if (counting) pieces.back().text = counting->body;
  for (const filters::ScreenSpec& spec : filters::list_screens(request_.spec, request_.values)) {
    Defines defines = map_defines_;
    defines.emplace_back("PASS", spec.name);
    if (counting) defines.insert(defines.end(), counting->defines.begin(), counting->defines.end());
    compiled.push_back({spec, shaders.compile_filter(fmt::format("{} {}", request_.spec.id, spec.name), "screen.frag",
                                                     defines, pieces)});
    set_uniforms(compiled.back().program, request_, light);
  }
  return compiled;
}

void ScreenPasses::retune(const filters::FilterRequest& request, const LightSetup& light) {
  request_ = request;
  for (Pass& pass : passes_) set_uniforms(pass.program, request, light);
}

ImageTarget& ScreenPasses::input(const GBuffer& gbuffer) {
  const auto fits = [&] {
    const gl::Texture& image = images_.front().texture();
    return image.width() == gbuffer.width() && image.height() == gbuffer.height();
  };
  if (images_.empty() || !fits()) {
    images_.clear();
    for (const char* label : {"screen", "screen, the other"})
      images_.emplace_back(label, GL_RG32F, gbuffer.width(), gbuffer.height());
  }
  return images_.front();
}

void ScreenPasses::draw(Pass& pass, int step, const gl::Texture& from) {
  from.bind(kScreenUnit);
  pass.program.set("pass_step", step);
  pass.program.use();
  triangle_.draw();
}

void ScreenPasses::run(const GBuffer& gbuffer, ImageTarget& target, const std::optional<glm::ivec2>& columns) {
  gbuffer.bind();
  int left = passes(), from = 0;
  for (Pass& pass : passes_) {
    for (int step = 0; step < pass.spec.steps; ++step) {
      ImageTarget& to = --left == 0 ? target : images_[static_cast<std::size_t>(1 - from)];
      to.bind();
      if (left == 0 && columns) glViewport(columns->x, 0, columns->y - columns->x, gbuffer.height());
      draw(pass, step, images_[static_cast<std::size_t>(from)].texture());
      from = 1 - from;
    }
  }
}

ScreenReads ScreenPasses::count_reads(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light,
                                      const CountingSource& source) {
  ScreenReads found;
  std::vector<Pass> counting = compile(shaders, light, &source);
  const gl::Texture reads("screen reads", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  gbuffer.bind();
  std::size_t from = 0;
  for (Pass& pass : counting) {
    double farthest = 0.0;
    for (int step = 0; step < pass.spec.steps; ++step) {
      gl::Framebuffer framebuffer("screen reads");
      framebuffer.attach_color(0, images_[1 - from].texture());
      framebuffer.attach_color(1, reads);
      framebuffer.bind();
      draw(pass, step, images_[from].texture());
      from = 1 - from;
      const std::vector<float> counted = reads.read_floats(4);
      double sum = 0.0, receivers = 0.0;
      for (std::size_t i = 0; i < counted.size(); i += 4) {
        if (counted[i] < 0.0f) continue;
        sum += static_cast<double>(counted[i]);
        receivers += 1.0;
        found.most_turns = std::max(found.most_turns, static_cast<int>(counted[i + 2]));
        farthest = std::max(farthest, static_cast<double>(counted[i + 1]));
      }
      found.per_receiver += sum / std::max(receivers, 1.0);
    }
    const int declared = filters::reach_pixels(pass.spec, request_.values);
    if (farthest > declared)
      found.exceeded.push_back(
          fmt::format("'{}' reads {} pixels away, and declares a reach of {}", pass.spec.name, farthest, declared));
  }
  return found;
}

int ScreenPasses::passes() const {
  int steps = 0;
  for (const Pass& pass : passes_) steps += pass.spec.steps;
  return steps;
}

std::vector<DrawnPass> ScreenPasses::list_passes() const {
  std::vector<DrawnPass> passes;
  const gl::PixelFormat& format = gl::pixel_format(GL_RG32F);
  for (const Pass& pass : passes_)
    passes.push_back({.name = pass.spec.name,
                      .fragment = pass.program.last_stage(),
                      .target = format,
                      .draws = pass.spec.steps,
                      .read_bytes = gl::pixel_format(GL_RGBA32F).bytes_per_texel,  // most are of the G-buffer
                      .is_screen = true});
  return passes;
}

}  // namespace shadowbench::render
