#pragma once

#include <cstdio>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>

namespace shadowbench::view {

/// Tells a test, in a file, what the window does: one JSON object a line. Does nothing without a file.
class ViewLog {
 public:
  ViewLog() = default;
  /// Throws Error(kOutput) where the file cannot be written.
  explicit ViewLog(const std::filesystem::path& file);

  bool is_on() const { return file_ != nullptr; }

  /// The last widget has this name and place, in pixels from the window's upper left corner.
  void note_widget(const std::string& name, const glm::vec2& least, const glm::vec2& most);

  /// A frame is finished: the time that it took from its events to its picture, and whether something was drawn anew.
  /// Writes also the widgets, where they are not where they were.
  void end_frame(double now_s, double frame_ms, bool drawn, const std::map<std::string, double>& more);

  /// Something happened.
  void note(double now_s, const std::string& event, const std::string& what);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::map<std::string, glm::vec4> widgets_, written_;
};

}  // namespace shadowbench::view
