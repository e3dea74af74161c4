#include "harness/scene/files/mesh_file.h"

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <tiny_gltf.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;

/// Whether a path begins with all parts of a folder's; both are canonical.
bool is_below(const fs::path& folder, const fs::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool is_gltf(const std::string& extension) { return extension == ".gltf" || extension == ".glb"; }

/// Keeps the high byte of 16-bit channels.
std::vector<std::uint8_t> to_8_bits(const tinygltf::Image& image) {
  if (image.bits == 8) return image.image;
  std::vector<std::uint8_t> high;
  high.reserve(image.image.size() / 2);
  for (std::size_t i = 1; i < image.image.size(); i += 2) high.push_back(image.image[i]);
  return high;
}

/// Refuses what a picture's header claims before any memory is asked for.
void require_usable_size(const std::vector<unsigned char>& bytes, const std::string& name, const std::string& where,
                         const std::vector<Texture>& others) {
  constexpr int kLongestSide = 16384;
  constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26;
  constexpr std::uint64_t kMostPixelsOfAll = std::uint64_t{1} << 28;
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  const bool is_known = stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) != 0;
  if (!is_known || stbi_is_hdr_from_memory(bytes.data(), size) != 0 || width <= 0 || height <= 0)
    fail_input(fmt::format("image '{}' cannot be decoded: use PNG or JPEG, 1 to {} pixels a side", name, kLongestSide),
               where);
  std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (std::max(width, height) > kLongestSide || pixels > kMostPixels) {
    fail_input(fmt::format("image '{}' says that it has {} x {} pixels; at most {} a side and {} in all are read", name,
                           width, height, kLongestSide, kMostPixels),
               where);
  }
  for (const Texture& other : others)
    pixels += static_cast<std::uint64_t>(other.width) * static_cast<std::uint64_t>(other.height);
  if (pixels <= kMostPixelsOfAll) return;
  fail_input(fmt::format("with image '{}' its textures have {} pixels; at most {} are read: use smaller ones", name,
                         pixels, kMostPixelsOfAll),
             where);
}

constexpr double kCreaseDeg = 45.0;
constexpr std::size_t kMostCornersOfAFace = 2048;

/// The bytes of a text file, without a byte order mark. Throws kInput for UTF-16, of which the parser would read
/// nothing.
std::string read_text(const std::filesystem::path& file) {
  const std::vector<unsigned char> bytes = read_file_bytes(file);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.substr(0, 4).find('\0') != text.npos)  // with its mark or without
    fail_input("this text is UTF-16: save it as UTF-8", file.string());
  return std::string(text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0));
}

/// A reference as written on any system: Windows' programs write \ for /.
std::string with_slashes(std::string reference) {
  std::ranges::replace(reference, '\\', '/');
  return reference;
}

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

/// The opacity that each texel of a map_d has: its alpha, or, where that is the same everywhere, its brightness.
std::vector<std::uint8_t> list_opacities(const Texture& picture) {
  std::vector<std::uint8_t> alpha, brightness;
  for (std::size_t i = 0; i + 3 < picture.rgba.size(); i += 4) {
    const std::uint8_t* texel = &picture.rgba[i];
    alpha.push_back(texel[3]);
    brightness.push_back(static_cast<std::uint8_t>((texel[0] + texel[1] + texel[2]) / 3));
  }
  const bool has_alpha = std::ranges::any_of(alpha, [](std::uint8_t each) { return each < 255; });
  return has_alpha ? alpha : brightness;
}

/// Whether opacities are those of holes, whose edges alone are neither clear nor solid.
bool are_holes(const std::vector<std::uint8_t>& opacities) {
  constexpr int kClear = 26, kSolid = 229;  // a tenth from either end
  const auto between = std::ranges::count_if(opacities, [](int each) { return each > kClear && each < kSolid; });
  return between <= static_cast<std::ptrdiff_t>(opacities.size() / 4);
}

/// A texture with this colour, or white, and these opacities; it has the size of the opacities' picture.
Texture with_opacities(Texture picture, const std::vector<std::uint8_t>& opacities, const Texture* colour) {
  const auto width = static_cast<std::size_t>(picture.width), height = static_cast<std::size_t>(picture.height);
  for (std::size_t i = 0; i < opacities.size(); ++i) {
    std::uint8_t* texel = &picture.rgba[4 * i];
    std::fill_n(texel, 3, std::uint8_t{255});
    if (colour) {
      const std::size_t x = i % width * static_cast<std::size_t>(colour->width) / width;
      const std::size_t y = i / width * static_cast<std::size_t>(colour->height) / height;
      std::copy_n(&colour->rgba[4 * (y * static_cast<std::size_t>(colour->width) + x)], 3, texel);
    }
    texel[3] = opacities[i];
  }
  return picture;
}

