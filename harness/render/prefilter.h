#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "harness/render/gbuffer.h"
#include "harness/render/geometry.h"
#include "harness/render/shader_library.h"
#include "harness/render/shadow_map.h"

namespace shadowbench::render {

/// The first texture unit of the maps of passes; shaders/lib has the units below.
inline constexpr GLuint kFirstPassUnit = 10;

/// The pieces "filter_parameters" and "filter" that lookup.frag and encode.frag include: constants for `const`
/// parameters (a choice becomes its index, with one name per choice, ROTATION_PER_PIXEL), uniforms for the others,
/// tables of points, and the filter's own GLSL with the line numbers of its file.
std::vector<gl::Piece> filter_pieces(const filters::FilterRequest& request);

/// Sets what every program that holds a filter's GLSL is told: the light, the seed, and the parameters that are not
/// `const`.
void set_uniforms(gl::Program& program, const filters::FilterRequest& request, const LightSetup& light);

/// A full-screen pass of a filter, as it is drawn for one map.
struct DrawnPass {
  std::string name;  ///< "lookup", "encode", "blur", or that of a pass of the filter's own
  gl::ShaderSource fragment;
  gl::PixelFormat target;  ///< what it draws into
  int draws = 1;
  std::int64_t texels = 0;  ///< that it writes, all draws together
  int read_bytes = 0;       ///< of a texel of what it reads
  bool is_screen = false;   ///< writes every pixel of the picture, and `texels` says nothing
};

/// The passes of a filter that stores something else than depth: `encode`, then `blur` twice where it asks for that.
class Prefilter {
 public:
  /// Throws Error(kFilter) with the line of the filter's file, Error(kUsage) when the GL cannot give the map's size.
  Prefilter(ShaderLibrary& shaders, const filters::FilterRequest& request, const ShadowMap& map,
            const LightSetup& light, Defines map_defines = {});

  /// Changes the light, and parameters that are neither `const` nor texts. The light must have the same range rule.
  void retune(const filters::FilterRequest& request, const LightSetup& light);

  /// Changes to another light with the same range rule. From now on run() writes to `stored` and bind() binds it; it
  /// has format() and the map's size.
  void turn_to(const LightSetup& light, std::shared_ptr<ImageTarget> stored);

  /// Encodes and blurs a layer of the depth map.
  void run(const ShadowMap& map, int layer = 0);

  /// Binds the result to the unit of lib/map_access.glsl that fetch_map reads.
  void bind() const;

  /// Reads the result back: channels() for each texel, row 0 is v = 0.
  std::vector<float> read() const { return read(*stored_); }

  /// Encodes a map again and reads it back before any blur; the result stays as it is.
  std::vector<float> read_before_blur(const ShadowMap& map, int layer = 0);

  const gl::Program& encode_program() const { return encode_; }

  int blur_radius_texels() const { return radius_; }

  /// What the blur reads outside the map, where that is not the map itself.
  std::optional<glm::vec4> blurred_border() const {
    return reads_border_ && radius_ > 0 ? std::optional(border_) : std::nullopt;
  }

  int passes() const { return (radius_ > 0 ? 3 : 1) + (samples_ ? 1 : 0); }
  std::int64_t bytes() const { return static_cast<std::int64_t>(stored_->texture().bytes()); }
  GLenum format() const { return stored_->texture().format().internal_format; }
  int channels() const { return stored_->texture().format().channels; }
  std::int64_t texels_written() const;

  /// Encode, and blur where there is one; `depth_bytes` are those of a texel of the depth map.
  std::vector<DrawnPass> list_passes(int depth_bytes) const;

 private:
  int radius_ = 0;
  ShaderLibrary* shaders_;
  std::optional<ImageTarget> samples_;  ///< the depth map once more, for filters that ask for several samples a texel
  std::shared_ptr<ImageTarget> stored_;
  std::optional<ImageTarget> scratch_;  ///< only with a blur
  gl::Program encode_;
  gl::Program* blur_ = nullptr;  ///< likewise
  glm::vec4 border_{0.0f};
  bool reads_border_ = true;  ///< what lies outside the map is border_
  gl::FullscreenTriangle triangle_;
  gl::Sampler sampler_{"encoded map"};
  gl::Sampler blur_sampler_{"encoded map, to blur"};

  std::vector<float> read(const ImageTarget& target) const { return target.texture().read_floats(channels()); }
  void encode(const ShadowMap& map, int layer, ImageTarget& to);
  glm::vec4 encode_border();
  void blur(const gl::Texture& from, ImageTarget& to, glm::vec2 direction);
};

/// The map of one pass of a filter's own, with what draws into it.
struct PassMap {
  gl::Texture texture;
  std::vector<gl::Framebuffer> levels;
};

/// The maps of all passes of a filter.
using PassMaps = std::vector<PassMap>;

/// The passes that a filter declares itself, as `[pass.NAME]`: they come after encode and blur, and before the lookup.
class OwnPasses {
 public:
  /// Throws Error(kFilter) with the line of the filter's file: GLSL that does not compile, a pass that reads what is
  /// only written after it, a format that this GL does not draw into.
  OwnPasses(ShaderLibrary& shaders, const filters::FilterRequest& request, int map_size, const LightSetup& light,
            const Defines& map_defines);

  /// Refuses an encode(), compiled as `encode`, that reads the map of a pass.
  void check_encode(const gl::Program& encode) const;

  /// Changes the light, and parameters that are neither `const` nor texts.
  void retune(const filters::FilterRequest& request, const LightSetup& light);

  std::shared_ptr<PassMaps> make_maps() const;

  /// From now on run() writes to these maps, which make_maps() made, and bind() binds them.
  void turn_to(const LightSetup& light, std::shared_ptr<PassMaps> maps);

  /// Requires that the depth map and the encoded map are written; `encoded` is null where the filter has none.
  void run(const ShadowMap& map, int layer, const Prefilter* encoded);

  void bind() const;

  int passes() const;                                   ///< of all steps
  std::int64_t texels_written() const;                  ///< by all steps
  std::vector<DrawnPass> list_passes() const;           ///< in their order; each reads as many bytes as it writes
  std::int64_t bytes(const gl::Program& reader) const;  ///< of the maps that a program reads

 private:
  struct Pass {
    filters::PassSpec spec;
    gl::Program program;
    int steps;
  };

  std::string filter_;  ///< path of its file
  int map_size_;
  std::vector<Pass> passes_;
  std::shared_ptr<PassMaps> maps_;
  std::vector<std::unique_ptr<PassMap>> scratch_;  ///< steps take turns between two maps; null where there is one step
  gl::FullscreenTriangle triangle_;

  /// Levels halve: their side is the power of two that holds the map.
  int side(const filters::PassSpec& spec) const;
  int count_steps(const filters::PassSpec& spec) const;
  std::int64_t texels_written(const Pass& pass) const;
  void check_reads(std::size_t pass) const;
  PassMap make_map(const filters::PassSpec& spec) const;
  [[noreturn]] void fail(const filters::PassSpec& spec, const std::string& message) const;
  void draw(Pass& pass, gl::Framebuffer& target, int step);
  void run_steps(std::size_t pass);
  void run_levels(std::size_t pass);
};

}  // namespace shadowbench::render
