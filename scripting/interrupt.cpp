#include "scripting/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include "scripting/exit_status.h"

namespace sterna::scripting {
namespace {

constexpr long k_poll_ns = 100'000'000;  // how often the waiter looks whether the program is over

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

void wait_for_signals(const std::stop_token& is_over, std::stop_source& source) {
  const sigset_t set = stop_signals();
  const timespec timeout{.tv_sec = 0, .tv_nsec = k_poll_ns};
  while (!is_over.stop_requested()) {
    if (sigtimedwait(&set, nullptr, &timeout) < 0) continue;  // nothing came
    if (source.stop_requested()) _exit(k_exit_interrupted);
    source.request_stop();
  }
}

}  // namespace

InterruptGuard::InterruptGuard() {
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  waiter_ = std::jthread([this](const std::stop_token& is_over) { wait_for_signals(is_over, source_); });
}

InterruptGuard::~InterruptGuard() {
  waiter_.request_stop();
  waiter_.join();
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace sterna::scripting
