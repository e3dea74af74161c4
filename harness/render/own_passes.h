#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/gl/fullscreen.h"
#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "harness/gl/texture.h"
#include "harness/render/light_setup.h"
#include "harness/render/prefilter.h"
#include "harness/render/shader_library.h"
#include "harness/render/shadow_map.h"

namespace shadowbench::render {

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
