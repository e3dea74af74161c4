#include "report/page/plot_files.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "filters/base/error.h"
#include "report/files/atomic_file.h"
#include "report/files/temporary_files.h"

namespace shadowbench::page {
namespace {

namespace fs = std::filesystem;

// A folder beside the plots' place, so that they can be renamed into it; gone at the end.
class WorkFolder {
 public:
  explicit WorkFolder(const fs::path& dir) : path_(files::make_temporary_folder_path(dir, "plots")) {}
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// gnuplot says nothing of a disk that is full: it leaves a drawing without its end.
bool is_whole(const fs::path& drawing) {
  constexpr std::string_view kEnd = "</svg>";
  std::ifstream file(drawing, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(file.tellg());
  std::string tail(32, '\0');
  if (!file || size < static_cast<std::streamoff>(tail.size())) return false;
  file.seekg(size - static_cast<std::streamoff>(tail.size()));
  file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  return tail.find(kEnd) != std::string::npos;
}

void move_plot(const fs::path& from, const fs::path& to) {
  if (!is_whole(from)) {
    throw Error(
        ErrorKind::kOutput,
        "gnuplot could not draw this file to its end; check the folder's free space, or choose another with --out",
        to.string());
  }
  std::error_code error;
  fs::rename(from, to, error);
  if (error)
    throw Error(ErrorKind::kOutput,
                fmt::format("the plot cannot be given its name ({}); check the folder's rights", error.message()),
                to.string());
}

}  // namespace

std::optional<std::string> write_plot_files(const fs::path& dir, const fs::path& script,
                                            const std::vector<Plot>& plots) {
  const std::string text = make_gnuplot_script(plots);
  files::write_text_file(dir / script, text);
  if (plots.empty()) return std::nullopt;
  const WorkFolder work(dir);
  files::write_text_file(work.path() / script, text);
  if (const auto reason = run_gnuplot(work.path(), script)) return reason;
  for (const Plot& plot : plots) move_plot(work.path() / plot.file, dir / plot.file);
  return std::nullopt;
}

}  // namespace shadowbench::page
