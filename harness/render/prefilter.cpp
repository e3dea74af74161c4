#include "harness/render/prefilter.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>

#include "base/error.h"
#include "filters/kernel.h"
#include "filters/random.h"
#include "filters/store_format.h"
#include "harness/gl/objects.h"

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

constexpr GLuint kStoredUnit = 3;   // of lib/map_access.glsl
constexpr GLuint kSamplesUnit = 4;  // of encode.frag

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

/// Throws Error(kFilter) with the line of `samples` where the GL gives fewer.
Defines add_samples(Defines defines, const filters::FilterRequest& request) {
  const int samples = filters::depth_samples(request.values);
  GLint most = 0;
  glGetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &most);
  if (samples > most) {
    throw Error(ErrorKind::kFilter,
                fmt::format("samples = {}: this GL gives at most {} samples of depth a texel", samples, most),
                fmt::format("{}:{}", request.spec.path, request.spec.samples_line));
  }
  if (samples > 1) defines.emplace_back("SAMPLES", std::to_string(samples));
  if (filters::combines_logs(request.values)) defines.emplace_back("COMBINE_LOGS", "1");
  return defines;
}

constexpr int kRadix = 4;  // a step of a prefix sum adds so many terms

std::string map_name(const PassSpec& spec) { return "map_" + spec.name; }

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

Prefilter::Prefilter(ShaderLibrary& shaders, const filters::FilterRequest& request, const ShadowMap& map,
                     const LightSetup& light, Defines map_defines)
    : shaders_(&shaders),
      stored_(std::make_shared<ImageTarget>(request.spec.id + " map", store_format(request.values), map.size(),
                                            map.size())),
      encode_(shaders.compile_filter(request.spec.id + " encode", "encode.frag",
                                     add_samples(std::move(map_defines), request), filter_pieces(request))) {
  if (const int samples = filters::depth_samples(request.values); samples > 1)
    samples_.emplace("depth samples", map.settings().format, map.size(), map.size(), samples);
  encode_.set("map_texel_uv", 1.0f / static_cast<float>(map.size()));
  const bool nearest = filters::reads_nearest(request.values);
  sampler_.set_filter(nearest ? GL_NEAREST : GL_LINEAR, nearest ? GL_NEAREST : GL_LINEAR);
  sampler_.set_wrap(wrap_mode(light.range.border));
  blur_sampler_.set_wrap(wrap_mode(light.range.border));
  reads_border_ = light.range.border == filters::Border::kBorder;
  retune(request, light);
}

void Prefilter::retune(const filters::FilterRequest& request, const LightSetup& light) {
  set_uniforms(encode_, request, light);
  border_ = encode_border();
  sampler_.set_border(border_);
  blur_sampler_.set_border(border_);
  radius_ = filters::prefilter_radius_texels(request.spec, request.values);
  if (radius_ == 0) return;
  blur_ = &shaders_->fullscreen("blur.frag", blur_defines(request, radius_));
  if (scratch_) return;
  scratch_.emplace(request.spec.id + " blur", store_format(request.values), stored_->texture().width(),
                   stored_->texture().width());
}

void Prefilter::turn_to(const LightSetup& light, std::shared_ptr<ImageTarget> stored) {
  set_light(encode_, light);
  stored_ = std::move(stored);
}

/// Outside the map lies the encoding of depth 1, stored in the map's own format.
glm::vec4 Prefilter::encode_border() {
  ImageTarget texel("encoded border", format(), 1, 1);
  encode_.set("encode_border", 1);
  texel.bind();
  encode_.use();
  triangle_.draw();
  encode_.set("encode_border", 0);
  std::vector<float> value = read(texel);
  value.resize(4, 0.0f);
  return {value[0], value[1], value[2], value[3]};
}

void Prefilter::encode(const ShadowMap& map, int layer, ImageTarget& to) {
  if (samples_) {
    map.draw_samples(*shaders_, *samples_, layer);
    samples_->texture().bind(kSamplesUnit);
  }
  map.bind(encode_, layer);
  to.bind();
  encode_.use();
  triangle_.draw();
}

void Prefilter::run(const ShadowMap& map, int layer) {
  encode(map, layer, *stored_);
  if (radius_ == 0) return;
  blur(stored_->texture(), *scratch_, {1.0f, 0.0f});
  blur(scratch_->texture(), *stored_, {0.0f, 1.0f});
}

void Prefilter::blur(const gl::Texture& from, ImageTarget& to, glm::vec2 direction) {
  to.bind();
  blur_->set("direction", direction);
  blur_->set("map_texel_uv", 1.0f / static_cast<float>(from.width()));
  from.bind(kStoredUnit);
  blur_sampler_.bind(kStoredUnit);
  blur_->use();
  triangle_.draw();
}

void Prefilter::bind() const {
  stored_->texture().bind(kStoredUnit);
  sampler_.bind(kStoredUnit);
}

std::vector<float> Prefilter::read_before_blur(const ShadowMap& map, int layer) {
  if (radius_ == 0) return read(*stored_);
  encode(map, layer, *scratch_);
  return read(*scratch_);
}

std::int64_t Prefilter::texels_written() const {
  const std::int64_t side = stored_->texture().width();
  return (passes() + (samples_ ? samples_->texture().samples() - 1 : 0)) * side * side;
}

std::vector<DrawnPass> Prefilter::list_passes(int depth_bytes) const {
  const gl::PixelFormat& format = stored_->texture().format();
  const std::int64_t texels = std::int64_t{1} * stored_->texture().width() * stored_->texture().width();
  std::vector<DrawnPass> passes = {{.name = "encode",
                                    .fragment = encode_.last_stage(),
                                    .target = format,
                                    .texels = texels,
                                    .read_bytes = depth_bytes}};
  if (radius_ > 0)
    passes.push_back({.name = "blur",
                      .fragment = blur_->last_stage(),
                      .target = format,
                      .draws = 2,
                      .texels = 2 * texels,
                      .read_bytes = format.bytes_per_texel});
  return passes;
}

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
