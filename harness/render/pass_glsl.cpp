#include <fmt/format.h>

#include "harness/render/map_passes.h"

namespace shadowbench::render {
namespace {

using filters::PassSpec;
using filters::PassSteps;

constexpr const char* kLoad = R"(
layout(binding = {unit}) uniform {sampler} map_{name};
{texel} load_{name}(ivec2 texel{parameter}) {{
  {count};
  return texelFetch(map_{name}, clamp(texel, ivec2(0), textureSize(map_{name}, {level}) - 1), {level});
}}
)";

constexpr const char* kFetch = R"(
vec4 fetch_{name}(Receiver r, vec2 offset_texels) {{
  COUNT_FETCH(r, offset_texels, {texels});
  return textureLod(map_{name}, r.uv + offset_texels * map_texel_uv, 0.0);
}}
)";

constexpr const char* kFetchLevels = R"(
vec4 fetch_{name}_lod(Receiver r, vec2 offset_texels, float lod) {{
  COUNT_FETCH(r, offset_texels, {texels} * exp2(ceil(max(lod, 0.0))));
  return textureLod(map_{name}, r.uv + offset_texels * map_texel_uv, lod);
}}
vec4 fetch_{name}_grad(Receiver r, vec2 offset_texels, vec2 along_x, vec2 along_y) {{
  COUNT_FETCH(r, offset_texels, max(length(along_x), length(along_y)) + {texels});
  return textureGrad(map_{name}, r.uv + offset_texels * map_texel_uv, along_x * map_texel_uv, along_y * map_texel_uv);
}}
)";

std::string declare_pass_map(const PassSpec& spec, GLuint unit) {
  const bool has_levels = spec.steps == PassSteps::kLevels;
  const char* level = has_levels ? "level" : "0";
  const char* texels = spec.half ? "2.0" : "1.0";  // of the depth map along one of level 0
  // What a prefix sum holds has come from anywhere: how far off it is read says nothing.
  const std::string count = spec.steps == PassSteps::kPrefix
                                ? "COUNT_LOAD(counted_uv / map_texel_uv, 0.0)"
                                : fmt::format(
                                      "COUNT_LOAD((vec2(texel) + 0.5) * {0} * exp2(float({1})), 0.5 * {0} * "
                                      "exp2(float({1})))",
                                      texels, level);
  const char* parameter = has_levels ? ", int level" : "";
  const auto write = [&](const char* glsl) {
    return fmt::format(fmt::runtime(glsl), fmt::arg("unit", unit), fmt::arg("name", spec.name),
                       fmt::arg("sampler", spec.is_integer() ? "usampler2D" : "sampler2D"),
                       fmt::arg("texel", spec.texel_type()), fmt::arg("parameter", parameter), fmt::arg("count", count),
                       fmt::arg("level", level), fmt::arg("texels", texels));
  };
  return write(kLoad) + (spec.is_integer() ? "" : write(kFetch)) +
         (spec.is_integer() || !has_levels ? "" : write(kFetchLevels));
}

}  // namespace

std::string declare_pass_maps(const filters::FilterSpec& spec) {
  std::string glsl;
  for (std::size_t i = 0; i < spec.passes.size(); ++i)
    glsl += declare_pass_map(spec.passes[i], kFirstPassUnit + static_cast<GLuint>(i));
  return glsl;
}

}  // namespace shadowbench::render
