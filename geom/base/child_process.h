// Starts other programs. Helpers (geom/base/helper_process.h), workers of a series and commands all use this mechanism.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/error.h"

namespace sterna {

/// Lowest descriptor that is free in the parent: above the fixed numbers under which a child inherits descriptors, so that none is overwritten in the child
/// before it is passed on.
inline constexpr int k_first_free_descriptor = 10;

/// Start parameters of a child process. Its stdin is empty and its signal handling is that of a process started by a shell. It runs in its own process group,
/// so that Ctrl-C reaches it only through this program.
struct ChildStart {
  std::vector<std::string> words;                ///< the program and its arguments; the program is searched for in PATH unless its name contains a slash
  std::vector<std::pair<int, int>> descriptors;  ///< {here, there}: `here` is inherited under the number `there`; \pre no `here` equals the `there` of an
                                                 ///< earlier pair
  std::string output;                            ///< file for stdout and stderr, emptied at the start; if empty, `descriptors` determines stdout and
                                                 ///< stderr
  std::string folder;                            ///< working directory; empty = that of this process
};

/// A started program, killed and reaped at the latest when the object is destroyed.
class ChildProcess {
 public:
  /// \throws Error(file_not_found) if the program does not exist, Error(internal) if it cannot be started
  explicit ChildProcess(const ChildStart& start);
  ~ChildProcess() { kill(); }
  ChildProcess(ChildProcess&& other) noexcept : pid_(std::exchange(other.pid_, -1)), status_(other.status_) {}
  ChildProcess& operator=(ChildProcess&& other) noexcept {
    if (this == &other) return *this;
    kill();
    pid_ = std::exchange(other.pid_, -1);
    status_ = other.status_;
    return *this;
  }

  /// Returns the wait status, as of waitpid(), once the program has ended.
  std::optional<int> ended() {
    if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
    return pid_ > 0 ? std::nullopt : std::optional<int>(status_);
  }
  /// Waits for the end of the program. Returns the wait status.
  int wait() {
    while (pid_ > 0 && waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return status_;
  }
  /// Sends SIGTERM to the program.
  void stop() const {
    if (pid_ > 0) ::kill(pid_, SIGTERM);
  }
  /// Kills the program and all processes of its group immediately. Returns the wait status.
  int kill() {
    if (pid_ > 0) ::kill(-pid_, SIGKILL);
    return wait();
  }

 private:
  pid_t pid_ = -1;
  int status_ = 0;
};

/// Closes a descriptor at the end of a scope.
struct Descriptor {
  Descriptor() = default;
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  void reset() {
    if (value >= 0) close(value);
    value = -1;
  }
  int value = -1;
};

/// A pipe whose ends can be inherited by a child.
struct Pipe {
  /// \throws Error(code) with `attempted` as given if the system refuses
  Pipe(ErrorCode code, const std::string& attempted) {
    const auto refuse = [&](const char* what) {
      throw Error({.code = code, .attempted = attempted, .problem = std::string(what) + ": " + std::strerror(errno)});
    };
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) refuse("pipe2");
    Descriptor low_read, low_write;
    low_read.value = ends[0];
    low_write.value = ends[1];
    read_end.value = fcntl(ends[0], F_DUPFD_CLOEXEC, k_first_free_descriptor);
    if (read_end.value >= 0) write_end.value = fcntl(ends[1], F_DUPFD_CLOEXEC, k_first_free_descriptor);
    if (read_end.value < 0 || write_end.value < 0) refuse("fcntl(F_DUPFD_CLOEXEC)");
  }
  Descriptor read_end, write_end;
};

/// Appends the available data to `text`. Returns false at the end of the stream.
inline bool read_some(int descriptor, std::string& text) {
  std::array<char, 4096> buffer{};
  const ssize_t n = read(descriptor, buffer.data(), buffer.size());
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  text.append(buffer.data(), static_cast<std::size_t>(n));
  return n > 0;
}

namespace detail {

/// File actions and attributes of posix_spawn, released with the object.
struct SpawnSetup {
  explicit SpawnSetup(const ChildStart& start) {
    constexpr mode_t k_new_file_mode = 0666;  // reduced by the umask
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
    if (!start.output.empty()) {
      posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, start.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, k_new_file_mode);
      posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    }
    for (const auto& [here, there] : start.descriptors) posix_spawn_file_actions_adddup2(&actions, here, there);
    if (!start.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, start.folder.c_str());
  }
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

}  // namespace detail

inline ChildProcess::ChildProcess(const ChildStart& start) {
  const detail::SpawnSetup setup(start);
  std::vector<std::string> words = start.words;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int error = posix_spawnp(&pid_, arguments.front(), &setup.actions, &setup.attributes, arguments.data(), environ);
  if (error == 0) return;
  pid_ = -1;
  throw Error({.code = error == ENOENT ? ErrorCode::file_not_found : ErrorCode::internal,
               .attempted = "starting " + start.words.front(),
               .problem = std::strerror(error)});
}

}  // namespace sterna