/// A number that the whole word is; nothing where it is none, or out of range.
template <class T>
std::optional<T> parse(const std::string& word) {
  T value{};
  const char* start = word.data() + (word.starts_with('+') ? 1 : 0);
  const char* end = word.data() + word.size();
  const auto [stop, problem] = std::from_chars(start, end, value);
  return problem == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

/// The polygon along the axis in which it is largest, counter-clockwise.
std::vector<glm::dvec2> flatten(const std::vector<glm::dvec3>& corners) {
  glm::dvec3 normal(0.0);  // Newell's: twice the area, seen along each axis
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  const glm::dvec3 size = glm::abs(normal);
  const int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::vector<glm::dvec2> flat;
  for (const glm::dvec3& corner : corners)
    flat.emplace_back(normal[z] < 0.0 ? -corner[(z + 1) % 3] : corner[(z + 1) % 3], corner[(z + 2) % 3]);
  return flat;
}

double cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// What is left of a polygon while ears are cut off it; a convex one becomes a fan.
/// Source: Eberly 2002, Triangulation by Ear Clipping.
class EarClipper {
 public:
  explicit EarClipper(const std::vector<glm::dvec3>& corners) : places_(flatten(corners)), left_(corners.size()) {
    std::iota(left_.begin(), left_.end(), std::size_t{0});
  }

  bool is_convex() const {
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (cross(place(i), place(i + 1), place(i + 2)) < 0.0) return false;
    return true;
  }

  /// Corners 3i to 3i+2 are those of triangle i. A polygon that touches or crosses itself gives some that overlap.
  std::vector<std::size_t> clip() {
    std::vector<std::size_t> triangles;
    std::size_t first = 0, misses = 0;
    while (left_.size() > 2) {
      if (misses < left_.size() && !is_ear(first)) {
        first = (first + 1) % left_.size();
        ++misses;
        continue;
      }
      triangles.insert(triangles.end(), {corner(first), corner(first + 1), corner(first + 2)});
      const std::size_t tip = (first + 1) % left_.size();
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(tip));
      if (tip < first) --first;
      misses = 0;
    }
    return triangles;
  }

 private:
  std::vector<glm::dvec2> places_;
  std::vector<std::size_t> left_;

  /// Counts from the first again behind the last.
  std::size_t corner(std::size_t i) const { return left_[i < left_.size() ? i : i - left_.size()]; }
  const glm::dvec2& place(std::size_t i) const { return places_[corner(i)]; }

  /// Whether no other corner lies in the triangle that begins at one; only those can that turn clockwise.
  bool is_ear(std::size_t first) const {
    const glm::dvec2 &a = place(first), &b = place(first + 1), &c = place(first + 2);
    if (cross(a, b, c) < 0.0) return false;
    for (std::size_t other = 3; other < left_.size(); ++other) {
      const std::size_t i = (first + other) % left_.size();
      const glm::dvec2& p = place(i);
      const bool is_in = cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0;
      const bool is_blunt = is_in && cross(place(i + left_.size() - 1), p, place(i + 1)) < 0.0;
      if (is_blunt && p != a && p != b && p != c) return false;
    }
    return true;
  }
};

/// The triangles of a polygon, three corners each: a convex one of four is cut along its shorter diagonal.
std::vector<std::size_t> cut_polygon(const std::vector<glm::dvec3>& corners) {
  if (corners.size() == 3) return {0, 1, 2};
  EarClipper clipper(corners);
  if (corners.size() != 4 || !clipper.is_convex()) return clipper.clip();
  if (glm::distance(corners[0], corners[2]) < glm::distance(corners[1], corners[3])) return {0, 1, 2, 0, 2, 3};
  return {0, 1, 3, 1, 2, 3};
}

/// Builds a model from a file's lines: first its vertices, which faces may name before they come, then all else.
class ObjImporter {
 public:
  ObjImporter(std::filesystem::path file, const glm::dvec3& origin)
      : file_(std::move(file)), where_(file_.string()), origin_(origin), text_(read_text(file_)) {}

