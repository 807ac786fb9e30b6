#include "geom/base/helper_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <optional>
#include <thread>

#include "geom/base/child_process.h"
#include "geom/base/schema.h"

namespace sterna {
namespace {

constexpr int k_poll_ms = 20;                ///< polling interval for a stop or the time limit
constexpr int k_late_poll_ms = 2;            ///< polling interval for late data
constexpr std::size_t k_output_kept = 4096;  ///< bytes of the helper's last output kept for the error message
constexpr int k_folders_up = 3;              ///< number of folders searched: the program's and two above it, because tests and fuzz targets lie below the build
                                             ///< folder

[[noreturn]] void throw_system_failure(const HelperTask& task, const std::string& what, int error) {
  throw Error({.code = task.failed, .attempted = task.attempted, .problem = what + ": " + std::strerror(error)});
}

/// Moves a descriptor out of the range of the helper's own descriptors.
int moved_up(int descriptor, const HelperTask& task) {
  const int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, k_first_free_descriptor);
  const int error = errno;
  close(descriptor);
  if (moved < 0) throw_system_failure(task, "fcntl(F_DUPFD_CLOEXEC)", error);
  return moved;
}

Pipe pipe_of(const HelperTask& task) { return Pipe(task.failed, task.attempted); }

/// Data sent to a helper after its start. The read end of the pipe stays open here: writing to it must not raise SIGPIPE if the helper has died.
class LateBlock {
 public:
  explicit LateBlock(const HelperTask& task) : task_(task), block_("sterna late", 0, task), ready_(pipe_of(task)) {}
  /// Returns false as long as there is no data.
  bool send(std::span<const std::byte> data) {
    if (is_sent_ || data.empty()) return is_sent_;
    block_.append(data);
    const std::uint64_t size = data.size();
    if (write(ready_.write_end.value, &size, sizeof size) != sizeof size) throw_system_failure(task_, "writing to a pipe", errno);
    return is_sent_ = true;
  }
  int descriptor() const { return block_.descriptor(); }
  int ready_descriptor() const { return ready_.read_end.value; }

 private:
  HelperTask task_;
  SharedBlock block_;
  Pipe ready_;
  bool is_sent_ = false;
};

ChildProcess start_child(const HelperStart& start, int request, int reply, int output, const LateBlock* late) {
  ChildStart child{.words = {start.path},
                   .descriptors = {{output, STDOUT_FILENO}, {output, STDERR_FILENO}, {request, k_helper_request_fd}, {reply, k_helper_reply_fd}},
                   .output = {},
                   .folder = {}};
  child.words.insert(child.words.end(), start.arguments.begin(), start.arguments.end());
  if (late) {
    child.descriptors.emplace_back(late->descriptor(), k_helper_late_fd);
    child.descriptors.emplace_back(late->ready_descriptor(), k_helper_late_ready_fd);
  }
  try {
    return ChildProcess(child);
  } catch (const Error& error) {
    throw Error({.code = start.task.missing,
                 .attempted = "starting " + start.task.helper,
                 .problem = "cannot start " + start.path + ": " + error.info().problem,
                 .hint = "build the target " + std::filesystem::path(start.path).filename().string() + start.task.else_try});
  }
}

/// Reads the available output and keeps the end of it. Returns false at the end of the stream.
bool read_output(int descriptor, std::string& output) {
  const bool is_open = read_some(descriptor, output);
  if (output.size() > 2 * k_output_kept) output.erase(0, output.size() - k_output_kept);
  return is_open;
}

}  // namespace

SharedBlock::SharedBlock(const char* name, std::size_t size, HelperTask task) : task_(std::move(task)) {
  const int descriptor = memfd_create(name, MFD_CLOEXEC);
  if (descriptor < 0) throw_system_failure(task_, "memfd_create", errno);
  descriptor_ = moved_up(descriptor, task_);
  if (ftruncate(descriptor_, static_cast<off_t>(size)) != 0) {
    const int error = errno;
    close(descriptor_);
    throw_system_failure(task_, "reserving " + std::to_string(size) + " bytes in memory", error);
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
  if (fstat(descriptor_, &state) != 0) throw_system_failure(task_, "fstat", errno);
  size_ = static_cast<std::size_t>(state.st_size);
  if (size_ == 0) return nullptr;
  void* block = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, descriptor_, 0);
  if (block == MAP_FAILED) throw_system_failure(task_, "mmap of " + std::to_string(size_) + " bytes", errno);
  data_ = static_cast<std::byte*>(block);
  return data_;
}

void SharedBlock::append(std::span<const std::byte> data) {
  while (!data.empty()) {
    const ssize_t n = write(descriptor_, data.data(), data.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw_system_failure(task_, "writing " + std::to_string(data.size()) + " bytes to memory", errno);
    data = data.subspan(static_cast<std::size_t>(n));
  }
}

int above_helper_descriptors(int descriptor, const HelperTask& task) { return moved_up(descriptor, task); }

HelperExit run_helper(const HelperStart& start, int request, int reply, const RunContext& context) {
  using Clock = std::chrono::steady_clock;
  Pipe words = pipe_of(start.task);
  std::optional<LateBlock> late_block;
  if (start.late) late_block.emplace(start.task);

  HelperExit result;
  const auto begin = Clock::now();
  ChildProcess child = start_child(start, request, reply, words.write_end.value, late_block ? &*late_block : nullptr);
  words.write_end.reset();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };

  // The helper usually ends when its output ends. If it has only closed its output, poll for its end in short intervals.
  std::optional<int> ended;
  for (bool is_open = true; is_open || !(ended = child.ended());) {
    const bool is_waiting = late_block && !late_block->send(start.late());
    if (is_open) {
      pollfd event{words.read_end.value, POLLIN, 0};
      if (poll(&event, 1, is_waiting ? k_late_poll_ms : k_poll_ms) > 0) is_open = read_output(words.read_end.value, result.output);
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    context.check_stop();
    if (!is_automatic(start.time_limit) && seconds() > start.time_limit) {
      result.is_time_over = true;
      ended = child.kill();
      break;
    }
  }
  result.wait_status = *ended;
  result.seconds = seconds();
  return result;
}

std::string find_helper(const std::string& name, const std::string& given_folder, const HelperTask& task) {
  namespace fs = std::filesystem;
  const auto is_executable = [](const fs::path& path) {
    std::error_code ignored;  // an inaccessible path is not an executable
    return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
  };
  std::vector<fs::path> candidates;
  if (given_folder.empty()) {
    fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
    for (int i = 0; i < k_folders_up; ++i, folder = folder.parent_path()) candidates.push_back(folder / name);
  } else {
    candidates = {fs::path(given_folder) / name};
  }
  std::string looked_at;
  for (const fs::path& candidate : candidates) {
    if (is_executable(candidate)) return candidate.string();
    looked_at += (looked_at.empty() ? "" : ", ") + candidate.string();
  }
  throw Error({.code = task.missing,
               .attempted = "looking for " + task.helper + " " + name,
               .problem = "the program was not built: no executable file at " + looked_at,
               .hint = "build the target " + name + " (its library must be installed)" + task.else_try});
}

std::string last_words(const HelperExit& exit) {
  std::string text = exit.output;
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  constexpr std::size_t k_quoted = 500;
  if (text.size() > k_quoted) text.erase(0, text.size() - k_quoted);
  return text.empty() ? "" : "; end of its output: \"" + text + "\"";
}

}  // namespace sterna
