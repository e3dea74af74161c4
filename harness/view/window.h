#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/gl/context/context_glfw.h"

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

/// Dear ImGui in a window of GLFW: events in, frames out.
class Window {
 public:
  /// `context` must be current and outlive this object. `scale` enlarges text and widgets; 0: as the screen asks for.
  /// Throws Error(kContext) where ImGui cannot draw into it.
  Window(gl::GlfwContext& context, float scale);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  /// The size that a window may have on the first screen, with room for its frame.
  static glm::ivec2 find_room();

  void set_title(const std::string& title);

  bool is_closing() const;
  void close();

  /// Waits for events, at most so many seconds, and handles them.
  void wait(double seconds);

  glm::ivec2 size() const;                ///< of the framebuffer, pixels
  float scale() const { return scale_; }  ///< pixels for each of a usual screen's

  /// A key that went down.
  struct KeyPress {
    int key = 0;  ///< of GLFW
    bool control = false;
  };

  /// The keys that went down since the last call, also those that are up again: ImGui sees only what is down while a
  /// frame begins. None of those that were typed into a widget.
  std::vector<KeyPress> take_keys();

  /// Whether a key of GLFW is down.
  bool is_held(int key) const;

  void begin_frame();

  /// Draws the widgets over what the window's framebuffer holds, and shows it after `look` has seen it.
  void end_frame(const std::function<void()>& look);

 private:
  GLFWwindow* window_;
  float scale_ = 1.0f;
  std::vector<KeyPress> keys_;
  std::string title_;

  static void note_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
};

}  // namespace shadowbench::view
