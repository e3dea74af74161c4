#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "filters/scalar.h"
#include "harness/gl/context/context.h"
#include "harness/gl/objects.h"
#include "harness/gl/program.h"

namespace shadowbench::gl {

/// Names a clock for GL work.
enum class TimerKind {
  kWallClock,  ///< the CPU's clock around the work, closed by glFinish
  kQuery,      ///< GL_TIME_ELAPSED
};

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

/// Finds out by experiment how exact this GL is: the weights of linear filtering, and exp() over [-80, 80]. Requires a
/// current context.
filters::GlAccuracy survey_gl();

/// After how many turns this GL ends a loop of a shader; 0: it let the longest one go on. Requires likewise. Cost: a
/// few milliseconds.
int measure_loop_turns();

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
