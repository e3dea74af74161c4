#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/measure/renderer.h"
#include "harness/view/file_watch.h"
#include "harness/view/stage.h"
#include "harness/view/view_state.h"

namespace shadowbench::view {

/// How long a saved file may go unseen.
inline constexpr double kSecondsBetweenLooks = 0.1;

/// What the window works on: a state, its drawing, its truth and its measurement, kept in step. Nothing here knows of
/// widgets. Times are seconds of any clock that does not go back.
class Workbench {
 public:
  /// `renderer` must outlive this object. `filter_files` are users' own. Throws Error as Catalogue and
  /// make_view_state() do.
  Workbench(measure::Renderer& renderer, ViewState state, std::vector<std::filesystem::path> filter_files);

  const ViewState& state() const { return state_; }
  Stage& stage() { return stage_; }
  measure::Renderer& renderer() { return renderer_; }
  const filters::Catalogue& catalogue() const { return catalogue_; }

  /// A filter with its default values.
  filters::FilterRequest request(const std::string& id) const { return catalogue_.parse_requests(id).front(); }

  /// Changes settings; drawn with the next draw(). What a run would refuse is not taken over, and what cannot be drawn
  /// is taken back there, with a message.
  void change(const Changes& what, const std::function<void(ViewSettings& settings)>& edit);

  /// Reads files that were saved, and takes over what was traced and measured meanwhile. To be called once a frame.
  void update(double now_s);

  /// Draws what has changed since the last time. Whether anything had.
  bool draw();

  /// What the window should say; empty: nothing.
  const std::string& message() const { return message_; }
  void say(std::string message) { message_ = std::move(message); }

  /// Whether work goes on beside the window, that would disturb times.
  bool is_busy() const { return truth_part_ < 1.0; }

  double truth_part() const { return truth_part_; }  ///< how much of the truth is traced, [0,1]
  const std::string& truth_absent() const { return truth_absent_; }
  const images::Image& truth_image() const { return truth_image_; }
  const images::Image& first_blockers() const { return first_blockers_; }  ///< metres; empty until the truth is whole
  const images::Image& texels_per_pixel() const { return texels_per_pixel_; }

  /// Counts what has been drawn anew, for those who keep what they made of it.
  std::uint64_t drawings() const { return drawings_; }

 private:
  measure::Renderer& renderer_;
  std::vector<std::filesystem::path> filter_files_;
  filters::Catalogue catalogue_;
  ViewState state_;
  ViewSettings drawn_;  ///< what was drawn last
  Stage stage_;
  FileWatch watch_;
  double next_look_s_ = 0.0;  ///< at the files
  Changes changes_ = Changes::all();
  std::string message_;
  double last_change_s_ = 0.0;
  bool truth_is_old_ = true;
  double truth_part_ = 0.0;
  std::string truth_absent_;
  images::Image truth_image_, first_blockers_, texels_per_pixel_;
  std::uint64_t drawings_ = 0;

  filters::Catalogue load_catalogue(const std::filesystem::path& folder) const;
  void watch_sides();
  void reload_filters();
};

}  // namespace shadowbench::view
