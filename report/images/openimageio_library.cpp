#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "report/images/image_library.h"

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

/// The channels of a layer, those whose names begin with its own and a dot.
std::vector<int> find_layer(const OIIO::ImageSpec& spec, const std::string& layer) {
  std::vector<int> channels;
  for (int c = 0; c < spec.nchannels; ++c)
    if (std::string_view(spec.channel_name(c)).starts_with(layer + ".")) channels.push_back(c);
  return channels;
}

/// A part, or the channels of it that are a layer.
struct FoundPart {
  int part = 0;
  std::vector<int> channels = {};  ///< empty: all
};

/// A part, or the layer of that name.
FoundPart find_part(OIIO::ImageInput& input, const PictureName& name) {
  if (!name.part) return {};
  const std::vector<std::string> parts = list_parts(input);
  const auto found = std::find(parts.begin(), parts.end(), *name.part);
  if (found != parts.end()) return {static_cast<int>(found - parts.begin())};
  std::vector<std::string> known = parts;
  for (int part = 0; part < static_cast<int>(parts.size()); ++part) {
    if (auto channels = find_layer(input.spec(part), *name.part); !channels.empty()) return {part, std::move(channels)};
    for (const std::string& channel : input.spec(part).channelnames)
      if (const std::size_t dot = channel.rfind('.'); dot != channel.npos) known.push_back(channel.substr(0, dot));
  }
  known.erase(std::unique(known.begin(), known.end()), known.end());  // channels of a layer stand together
  fail(name.file, fmt::format("there is no part '{}'{}; parts: {}", *name.part, did_you_mean(*name.part, known),
                              fmt::join(known, ", ")));
}

void check(const OIIO::ImageSpec& spec, const std::string& where) {
  if (spec.deep) fail(where, "the picture is deep, with many samples per pixel: flatten it first");
  if (spec.depth > 1) fail(where, fmt::format("the picture is a volume of {} slices: choose one first", spec.depth));
  if (spec.image_pixels() <= kMostPixels) return;
  fail(where, fmt::format("the picture has {} x {} pixels: at most {} are read", spec.width, spec.height, kMostPixels));
}

bool is_alpha(std::string_view channel) {
  const std::string name = OIIO::Strutil::lower(channel.substr(channel.rfind('.') + 1));
  return name == "a" || name == "alpha";
}

/// Some readers give the index of a channel that is not there (GIF): names count first.
int find_alpha(const OIIO::ImageSpec& spec) {
  for (int c = 0; c < spec.nchannels; ++c)
    if (is_alpha(spec.channel_name(c))) return c;
  return spec.alpha_channel < spec.nchannels ? spec.alpha_channel : -1;
}

bool is_srgb(const OIIO::ImageSpec& spec) {
  return !spec.format.is_floating_point() &&
         OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "sRGB");
}

StoredPicture read_part(OIIO::ImageInput& input, int part, const std::string& where) {
  const OIIO::ImageSpec spec = input.spec(part);
  check(spec, where);
  StoredPicture picture{Image(spec.width, spec.height, spec.nchannels),
                        find_alpha(spec),
                        spec.channelnames,
                        is_srgb(spec),
                        spec.x,
                        spec.y};
  if (!input.read_image(part, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, picture.image.texels.data()))
    fail(where, fmt::format("the picture is damaged ({})", make_line(input.geterror())));
  return picture;
}

/// Some channels of a picture, in this order.
StoredPicture choose_channels(const StoredPicture& whole, const OIIO::ImageSpec& spec,
                              const std::vector<int>& channels) {
  StoredPicture chosen = whole;
  const auto count = channels.size(), all = static_cast<std::size_t>(whole.image.channels);
  chosen.image = Image(whole.image.width, whole.image.height, static_cast<int>(count));
  for (std::size_t i = 0; i < chosen.image.texels.size(); ++i)
    chosen.image.texels[i] = whole.image.texels[i / count * all + static_cast<std::size_t>(channels[i % count])];
  chosen.channel_names.clear();
  for (const int c : channels) chosen.channel_names.push_back(spec.channel_name(c));
  const auto alpha = std::ranges::find_if(channels, [&](int c) { return is_alpha(spec.channel_name(c)); });
  chosen.alpha_channel = alpha == channels.end() ? -1 : static_cast<int>(alpha - channels.begin());
  return chosen;
}

