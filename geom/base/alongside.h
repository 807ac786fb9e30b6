// Work of our own on a second thread while the calling one waits for something else.
#pragma once

#include <exception>
#include <latch>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "geom/base/run_context.h"

namespace sterna {

namespace detail {
/// Lowers the priority of the calling thread, so that what the caller waits for comes first.
void yield_to_others();
}  // namespace detail

/// Runs `work(context) -> T` beside the caller, on all threads of the context but one, or on all; with a single thread it runs before the caller goes on. Its
/// priority is low. The result does not depend on that, because no kernel's does. The destructor stops the work.
template <class T>
class Alongside {
 public:
  /// For a caller that waits for another process, which needs a thread.
  template <class Work>
  Alongside(const RunContext& context, Work work) : Alongside(context, context.threads() - 1, std::move(work)) {}
  /// On so many threads, as far as the caller's own parallel loops leave them idle. \pre n_threads > 0 where the context has more than one
  template <class Work>
  Alongside(const RunContext& context, int n_threads, Work work) {
    if (context.threads() == 1) {
      result_.emplace(work(context));
      ended_.count_down();
      return;
    }
    thread_ = std::jthread([this, context, n_threads, work = std::move(work)](std::stop_token stop) {
      detail::yield_to_others();
      try {
        result_.emplace(work(context.beside(n_threads, std::move(stop))));
      } catch (...) {
        exception_ = std::current_exception();
      }
      ended_.count_down();
    });
  }
  Alongside(const Alongside&) = delete;
  Alongside& operator=(const Alongside&) = delete;

  /// Whether take() would not wait.
  bool is_done() const { return ended_.try_wait(); }
  /// From any thread.
  void wait() const { ended_.wait(); }
  /// Waits for the result; call it once.
  /// \throws what the work has thrown.
  T take() {
    if (thread_.joinable()) thread_.join();
    if (exception_) std::rethrow_exception(exception_);
    return std::move(*result_);
  }

 private:
  std::optional<T> result_;
  std::exception_ptr exception_;
  std::latch ended_{1};
  std::jthread thread_;  ///< last: ends before what it writes to
};

}  // namespace sterna
