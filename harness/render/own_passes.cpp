#include "harness/render/own_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/error.h"
#include "harness/render/filter_glsl.h"

namespace shadowbench::render {
namespace {

using filters::PassSpec;
using filters::PassSteps;

constexpr int kRadix = 4;  // a step of a prefix sum adds so many terms

std::string map_name(const PassSpec& spec) { return "map_" + spec.name; }

}  // namespace

OwnPasses::OwnPasses(ShaderLibrary& shaders, const filters::FilterRequest& request, int map_size,
                     const LightSetup& light, const Defines& map_defines)
    : filter_(request.spec.path), map_size_(map_size) {
  for (const PassSpec& spec : request.spec.passes) {
    Defines defines = map_defines;
    defines.emplace_back("PASS", spec.name);
    defines.emplace_back("PASS_TEXEL", spec.texel_type());
    passes_.push_back({spec,
                       shaders.compile_filter(fmt::format("{} {}", request.spec.id, spec.name), "pass.frag", defines,
                                              filter_pieces(request)),
                       count_steps(spec)});
  }
  for (std::size_t i = 0; i < passes_.size(); ++i) check_reads(i);
  maps_ = make_maps();
  for (const Pass& pass : passes_) {
    const bool takes_turns = pass.spec.steps != PassSteps::kLevels && pass.steps > 1;
    scratch_.push_back(takes_turns ? std::make_unique<PassMap>(make_map(pass.spec)) : nullptr);
  }
  retune(request, light);
}

int OwnPasses::count_steps(const PassSpec& spec) const {
  switch (spec.steps) {
    case PassSteps::kOnce: return 1;
    case PassSteps::kAxes: return 3;
    case PassSteps::kPrefix: {  // a step to begin, and then one per power of the radix along each axis
      int steps = 0;
      for (int stride = 1; stride < side(spec); stride *= kRadix) ++steps;
      return 1 + 2 * steps;
    }
    case PassSteps::kLevels: break;
  }
  return std::bit_width(static_cast<unsigned>(side(spec)));
}

int OwnPasses::side(const PassSpec& spec) const {
  const int texels = spec.half ? map_size_ / 2 : map_size_;
  if (spec.steps != PassSteps::kLevels) return texels;
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(texels)));
}

void OwnPasses::fail(const PassSpec& spec, const std::string& message) const {
  throw Error(ErrorKind::kFilter, message, fmt::format("{}:{}", filter_, spec.line));
}

/// The compiler knows what a pass reads: it keeps the samplers of no other maps.
void OwnPasses::check_reads(std::size_t pass) const {
  for (std::size_t later = pass; later < passes_.size(); ++later) {
    const bool own = later == pass && passes_[pass].spec.steps != PassSteps::kOnce;
    if (own || !passes_[pass].program.has(map_name(passes_[later].spec))) continue;
    fail(passes_[pass].spec,
         fmt::format("the pass '{}' reads the map '{}', which is not written yet: move its table before this one",
                     passes_[pass].spec.name, passes_[later].spec.name));
  }
}

void OwnPasses::check_encode(const gl::Program& encode) const {
  for (const Pass& pass : passes_) {
    if (!encode.has(map_name(pass.spec))) continue;
    fail(pass.spec, fmt::format("encode() reads the map '{}', which is not written yet", pass.spec.name));
  }
}

PassMap OwnPasses::make_map(const PassSpec& spec) const {
  const GLenum format = gl::parse_pixel_format(spec.store).internal_format;
  const bool levels = spec.steps == PassSteps::kLevels;
  const GLenum magnify = spec.is_integer() ? GL_NEAREST : GL_LINEAR;
  PassMap map{gl::Texture(map_name(spec), format, side(spec), side(spec), levels ? count_steps(spec) : 1), {}};
  map.texture.set_filter(levels && !spec.is_integer() ? GL_LINEAR_MIPMAP_LINEAR : magnify, magnify);
  for (int level = 0; level < (levels ? count_steps(spec) : 1); ++level)
    map.levels.emplace_back(map_name(spec)).attach_color(0, map.texture, level);
  try {
    map.levels.front().bind();
  } catch (const Error& error) {
    fail(spec, fmt::format("this GL does not draw into a map of format {}: {}", spec.store, error.message()));
  }
  return map;
}

std::shared_ptr<PassMaps> OwnPasses::make_maps() const {
  auto maps = std::make_shared<PassMaps>();
  for (const Pass& pass : passes_) maps->push_back(make_map(pass.spec));
  return maps;
}

