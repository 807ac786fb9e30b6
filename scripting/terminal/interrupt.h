// Ctrl-C and SIGTERM as a stop request.
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

namespace sterna::scripting {

/// While it lives, SIGINT and SIGTERM are taken by a thread of its own and become a stop request; the second one ends the program at once (status 130). Where
/// work does not take the request in time (a library that does not ask, a Lua pattern without end), the program ends, too: helpers are killed and temporary
/// files removed, so that nothing is left half-written.
/// \pre constructed before any other thread is started, so that all of them inherit the blocked signals.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  std::stop_token token() const;
  /// For a prompt, which goes on: a new token where the old one was stopped.
  void renew();
  /// A prompt waits for work that does not stop, and says so.
  void wait_for_late_work() { ends_late_work_ = false; }
  /// Work that ends by itself however long that takes (a series waits for its jobs to be gone): only a second Ctrl-C ends the program then.
  void leave_to_work(bool is_left);

 private:
  void wait_for_signals(const std::stop_token& is_over);
  void take_signal();
  void look_at_late_work();

  mutable std::mutex mutex_;
  std::stop_source source_;
  std::optional<std::chrono::steady_clock::time_point> requested_;
  bool ends_late_work_ = true;  ///< set before anything can be late
  bool is_left_to_work_ = false;
  std::jthread waiter_;
};

}  // namespace sterna::scripting
