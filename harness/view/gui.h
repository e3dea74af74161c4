#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/render/picture_passes.h"
#include "harness/view/inspection.h"
#include "harness/view/layers.h"
#include "harness/view/picture_input.h"
#include "harness/view/settings_panel.h"
#include "harness/view/view_state.h"
#include "harness/view/window.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

/// The whole window: picture, panels, status line.
class Gui {
 public:
  /// Everything must outlive this object. Saved files go to `out`. With `keeps_size` the picture keeps its size, and
  /// else it takes that of the window.
  Gui(Window& window, Workbench& bench, ViewLog& log, std::filesystem::path out, bool keeps_size);

  /// Takes a frame's input and lays out its widgets; between Window::begin_frame() and end_frame().
  void lay_out(double now_s);

  /// Draws the picture, over which end_frame() draws the widgets.
  void draw_picture();

  /// Whether the next frame must not wait for an event.
  bool is_moving() const { return input_.is_flying() || is_timing_; }

  /// Saves the picture that was asked for, once all that it shows is there; after the widgets are drawn over it.
  void save_wanted_picture();

  PicturePlace place() const;
  const Look& look() const { return look_; }
  /// Begins a lesson by name.
  void start(const std::string& lesson);

  std::string lesson() const { return scenes_.lesson(); }
  const std::string& reading() const { return reading_; }

  /// What the panels take of the window's size, in pixels.
  static glm::ivec2 panel_size(float scale);

  /// One key with what it does, beside those that fly the camera; F1 lists them all.
  struct Key {
    int key = 0;           ///< of GLFW
    bool control = false;  ///< with Ctrl
    std::string name;      ///< as it is written on the keyboard
    std::string text;      ///< what it does
    void (*press)(Gui& gui);
  };

 private:
  Window& window_;
  Workbench& bench_;
  ViewLog& log_;
  std::filesystem::path out_;
  bool keeps_size_;
  Look look_;
  Layers layers_;
  render::DisplayPass display_;
  PictureInput input_;
  ScenePanel scenes_;
  SettingsPanel settings_;
  TimeMeter meter_;
  bool is_timing_ = false;
  MapPanel map_;
  std::array<ShownLayer, kSides> shown_;
  glm::ivec2 full_size_;  ///< of the picture, in pixels, while nothing is dragged
  double moved_s_ = 0.0;  ///< when camera or light moved last
  double last_s_ = 0.0;
  std::string reading_;         ///< what the picture shows under the pointer; empty: it is elsewhere
  std::string saved_;           ///< what was saved last
  bool wants_picture_ = false;  ///< it is saved when all that it shows is there

  glm::vec2 free_area() const;
  glm::ivec2 gl_corner() const;
  void fit_picture(double now_s);
  void resize(bool halves);
  bool is_halved() const { return bench_.state().options.width != full_size_.x; }
  void start(const Lesson& lesson);
  /// All keys, in the order of the help; one table.
  static const std::vector<Key>& list_keys();
  void obey(const Window::KeyPress& press);
  void lay_out_panels();
  void lay_out_status();
  void lay_out_help();
  std::string make_caption(std::size_t side) const;
  void lay_out_captions();
  std::vector<std::pair<std::size_t, ScaleCaption>> list_scales() const;
  void lay_out_scales(glm::vec2 corner);
  void lay_out_faults();
  void follow_pointer();
  std::string read_value(const glm::ivec2& pixel, std::size_t side) const;
  void draw_divider();
  void save(const std::string& what, const std::function<void(const std::filesystem::path& stem)>& write);
  void save_state(const std::string& what, void (*write)(const ViewState& state, const std::filesystem::path& file));
  void save_picture(const std::filesystem::path& stem);
};

/// What `shadowbench view` is told.
struct ViewOptions {
  options::RunOptions run;  ///< its `out` is where files are saved
  std::string scene = "cubes";
  std::string lesson;                                        ///< by name, in place of scene, sides and map; empty: none
  std::string light_name;                                    ///< of the one that shines; empty: the first
  std::array<std::string, kSides> sides = {"", kTruthName};  ///< as make_side() takes them; empty: a usual filter
  std::vector<std::filesystem::path> filter_files;
  bool keeps_size = false;     ///< the picture does not follow the window's size
  double scale = 0.0;          ///< of text and widgets; 0: as the screen asks for
  std::string log;             ///< its file; empty: none
  double close_after_s = 0.0;  ///< 0: never
};

/// Opens the window, and returns when it is closed. Throws Error(kContext) where there is no display, and otherwise as
/// a run does.
void run_view(const ViewOptions& options);

}  // namespace shadowbench::view
