#include "io/input/leftovers.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>
#include <string>
#include <system_error>
#include <vector>

namespace sterna::io {
namespace {

/// Minimum age in seconds. A file is locked directly after its creation; the gap takes microseconds.
constexpr std::time_t k_least_age = 60;

bool is_temporary(const std::string& name) { return name.starts_with(".sterna-") && name.ends_with(".part"); }

/// Returns true if the name still refers to the opened file. Another process may have removed the file and created its own of that name meanwhile.
bool is_still_named(const std::filesystem::path& path, const struct stat& opened) {
  struct stat named {};
  return ::lstat(path.c_str(), &named) == 0 && named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

void remove_if_left(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  const bool is_old =
      ::fstat(descriptor, &status) == 0 && (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) && ::time(nullptr) - status.st_mtime > k_least_age;
  std::error_code ignored;  // a leftover does no harm
  if (is_old && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_still_named(path, status)) std::filesystem::remove_all(path, ignored);
  ::close(descriptor);
}

}  // namespace

void hold(int descriptor) noexcept { static_cast<void>(::flock(descriptor, LOCK_EX | LOCK_NB)); }

void remove_leftovers(const std::filesystem::path& folder) noexcept try {
  std::error_code failure;  // if the folder cannot be listed; writing into it reports the error
  std::vector<std::filesystem::path> found;
  for (std::filesystem::directory_iterator it(folder.empty() ? "." : folder, failure), end; !failure && it != end; it.increment(failure))
    if (is_temporary(it->path().filename().string())) found.push_back(it->path());
  for (const std::filesystem::path& path : found) remove_if_left(path);
} catch (const std::exception&) {
  // No memory for a list of names: the files are kept.
}

}  // namespace sterna::io
