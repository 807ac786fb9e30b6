#include "scripting/series/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>

#include "geom/base/error.h"

namespace sterna::scripting {
namespace {

constexpr mode_t k_lock_file_mode = 0666;  ///< reduced by the umask
/// Longest wait for the workers of a killed run, which end within a second of their parent's death; pause between two attempts.
constexpr std::chrono::milliseconds k_patience{5000}, k_lock_pause{20};
constexpr int k_least_descriptor = 10;  ///< above the descriptors passed to a worker

std::string locking_host() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// The process that holds the lock, which may be dead by now.
struct Holder {
  long pid = 0;
  std::string host;
  bool is_dead() const { return host == locking_host() && pid > 0 && kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH; }
};

Holder holder_of(const std::filesystem::path& file) {
  Holder holder;
  std::ifstream(file) >> holder.pid >> holder.host;
  return holder;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, const RunContext& context) {
  const std::filesystem::path file = folder / ".lock";
  const auto fail = [&](std::string problem, std::string hint = {}) {
    if (descriptor_ >= 0) close(descriptor_);
    throw Error(
        {.code = ErrorCode::write_failed, .attempted = "working in the folder " + folder.string(), .problem = std::move(problem), .hint = std::move(hint)});
  };
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) fail(failure.message());
  const int opened = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, k_lock_file_mode);
  if (opened < 0) fail(std::strerror(errno));
  descriptor_ = fcntl(opened, F_DUPFD_CLOEXEC, k_least_descriptor);
  close(opened);
  if (descriptor_ < 0) fail(std::strerror(errno));
  const auto begin = std::chrono::steady_clock::now();
  while (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) fail(std::string("locking: ") + std::strerror(errno), "use a folder on a file system with locks");
    const Holder holder = holder_of(file);
    if (!holder.is_dead() || std::chrono::steady_clock::now() - begin > k_patience)
      fail("another run uses this folder: process " + std::to_string(holder.pid) + " on " + holder.host,
           "wait until that run ends, or give this series another name");
    std::this_thread::sleep_for(k_lock_pause);
    context.check_stop();
  }
  const std::string text = std::to_string(getpid()) + " " + locking_host() + "\n";
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) fail(std::strerror(errno));
}

FolderLock::~FolderLock() { close(descriptor_); }

}  // namespace sterna::scripting
