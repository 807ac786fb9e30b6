// Private to geom/base: the state that all copies of a RunContext share.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>

#include "geom/base/run_context.h"

namespace sterna {

/// Creates the threads of a run; 0 = all hardware threads.
std::shared_ptr<ThreadPool> make_thread_pool(int threads);
/// Creates threads beside a run: those that the run itself does not use at the time.
std::shared_ptr<ThreadPool> make_side_pool(int threads);
int thread_count(const ThreadPool& pool);

struct RunContext::State {
  RunSettings settings;
  std::mutex mutex;  ///< guards log, progress and times
  std::vector<StageTime> times;
  std::chrono::steady_clock::time_point last_progress{};
  std::atomic<std::int64_t> silent_until_ns = 0;  ///< time before which no message about a long step is logged
};

}  // namespace sterna
