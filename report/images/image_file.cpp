#include "report/images/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "filters/base/atomic_file.h"
#include "filters/base/error.h"

namespace shadowbench::images {
namespace {

/// A file that remembers the first write that failed.
class CheckedFile final : public OIIO::Filesystem::IOProxy {
 public:
  explicit CheckedFile(const std::string& name)
      : IOProxy(name, Write), descriptor_(::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
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

}  // namespace

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

}  // namespace shadowbench::images
