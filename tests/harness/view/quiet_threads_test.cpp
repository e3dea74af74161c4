#include <gtest/gtest.h>
#include <sched.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "harness/view/background_truth.h"

namespace shadowbench::view {
namespace {

/// The threads that a parallel loop ran on, and their scheduling policies. A body lasts until every core has a thread
/// in the loop, or a few seconds.
struct Loop {
  std::set<std::thread::id> threads;
  std::set<int> policies;

  void run() {
    const auto cores = static_cast<std::size_t>(tbb::info::default_concurrency());
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    std::mutex mutex;
    const auto note = [&] {
      const std::scoped_lock lock(mutex);
      threads.insert(std::this_thread::get_id());
      policies.insert(sched_getscheduler(0));
      return threads.size();
    };
    tbb::parallel_for(0, 1000, [&](int) {
      while (note() < cores && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    });
  }
};

TEST(QuietThreads, LoopsRunOnEveryCore_OnThreadsThatGiveWay) {
  std::thread([] {
    give_way_to_others();
    for (int i = 0; i < 3; ++i) {
      Loop loop;
      run_on_quiet_threads([&] { loop.run(); });
      EXPECT_EQ(loop.threads.size(), static_cast<std::size_t>(tbb::info::default_concurrency()));
      EXPECT_EQ(loop.policies, std::set{SCHED_IDLE});
    }
  }).join();
}

TEST(QuietThreads, LoopsOfOthers_AreAsFastAsBefore) {
  std::thread([] {
    give_way_to_others();
    Loop quiet;
    run_on_quiet_threads([&] { quiet.run(); });
  }).join();
  Loop loop;
  loop.run();
  EXPECT_EQ(loop.policies, std::set{SCHED_OTHER});
}

TEST(QuietThreads, ExceptionsOfALoop_ReachTheCaller) {
  EXPECT_THROW(run_on_quiet_threads([] {
                 tbb::parallel_for(
                     0, 100,
                     [](int i) {
                       if (i == 57) throw std::out_of_range("57");
                     });
               }),
               std::out_of_range);
}

/// A loop is found by the helper whenever it starts, even after a long while in which there was none.
TEST(QuietThreads, HelpersWaitForALateLoop) {
  run_on_quiet_threads([] {
    for (int i = 0; i < 3; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      Loop loop;
      loop.run();
      EXPECT_EQ(loop.threads.size(), static_cast<std::size_t>(tbb::info::default_concurrency()));
    }
  });
}

}  // namespace
}  // namespace shadowbench::view