  MeshFile import() {
    visit_lines([&](const std::vector<std::string>& words, const std::string&) { read_numbers(words); });
    visit_lines([&](const std::vector<std::string>& words, const std::string& rest) { read_line(words, rest); });
    finish_shape();
    for (const tinyobj::material_t& material : materials_) add_material(material);
    result_.materials.push_back({.name = "default"});
    for (Mesh& mesh : result_.meshes) mesh.material = std::min(mesh.material, static_cast<int>(materials_.size()));
    return std::move(result_);
  }

 private:
  /// A texture's index, -1 for none, and what its alpha means.
  struct Picture {
    int texture = -1;
    AlphaMode alpha_mode = AlphaMode::kOpaque;
  };

  static constexpr int kNoMaterial = std::numeric_limits<int>::max();

  std::filesystem::path file_;
  std::string where_;
  glm::dvec3 origin_;
  std::string text_;
  std::size_t line_ = 0;  ///< the number of the one that is read
  std::vector<glm::dvec3> places_;
  std::vector<glm::vec3> normals_;
  std::vector<glm::vec2> uvs_;
  std::size_t known_places_ = 0, known_normals_ = 0, known_uvs_ = 0;  ///< before the line: indices below 0 count back
  std::vector<tinyobj::material_t> materials_;
  std::map<std::string, int> material_of_;
  std::set<std::string> libraries_, warned_;
  int material_ = kNoMaterial;  ///< of the next faces
  std::string name_;            ///< of the shape
  std::map<int, Mesh> shape_;   ///< by material
  bool has_normals_ = true;     ///< at each of its corners
  MeshFile result_;
  std::map<std::pair<std::string, std::string>, Picture> pictures_;

  [[noreturn]] void fail(const std::string& message) const { fail_input(message, where_); }
  [[noreturn]] void fail_line(const std::string& message) const {
    fail_input(message, fmt::format("{}:{}", where_, line_));
  }

  void warn(const std::string& message) {
    if (warned_.insert(message).second) result_.warnings.push_back(message);
  }

