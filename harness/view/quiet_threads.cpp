#include "harness/view/quiet_threads.h"

#include <pthread.h>
#include <sched.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <thread>
#include <vector>

namespace shadowbench::view {

void give_way_to_others() {
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
}

void run_on_quiet_threads(const std::function<void()>& work) {
  const int threads = tbb::info::default_concurrency();
  const auto helpers = static_cast<std::size_t>(threads - 1);
  // All places are reserved for threads that enter by themselves.
  tbb::task_arena arena(threads, static_cast<unsigned>(threads));
  // A helper waits for a group that nothing ends but the end of the work, and meanwhile takes part in the arena's
  // loops.
  std::vector<tbb::task_group> groups(helpers);
  std::vector<std::jthread> waiting;
  std::vector<tbb::task_handle> held;
  for (tbb::task_group& group : groups) {
    held.push_back(group.defer([] {}));
    waiting.emplace_back([&] { arena.execute([&] { group.wait(); }); });
  }
  arena.execute(work);
}

}  // namespace shadowbench::view
