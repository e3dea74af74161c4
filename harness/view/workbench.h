#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/measure/scene_assets.h"
#include "harness/render/filter_passes.h"
#include "harness/view/side_measurement.h"
#include "harness/view/view_state.h"
#include "report/images/image.h"

namespace shadowbench::view {

/// What is different from what was drawn last.
struct Changes {
  bool camera = false;                ///< or the picture's size
  bool light = false;                 ///< or what decides how its map is fitted
  bool map = false;                   ///< the map's size, format or bias: filters are compiled for it
  std::array<bool, kSides> filter{};  ///< another filter, or its code
  std::array<bool, kSides> values{};  ///< its parameters

  Changes& operator|=(const Changes& other);
  static Changes all() {
    return {.camera = true, .light = true, .map = true, .filter = {true, true}, .values = {true, true}};
  }
  bool any() const { return camera || light || map || filter[0] || filter[1] || values[0] || values[1]; }
};

/// Draws what a state says, with the passes that a run draws with: the G-buffer, the light's map, and for each side
/// its visibility and the picture that it makes. What has not changed is not drawn again.
class Stage {
 public:
  /// `renderer` must outlive this object. Puts the scene's geometry into GL memory.
  Stage(measure::Renderer& renderer, const scene::Scene& scene);

  /// Draws what has changed. A filter that does not compile leaves its side as it was; see fault().
  /// Throws Error(kUsage) for a map that the GL cannot give, or that does not fit the scene.
  void draw(const ViewState& state, const Changes& changes);

  /// Shows this image on sides of the truth from the next draw() on; of the G-buffer's size, rows top to bottom. Empty:
  /// there is none yet, and such sides are lit everywhere.
  void set_truth(const images::Image& visibility);

  /// Why a side shows an older filter than it should: file, line and message; empty where it does not.
  const std::string& fault(std::size_t side) const { return sides_[side].fault; }

  const render::GBuffer& gbuffer() const { return *gbuffer_; }

  /// World position and view depth of what a pixel shows, row 0 on top; nothing on the background.
  std::optional<glm::vec4> find_surface(const glm::ivec2& pixel) const;
  measure::LightMap& light_map() { return *light_; }
  const gl::Texture* truth() const { return truth_ ? &*truth_ : nullptr; }  ///< R32F; null: none yet

  /// R32F; valid in these columns, from the first up to the second. Cost: their lookup, where they have not been asked
  /// for since the last draw().
  const gl::Texture& visibility(std::size_t side, const glm::ivec2& columns);

  /// RGBA32F, linear RGB; as above, with their shading.
  const gl::Texture& picture(const ViewState& state, std::size_t side, const glm::ivec2& columns);

  /// A side's passes; null where it shows the truth, or where its filter has never compiled.
  render::FilterPasses* passes(std::size_t side) { return sides_[side].passes.get(); }

  /// Draw again, into textures that nobody sees, for timing.
  void redraw_map(const ViewState& state);
  void look_up(std::size_t side);

  /// Texels of the map under each pixel's footprint, rows top to bottom. Cost: see measure::measure_coverage().
  images::Image texels_per_pixel(const ViewState& state);

 private:
  struct SideDrawing {
    std::unique_ptr<render::FilterPasses> passes;
    std::optional<render::ImageTarget> visibility;
    std::optional<render::ImageTarget> picture;
    glm::ivec2 looked_up{0};  ///< columns of the visibility that are valid
    glm::ivec2 shaded{0};     ///< likewise of the picture
    std::string fault;
  };

  measure::Renderer& renderer_;
  render::Geometry geometry_;
  std::unique_ptr<render::GBuffer> gbuffer_;
  std::unique_ptr<measure::LightMap> light_;
  double pad_texels_ = -1.0;
  std::array<SideDrawing, kSides> sides_;
  std::optional<gl::Texture> truth_;
  std::optional<render::ImageTarget> unseen_;  ///< what timed lookups draw into

  void draw_gbuffer(const ViewState& state);
  bool draw_map(const ViewState& state, bool map_changed);
  void draw_side(const ViewState& state, std::size_t side, bool compile, bool retune);
  void compile(const ViewState& state, std::size_t side);
};

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

/// Errors of what is drawn wait for less: their cost is the lookup of all columns.
inline constexpr double kSecondsBeforeError = 0.1;

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

  /// Root mean square error of a side's image to the truth; nothing for the truth, and until nothing has changed for a
  /// moment.
  std::optional<double> rmse(std::size_t side) const { return rmse_[side]; }

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
  bool is_compared_ = false;  ///< with the truth
  std::array<std::optional<double>, kSides> rmse_;

  void watch_sides();
  void reload_filters();
  void age_truth(const Changes& changes);
  void follow_truth(double now_s);
  void follow_measurement(double now_s);
  void compare(double now_s);
  void start(SideMeasurement& measurement, SideMeasurement::State& state, Measurand measurand, double now_s);
};

}  // namespace shadowbench::view
