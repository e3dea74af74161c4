#include "harness/view/view_log.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "filters/base/error.h"

namespace shadowbench::view {

ViewLog::ViewLog(const std::filesystem::path& file) : file_(std::fopen(file.c_str(), "w")) {
  if (file_) return;
  throw Error(ErrorKind::kOutput, fmt::format("the log cannot be written ({})", std::strerror(errno)), file.string());
}

void ViewLog::note_widget(const std::string& name, const glm::vec2& least, const glm::vec2& most) {
  if (is_on()) widgets_[name] = glm::vec4(least, most);
}

void ViewLog::end_frame(double now_s, double frame_ms, bool drawn, const std::map<std::string, double>& more) {
  if (!is_on()) return;
  nlohmann::json line = {{"event", "frame"}, {"t", now_s}, {"ms", frame_ms}, {"drawn", drawn}};
  for (const auto& [name, value] : more) line[name] = value;
  if (widgets_ != written_) {
    for (const auto& [name, place] : widgets_) line["widgets"][name] = {place.x, place.y, place.z, place.w};
    written_ = widgets_;
  }
  widgets_.clear();
  fmt::print(file_.get(), "{}\n", line.dump());
  std::fflush(file_.get());
}

void ViewLog::note(double now_s, const std::string& event, const std::string& what) {
  if (!is_on()) return;
  fmt::print(file_.get(), "{}\n", nlohmann::json({{"event", event}, {"t", now_s}, {"what", what}}).dump());
  std::fflush(file_.get());
}

}  // namespace shadowbench::view
