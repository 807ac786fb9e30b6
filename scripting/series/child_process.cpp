#include "scripting/series/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "geom/base/error.h"
#include "scripting/series/case_worker.h"

extern char** environ;

namespace sterna::scripting {
namespace {

constexpr int k_poll_ms = 20;             ///< how soon a stop is noticed
constexpr mode_t k_new_file_mode = 0666;  ///< the umask takes its part

/// File actions and attributes of posix_spawn, released with the object: signals as a shell would start it, a group of its own.
struct Setup {
  Setup() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  ~Setup() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  Setup(const Setup&) = delete;
  Setup& operator=(const Setup&) = delete;
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

pid_t spawn(const std::vector<std::string>& words, const Setup& setup) {
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, arguments.front(), &setup.actions, &setup.attributes, arguments.data(), environ);
  if (error == 0) return pid;
  throw Error(
      {.code = error == ENOENT ? ErrorCode::file_not_found : ErrorCode::internal, .attempted = "starting " + words.front(), .problem = std::strerror(error)});
}

struct Pipe {
  Pipe() {
    std::array<int, 2> pair{};
    if (pipe2(pair.data(), O_CLOEXEC) != 0)
      throw Error({.code = ErrorCode::internal, .attempted = "starting a command", .problem = std::string("pipe2: ") + std::strerror(errno)});
    read_end = pair[0];
    write_end = pair[1];
  }
  ~Pipe() {
    close(read_end);
    close_write_end();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_write_end() {
    if (write_end >= 0) close(write_end);
    write_end = -1;
  }
  int read_end = -1, write_end = -1;
};

/// Appends what is there; false at the end.
bool read_some(int descriptor, std::string& text) {
  std::array<char, 4096> buffer{};
  const ssize_t n = read(descriptor, buffer.data(), buffer.size());
  if (n < 0) return errno == EINTR;
  text.append(buffer.data(), static_cast<std::size_t>(n));
  return n > 0;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& words, const std::filesystem::path& output, int lock, const std::filesystem::path& folder) {
  Setup setup;
  posix_spawn_file_actions_addopen(&setup.actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, k_new_file_mode);
  posix_spawn_file_actions_adddup2(&setup.actions, STDOUT_FILENO, STDERR_FILENO);
  if (lock >= 0) posix_spawn_file_actions_adddup2(&setup.actions, lock, k_series_lock_descriptor);
  if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&setup.actions, folder.c_str());
  pid_ = spawn(words, setup);
}

ChildProcess::~ChildProcess() { kill(); }

ChildProcess::ChildProcess(ChildProcess&& other) noexcept : pid_(std::exchange(other.pid_, -1)), status_(other.status_) {}
ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this == &other) return *this;
  kill();
  pid_ = std::exchange(other.pid_, -1);
  status_ = other.status_;
  return *this;
}

std::optional<int> ChildProcess::ended() {
  if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
  return pid_ > 0 ? std::nullopt : std::optional<int>(status_);
}

void ChildProcess::stop() const {
  if (pid_ > 0) ::kill(pid_, SIGTERM);
}

void ChildProcess::kill() {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  reap();
}

void ChildProcess::reap() {
  while (waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

CommandResult run_command(const std::vector<std::string>& words, const RunContext& context) {
  Pipe output, errors;
  Setup setup;
  posix_spawn_file_actions_adddup2(&setup.actions, output.write_end, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&setup.actions, errors.write_end, STDERR_FILENO);
  const pid_t pid = spawn(words, setup);
  output.close_write_end();
  errors.close_write_end();
  CommandResult result;
  bool is_output_open = true, is_errors_open = true;
  while (is_output_open || is_errors_open) {
    std::array<pollfd, 2> events = {pollfd{is_output_open ? output.read_end : -1, POLLIN, 0}, pollfd{is_errors_open ? errors.read_end : -1, POLLIN, 0}};
    if (poll(events.data(), events.size(), k_poll_ms) > 0) {
      if (events[0].revents != 0) is_output_open = read_some(output.read_end, result.output);
      if (events[1].revents != 0) is_errors_open = read_some(errors.read_end, result.errors);
    }
    if (!context.stop_token().stop_requested()) continue;
    ::kill(-pid, SIGKILL);
    break;
  }
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  context.check_stop();
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace sterna::scripting
