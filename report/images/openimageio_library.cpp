#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <functional>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "report/images/image_library.h"

namespace shadowbench::images {
namespace {

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

// EXR sorts channels by name; this attribute keeps the order they were given in.
constexpr const char* kChannelOrder = "shadowbench:channels";

bool has_unique_names(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return std::adjacent_find(names.begin(), names.end()) == names.end();
}

void check_names(const std::filesystem::path& path, const std::vector<Part>& parts) {
  std::vector<std::string> names;
  for (const Part& part : parts) {
    assert(part.channel_names.size() == static_cast<std::size_t>(part.image.channels));
    names.push_back(part.name);
    if (!has_unique_names(part.channel_names))
      throw Error(ErrorKind::kOutput, fmt::format("two channels of part '{}' have one name", part.name), path.string());
  }
  if (!has_unique_names(names)) throw Error(ErrorKind::kOutput, "two parts have one name", path.string());
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
  spec.attribute(kChannelOrder, OIIO::Strutil::join(part.channel_names, ","));
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

// Puts the channels back into the order they were written in, where the file says so.
Part reorder_channels(Part part, const std::string& order) {
  const std::vector<std::string> names = OIIO::Strutil::splits(order, ",");
  if (names == part.channel_names ||
      !std::is_permutation(names.begin(), names.end(), part.channel_names.begin(), part.channel_names.end()))
    return part;
  Part result{part.name, names, Image(part.image.width, part.image.height, part.image.channels), part.half};
  const std::size_t channels = names.size();
  for (std::size_t to = 0; to < channels; ++to) {
    const auto found = std::find(part.channel_names.begin(), part.channel_names.end(), names[to]);
    const auto from = static_cast<std::size_t>(found - part.channel_names.begin());
    for (std::size_t i = 0; i < part.image.texels.size(); i += channels)
      result.image.texels[i + to] = part.image.texels[i + from];
  }
  return result;
}

std::string name_part(const OIIO::ImageSpec& spec) { return spec.get_string_attribute("oiio:subimagename"); }

Part read_part(OIIO::ImageInput& input, int index, const std::filesystem::path& path) {
  const OIIO::ImageSpec spec = input.spec(index);
  Part part{name_part(spec), spec.channelnames, Image(spec.width, spec.height, spec.nchannels),
            spec.format == OIIO::TypeDesc::HALF};
  if (!input.read_image(index, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, part.image.texels.data())) {
    throw Error(ErrorKind::kInput, fmt::format("part '{}' is damaged ({})", part.name, input.geterror()),
                path.string());
  }
  return reorder_channels(std::move(part), spec.get_string_attribute(kChannelOrder));
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
  require_plain_file(path, 16384 * kMebibyte);
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input)
    throw Error(ErrorKind::kInput, fmt::format("the EXR file cannot be read ({})", OIIO::geterror()), path.string());
  ExrFile file{{}, read_metadata(input->spec(0))};
  for (int i = 0; input->seek_subimage(i, 0); ++i)
    if (is_wanted(name_part(input->spec(i)))) file.parts.push_back(read_part(*input, i, path));
  return file;
}

}  // namespace shadowbench::images

constexpr shadowbench::images::ImageLibrary shadowbench_image_library = {
    shadowbench::images::read_stored_picture, shadowbench::images::read_layers,
    shadowbench::images::write_exr,           shadowbench::images::read_exr,
    shadowbench::images::round_to_half,       shadowbench::images::color_linearly};
