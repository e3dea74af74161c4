#include "harness/scene/files/obj_file.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "filters/base/error.h"
#include "filters/base/split_list.h"
#include "harness/scene/files/big_faces.h"
#include "harness/scene/files/file_bytes.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

constexpr double kCreaseDeg = 45.0;

/// Reads material libraries from the model's own folder only.
class LibraryReader : public tinyobj::MaterialReader {
 public:
  LibraryReader(std::filesystem::path folder, std::string where)
      : folder_(std::move(folder)), where_(std::move(where)) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* index_of, std::string* warning, std::string* failure) override {
    const std::optional<std::filesystem::path> file = resolve_inside(folder_, name);
    if (!file) fail_input(fmt::format("mtllib '{}' lies outside its folder; such files are not read", name), where_);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(*file, ignored)) {
      *warning += fmt::format("the material library '{}' is missing\n", name);
      return true;
    }
    const std::vector<unsigned char> bytes = read_file_bytes(*file);
    std::istringstream text(std::string(bytes.begin(), bytes.end()));
    tinyobj::LoadMtl(index_of, materials, &text, warning, failure);
    return true;
  }

 private:
  std::filesystem::path folder_;
  std::string where_;
};

/// Throws unless the word is a finite number; the parser would read it as 0.
void require_number(const std::string& word, std::size_t line, const std::string& where) {
  double value = 0.0;
  const char* start = word.data() + (word.starts_with('+') ? 1 : 0);
  const char* end = word.data() + word.size();
  const auto [stop, problem] = std::from_chars(start, end, value);
  if (problem == std::errc() && stop == end && std::isfinite(value)) return;
  fail_input(fmt::format("'{}' is not a finite number", word), fmt::format("{}:{}", where, line));
}

/// Throws unless each part of a corner, as in 1/2/3 or 1//3, is empty or an index; the parser would read it as another.
void require_indices(const std::string& corner, std::size_t line, const std::string& where) {
  for (const std::string& part : split_list(corner, "/")) {
    int index = 0;
    const char* start = part.data() + (part.starts_with('+') ? 1 : 0);
    const char* end = part.data() + part.size();
    const auto [stop, problem] = std::from_chars(start, end, index);
    if (part.empty() || (problem == std::errc() && stop == end)) continue;
    fail_input(fmt::format("'{}' is not an index: whole numbers are, up to {}", part, std::numeric_limits<int>::max()),
               fmt::format("{}:{}", where, line));
  }
}

/// Checks the coordinates of all v, vn and vt lines, and the indices of all f, l and p lines.
void require_numbers(const std::string& text, const std::string& where) {
  std::istringstream lines(text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word;
    words >> word;
    if (word == "f" || word == "l" || word == "p")
      while (words >> word) require_indices(word, number, where);
    if (word != "v" && word != "vn" && word != "vt") continue;
    const std::size_t least = word == "vt" ? 1 : 3;
    std::size_t count = 0;
    for (; words >> word; ++count) require_number(word, number, where);
    if (count >= least) continue;
    fail_input(fmt::format("expected at least {} numbers, found {}", least, count),
               fmt::format("{}:{}", where, number));
  }
}

/// Ends each line as the checks and the parser expect it, whatever system wrote the file.
std::string with_newlines(const std::string& text) {
  std::string lines;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] != '\r')
      lines += text[i];
    else if (i + 1 == text.size() || text[i + 1] != '\n')
      lines += '\n';
  return lines;
}

/// A parsed file: attributes, shapes and materials as the parser names them.
struct ObjData {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning;
};

ObjData parse_obj(const std::filesystem::path& file) {
  const std::string where = file.string();
  const std::vector<unsigned char> bytes = read_file_bytes(file);
  std::string text = with_newlines({bytes.begin(), bytes.end()});
  require_numbers(text, where);
  text = split_big_faces(std::move(text), where);
  LibraryReader libraries(file.parent_path(), where);
  ObjData data;
  std::string failure;
  std::istringstream stream(text);
  const bool parsed = tinyobj::LoadObj(&data.attributes, &data.shapes, &data.materials, &data.warning, &failure,
                                       &stream, &libraries, true);
  if (parsed && failure.empty()) return data;
  fail_input("not a valid .obj file: " + failure.substr(0, failure.find('\n')), where);
}

