#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/measure/scene_assets.h"
#include "harness/view/side_measurement.h"
#include "harness/view/stage.h"
#include "harness/view/view_state.h"

namespace shadowbench::view {

/// Sees when files are saved, by looking at them.
class FileWatch {
 public:
  /// Looks at these files from now on; those it looks at already go on to count from what they were.
  void watch(const std::vector<std::filesystem::path>& files);

  /// Whether any has changed since it was last asked: written, replaced, or come back after it was gone.
  bool has_changed();

 private:
  /// What tells a file's states apart, nothing of one that is not there; two saves within a clock's tick differ in size
  /// or in their inode, mostly.
  using Stamp = std::optional<std::pair<std::filesystem::file_time_type, std::uintmax_t>>;

  std::map<std::filesystem::path, Stamp> files_;

  static Stamp read_stamp(const std::filesystem::path& file);
};

/// How long a saved file may go unseen.
inline constexpr double kSecondsBetweenLooks = 0.1;

/// The truth waits for this long after the last change: a picture that moves would only throw it away.
inline constexpr double kSecondsBeforeTruth = 0.15;

/// What is measured of both sides takes seconds: it waits for longer.
inline constexpr double kSecondsBeforeMeasurement = 0.5;

/// The filters of a folder, and users' own. Throws Error as Catalogue does.
filters::Catalogue load_catalogue(const std::filesystem::path& folder,
                                  const std::vector<std::filesystem::path>& filter_files);

/// What the window works on: a state, its drawing, its truth and its measurement, kept in step. Nothing here knows of
/// widgets. Times are seconds of any clock that does not go back.
class Workbench {
 public:
  /// `renderer` must outlive this object. `catalogue` is what load_catalogue() gives for these users' files.
  Workbench(measure::Renderer& renderer, ViewState state, filters::Catalogue catalogue,
            std::vector<std::filesystem::path> filter_files);

  const ViewState& state() const { return state_; }
  Stage& stage() { return *stage_; }
  measure::Renderer& renderer() { return renderer_; }
  const filters::Catalogue& catalogue() const { return catalogue_; }

  /// A filter with its default values.
  filters::FilterRequest request(const std::string& id) const { return catalogue_.parse_requests(id).front(); }

  /// Changes settings; drawn with the next draw(). What a run would refuse is not taken over, and what cannot be drawn
  /// is taken back there, with a message.
  void change(const Changes& what, const std::function<void(ViewSettings& settings)>& edit);

  /// Shows another state, of any scene. Throws Error where it cannot be drawn, and goes on to show what it showed.
  void show(ViewState state);

  /// The state that was shown first, before anything was changed.
  const ViewSettings& first() const { return first_; }

  /// What the next draw() will draw anew.
  const Changes& changes() const { return changes_; }

  /// Reads files that were saved, and takes over what was traced and measured meanwhile. To be called once a frame.
  void update(double now_s);

  /// Draws what has changed since the last time. Whether anything had.
  bool draw();

  /// What the window should say; empty: nothing.
  const std::string& message() const { return message_; }
  void say(std::string message) { message_ = std::move(message); }

  /// Whether work goes on beside the window, which would disturb times.
  bool is_busy() const { return !is_traced() || measured_ == SideMeasurement::State::kRunning; }

  /// Whether the truth is there, or will not come; it is traced anew when camera or light change.
  bool is_traced() const {
    return traced_ == SideMeasurement::State::kFinished || traced_ == SideMeasurement::State::kFailed;
  }

  /// What a run has found of the truth as it is now; null until it has.
  const MeasuredSides* truth() const {
    return traced_ == SideMeasurement::State::kFinished ? &truth_.results() : nullptr;
  }

  /// Why there is no truth to be seen; empty where there is.
  std::string explain_no_truth() const;

  /// Asks, in a frame that shows what comes of it, for a run that measures both sides; it starts when nothing has
  /// changed for a while.
  void want_measurement() { wants_measurement_ = true; }

  /// What such a run has found of the sides as they are now; null where there is nothing, see explain_no_measurement().
  const MeasuredSides* measured() const {
    return measured_ == SideMeasurement::State::kFinished ? &measurement_.results() : nullptr;
  }
  const measure::MeasuredCell* find_measured(std::size_t side) const {
    return measured() ? measured()->find_side(side) : nullptr;
  }
  std::string explain_no_measurement() const;

  /// Counts what has been drawn anew, for those who keep what they made of it.
  std::uint64_t drawings() const { return drawings_; }

 private:
  measure::Renderer& renderer_;
  std::vector<std::filesystem::path> filter_files_;
  filters::Catalogue catalogue_;
  ViewState state_;
  ViewSettings first_;
  ViewSettings drawn_;  ///< what was drawn last
  std::unique_ptr<Stage> stage_;
  FileWatch watch_;
  double next_look_s_ = 0.0;  ///< at the files
  Changes changes_ = Changes::all();
  std::string message_;
  bool was_changed_ = true;
  double last_change_s_ = 0.0;
  SideMeasurement truth_, measurement_;  ///< one at a time
  SideMeasurement::State traced_ = SideMeasurement::State::kIdle, measured_ = SideMeasurement::State::kIdle;
  bool wants_measurement_ = false;
  std::uint64_t drawings_ = 0;

  void watch_sides();
  void reload_filters();
  void age_truth(const Changes& changes);
  void follow_truth(double now_s);
  void follow_measurement(double now_s);
  void start(SideMeasurement& measurement, SideMeasurement::State& state, Measurand measurand, double now_s);
};

}  // namespace shadowbench::view
