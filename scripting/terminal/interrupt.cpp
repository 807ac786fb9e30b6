#include "scripting/terminal/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "scripting/terminal/exit_status.h"

namespace sterna::scripting {
namespace {

constexpr long k_poll_ns = 50'000'000;  // interval of the waiting thread's checks for the end of the program and for late work
/// Time after which work is late: Ctrl-C must take effect within a second.
constexpr std::chrono::milliseconds k_late{750};

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

void say(std::string_view text) { static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size())); }  // a failure cannot be reported

/// Kills helper processes, which would otherwise continue without the program.
void kill_children() {
  std::error_code failure;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", failure)) {
    std::ifstream children(task.path() / "children");
    for (pid_t pid = 0; children >> pid;) ::kill(pid, SIGKILL);
  }
}

/// Removes open temporary files of AtomicFile and similar classes: ".sterna-<process>-<number>.part".
void remove_temporaries() {
  const std::string ours = ".sterna-" + std::to_string(::getpid()) + "-";
  std::error_code failure;
  for (const auto& descriptor : std::filesystem::directory_iterator("/proc/self/fd", failure)) {
    const std::filesystem::path file = std::filesystem::read_symlink(descriptor.path(), failure);
    const std::string name = file.filename().string();
    if (!failure && name.starts_with(ours) && name.ends_with(".part")) std::filesystem::remove_all(file, failure);
  }
}

}  // namespace

InterruptGuard::InterruptGuard() {
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  waiter_ = std::jthread([this](const std::stop_token& is_over) { wait_for_signals(is_over); });
}

InterruptGuard::~InterruptGuard() {
  waiter_.request_stop();
  waiter_.join();
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

std::stop_token InterruptGuard::token() const {
  const std::lock_guard lock(mutex_);
  return source_.get_token();
}

void InterruptGuard::renew() {
  const std::lock_guard lock(mutex_);
  if (source_.stop_requested()) source_ = std::stop_source();
  requested_.reset();
}

void InterruptGuard::leave_to_work(bool is_left) {
  const std::lock_guard lock(mutex_);
  is_left_to_work_ = is_left;
  if (requested_) requested_ = std::chrono::steady_clock::now();  // the work after this gets its own time limit
}

void InterruptGuard::wait_for_signals(const std::stop_token& is_over) {
  const sigset_t set = stop_signals();
  const timespec timeout{.tv_sec = 0, .tv_nsec = k_poll_ns};
  while (!is_over.stop_requested()) {
    if (sigtimedwait(&set, nullptr, &timeout) >= 0) take_signal();
    else if (!is_over.stop_requested()) look_at_late_work();
  }
}

void InterruptGuard::take_signal() {
  std::stop_source source;
  {
    const std::lock_guard lock(mutex_);
    if (source_.stop_requested()) _exit(k_exit_interrupted);
    requested_ = std::chrono::steady_clock::now();
    source = source_;
  }
  source.request_stop();  // runs callbacks, which may request a token
}

void InterruptGuard::look_at_late_work() {
  const std::lock_guard lock(mutex_);
  if (!requested_ || is_left_to_work_ || std::chrono::steady_clock::now() - *requested_ < k_late) return;
  requested_.reset();
  if (!ends_late_work_) {
    say("\nstopping; the current step cannot be interrupted. Press Ctrl-C again to end the program at once\n");
    return;
  }
  kill_children();
  remove_temporaries();
  say("\nerror: stopped on request, within a step that cannot be interrupted\n");
  _exit(k_exit_interrupted);
}

}  // namespace sterna::scripting
