#pragma once

#include <array>
#include <glm/glm.hpp>

#include "harness/gl/fullscreen.h"
#include "harness/gl/objects.h"
#include "harness/render/image_target.h"
#include "harness/render/shader_library.h"
#include "report/images/color_values.h"

namespace shadowbench::render {

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

 private:
  gl::Texture grey_;
  gl::Texture diverging_;
  gl::Texture sequential_;
  gl::FullscreenTriangle triangle_;

  const gl::Texture& scale_of(Colors colors) const;
  void draw_side(ShaderLibrary& shaders, const DisplayedValues& shown, const DisplayPlace& place, int from, int to);
};

}  // namespace shadowbench::render
