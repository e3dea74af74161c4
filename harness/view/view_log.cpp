#include "harness/view/view_log.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace shadowbench::view {

ViewLog::ViewLog(const std::filesystem::path& file) : file_(std::fopen(file.c_str(), "w")) {
  if (file_) return;
  throw Error(ErrorKind::kOutput, fmt::format("the log cannot be written ({})", std::strerror(errno)), file.string());
}

void ViewLog::note_widget(const std::string& name, const glm::vec2& least, const glm::vec2& most) {
  if (is_on()) widgets_[name] = glm::vec4(least, most);
}

void ViewLog::end_frame(const Frame& frame) {
  if (!is_on()) return;
  nlohmann::json line = {{"event", "frame"}, {"t", frame.begun_s}, {"ms", frame.ms}, {"drawn", frame.drawn}};
  for (const auto& [name, value] : frame.numbers) line[name] = value;
  for (const auto& [name, text] : frame.texts) line[name] = text;
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