void OwnPasses::retune(const filters::FilterRequest& request, const LightSetup& light) {
  for (Pass& pass : passes_) {
    set_uniforms(pass.program, request, light);
    pass.program.set("map_texel_uv", 1.0f / static_cast<float>(map_size_));
  }
}

void OwnPasses::turn_to(const LightSetup& light, std::shared_ptr<PassMaps> maps) {
  for (Pass& pass : passes_) set_light(pass.program, light);
  maps_ = std::move(maps);
}

void OwnPasses::bind() const {
  for (std::size_t i = 0; i < passes_.size(); ++i) (*maps_)[i].texture.bind(kFirstPassUnit + static_cast<GLuint>(i));
}

void OwnPasses::run(const ShadowMap& map, int layer, const Prefilter* encoded) {
  if (encoded) encoded->bind();
  bind();
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    map.bind(passes_[i].program, layer);
    if (passes_[i].spec.steps == PassSteps::kLevels)
      run_levels(i);
    else
      run_steps(i);
  }
}

void OwnPasses::draw(Pass& pass, gl::Framebuffer& target, int step) {
  const int strides = (pass.steps - 1) / 2;  // along each axis
  const bool is_prefix = pass.spec.steps == PassSteps::kPrefix;
  const bool along_v = step > strides;
  int stride = 1;
  for (int i = 1; is_prefix && i < step - (along_v ? strides : 0); ++i) stride *= kRadix;
  target.bind();
  pass.program.set("pass_size", glm::ivec2(target.width(), target.height()));
  pass.program.set("pass_step", step);
  pass.program.set("pass_direction", along_v ? glm::ivec2(0, 1) : glm::ivec2(1, 0));
  pass.program.set("pass_stride", stride);
  pass.program.use();
  triangle_.draw();
}

/// Steps take turns between two maps, so that the last one writes to the map that is read.
void OwnPasses::run_steps(std::size_t i) {
  PassMap& last = (*maps_)[i];
  const GLuint unit = kFirstPassUnit + static_cast<GLuint>(i);
  for (int step = 0; step < passes_[i].steps; ++step) {
    const bool to_last = (passes_[i].steps - 1 - step) % 2 == 0;
    draw(passes_[i], (to_last ? last : *scratch_[i]).levels.front(), step);
    (to_last ? last : *scratch_[i]).texture.bind(unit);
  }
}

/// While a level is written only the ones before it can be read.
void OwnPasses::run_levels(std::size_t i) {
  PassMap& map = (*maps_)[i];
  for (int level = 0; level < passes_[i].steps; ++level) {
    map.texture.set_last_level(std::max(level - 1, 0));
    draw(passes_[i], map.levels[static_cast<std::size_t>(level)], level);
  }
  map.texture.set_last_level(passes_[i].steps - 1);
}

int OwnPasses::passes() const {
  int steps = 0;
  for (const Pass& pass : passes_) steps += pass.steps;
  return steps;
}

std::int64_t OwnPasses::texels_written(const Pass& pass) const {
  const std::int64_t all = std::int64_t{1} * side(pass.spec) * side(pass.spec);
  return pass.spec.steps == PassSteps::kLevels ? (4 * all - 1) / 3 : all * pass.steps;
}

std::int64_t OwnPasses::texels_written() const {
  std::int64_t texels = 0;
  for (const Pass& pass : passes_) texels += texels_written(pass);
  return texels;
}

std::vector<DrawnPass> OwnPasses::list_passes() const {
  std::vector<DrawnPass> passes;
  for (const Pass& pass : passes_) {
    const gl::PixelFormat& format = gl::parse_pixel_format(pass.spec.store);
    passes.push_back({.name = pass.spec.name,
                      .fragment = pass.program.last_stage(),
                      .target = format,
                      .draws = pass.steps,
                      .texels = texels_written(pass),
                      .read_bytes = format.bytes_per_texel});
  }
  return passes;
}

std::int64_t OwnPasses::bytes(const gl::Program& reader) const {
  std::int64_t bytes = 0;
  for (std::size_t i = 0; i < passes_.size(); ++i)
    if (reader.has(map_name(passes_[i].spec))) bytes += static_cast<std::int64_t>((*maps_)[i].texture.bytes());
  return bytes;
}

}  // namespace shadowbench::render
