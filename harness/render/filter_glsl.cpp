#include "harness/render/filter_glsl.h"

#include <fmt/format.h>

#include <cctype>

#include "filters/disk_points.h"
#include "filters/store_format.h"
#include "harness/gl/pixel_format.h"

namespace shadowbench::render {
namespace {

using filters::FilterRequest;
using filters::ParamSpec;
using filters::ParamValue;
using filters::PassSpec;
using filters::PassSteps;

std::string literal(float value) {
  const std::string digits = fmt::format("{:.9g}", value);
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}

std::string constant_name(const std::string& param, const std::string& choice) {
  std::string name = param + "_" + choice;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? static_cast<char>(std::toupper(c)) : '_';
  return name;
}

std::string declare_choices(const ParamSpec& param, const ParamValue& value) {
  std::string glsl;
  for (std::size_t i = 0; i < param.choices.size(); ++i) {
    glsl += fmt::format("const int {} = {};\n", constant_name(param.name, filters::to_string(param.choices[i])), i);
    if (param.choices[i] == value) glsl += fmt::format("const int {} = {};\n", param.name, i);
  }
  return glsl;
}

const char* glsl_type(const ParamSpec& param) {
  if (std::holds_alternative<bool>(param.default_value)) return "bool";
  return param.integer ? "int" : "float";
}

std::string declare(const ParamSpec& param, const ParamValue& value) {
  if (std::holds_alternative<std::string>(value)) return declare_choices(param, value);
  if (!param.is_const) return fmt::format("uniform {} {};\n", glsl_type(param), param.name);
  if (const auto* flag = std::get_if<bool>(&value)) return fmt::format("const bool {} = {};\n", param.name, *flag);
  const double number = std::get<double>(value);
  const std::string text =
      param.integer ? fmt::format("{}", static_cast<int>(number)) : literal(static_cast<float>(number));
  return fmt::format("const {} {} = {};\n", glsl_type(param), param.name, text);
}

std::string declare_disk(const FilterRequest& request, const filters::DiskTable& disk) {
  std::string points;
  const auto generated = filters::generate_disk_points(request.spec, request.values, disk.name);
  for (const glm::vec2& p : generated)
    points += fmt::format("{}vec2({}, {})", points.empty() ? "" : ", ", literal(p.x), literal(p.y));
  return fmt::format("const vec2 {}[{}] = vec2[]({});\n", disk.name, generated.size(), points);
}

/// `store`, `sample` and `samples` are for the program and not for the shader; `sample` is also a keyword of GLSL.
bool is_for_shader(const ParamSpec& param) {
  return param.name != "store" && param.name != "sample" && param.name != "samples";
}

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
  return textureLod(map_{name}, (r.uv + offset_texels * map_texel_uv){scale}, 0.0);
}}
)";

// How far a footprint extends follows from the pixel, and not from a kernel: its reach is not counted. Samplers could
// take as many taps themselves, but not the same ones on every GL.
constexpr const char* kFetchLevels = R"(
vec4 fetch_{name}_lod(Receiver r, vec2 offset_texels, float lod) {{
  COUNT_FETCH(r, offset_texels, {texels} * exp2(ceil(max(lod, 0.0))), {bits});
  return textureLod(map_{name}, (r.uv + offset_texels * map_texel_uv){scale}, lod);
}}
vec4 fetch_{name}_grad(Receiver r, vec2 offset_texels, vec2 along_x, vec2 along_y) {{
  float x = length(along_x), y = length(along_y);
  int taps = clamp(int(ceil(max(x, y) / max(min(x, y), {texels}))), 1, {anisotropy});
  float lod = log2(max(max(x, y) / (float(taps) * {texels}), 1.0));
  vec4 sum = vec4(0.0);
  for (int i = 0; i < taps; ++i) {{
    vec2 place = offset_texels + (x > y ? along_x : along_y) * ((float(i) + 0.5) / float(taps) - 0.5);
    COUNT_FETCH(r, offset_texels, {texels}, {bits});
    sum += textureLod(map_{name}, (r.uv + place * map_texel_uv){scale}, lod);
  }}
  return sum / float(taps);
}}
)";

