#include "harness/live/frame_file.h"

#include <fmt/format.h>
#include <tbb/parallel_for_each.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "harness/gl/objects.h"
#include "harness/spirv/spirv.h"
#include "report/images/value_file.h"

namespace shadowbench::live {
namespace {

using gl::Step;
using nlohmann::json;

constexpr const char* kFolder = "live";

/// Writes a script that hands the page a text, which is made where the folder has none of what it holds yet. Returns
/// its path in the folder.
template <class Pack>
std::string write_script(const std::filesystem::path& folder, std::span<const std::byte> bytes, const Pack& pack) {
  ContentHash hash;
  hash.add(bytes);
  const std::string path = fmt::format("{}/{}.js", kFolder, hash.name());
  if (!std::filesystem::exists(folder / path))
    write_text_file(folder / path, fmt::format("shadowbenchValues(\"{}\",\"{}\");\n", path, pack()));
  return path;
}

/// A filter's parameters as sliders show them; what is built into its shaders' texts is marked as constant.
json list_parameters(const filters::FilterRequest& request) {
  json parameters = json::array();
  for (const filters::ParamSpec& param : request.spec.params) {
    const filters::ParamValue& value = request.values.at(param.name);
    const double* number = std::get_if<double>(&value);
    const bool is_bounded = number && param.min && param.max;
    if (!param.is_const && !is_bounded) continue;
    json item = {{"name", param.name},
                 {"whole", param.integer},
                 {"constant", param.is_const},
                 {"unit", param.unit},
                 {"text", param.text}};
    item["value"] = number ? json(*number) : json(filters::to_string(value));
    if (is_bounded) item.update({{"min", *param.min}, {"max", *param.max}});
    parameters.push_back(std::move(item));
  }
  return parameters;
}

/// The graph as JSON: everything is named by its place in a list.
class FrameGraph {
 public:
  explicit FrameGraph(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void add(const std::string& key, const Frame& frame) {
    cells_[key] = {{"picture", add_step(frame.picture)},
                   {"empty", add_step(frame.empty)},
                   {"lightSize", frame.light_size},
                   {"parameters", list_parameters(frame.request)}};
  }

  void add(const Check& check) {
    check_ = {{"rect", list(check.rect)}, {"known", json::array()}, {"whole", check.is_whole}};
    for (const KnownTexels& known : check.known) {
      if (!known.content.step) continue;
      check_["known"].push_back({{"texture", add_texture(known.content.texture)},
                                 {"step", add_step(known.content.step)},
                                 {"rect", list(known.rect)},
                                 {"channels", known.channels},
                                 {"fill", known.fill},
                                 {"blob", add_blob(&known, std::as_bytes(std::span(known.texels)),
                                                   static_cast<std::size_t>(known.channels))}});
    }
  }

  json take() {
    translate_programs();
    return {{"textures", std::move(textures_)}, {"programs", std::move(programs_json_)},
            {"blobs", std::move(blobs_)},       {"steps", std::move(steps_)},
            {"check", std::move(check_)},       {"cells", std::move(cells_)}};
  }

 private:
  std::filesystem::path folder_;
  std::map<const gl::RecordedTexture*, std::size_t> texture_places_;
  json textures_ = json::array();
  std::map<std::map<GLenum, std::string>, std::size_t> by_source_;
  std::vector<const gl::RecordedProgram*> programs_;
  json programs_json_ = json::array();
  json blobs_ = json::array();
  std::map<const void*, std::size_t> blob_places_;
  std::map<const Step*, std::size_t> step_places_;
  std::map<std::string, std::size_t> by_text_;
  json steps_ = json::array();
  json check_ = json::object();
  json cells_ = json::object();

  static json list(const images::Rect& rect) { return {rect.x, rect.y, rect.width, rect.height}; }

  json add_step(const gl::StepPointer& step) {
    if (!step) return nullptr;
    const auto known = step_places_.find(step.get());
    if (known != step_places_.end()) return known->second;
    json item = std::visit([&](const auto& what) { return describe(what); }, step->what);
    for (const gl::StepTarget& target : step->targets)
      item["targets"].push_back({{"place", target.place},
                                 {"texture", add_texture(target.texture)},
                                 {"level", target.level},
                                 {"before", add_step(target.before)}});
    const auto [place, is_new] = by_text_.try_emplace(item.dump(), steps_.size());
    if (is_new) steps_.push_back(std::move(item));
    step_places_[step.get()] = place->second;
    return place->second;
  }

  std::size_t add_texture(const gl::TexturePointer& texture) {
    const auto [place, is_new] = texture_places_.try_emplace(texture.get(), textures_.size());
    if (is_new)
      textures_.push_back({{"format", gl::pixel_format(texture->format).name},
                           {"width", texture->width},
                           {"height", texture->height},
                           {"levels", texture->levels},
                           {"samples", texture->samples}});
    return place->second;
  }

  std::size_t add_program(const gl::RecordedProgram* program) {
    const auto [place, is_new] = by_source_.try_emplace(program->sources, programs_.size());
    if (is_new) programs_.push_back(program);
    return place->second;
  }

  json add_blob(const void* owner, std::span<const std::byte> bytes, std::size_t columns) {
    const auto [place, is_new] = blob_places_.try_emplace(owner, blobs_.size());
    if (!is_new) return place->second;
    const std::size_t rows = columns > 0 ? bytes.size() / (columns * sizeof(float)) : 0;
    const auto pack = [&] { return columns > 0 ? pack_vertices(bytes, rows, columns) : images::pack_bytes(bytes); };
    blobs_.push_back({{"path", write_script(folder_, bytes, pack)}, {"rows", rows}, {"columns", columns}});
    return place->second;
  }

  /// Each component of all vertices by itself, which is smaller.
  static std::string pack_vertices(std::span<const std::byte> bytes, std::size_t rows, std::size_t columns) {
    images::Image plane(static_cast<int>(rows), static_cast<int>(columns), 1);
    for (std::size_t column = 0; column < columns; ++column)
      for (std::size_t row = 0; row < rows; ++row)
        std::memcpy(&plane.texels[column * rows + row], &bytes[sizeof(float) * (row * columns + column)],
                    sizeof(float));
    return images::pack_floats(plane);
  }

  json describe(const gl::DrawStep& draw) {
    json item = {{"op", "draw"},
                 {"program", add_program(draw.program.get())},
                 {"uniforms", draw.uniforms},
                 {"inputs", json::array()},
                 {"first", draw.first},
                 {"count", draw.count},
                 {"viewport", {draw.viewport.x, draw.viewport.y, draw.viewport.z, draw.viewport.w}},
                 {"depth", draw.depth_function},
                 {"writesDepth", draw.writes_depth},
                 {"adds", draw.adds},
                 {"culled", draw.culled},
                 {"offset", {draw.offset.x, draw.offset.y}}};
    for (const gl::StepInput& input : draw.inputs) item["inputs"].push_back(describe(input));
    if (draw.attributes.empty()) return item;
    json attributes = json::array();
    for (const auto& each : draw.attributes) attributes.push_back({each.location, each.components, each.offset});
    const bool has_bytes = draw.vertices && !draw.vertices->bytes.empty();
    item["vertices"] = {{"blob", has_bytes ? add_blob(draw.vertices.get(), draw.vertices->bytes,
                                                      static_cast<std::size_t>(draw.stride) / sizeof(float))
                                           : json()},
                        {"stride", draw.stride},
                        {"attributes", attributes}};
    return item;
  }

  json describe(const gl::StepInput& input) {
    const gl::Sampling& sampling = input.sampling;
    const auto last = std::min(sampling.last_level, input.texture->levels - 1);
    json levels = json::array();
    for (int level = 0; level <= last; ++level)
      levels.push_back(add_step(input.levels[static_cast<std::size_t>(level)]));
    return {{"sampler", input.sampler},
            {"texture", add_texture(input.texture)},
            {"minify", sampling.minify},
            {"magnify", sampling.magnify},
            {"wrap", sampling.wrap},
            {"compare", sampling.compare},
            {"border", {sampling.border.x, sampling.border.y, sampling.border.z, sampling.border.w}},
            {"levels", levels}};
  }

  static json describe(const gl::ClearStep& clear) {
    return {{"op", "clear"}, {"value", {clear.value.x, clear.value.y, clear.value.z, clear.value.w}}};
  }

  json describe(const gl::UploadStep& upload) {
    return {{"op", "upload"},
            {"format", upload.format},
            {"type", upload.type},
            {"blob", add_blob(&upload, upload.texels, 0)}};
  }

  static json describe(const gl::MipmapStep&) { return {{"op", "mipmaps"}}; }

  static std::string translate(const gl::RecordedProgram& program, GLenum kind) {
    return spirv::translate_to_webgl({program.sources.at(kind), {}},
                                     kind == GL_VERTEX_SHADER ? spirv::Stage::kVertex : spirv::Stage::kFragment);
  }

  static json translate(const gl::RecordedProgram& program) {
    if (program.sources.contains(GL_GEOMETRY_SHADER))
      return {{"label", program.label}, {"refused", "WebGL 2 has no geometry shaders"}};
    try {
      return {{"label", program.label},
              {"vertex", translate(program, GL_VERTEX_SHADER)},
              {"fragment", translate(program, GL_FRAGMENT_SHADER)}};
    } catch (const Error& error) {
      return {{"label", program.label}, {"refused", error.message()}};
    }
  }

  void translate_programs() {
    std::vector<json> translated(programs_.size());
    std::vector<std::size_t> places(programs_.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
    tbb::parallel_for_each(places, [&](std::size_t i) { translated[i] = translate(*programs_[i]); });
    for (json& each : translated) programs_json_.push_back(std::move(each));
  }
};

}  // namespace

std::string write_frames(const std::filesystem::path& folder, const std::map<std::string, Frame>& frames,
                         const Check& check) {
  FrameGraph graph(folder);
  for (const auto& [key, frame] : frames) graph.add(key, frame);
  graph.add(check);
  const std::string text = graph.take().dump(-1, ' ', false, json::error_handler_t::replace);
  const auto bytes = std::as_bytes(std::span(text));
  return write_script(folder, bytes, [&] { return images::pack_bytes(bytes); });
}

void copy_frames(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (!std::filesystem::exists(from / kFolder)) return;
  for (const auto& entry : std::filesystem::directory_iterator(from / kFolder)) {
    const std::filesystem::path copy = to / kFolder / entry.path().filename();
    if (!std::filesystem::exists(copy)) copy_whole_file(entry.path(), copy);
  }
}

}  // namespace shadowbench::live
