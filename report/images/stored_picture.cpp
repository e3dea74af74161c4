#include "report/images/stored_picture.h"

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/input_file.h"
#include "base/nearest_name.h"

namespace shadowbench::images {
namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

[[noreturn]] void fail(const std::string& where, const std::string& message) {
  throw Error(ErrorKind::kInput, message, where);
}

/// Libraries' messages may have several lines; ours have one.
std::string make_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

struct PictureName {
  std::string file;
  std::optional<std::string> part;
};

bool exists(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

/// File names may hold '#' themselves: the longest one that exists is meant.
PictureName parse_name(const std::string& name) {
  if (exists(name)) return {name, std::nullopt};
  for (std::size_t at = name.rfind('#'); at != std::string::npos && at > 0; at = name.rfind('#', at - 1))
    if (exists(name.substr(0, at))) return {name.substr(0, at), name.substr(at + 1)};
  fail(name.substr(0, name.rfind('#')), "there is no such file: check the path, or run 'shadowbench run' first");
}

std::unique_ptr<OIIO::ImageInput> open_file(const std::string& file) {
  if (std::filesystem::is_directory(file)) fail(file, "this is a folder: name a picture in it");
  require_plain_file(file, 16384 * kMebibyte);
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);
  auto input = OIIO::ImageInput::open(file, &wishes);
  if (!input) fail(file, fmt::format("the picture cannot be read ({})", make_line(OIIO::geterror())));
  return input;
}

std::vector<std::string> list_parts(OIIO::ImageInput& input) {
  std::vector<std::string> names;
  for (int i = 0; input.seek_subimage(i, 0); ++i) {
    const std::string name = input.spec().get_string_attribute("oiio:subimagename");
    names.push_back(name.empty() ? std::to_string(i) : name);
  }
  input.geterror();  // the one that ended the loop
  return names;
}

int find_part(OIIO::ImageInput& input, const PictureName& name) {
  if (!name.part) return 0;
  const std::vector<std::string> parts = list_parts(input);
  const auto found = std::find(parts.begin(), parts.end(), *name.part);
  if (found != parts.end()) return static_cast<int>(found - parts.begin());
  fail(name.file, fmt::format("there is no part '{}'{}; parts: {}", *name.part, did_you_mean(*name.part, parts),
                              fmt::join(parts, ", ")));
}

void check(const OIIO::ImageSpec& spec, const std::string& where) {
  if (spec.deep) fail(where, "the picture is deep, with many samples per pixel: flatten it first");
  if (spec.depth > 1) fail(where, fmt::format("the picture is a volume of {} slices: choose one first", spec.depth));
  if (spec.image_pixels() <= kMostPixels) return;
  fail(where, fmt::format("the picture has {} x {} pixels: at most {} are read", spec.width, spec.height, kMostPixels));
}

/// Some readers give the index of a channel that is not there (GIF): names count first.
int find_alpha(const OIIO::ImageSpec& spec) {
  for (int c = 0; c < spec.nchannels; ++c) {
    const std::string name = OIIO::Strutil::lower(spec.channel_name(c));
    if (name == "a" || name == "alpha") return c;
  }
  return spec.alpha_channel < spec.nchannels ? spec.alpha_channel : -1;
}

bool is_srgb(const OIIO::ImageSpec& spec) {
  return !spec.format.is_floating_point() &&
         OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "sRGB");
}

}  // namespace

StoredPicture read_stored_picture(const std::string& name) {
  const PictureName parsed = parse_name(name);
  const auto input = open_file(parsed.file);
  const int part = find_part(*input, parsed);
  const OIIO::ImageSpec spec = input->spec(part);
  check(spec, name);
  StoredPicture picture{Image(spec.width, spec.height, spec.nchannels), find_alpha(spec), is_srgb(spec), spec.x,
                        spec.y};
  if (!input->read_image(part, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, picture.image.texels.data()))
    fail(name, fmt::format("the picture is damaged ({})", make_line(input->geterror())));
  return picture;
}

}  // namespace shadowbench::images