  /// Calls `visit` with each line's words, comments left out, and with all that follows the first word.
  template <class Visit>
  void visit_lines(const Visit& visit) {
    line_ = 0;
    for (std::size_t begin = 0; begin < text_.size();) {
      const std::size_t end = std::min(text_.find_first_of("\r\n", begin), text_.size());
      const std::string line = text_.substr(begin, end - begin);
      begin = end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1);  // whatever system wrote the file
      ++line_;
      std::istringstream stream(line.substr(0, line.find('#')));
      const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
      if (words.empty()) continue;
      std::string rest = line.substr(line.find(words[0]) + words[0].size());
      rest.erase(0, rest.find_first_not_of(" \t"));
      rest.erase(rest.find_last_not_of(" \t") + 1);
      visit(words, rest);
    }
  }

  void read_numbers(const std::vector<std::string>& words) {
    const std::string& kind = words[0];
    if (kind != "v" && kind != "vn" && kind != "vt") return;
    std::vector<double> numbers;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::optional<double> number = parse<double>(words[i]);
      if (!number || !std::isfinite(*number)) fail_line(fmt::format("'{}' is not a finite number", words[i]));
      numbers.push_back(*number);
    }
    const std::size_t least = kind == "vt" ? 1 : 3;
    if (numbers.size() < least) fail_line(fmt::format("expected at least {} numbers, found {}", least, numbers.size()));
    numbers.resize(3);
    const glm::dvec3 all(numbers[0], numbers[1], numbers[2]);
    if (kind == "v") places_.push_back(all);
    if (kind == "vn") normals_.emplace_back(all);
    if (kind == "vt") uvs_.emplace_back(all.x, 1.0 - all.y);
  }

  void read_line(const std::vector<std::string>& words, const std::string& rest) {
    const std::string& kind = words[0];
    known_places_ += kind == "v";
    known_normals_ += kind == "vn";
    known_uvs_ += kind == "vt";
    if (kind == "f") add_face(words);
    if (kind == "mtllib") load_libraries(rest);
    if (kind == "usemtl") {
      const auto found = material_of_.find(rest);
      if (found == material_of_.end()) warn(fmt::format("no material library has the material '{}'", rest));
      material_ = found != material_of_.end() ? found->second : kNoMaterial;
    }
    if (kind != "g" && kind != "o") return;
    finish_shape();
    name_ = rest;
  }

  /// Names are parted by spaces that no backslash goes before; any other backslash is a slash of Windows.
  void load_libraries(std::string names) {
    for (std::size_t at = 0; (at = names.find("\\ ", at)) != names.npos;) names.replace(at, 2, "\n");
    for (std::string name : split_list(with_slashes(names), " ")) {
      std::ranges::replace(name, '\n', ' ');
      if (!name.empty() && libraries_.insert(name).second) load_library(name);
    }
  }

  void load_library(const std::string& name) {
    const std::optional<std::filesystem::path> file = resolve_inside(file_.parent_path(), name);
    if (!file) fail(fmt::format("mtllib '{}' lies outside its folder; such files are not read", name));
    if (!is_file(*file)) return warn(fmt::format("the material library '{}' is missing", name));
    std::istringstream text(read_text(*file));
    std::string warnings, failure;
    tinyobj::LoadMtl(&material_of_, &materials_, &text, &warnings, &failure);
    if (!failure.empty()) fail("not a valid .obj file: " + failure.substr(0, failure.find('\n')));
    for (const std::string& line : split_list(warnings, "\n"))
      if (!line.empty()) warn(line);
  }

  /// A corner is 1, 1/2, 1//3 or 1/2/3: indices of a vertex, a texture coordinate and a normal.
  void add_face(const std::vector<std::string>& words) {
    const std::size_t count = words.size() - 1;
    if (count > kMostCornersOfAFace)
      fail_line(fmt::format("this face has {} corners; at most {} are read: triangulate it in the modelling program",
                            count, kMostCornersOfAFace));
    std::vector<Vertex> corners;
    std::vector<glm::dvec3> places;
    bool has_normals = true;
    for (std::size_t i = 1; i <= count; ++i) {
      std::vector<std::string> parts = split_list(words[i], "/");
      parts.resize(3);
      Vertex& corner = corners.emplace_back();
      places.push_back(
          places_[*find_index(parts[0].empty() ? "0" : parts[0], known_places_, places_.size(), "vertex")]);
      corner.position_ws = glm::vec3(places.back() - origin_);
      if (const auto uv = find_index(parts[1], known_uvs_, uvs_.size(), "texture coordinate")) corner.uv = uvs_[*uv];
      const auto normal = find_index(parts[2], known_normals_, normals_.size(), "normal");
      if (normal) corner.normal_ws = normals_[*normal];
      has_normals = has_normals && normal;
    }
    if (count < 3) return warn("faces of fewer than three corners are left out");
    has_normals_ = has_normals_ && has_normals;
    Mesh& mesh = shape_[material_];
    for (const std::size_t corner : cut_polygon(places)) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(corners[corner]);
    }
  }

  /// Nothing for an empty part.
  std::optional<std::size_t> find_index(const std::string& part, std::size_t known, std::size_t count,
                                        const char* what) const {
    if (part.empty()) return std::nullopt;
    const std::optional<int> index = parse<int>(part);
    if (!index)
      fail_line(
          fmt::format("'{}' is not an index: whole numbers are, up to {}", part, std::numeric_limits<int>::max()));
    const std::int64_t at = *index < 0 ? static_cast<std::int64_t>(known) + *index : std::int64_t{*index} - 1;
    if (at >= 0 && at < static_cast<std::int64_t>(count)) return static_cast<std::size_t>(at);
    fail_line(fmt::format("a face uses {} {}, but there are {}", what, *index, count));
  }

  /// One mesh for each material of the shape.
  void finish_shape() {
    for (auto& [material, mesh] : shape_) {
      mesh.material = material;
      mesh.name = name_.empty() ? file_.stem().string() : name_;
      result_.meshes.push_back(has_normals_ ? std::move(mesh) : with_smooth_normals(mesh, kCreaseDeg));
    }
    shape_.clear();
    has_normals_ = true;
  }

  void add_material(const tinyobj::material_t& source) {
    Material material;
    material.name = source.name;
    material.base_color = {source.diffuse[0], source.diffuse[1], source.diffuse[2], source.dissolve};
    const Picture picture = add_texture(source.diffuse_texname, source.alpha_texname);
    material.base_color_texture = picture.texture;
    material.alpha_mode = source.dissolve < 1.0f ? AlphaMode::kBlend : picture.alpha_mode;
    if (material.alpha_mode == AlphaMode::kBlend)
      result_.warnings.push_back(fmt::format("material '{}' blends; cameras see it opaque", material.name));
    result_.materials.push_back(material);
  }

  /// The texture of two pictures, by their names, which may be empty: map_Kd, whose own alpha does not count, and
  /// map_d. One that several materials show is there once.
  Picture add_texture(const std::string& colour_name, const std::string& opacity_name) {
    const auto [known, is_new] = pictures_.try_emplace({colour_name, opacity_name});
    if (!is_new) return known->second;
    std::optional<Texture> texture = read_colour(colour_name);
    if (!opacity_name.empty()) {
      Texture opacity = read_picture(find_picture("map_d", opacity_name), opacity_name);
      const std::vector<std::uint8_t> opacities = list_opacities(opacity);
      known->second.alpha_mode = are_holes(opacities) ? AlphaMode::kMask : AlphaMode::kBlend;
      texture = with_opacities(std::move(opacity), opacities, texture ? &*texture : nullptr);
    }
    if (!texture) return known->second;
    result_.textures.push_back(std::move(*texture));
    known->second.texture = static_cast<int>(result_.textures.size()) - 1;
    return known->second;
  }

  std::optional<Texture> read_colour(const std::string& name) {
    if (name.empty()) return std::nullopt;
    const std::filesystem::path file = find_picture("map_Kd", name);
    if (!is_file(file)) {
      result_.warnings.push_back(
          fmt::format("the picture '{}' is missing; its materials have their plain colour", name));
      return std::nullopt;
    }
    Texture colour = read_picture(file, name);
    for (std::size_t i = 3; i < colour.rgba.size(); i += 4) colour.rgba[i] = 255;
    return colour;
  }

  std::filesystem::path find_picture(const char* key, const std::string& name) const {
    const auto file = resolve_inside(file_.parent_path(), with_slashes(name));
    if (!file) fail(fmt::format("{} '{}' lies outside its folder; such files are not read", key, name));
    return *file;
  }

  Texture read_picture(const std::filesystem::path& file, const std::string& name) const {
    return decode_texture(read_file_bytes(file), name, where_, result_.textures);
  }
};

}  // namespace

