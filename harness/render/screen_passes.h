#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/render/gbuffer.h"
#include "harness/render/prefilter.h"

namespace shadowbench::render {

/// What makes of a filter's GLSL what counts its reads and the turns of its loops.
struct CountingSource {
  Defines defines;
  std::string body;
};

/// What a filter's screen passes read, on any machine.
struct ScreenReads {
  double per_receiver = 0.0;          ///< pixels read for each receiver, by all steps, mean
  int most_turns = 0;                 ///< of one of their loops, for any receiver
  std::vector<std::string> exceeded;  ///< "NAME reads 3 pixels away, and declares 2"
};

/// The passes over its own picture that a filter declares as `[screen.NAME]`: they come after the lookup.
class ScreenPasses {
 public:
  /// Requires that these values ask for a screen pass. Throws Error(kFilter) with the line of the filter's file: GLSL
  /// that does not compile, a pass that reads the map.
  ScreenPasses(ShaderLibrary& shaders, const filters::FilterRequest& request, const LightSetup& light,
               const Defines& map_defines);

  /// Changes the light, and parameters that are neither `const` nor texts.
  void retune(const filters::FilterRequest& request, const LightSetup& light);

  /// Where the lookup is to draw what the first step reads, RG32F: visibility and `screen_value`.
  ImageTarget& input(const GBuffer& gbuffer);

  /// Runs all steps; the last one draws visibility into `target`, in `columns`, where they are given.
  void run(const GBuffer& gbuffer, ImageTarget& target, const std::optional<glm::ivec2>& columns = std::nullopt);

  /// Requires that the lookup has drawn input(). Cost: compiles the passes once more.
  ScreenReads count_reads(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light,
                          const CountingSource& counting);

  int passes() const;                          ///< of all steps
  std::vector<DrawnPass> list_passes() const;  ///< in their order

 private:
  struct Pass {
    filters::ScreenSpec spec;
    gl::Program program;
  };

  filters::FilterRequest request_;
  Defines map_defines_;
  std::vector<Pass> passes_;
  std::vector<ImageTarget> images_;  ///< steps take turns between two, of the G-buffer's size
  gl::FullscreenTriangle triangle_;

  std::vector<Pass> compile(ShaderLibrary& shaders, const LightSetup& light, const CountingSource* counting) const;
  void draw(Pass& pass, int step, const gl::Texture& from);
};

}  // namespace shadowbench::render
