// Two back ends of the same functions: oneTBB, and std::thread for the tsan preset (Debian's libtbb is not instrumented, and suppressing its reports would hide
// real races).
#include "geom/base/parallel.h"

#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

#include "geom/base/run_context_state.h"

#ifndef STERNA_STD_THREADS
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace sterna {
namespace {

/// Keeps the exception of the lowest chunk, so that the reported error does not depend on timing.
class FirstException {
 public:
  void capture(std::size_t chunk) {
    const std::scoped_lock lock(mutex_);
    if (chunk >= chunk_) return;
    chunk_ = chunk;
    exception_ = std::current_exception();
  }
  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  std::mutex mutex_;
  std::size_t chunk_ = std::numeric_limits<std::size_t>::max();
  std::exception_ptr exception_;
};

int resolve_threads(int threads) { return threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

}  // namespace

#ifndef STERNA_STD_THREADS

/// Limit of TBB's total number of threads if a pool requires more than the hardware has. TBB applies the smallest of all existing limits, so a pool must not
/// set its own count as a limit (a pool of 2 would restrict one of 7): its arena limits it instead. 256 is the number for which TBB itself reserves memory.
constexpr std::size_t k_allowed_threads = 256;

class ThreadPool {
 public:
  ThreadPool(int count, bool is_beside) : threads(count), arena(count, 1, is_beside ? tbb::task_arena::priority::low : tbb::task_arena::priority::normal) {
    if (count > tbb::info::default_concurrency())
      allowance.emplace(tbb::global_control::max_allowed_parallelism, std::max(static_cast<std::size_t>(count), k_allowed_threads));
  }
  int threads;
  std::optional<tbb::global_control> allowance;  ///< set only if more threads are requested than the hardware has, which is TBB's own limit; 7 threads must be
                                                 ///< possible on 2 cores
  tbb::task_arena arena;
};

static void run_chunks(ThreadPool& pool, std::size_t n_chunks, const std::function<void(std::size_t)>& body) {
  pool.arena.execute([&] { tbb::parallel_for(std::size_t{0}, n_chunks, [&](std::size_t i) { body(i); }); });
}

#else

class ThreadPool {
 public:
  ThreadPool(int count, bool) : threads(count) {}
  int threads;
};

static void run_chunks(ThreadPool& pool, std::size_t n_chunks, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next.fetch_add(1); i < n_chunks; i = next.fetch_add(1)) body(i);
  };
  std::vector<std::jthread> workers;
  for (int t = 1; t < pool.threads && static_cast<std::size_t>(t) < n_chunks; ++t) workers.emplace_back(work);
  work();
}

#endif

std::shared_ptr<ThreadPool> make_thread_pool(int threads) { return std::make_shared<ThreadPool>(resolve_threads(threads), false); }
std::shared_ptr<ThreadPool> make_side_pool(int threads) { return std::make_shared<ThreadPool>(threads, true); }
int thread_count(const ThreadPool& pool) { return pool.threads; }

void parallel_chunks(const RunContext& context, std::size_t n, std::size_t chunk, detail::RangeFunction f) {
  if (n == 0) return;
  context.check_stop();
  const std::size_t n_chunks = (n + chunk - 1) / chunk;
  if (n_chunks == 1) {
    f(0, n);
    return;
  }
  FirstException failure;
  run_chunks(pool_of(context), n_chunks, [&](std::size_t i) {
    try {
      context.check_stop();
      f(i * chunk, std::min(n, (i + 1) * chunk));
    } catch (...) {
      failure.capture(i);
    }
  });
  failure.rethrow();
}

void parallel_invoke(const RunContext& context, const std::function<void()>& f, const std::function<void()>& g) {
  parallel_chunks(context, 2, 1, [&](std::size_t begin, std::size_t) { begin == 0 ? f() : g(); });
}

}  // namespace sterna