/// Readers of some formats (GIF) make room for a whole picture before they can be asked for its size.
template <class Read>
auto read_any_size(const std::string& where, const Read& read) {
  try {
    return read();
  } catch (const std::length_error&) {
    fail(where, "the picture is damaged: it says that it is larger than memory can be");
  }
}

/// A file that remembers the first write that failed.
class CheckedFile final : public OIIO::Filesystem::IOProxy {
 public:
  explicit CheckedFile(const std::string& name)
      : IOProxy(name, Write), descriptor_(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) error_ = errno;
  }
  ~CheckedFile() override { finish(); }

  const char* proxytype() const override { return "checked"; }
  void close() override {}  // image libraries close between the parts of a file

  std::size_t write(const void* bytes, std::size_t size) override {
    const std::size_t written = pwrite(bytes, size, m_pos);
    m_pos += static_cast<std::int64_t>(written);
    return written;
  }

  std::size_t pwrite(const void* bytes, std::size_t size, std::int64_t offset) override {
    std::size_t written = 0;
    while (written < size && error_ == 0) {
      const ssize_t more = ::pwrite(descriptor_, static_cast<const char*>(bytes) + written, size - written,
                                    offset + static_cast<std::int64_t>(written));
      if (more < 0 && errno != EINTR) error_ = errno;
      if (more > 0) written += static_cast<std::size_t>(more);
    }
    return written;
  }

  std::size_t size() const override {
    struct stat status {};
    return fstat(descriptor_, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
  }

  /// Closes the file; gives the error of the first write that failed, or of closing, or 0.
  int finish() {
    if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0 && error_ == 0) error_ = errno;
    return error_;
  }

 private:
  int descriptor_ = -1;
  int error_ = 0;
};

/// Opens a file by the name it is given, writes it and closes it; gives whether that went well.
using ImageWriting = std::function<bool(OIIO::ImageOutput& output, const std::string& name)>;

/// Has OpenImageIO write an image file, which appears whole or not at all: the image libraries do not check
/// whether what they write arrives on the disk, so this function writes their bytes and checks. Throws Error(kOutput).
void write_image_file(const std::filesystem::path& path, const ImageWriting& write) {
  PendingFile pending(path);
  const std::string name = pending.temporary_path().string();
  CheckedFile file(name);
  std::string reason;
  {
    const auto output = OIIO::ImageOutput::create(name);
    const bool is_written = output && output->set_ioproxy(&file) && write(*output, name);
    if (!is_written) reason = output ? output->geterror() : OIIO::geterror();
    if (!is_written && reason.empty()) reason = "the image library gives no reason";
  }
  if (const int error = file.finish()) reason = std::generic_category().message(error);
  if (!reason.empty()) {
    throw Error(ErrorKind::kOutput,
                fmt::format("the picture cannot be written ({}); check the folder's rights and free space, or choose "
                            "another with --out",
                            reason),
                path.string());
  }
  pending.commit();
}

void check_names(const std::filesystem::path& path, const std::vector<Part>& parts) {
  std::vector<std::string> names;
  for (const Part& part : parts) names.push_back(part.name);
  std::sort(names.begin(), names.end());
  if (std::adjacent_find(names.begin(), names.end()) != names.end())
    throw Error(ErrorKind::kOutput, "two parts have one name", path.string());
}

OIIO::ImageSpec make_spec(const Part& part, const Image& display, const Metadata& metadata) {
  OIIO::ImageSpec spec(part.image.width, part.image.height, part.image.channels,
                       part.half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
  // All parts of a file share one display window; their data windows are their own.
  spec.full_width = display.width;
  spec.full_height = display.height;
  spec.channelnames = part.channel_names;
  spec.attribute("compression", "zip");
  spec.attribute("oiio:subimagename", part.name);
  for (const auto& [name, value] : metadata)
    if (const auto* number = std::get_if<double>(&value))
      spec.attribute(name, OIIO::TypeDesc::DOUBLE, number);
    else
      spec.attribute(name, std::get<std::string>(value));
  return spec;
}

bool write_parts(OIIO::ImageOutput& output, const std::string& file, const std::vector<Part>& parts,
                 const std::vector<OIIO::ImageSpec>& specs) {
  if (!output.open(file, static_cast<int>(specs.size()), specs.data())) return false;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0 && !output.open(file, specs[i], OIIO::ImageOutput::AppendSubimage)) return false;
    if (!output.write_image(OIIO::TypeDesc::FLOAT, parts[i].image.texels.data())) return false;
  }
  return output.close();
}

std::string name_part(const OIIO::ImageSpec& spec) { return spec.get_string_attribute("oiio:subimagename"); }

