#include "harness/render/filter_glsl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "filters/disk_points.h"
#include "filters/store_format.h"
#include "harness/render/map_passes.h"

namespace shadowbench::render {
namespace {

using filters::FilterRequest;
using filters::ParamSpec;
using filters::ParamValue;

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
