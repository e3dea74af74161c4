#pragma once

#include <functional>

#include "harness/gl/context/context.h"

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

}  // namespace shadowbench::gl
