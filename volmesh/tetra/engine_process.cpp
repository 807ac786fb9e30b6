#include "volmesh/tetra/engine_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <thread>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "volmesh/tetra/wire.h"

extern char** environ;

namespace sterna::volmesh {
namespace {

constexpr int k_poll_ms = 20;                   ///< how soon a stop or the time limit is noticed
constexpr int k_late_poll_ms = 2;                ///< how soon data that comes late is handed on
constexpr std::size_t k_output_kept = 4096;     ///< bytes of the helper's last words kept for the error text
constexpr int k_first_free_descriptor = 10;     ///< above the descriptors that the helper inherits, so that dup2 in the child never clobbers a source

[[noreturn]] void throw_system_failure(const std::string& what, int error) {
  throw Error({.code = ErrorCode::tetra_engine_failed,
               .attempted = "handing the boundary to the tetrahedra engine",
               .problem = what + ": " + std::strerror(error)});
}

/// Closes a descriptor at the end of a scope.
struct Descriptor {
  int value = -1;
  ~Descriptor() { reset(); }
  void reset() {
    if (value >= 0) close(value);
    value = -1;
  }
};

/// Moves a descriptor out of the range that the helper's own descriptors will have.
int moved_up(int descriptor) {
  const int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, k_first_free_descriptor);
  const int error = errno;
  close(descriptor);
  if (moved < 0) throw_system_failure("fcntl(F_DUPFD_CLOEXEC)", error);
  return moved;
}

/// A started process; killed and reaped at the latest when the object goes.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() { kill_and_reap(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// True once it has ended (and is reaped).
  bool has_ended() {
    if (pid_ > 0 && waitpid(pid_, &wait_status_, WNOHANG) == pid_) pid_ = -1;
    return pid_ <= 0;
  }
  void kill_and_reap() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    while (waitpid(pid_, &wait_status_, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
  }
  int wait_status() const { return wait_status_; }

 private:
  pid_t pid_;
  int wait_status_ = 0;
};

/// File actions and attributes of posix_spawn, released with the object.
struct SpawnSetup {
  SpawnSetup() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
  }
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw_system_failure("pipe2", errno);
    read_end.value = moved_up(ends[0]);
    write_end.value = moved_up(ends[1]);
  }
  Descriptor read_end, write_end;
};

/// What a helper gets later than its start. The read end of the pipe stays open here: writing to it must not raise SIGPIPE when the helper has died.
class LateBlock {
 public:
  /// False as long as there is no data.
  bool send(std::span<const std::byte> data) {
    if (is_sent_ || data.empty()) return is_sent_;
    block_.append(data);
    const std::uint64_t size = data.size();
    if (write(ready_.write_end.value, &size, sizeof size) != sizeof size) throw_system_failure("writing to a pipe", errno);
    return is_sent_ = true;
  }
  int descriptor() const { return block_.descriptor(); }
  int ready_descriptor() const { return ready_.read_end.value; }

 private:
  SharedBlock block_{"sterna late", 0};
  Pipe ready_;
  bool is_sent_ = false;
};

pid_t spawn(const std::string& path, int request, int reply, int output, const LateBlock* late) {
  SpawnSetup setup;
  posix_spawn_file_actions_addopen(&setup.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&setup.actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&setup.actions, output, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&setup.actions, request, wire::k_request_fd);
  posix_spawn_file_actions_adddup2(&setup.actions, reply, wire::k_reply_fd);
  if (late) {
    posix_spawn_file_actions_adddup2(&setup.actions, late->descriptor(), wire::k_size_fd);
    posix_spawn_file_actions_adddup2(&setup.actions, late->ready_descriptor(), wire::k_size_ready_fd);
  }
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&setup.attributes, &none);
  posix_spawnattr_setsigdefault(&setup.attributes, &all);
  posix_spawnattr_setpgroup(&setup.attributes, 0);
  posix_spawnattr_setflags(&setup.attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::string name = path;
  std::array<char*, 2> arguments = {name.data(), nullptr};
  pid_t pid = -1;
  const int error = posix_spawn(&pid, path.c_str(), &setup.actions, &setup.attributes, arguments.data(), environ);
  if (error != 0) {
    throw Error({.code = ErrorCode::tetra_engine_missing,
                 .attempted = "starting the tetrahedra engine",
                 .problem = "cannot start " + path + ": " + std::strerror(error),
                 .hint = "build the target " + std::filesystem::path(path).filename().string() + ", or set tetrahedra.helper_folder to where it is"});
  }
  return pid;
}

