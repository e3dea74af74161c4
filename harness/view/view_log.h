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

  /// What a frame shows.
  struct Frame {
    double begun_s = 0.0;  ///< of std::chrono::steady_clock, after its events were taken
    double ms = 0.0;       ///< from there until it was handed to the window system
    bool drawn = false;    ///< whether passes ran
    std::map<std::string, double> numbers;
    std::map<std::string, std::string> texts;
  };

  /// A frame is finished. Writes also the widgets, where they are not where they were.
  void end_frame(const Frame& frame);

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
