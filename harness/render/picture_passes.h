#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <optional>

#include "filters/depth_map.h"
#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "harness/render/gbuffer.h"
#include "harness/render/geometry.h"
#include "harness/render/shader_library.h"
#include "report/images/color_values.h"
#include "report/images/image.h"

namespace shadowbench::render {

/// The share of the ambient light that an upright surface gets; one that faces up gets all.
inline constexpr float kAmbientAtSide = 0.75f;

/// What a camera sees, to be shaded.
struct ShadedView {
  const GBuffer& gbuffer;
  const gl::Texture& visibility;  ///< R32F, of the G-buffer's size
  const scene::Scene& scene;
  const scene::Camera& camera;
  filters::RangeRule range = {};  ///< without its behind test a lamp's cone is mirrored through it
};

/// Shades a view into `target` (RGBA32F, of its size): Blinn-Phong whose ambient part is never shadowed; linear RGB.
/// Only in `columns`, from the first up to the second.
void shade_into(ImageTarget& target, ShaderLibrary& shaders, const ShadedView& view, const glm::ivec2& columns);

/// The same, read back: rows top to bottom.
images::Image shade(ShaderLibrary& shaders, const GBuffer& gbuffer, const gl::Texture& visibility,
                    const scene::Scene& scene, const scene::Camera& camera, const filters::RangeRule& range = {});

/// How values are shown.
enum class Colors {
  kPicture,     ///< linear RGB, encoded as sRGB
  kGrey,        ///< dark to light, codes linear in the value
  kDiverging,   ///< as images::map_diverging()
  kSequential,  ///< viridis, which people who do not tell red from green can read
};

/// The colour of a place in [0,1] between the ends of a scale; not of a picture.
images::Colors color_function(Colors colors);

/// The values that are shown on one side of the divider; what is not a number is magenta.
struct DisplayedValues {
  const gl::Texture* values = nullptr;
  const gl::Texture* less = nullptr;  ///< taken away from the values; null: nothing
  int channel = 0;                    ///< of the values; not of a picture
  Colors colors = Colors::kPicture;
  float low = 0.0f;  ///< gets the first of the colours, and `high` the last; not of a picture
  float high = 1.0f;
  std::size_t infinite = 0;  ///< how many of the values are, as far as that was counted
};

/// Where pixels of the pictures are shown.
struct DisplayPlace {
  glm::ivec2 corner{0};         ///< lower left, in the target's pixels
  glm::ivec2 size{1};           ///< likewise
  glm::vec2 first_pixel{0.0f};  ///< of the pictures, shown at the corner; rows run bottom to top
  float magnified = 1.0f;       ///< the target's pixels for each of the pictures'
  float divider = 0.0f;         ///< the pictures' column from which on the right side is shown
};

/// Draws two sides of values, which have one size, into a window or a texture.
class DisplayPass {
 public:
  DisplayPass();

  /// Draws into a texture, or without one into the window of the context.
  void draw(ShaderLibrary& shaders, const std::array<DisplayedValues, 2>& sides, const DisplayPlace& place,
            ImageTarget* target = nullptr);

  /// Fills the window of the context with one colour.
  static void clear_window(const glm::ivec2& size, const glm::vec3& color);

  /// A part of that window, sRGB, rows top to bottom; `corner` is its lower left one.
  static images::Image read_window(const glm::ivec2& corner, const glm::ivec2& size);

 private:
  std::map<Colors, gl::Texture> scales_;
  gl::FullscreenTriangle triangle_;

  void draw_side(ShaderLibrary& shaders, const DisplayedValues& shown, const DisplayPlace& place, int from, int to);
};

/// How frames are accumulated.
struct ResolveRule {
  float least_weight = 0.1f;  ///< of the newest frame; that of the n-th is 1/n at least: 0 is the plain mean, 1 no mean
  bool clamps = true;         ///< what was resolved before stays within this frame's 3x3 pixels around
};

/// A picture whose visibility is added.
struct ResolvedFrame {
  const GBuffer& gbuffer;
  const gl::Texture& visibility;  ///< R32F, of the G-buffer's size
  const scene::Camera& camera;    ///< without jitter
};

/// Accumulates visibility over frames, as temporal antialiasing does with colours: an exponential mean of what was
/// resolved at the same point of a surface, which the G-buffer's positions find again. A point starts anew that lay
/// outside the picture or was hidden: no 3x3 pixels there showed depths around its own.
/// Source: Karis 2014, High-Quality Temporal Supersampling, SIGGRAPH; weights of 1/n at first: Schied et al. 2017,
/// Spatiotemporal Variance-Guided Filtering, HPG. Surfaces that move are found where they were not: we move none.
class ResolvePass {
 public:
  ResolvePass(ResolveRule rule, int width, int height);

  /// Adds a frame. Cost: one pass over the picture.
  void add(ShaderLibrary& shaders, const scene::Scene& scene, const ResolvedFrame& frame);

  /// The resolved visibility, its first channel; of the others none is for reading.
  const gl::Texture& texture() const { return targets_[newest_].texture(); }

 private:
  ResolveRule rule_;
  std::array<ImageTarget, 2> targets_;
  std::size_t newest_ = 0;
  std::optional<scene::Camera> before_;
};

}  // namespace shadowbench::render