/// Reads what is there. False at the end of the stream.
bool read_output(int descriptor, std::string& output) {
  std::array<char, 4096> buffer;
  const ssize_t n = read(descriptor, buffer.data(), buffer.size());
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  output.append(buffer.data(), static_cast<std::size_t>(n));
  if (output.size() > 2 * k_output_kept) output.erase(0, output.size() - k_output_kept);
  return n > 0;
}

}  // namespace

SharedBlock::SharedBlock(const char* name, std::size_t size) {
  const int descriptor = memfd_create(name, MFD_CLOEXEC);
  if (descriptor < 0) throw_system_failure("memfd_create", errno);
  descriptor_ = moved_up(descriptor);
  if (ftruncate(descriptor_, static_cast<off_t>(size)) != 0) {
    const int error = errno;
    close(descriptor_);
    throw_system_failure("reserving " + std::to_string(size) + " bytes in memory", error);
  }
}

SharedBlock::~SharedBlock() {
  if (data_) munmap(data_, size_);
  close(descriptor_);
}

std::byte* SharedBlock::map() {
  if (data_) munmap(data_, size_);
  data_ = nullptr;
  struct stat state {};
  if (fstat(descriptor_, &state) != 0) throw_system_failure("fstat", errno);
  size_ = static_cast<std::size_t>(state.st_size);
  if (size_ == 0) return nullptr;
  void* block = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, descriptor_, 0);
  if (block == MAP_FAILED) throw_system_failure("mmap of " + std::to_string(size_) + " bytes", errno);
  data_ = static_cast<std::byte*>(block);
  return data_;
}

void SharedBlock::append(std::span<const std::byte> data) {
  while (!data.empty()) {
    const ssize_t n = write(descriptor_, data.data(), data.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw_system_failure("writing " + std::to_string(data.size()) + " bytes to memory", errno);
    data = data.subspan(static_cast<std::size_t>(n));
  }
}

HelperExit run_helper(const std::string& path, const SharedBlock& request, const SharedBlock& reply, const LateData& late, double time_limit, const RunContext& context) {
  using Clock = std::chrono::steady_clock;
  Pipe words;
  std::optional<LateBlock> late_block;
  if (late) late_block.emplace();

  HelperExit result;
  const auto start = Clock::now();
  Child child(spawn(path, request.descriptor(), reply.descriptor(), words.write_end.value, late_block ? &*late_block : nullptr));
  words.write_end.reset();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };

  // The end of the output is the end of the helper, unless it has closed its output; then it is waited for in small sleeps.
  for (bool is_open = true; is_open || !child.has_ended();) {
    const bool is_waiting = late_block && !late_block->send(late());
    if (is_open) {
      pollfd event{words.read_end.value, POLLIN, 0};
      if (poll(&event, 1, is_waiting ? k_late_poll_ms : k_poll_ms) > 0) is_open = read_output(words.read_end.value, result.output);
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    context.check_stop();
    if (!is_automatic(time_limit) && seconds() > time_limit) {
      result.is_time_over = true;
      child.kill_and_reap();
      break;
    }
  }
  result.wait_status = child.wait_status();
  result.seconds = seconds();
  return result;
}

std::string find_helper(const std::string& name, const std::string& given_folder) {
  namespace fs = std::filesystem;
  const auto is_executable = [](const fs::path& path) {
    std::error_code ignored;  // a path that cannot be looked at is no executable
    return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
  };
  std::vector<fs::path> candidates;
  if (given_folder.empty()) {
    const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
    candidates = {folder / name, folder.parent_path() / name};
  } else {
    candidates = {fs::path(given_folder) / name};
  }
  std::string looked_at;
  for (const fs::path& candidate : candidates) {
    if (is_executable(candidate)) return candidate.string();
    looked_at += (looked_at.empty() ? "" : ", ") + candidate.string();
  }
  throw Error({.code = ErrorCode::tetra_engine_missing,
               .attempted = "looking for the tetrahedra engine " + name,
               .problem = "this engine is not built in: no executable file at " + looked_at,
               .hint = "build the target " + name + " (its library must be installed), choose another tetrahedra.engine, or set tetrahedra.helper_folder to where it is"});
}

}  // namespace sterna::volmesh
