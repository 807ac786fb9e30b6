// Runs work of this process on a second thread while the calling thread waits for something else.
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
/// Lowers the priority of the calling thread, so that the work which the caller waits for runs first.
void yield_to_others();
}  // namespace detail

/// Runs `work(context) -> T` beside the caller at low priority. With a single thread the work runs to its end before the caller continues. The result does not
/// depend on the number of threads, because no kernel's result does. The destructor stops the work.
template <class T>
class Alongside {
 public:
  /// Uses all threads of the context except one: for a caller that waits for another process, which itself needs one thread.
  template <class Work>
  Alongside(const RunContext& context, Work work) : Alongside(context, context.threads() - 1, std::move(work)) {}
  /// Runs the work on `n_threads` threads, as far as the caller's own parallel loops leave them idle. \pre n_threads > 0 if the context has more than one
  /// thread
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

  /// Returns true if take() would return without waiting.
  bool is_done() const { return ended_.try_wait(); }
  /// Waits for the end of the work; may be called from any thread.
  void wait() const { ended_.wait(); }
  /// Waits for the result and returns it. std::move(work).take() marks that the result can be taken only once. is_done() and wait() remain valid.
  /// \throws any exception thrown by the work
  T take() && {
    if (thread_.joinable()) thread_.join();
    if (exception_) std::rethrow_exception(exception_);
    return std::move(*result_);
  }

 private:
  std::optional<T> result_;
  std::exception_ptr exception_;
  std::latch ended_{1};
  std::jthread thread_;  ///< last member: the thread ends before the members that it writes to are destroyed
};

}  // namespace sterna
