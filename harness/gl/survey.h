#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "harness/gl/context/context.h"
#include "harness/gl/objects.h"
#include "harness/gl/program.h"

namespace shadowbench::gl {

/// Names a clock for GL work.
enum class TimerKind {
  kWallClock,  ///< the CPU's clock around the work, closed by glFinish
  kQuery,      ///< GL_TIME_ELAPSED
};

/// Returns "wall clock" or "query", as results record it.
const char* timer_name(TimerKind kind);

/// What timing the same work by both clocks showed.
struct TimerCheck {
  double wall_ms = 0.0;    ///< median for the longest work timed
  double query_ms = 0.0;   ///< likewise
  double agreement = 0.0;  ///< share of all runs in which the query lay within 0.5 to 1.05 of the wall clock, [0, 1]

  /// Returns the query where it agreed in 9 runs of 10, otherwise the wall clock. One run says little: llvmpipe's query
  /// times each thread's last tile, which is anything between nothing and, when threads must wait for a core, all.
  TimerKind choice() const;
};

/// Times drawing of 1 to 8 ms with both clocks at once.
/// Requires: `context` is current. Cost: about 0.2 s.
TimerCheck check_timer(Context& context);

/// Chooses the clock to trust on this GL: by `check_timer` on a GPU; the wall clock on a software rasteriser, which
/// works on the processor that the clock times, and whose query may agree by chance on a busy machine.
TimerKind choose_timer(Context& context);

/// Runs `work` and returns how long the GL took over it, in milliseconds. Waits for what was queued before, and for it.
double time_ms(TimerKind kind, const std::function<void()>& work);

/// How finely the GL interpolates between two texels.
struct WeightPrecision {
  /// As many bits as fp32 coordinates can tell apart; from 22 on weights count as exact.
  static constexpr int kMaxBits = 23;

  int bits = 0;            ///< fractional bits of the weight: 8 means steps of 1/256
  double max_error = 0.0;  ///< largest distance from the exact weight, over [0, 1]

  bool exact() const { return bits >= 22; }
};

/// What a GL really does, as found by experiment.
struct GlSurvey {
  WeightPrecision r32f;  ///< linear filtering of colour
  WeightPrecision rg32f;
  double exp_ulp = 0.0;  ///< worst relative error of exp() over [-80, 80], in units of 2^-24
};

/// Finds out what this GL does. Requires: `context` is current.
GlSurvey survey_gl(Context& context);

/// Measures the weights of hardware PCF on a map of GL_DEPTH_COMPONENT16, 24 or 32F.
WeightPrecision measure_pcf_weights(Context& context, GLenum depth_format);

/// After how many turns this GL ends a loop of a shader; 0: it let the longest one go on. Cost: a few milliseconds.
int measure_loop_turns(Context& context);

/// Runs one of this folder's own fragment shaders over a grid and hands back what it wrote.
class SurveyShader {
 public:
  /// Takes an embedded shader's name, the grid's size and the format to write, R32F or wider.
  SurveyShader(const std::string& fragment, glm::ivec2 size, GLenum format = GL_R32F);

  Program& program() { return program_; }

  /// Queues one draw over the grid.
  void draw();

  /// Draws and returns all channels of the format, rows bottom to top.
  std::vector<float> run();

 private:
  Program program_;
  FullscreenTriangle triangle_;
  Texture target_;
  Framebuffer framebuffer_;
};

}  // namespace shadowbench::gl