std::string declare_pass_map(const PassSpec& spec, GLuint unit) {
  const bool has_levels = spec.steps == PassSteps::kLevels;
  const char* level = has_levels ? "level" : "0";
  const char* texels = spec.half ? "2.0" : "1.0";  // of the depth map along one of level 0
  const int bits = 8 * gl::parse_pixel_format(spec.store).bytes_per_texel;
  // What a prefix sum holds has come from anywhere: how far off it is read says nothing.
  const std::string count = spec.steps == PassSteps::kPrefix
                                ? fmt::format("COUNT_LOAD(counted_uv / map_texel_uv, 0.0, {})", bits)
                                : fmt::format(
                                      "COUNT_LOAD((vec2(texel) + 0.5) * {0} * exp2(float({1})), 0.5 * {0} * "
                                      "exp2(float({1})), {2})",
                                      texels, level, bits);
  const char* parameter = has_levels ? ", int level" : "";
  // Levels have the power of two for a side that holds the map.
  const std::string scale =
      has_levels ? fmt::format(" / (map_texel_uv * {} * float(textureSize(map_{}, 0).x))", texels, spec.name) : "";
  const auto write = [&](const char* glsl) {
    return fmt::format(fmt::runtime(glsl), fmt::arg("unit", unit), fmt::arg("name", spec.name),
                       fmt::arg("sampler", spec.is_integer() ? "usampler2D" : "sampler2D"),
                       fmt::arg("texel", spec.texel_type()), fmt::arg("parameter", parameter), fmt::arg("count", count),
                       fmt::arg("level", level), fmt::arg("bits", bits), fmt::arg("texels", texels),
                       fmt::arg("anisotropy", spec.anisotropy), fmt::arg("scale", scale));
  };
  return write(kLoad) + (spec.is_integer() ? "" : write(kFetch)) +
         (spec.is_integer() || !has_levels ? "" : write(kFetchLevels));
}

/// The GLSL that declares the maps of a filter's passes and reads them.
std::string declare_pass_maps(const filters::FilterSpec& spec) {
  std::string glsl;
  for (std::size_t i = 0; i < spec.passes.size(); ++i)
    glsl += declare_pass_map(spec.passes[i], kFirstPassUnit + static_cast<GLuint>(i));
  return glsl;
}

}  // namespace

std::vector<gl::Piece> filter_pieces(const FilterRequest& request) {
  gl::Piece parameters;
  parameters.include_name = "filter_parameters";
  parameters.display_name = request.spec.path + " (parameters)";
  for (const ParamSpec& param : request.spec.params)
    if (is_for_shader(param)) parameters.text += declare(param, request.values.at(param.name));
  if (request.spec.has_encode) {
    const double largest =
        filters::largest_number(filters::store_precision(filters::text_or(request.values, "store", "")));
    parameters.text += fmt::format("const float store_largest = {};\n", literal(static_cast<float>(largest)));
  }
  parameters.text += declare_pass_maps(request.spec);
  for (const filters::DiskTable& disk : request.spec.disks) parameters.text += declare_disk(request, disk);
  return {parameters, {"filter", request.spec.body, request.spec.path, request.spec.body_first_line}};
}

void set_uniforms(gl::Program& program, const FilterRequest& request, const LightSetup& light) {
  set_light(program, light);
  program.set("run_seed", light.seed);
  program.set("run_frame", light.frame);
  for (const ParamSpec& param : request.spec.params) {
    const ParamValue& value = request.values.at(param.name);
    if (param.is_const || std::holds_alternative<std::string>(value)) continue;
    if (const auto* flag = std::get_if<bool>(&value))
      program.set(param.name, *flag ? 1 : 0);
    else if (param.integer)
      program.set(param.name, static_cast<int>(std::get<double>(value)));
    else
      program.set(param.name, static_cast<float>(std::get<double>(value)));
  }
}

}  // namespace shadowbench::render
