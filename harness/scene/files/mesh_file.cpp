#include "harness/scene/files/mesh_file.h"

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <limits>
#include <utility>

#include "base/error.h"

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

}  // namespace shadowbench::scene
