// Conversion of Ctrl-C and SIGTERM to a stop request.
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

namespace sterna::scripting {

/// During its lifetime, a separate thread converts SIGINT and SIGTERM to a stop request. The second signal ends the program at once (status 130). The program
/// also ends if the work does not stop in time (a library that does not check for stops, an endless Lua pattern). Helpers are then killed and temporary files
/// removed, so that no half-written files are left.
/// \pre constructed before any other thread is started, so that all of them inherit the blocked signals.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  std::stop_token token() const;
  /// Replaces a stopped token by a new one, for a prompt that continues.
  void renew();
  /// For a prompt: lets the program wait for work that does not stop. The prompt reports that it waits.
  void wait_for_late_work() { ends_late_work_ = false; }
  /// Marks work that ends by itself after an arbitrary time, such as a series that waits for its jobs to end. Then only a second Ctrl-C ends the program.
  void leave_to_work(bool is_left);

 private:
  void wait_for_signals(const std::stop_token& is_over);
  void take_signal();
  void look_at_late_work();

  mutable std::mutex mutex_;
  std::stop_source source_;
  std::optional<std::chrono::steady_clock::time_point> requested_;
  bool ends_late_work_ = true;  ///< set before any work can be late
  bool is_left_to_work_ = false;
  std::jthread waiter_;
};

}  // namespace sterna::scripting
