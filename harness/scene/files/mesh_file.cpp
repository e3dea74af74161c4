#include "harness/scene/files/mesh_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
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

using Bytes = std::span<const unsigned char>;

constexpr std::uint64_t from_big_endian(Bytes bytes) {
  std::uint64_t value = 0;
  for (const unsigned char byte : bytes) value = value << 8 | byte;
  return value;
}

constexpr std::uint64_t from_little_endian(Bytes bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i > 0; --i) value = value << 8 | bytes[i - 1];
  return value;
}

bool starts_with(Bytes bytes, std::initializer_list<unsigned char> signature) {
  return bytes.size() >= signature.size() && std::equal(signature.begin(), signature.end(), bytes.begin());
}

std::optional<PictureSize> png_size(Bytes bytes) {
  constexpr std::array<unsigned char, 4> kHeader{'I', 'H', 'D', 'R'};
  if (bytes.size() < 24 || !std::ranges::equal(bytes.subspan(12, 4), kHeader)) return std::nullopt;
  return PictureSize{from_big_endian(bytes.subspan(16, 4)), from_big_endian(bytes.subspan(20, 4))};
}

/// The magnitude of a signed height: negative ones say that the rows run from the top.
std::uint64_t magnitude(std::uint64_t bits) { return bits > 0x7fffffffU ? 0x100000000U - bits : bits; }

std::optional<PictureSize> bmp_size(Bytes bytes) {
  if (bytes.size() < 26) return std::nullopt;
  if (from_little_endian(bytes.subspan(14, 4)) == 12)
    return PictureSize{from_little_endian(bytes.subspan(18, 2)), from_little_endian(bytes.subspan(20, 2))};
  return PictureSize{magnitude(from_little_endian(bytes.subspan(18, 4))),
                     magnitude(from_little_endian(bytes.subspan(22, 4)))};
}

std::optional<PictureSize> gif_size(Bytes bytes) {
  if (bytes.size() < 10) return std::nullopt;
  return PictureSize{from_little_endian(bytes.subspan(6, 2)), from_little_endian(bytes.subspan(8, 2))};
}

/// A TGA has no signature: its second and third byte say whether it has a palette, and how its pixels are packed.
std::optional<PictureSize> tga_size(Bytes bytes) {
  constexpr std::array<unsigned char, 6> kKinds{1, 2, 3, 9, 10, 11};
  if (bytes.size() < 18 || bytes[1] > 1 || std::ranges::find(kKinds, bytes[2]) == kKinds.end()) return std::nullopt;
  return PictureSize{from_little_endian(bytes.subspan(12, 2)), from_little_endian(bytes.subspan(14, 2))};
}

/// Goes from marker to marker to the first that begins a frame.
std::optional<PictureSize> jpeg_size(Bytes bytes) {
  std::size_t at = 2;
  while (at + 8 < bytes.size()) {
    if (bytes[at] != 0xff || bytes[at + 1] == 0xff) {
      ++at;
      continue;
    }
    const unsigned char marker = bytes[at + 1];
    if (marker >= 0xc0 && marker <= 0xc2)
      return PictureSize{from_big_endian(bytes.subspan(at + 7, 2)), from_big_endian(bytes.subspan(at + 5, 2))};
    at += 2 + from_big_endian(bytes.subspan(at + 2, 2));
  }
  return std::nullopt;
}

/// Refuses what a picture's header claims before any memory is asked for.
void require_usable_size(const std::vector<unsigned char>& bytes, const std::string& name, const std::string& where,
                         const std::vector<Texture>& others) {
  constexpr std::uint64_t kLongestSide = 16384;
  constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26;
  constexpr std::uint64_t kMostPixelsOfAll = std::uint64_t{1} << 28;
  const std::optional<PictureSize> size = read_picture_size(bytes);
  if (!size) fail_input(fmt::format("image '{}' cannot be decoded: use PNG or JPEG", name), where);
  if (size->width == 0 || size->height == 0)
    fail_input(fmt::format("image '{}' has no pixels: {} x {}", name, size->width, size->height), where);
  const bool short_enough = std::max(size->width, size->height) <= kLongestSide;
  if (!short_enough || size->width * size->height > kMostPixels) {
    fail_input(fmt::format("image '{}' says that it has {} x {} pixels; at most {} a side and {} in all are read", name,
                           size->width, size->height, kLongestSide, kMostPixels),
               where);
  }
  std::uint64_t pixels = size->width * size->height;
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

std::optional<PictureSize> read_picture_size(std::span<const unsigned char> bytes) {
  if (starts_with(bytes, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'})) return png_size(bytes);
  if (starts_with(bytes, {0xff, 0xd8})) return jpeg_size(bytes);
  if (starts_with(bytes, {'B', 'M'})) return bmp_size(bytes);
  if (starts_with(bytes, {'G', 'I', 'F', '8'})) return gif_size(bytes);
  return tga_size(bytes);
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