Part read_named_part(OIIO::ImageInput& input, int index, const std::string& file) {
  const OIIO::ImageSpec spec = input.spec(index);
  StoredPicture stored = read_part(input, index, file);
  return {name_part(spec), stored.channel_names, std::move(stored.image), spec.format == OIIO::TypeDesc::HALF};
}

Metadata read_metadata(const OIIO::ImageSpec& spec) {
  Metadata metadata;
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    const OIIO::TypeDesc type = attribute.type();
    if (type == OIIO::TypeDesc::STRING)
      metadata[attribute.name().string()] = attribute.get_string();
    else if (type == OIIO::TypeDesc::DOUBLE)
      metadata[attribute.name().string()] = *static_cast<const double*>(attribute.data());
  }
  return metadata;
}

/// OpenImageIO's own maps: viridis, inferno, magma, turbo and others.
Image color_linearly(const Image& values, const std::string& map) {
  const OIIO::ImageSpec spec(values.width, values.height, 1, OIIO::TypeDesc::FLOAT);
  const OIIO::ImageBuf source(spec, const_cast<float*>(values.texels.data()));
  Image colors(values.width, values.height, 3);
  OIIO::ImageBufAlgo::color_map(source, 0, map)
      .get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, colors.texels.data());
  return colors;
}

}  // namespace

StoredPicture read_stored_picture(const std::string& name) {
  const PictureName parsed = parse_name(name);
  return read_any_size(name, [&] {
    const auto input = open_file(parsed.file);
    const auto [part, channels] = find_part(*input, parsed);
    StoredPicture whole = read_part(*input, part, name);
    return channels.empty() ? whole : choose_channels(whole, input->spec(part), channels);
  });
}

std::map<std::string, StoredPicture> read_layers(const std::string& file) {
  if (!exists(file)) fail(file, "there is no such file: check the path");
  return read_any_size(file, [&] {
    const auto input = open_file(file);
    std::map<std::string, StoredPicture> layers;
    const std::vector<std::string> parts = list_parts(*input);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const OIIO::ImageSpec spec = input->spec(static_cast<int>(part));
      const StoredPicture whole = read_part(*input, static_cast<int>(part), file);
      std::map<std::string, std::vector<int>> channels;  // by layer
      for (int c = 0; c < spec.nchannels; ++c) {
        const std::string name = spec.channel_name(c);
        const std::size_t dot = name.rfind('.');
        channels[dot != name.npos ? name.substr(0, dot) : std::string(spec.get_string_attribute("oiio:subimagename"))]
            .push_back(c);
      }
      for (const auto& [name, own] : channels) layers.insert_or_assign(name, choose_channels(whole, spec, own));
    }
    return layers;
  });
}

Image round_to_half(const Image& image) {
  Image rounded = image;
  std::vector<std::uint16_t> halves(image.texels.size());
  const int count = static_cast<int>(image.texels.size());
  OIIO::convert_pixel_values(OIIO::TypeDesc::FLOAT, image.texels.data(), OIIO::TypeDesc::HALF, halves.data(), count);
  OIIO::convert_pixel_values(OIIO::TypeDesc::HALF, halves.data(), OIIO::TypeDesc::FLOAT, rounded.texels.data(), count);
  return rounded;
}

void write_exr(const std::filesystem::path& path, const std::vector<Part>& parts, const Metadata& metadata) {
  assert(!parts.empty());
  check_names(path, parts);
  std::vector<OIIO::ImageSpec> specs;
  for (const Part& part : parts) specs.push_back(make_spec(part, parts.front().image, metadata));
  write_image_file(path, [&](OIIO::ImageOutput& output, const std::string& name) {
    return write_parts(output, name, parts, specs);
  });
}

ExrFile read_exr(const std::filesystem::path& path, const PartChoice& is_wanted) {
  const auto input = open_file(path.string());
  ExrFile file{{}, read_metadata(input->spec(0))};
  for (int i = 0; input->seek_subimage(i, 0); ++i)
    if (is_wanted(name_part(input->spec(i)))) file.parts.push_back(read_named_part(*input, i, path.string()));
  return file;
}

}  // namespace shadowbench::images

constexpr shadowbench::images::ImageLibrary shadowbench_image_library = {
    shadowbench::images::read_stored_picture, shadowbench::images::read_layers,
    shadowbench::images::write_exr,           shadowbench::images::read_exr,
    shadowbench::images::round_to_half,       shadowbench::images::color_linearly};