/// Builds a model from a parsed file, part by part.
class ObjImporter {
 public:
  ObjImporter(ObjData source, std::filesystem::path file)
      : source_(std::move(source)), file_(std::move(file)), where_(file_.string()) {}

  MeshFile import() {
    for (const tinyobj::material_t& material : source_.materials) add_material(material);
    result_.materials.push_back({.name = "default"});
    for (const tinyobj::shape_t& shape : source_.shapes) add_shape(shape);
    std::istringstream warnings(source_.warning);
    for (std::string line; std::getline(warnings, line);)
      if (!line.empty()) result_.warnings.push_back(line);
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail_input(message, where_); }

  void add_material(const tinyobj::material_t& source) {
    Material material;
    material.name = source.name;
    material.base_color = {source.diffuse[0], source.diffuse[1], source.diffuse[2], 1.0f};
    if (!source.diffuse_texname.empty()) {
      const auto file = resolve_inside(file_.parent_path(), source.diffuse_texname);
      if (!file)
        fail(fmt::format("map_Kd '{}' lies outside its folder; such files are not read", source.diffuse_texname));
      material.base_color_texture = add_texture(*file, source.diffuse_texname);
    }
    result_.materials.push_back(material);
  }

  /// A picture that several materials show is there once.
  int add_texture(const std::filesystem::path& file, const std::string& name) {
    const auto [known, is_new] = texture_of_name_.try_emplace(name, static_cast<int>(result_.textures.size()));
    if (is_new) result_.textures.push_back(decode_texture(read_file_bytes(file), name, where_, result_.textures));
    return known->second;
  }

  /// Adds one mesh per material of the shape.
  void add_shape(const tinyobj::shape_t& shape) {
    std::map<int, Mesh> mesh_of;
    bool has_normals = true;
    for (std::size_t i = 0; i < shape.mesh.indices.size(); ++i) {
      const std::size_t face = i / 3;
      const int wanted = face < shape.mesh.material_ids.size() ? shape.mesh.material_ids[face] : -1;
      const bool known = wanted >= 0 && static_cast<std::size_t>(wanted) < source_.materials.size();
      const int material = known ? wanted : static_cast<int>(source_.materials.size());
      Mesh& mesh = mesh_of[material];
      mesh.material = material;
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(read_corner(shape.mesh.indices[i], shape.name));
      has_normals = has_normals && shape.mesh.indices[i].normal_index >= 0;
    }
    for (auto& [material, mesh] : mesh_of) {
      mesh.name = shape.name.empty() ? file_.stem().string() : shape.name;
      result_.meshes.push_back(has_normals ? std::move(mesh) : with_smooth_normals(mesh, kCreaseDeg));
    }
  }

  Vertex read_corner(const tinyobj::index_t& corner, const std::string& name) const {
    const tinyobj::attrib_t& all = source_.attributes;
    const auto check = [&](int index, std::size_t count, const char* what) {
      if (index >= 0 && static_cast<std::size_t>(index) < count) return static_cast<std::size_t>(index);
      fail(fmt::format("a face of '{}' uses {} {}, but there are {}", name, what, index + 1, count));
    };
    Vertex vertex;
    const std::size_t p = 3 * check(corner.vertex_index, all.vertices.size() / 3, "vertex");
    vertex.position_ws = {all.vertices[p], all.vertices[p + 1], all.vertices[p + 2]};
    if (corner.normal_index >= 0) {
      const std::size_t n = 3 * check(corner.normal_index, all.normals.size() / 3, "normal");
      vertex.normal_ws = {all.normals[n], all.normals[n + 1], all.normals[n + 2]};
    }
    if (corner.texcoord_index >= 0) {
      const std::size_t t = 2 * check(corner.texcoord_index, all.texcoords.size() / 2, "texture coordinate");
      vertex.uv = {all.texcoords[t], 1.0f - all.texcoords[t + 1]};
    }
    return vertex;
  }

  ObjData source_;
  std::filesystem::path file_;
  std::string where_;
  MeshFile result_;
  std::map<std::string, int> texture_of_name_;
};

}  // namespace

MeshFile import_obj(const std::filesystem::path& file) { return ObjImporter(parse_obj(file), file).import(); }

}  // namespace shadowbench::scene
