#include "io/output/atomic_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "geom/base/error.h"
#include "io/input/leftovers.h"

namespace sterna::io {
namespace {

constexpr int k_max_folder_names = 1000;    // the same number as in AtomicFile: leftovers of killed runs can occupy some names
constexpr mode_t k_new_folder_mode = 0777;  // reduced by the umask

void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // the files are synced already; not every file system can open folders
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

AtomicFolder::AtomicFolder(const std::filesystem::path& path, std::string_view proof) : path_(path), target_(path) {
  std::error_code failure;
  if (std::filesystem::is_symlink(path, failure)) {
    target_ = std::filesystem::weakly_canonical(path, failure);
    if (failure) fail(failure.value(), "following the link");
  }
  const std::filesystem::file_status status = std::filesystem::status(target_, failure);
  if (std::filesystem::exists(status)) {
    const bool is_ours =
        std::filesystem::is_directory(status) && (std::filesystem::exists(target_ / proof) || std::filesystem::exists(target_ / (std::string(proof) + ".gz")) ||
                                                  std::filesystem::is_empty(target_, failure));
    if (!is_ours)
      throw Error({.code = ErrorCode::write_failed,
                   .attempted = "writing " + path_.string(),
                   .problem = std::filesystem::is_directory(status)
                                  ? "the existing folder of that name has no file \"" + std::string(proof) + "\", so it holds something else"
                                  : "the existing item of that name is not a folder",
                   .hint = "choose another name, or remove the existing item"});
  }
  if (target_.has_parent_path()) {
    std::filesystem::create_directories(target_.parent_path(), failure);
    if (failure) fail(failure.value(), "creating the parent folder");
  }
  remove_leftovers(target_.parent_path());
  for (int i = 0;; ++i) {
    temporary_ = target_.parent_path() / (".sterna-" + std::to_string(::getpid()) + "-" + std::to_string(i) + ".part");
    if (::mkdir(temporary_.c_str(), k_new_folder_mode) == 0) break;
    const int error_number = errno;
    if (error_number == EEXIST && i < k_max_folder_names) continue;
    temporary_.clear();  // the folder was not created by this object
    fail(error_number, "creating a folder");
  }
  held_ = ::open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (held_ >= 0) hold(held_);
}

AtomicFolder::~AtomicFolder() { discard(); }

void AtomicFolder::commit() {
  sync_folder(temporary_);
  if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) {
    discard();  // removes the old folder, which has the temporary name after the exchange
  } else if (errno == ENOENT) {
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno, "renaming");
    temporary_.clear();
  } else {
    // The file system does not support exchanges. The old folder is renamed, and restored if the new folder cannot take its name.
    const std::filesystem::path aside = temporary_.string() + ".old";
    if (::rename(target_.c_str(), aside.c_str()) != 0) fail(errno, "renaming the old folder");
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
      const int error_number = errno;
      ::rename(aside.c_str(), target_.c_str());
      fail(error_number, "renaming");
    }
    temporary_ = aside;
    discard();
  }
  sync_folder(target_.has_parent_path() ? target_.parent_path() : ".");
}

void AtomicFolder::fail(int error_number, std::string_view doing) {
  discard();
  throw Error({.code = ErrorCode::write_failed,
               .attempted = "writing " + path_.string(),
               .problem = std::string(doing) + " failed: " + std::generic_category().message(error_number),
               .hint = "write to a folder for which you have write permission"});
}

void AtomicFolder::discard() noexcept {
  std::error_code ignored;  // a destructor cannot report errors; the name of the leftover identifies it
  if (!temporary_.empty()) std::filesystem::remove_all(temporary_, ignored);
  temporary_.clear();
  if (held_ >= 0) ::close(held_);
  held_ = -1;
}

}  // namespace sterna::io