bool is_mesh_file(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return is_gltf(extension) || extension == ".obj";
}

MeshFile import_mesh_file(const std::filesystem::path& file, const glm::dvec3& origin) {
  const std::string extension = extension_of(file);
  if (is_gltf(extension)) return import_gltf(file, origin);
  if (extension == ".obj") return import_obj(file, origin);
  fail_input(fmt::format("'{}' is no kind of model: use .gltf, .glb or .obj", extension), file.string());
}

Scene add_mesh_file(Scene scene, MeshFile file) {
  const auto first_material = static_cast<int>(scene.materials.size());
  const auto first_texture = static_cast<int>(scene.textures.size());
  for (Material& material : file.materials) {
    if (material.base_color_texture >= 0) material.base_color_texture += first_texture;
    scene.materials.push_back(std::move(material));
  }
  for (Mesh& mesh : file.meshes) {
    mesh.material += first_material;
    scene.meshes.push_back(std::move(mesh));
  }
  scene.rounding_m = std::max(scene.rounding_m, file.rounding_m);
  std::ranges::move(file.textures, std::back_inserter(scene.textures));
  std::ranges::move(file.warnings, std::back_inserter(scene.warnings));
  return scene;
}

Texture decode_texture(const std::vector<unsigned char>& bytes, const std::string& name, const std::string& where,
                       const std::vector<Texture>& others) {
  if (bytes.empty() || bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    fail_input(fmt::format("image '{}' has no usable size: {} bytes", name, bytes.size()), where);
  require_usable_size(bytes, name, where, others);
  tinygltf::Image image;
  std::string failure;
  std::string warning;
  const bool decoded = tinygltf::LoadImageData(&image, 0, &failure, &warning, 0, 0, bytes.data(),
                                               static_cast<int>(bytes.size()), nullptr);
  if (!decoded || image.component != 4)
    fail_input(fmt::format("image '{}' cannot be decoded: use PNG or JPEG", name), where);
  return {name, image.width, image.height, to_8_bits(image)};
}

std::optional<fs::path> resolve_inside(const fs::path& folder, std::string_view reference) {
  if (reference.find('\0') != std::string_view::npos) return std::nullopt;
  const fs::path relative = fs::path(reference).lexically_normal();
  if (relative.is_absolute() || relative.empty() || *relative.begin() == "..") return std::nullopt;
  std::error_code failure;
  const fs::path here = folder.empty() ? "." : folder;  // what begins with no folder may be absent as a whole
  const fs::path top = fs::weakly_canonical(here, failure);
  const fs::path target = failure ? fs::path() : fs::weakly_canonical(here / relative, failure);
  if (failure || !is_below(top, target)) return std::nullopt;
  return folder / relative;
}

MeshFile import_obj(const std::filesystem::path& file, const glm::dvec3& origin) {
  return ObjImporter(file, origin).import();
}

}  // namespace shadowbench::scene
