// Ctrl-C and SIGTERM as a stop request.
#pragma once

#include <stop_token>
#include <thread>

namespace sterna::scripting {

/// While it lives, SIGINT and SIGTERM are taken by a thread of its own and become a stop request; the second one ends the program at once (status 130).
/// \pre constructed before any other thread is started, so that all of them inherit the blocked signals.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread waiter_;
};

}  // namespace sterna::scripting
