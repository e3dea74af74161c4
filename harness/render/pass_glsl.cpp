#include <fmt/format.h>

#include "harness/gl/pixel_format.h"
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
  COUNT_FETCH(r, offset_texels, {texels}, {bits});
  return textureLod(map_{name}, r.uv + offset_texels * map_texel_uv, 0.0);
}}
)";

// How far a footprint extends follows from the pixel, and not from a kernel: its reach is not counted. Samplers could
// take as many taps themselves, but not the same ones on every GL.
constexpr const char* kFetchLevels = R"(
vec4 fetch_{name}_lod(Receiver r, vec2 offset_texels, float lod) {{
  COUNT_FETCH(r, offset_texels, {texels} * exp2(ceil(max(lod, 0.0))), {bits});
  return textureLod(map_{name}, r.uv + offset_texels * map_texel_uv, lod);
}}
vec4 fetch_{name}_grad(Receiver r, vec2 offset_texels, vec2 along_x, vec2 along_y) {{
  float x = length(along_x), y = length(along_y);
  int taps = clamp(int(ceil(max(x, y) / max(min(x, y), {texels}))), 1, {anisotropy});
  float lod = log2(max(max(x, y) / (float(taps) * {texels}), 1.0));
  vec4 sum = vec4(0.0);
  for (int i = 0; i < taps; ++i) {{
    vec2 place = offset_texels + (x > y ? along_x : along_y) * ((float(i) + 0.5) / float(taps) - 0.5);
    COUNT_FETCH(r, offset_texels, {texels}, {bits});
    sum += textureLod(map_{name}, r.uv + place * map_texel_uv, lod);
  }}
  return sum / float(taps);
}}
)";

int texel_bits(const std::string& store) { return 8 * gl::parse_pixel_format(store).bytes_per_texel; }

std::string declare_pass_map(const PassSpec& spec, GLuint unit) {
  const bool has_levels = spec.steps == PassSteps::kLevels;
  const char* level = has_levels ? "level" : "0";
  const char* texels = spec.half ? "2.0" : "1.0";  // of the depth map along one of level 0
  const int bits = texel_bits(spec.store);
  // What a prefix sum holds has come from anywhere: how far off it is read says nothing.
  const std::string count = spec.steps == PassSteps::kPrefix
                                ? fmt::format("COUNT_LOAD(counted_uv / map_texel_uv, 0.0, {})", bits)
                                : fmt::format(
                                      "COUNT_LOAD((vec2(texel) + 0.5) * {0} * exp2(float({1})), 0.5 * {0} * "
                                      "exp2(float({1})), {2})",
                                      texels, level, bits);
  const char* parameter = has_levels ? ", int level" : "";
  const auto write = [&](const char* glsl) {
    return fmt::format(fmt::runtime(glsl), fmt::arg("unit", unit), fmt::arg("name", spec.name),
                       fmt::arg("sampler", spec.is_integer() ? "usampler2D" : "sampler2D"),
                       fmt::arg("texel", spec.texel_type()), fmt::arg("parameter", parameter), fmt::arg("count", count),
                       fmt::arg("level", level), fmt::arg("bits", bits), fmt::arg("texels", texels),
                       fmt::arg("anisotropy", spec.anisotropy));
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
