#pragma once

#include <functional>

namespace shadowbench::view {

/// Makes the calling thread, and those that it starts from now on, compute only where no other thread wants the
/// processor. Without effect where the system refuses.
void give_way_to_others();

/// Runs `work` with its parallel loops on this thread and on new ones of the same priority, one for each further core.
/// TBB's own threads take no part: others wait for them, and a loop that waits for a quiet thread waits long.
/// Throws what `work` throws, and std::system_error where no thread can be started.
void run_on_quiet_threads(const std::function<void()>& work);

}  // namespace shadowbench::view
