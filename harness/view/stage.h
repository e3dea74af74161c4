#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "harness/measure/scene_assets.h"
#include "harness/render/filter_passes.h"
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

  /// Draws again, into textures that nobody sees, for timing.
  void redraw_map(const ViewState& state);
  void look_up(std::size_t side);
  void look_up_nothing(std::size_t side);

  /// The distance in metres from each receiver towards the light to the surface that the map holds for it, rows top to
  /// bottom; 0 where there is none before it. Cost: a lookup.
  images::Image blocker_distance(const ViewState& state);

  /// Texels of the map under each pixel's footprint, rows top to bottom. Cost: see measure::measure_coverage().
  images::Image texels_per_pixel(const ViewState& state);

 private:
  struct SideDrawing {
    std::unique_ptr<render::FilterPasses> passes;
    measure::EmptyLookups empty;
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
  std::optional<render::ImageTarget> unseen_;             ///< what timed lookups draw into
  std::unique_ptr<render::FilterPasses> blocker_passes_;  ///< null where they must be compiled anew

  void draw_gbuffer(const ViewState& state);
  bool draw_map(const ViewState& state, bool map_changed);
  void draw_side(const ViewState& state, std::size_t side, bool compile, bool retune);
  void compile(const ViewState& state, std::size_t side);
  void retune(const ViewState& state, render::FilterPasses& passes, const filters::FilterRequest& request);
};

}  // namespace shadowbench::view
