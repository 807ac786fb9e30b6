#include "io/output/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "geom/base/error.h"
#include "io/input/leftovers.h"

namespace sterna::io {
namespace {

/// Number of attempts to find a free temporary name; leftovers of killed runs with the same process number can occupy a few.
constexpr int k_max_names = 1000;
/// Once this many bytes are ready, writing to the disk begins while more are generated; otherwise the disk would be idle until fsync.
constexpr std::uint64_t k_send_bytes = 1u << 23;
constexpr mode_t k_new_file_mode = 0666;  // reduced by the umask
constexpr mode_t k_permission_bits = 07777;

std::string reason(int error_number) { return std::generic_category().message(error_number); }

std::string hint_for(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG: return "free disk space (or raise the limit), or write to another folder";
    case EACCES:
    case EPERM:
    case EROFS: return "write to a folder for which you have write permission";
    case ENOENT:
    case ENOTDIR: return "create the folder first";
    default: return {};
  }
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), target_(path) {
  std::error_code failure;
  if (std::filesystem::is_symlink(path, failure)) {
    target_ = std::filesystem::weakly_canonical(path, failure);
    if (failure) fail(failure.value(), "following the link");
  }
  struct stat old {};
  const bool exists = ::stat(target_.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode))
    throw Error({.code = ErrorCode::write_failed,
                 .attempted = "writing " + path_.string(),
                 .problem = "the existing item of that name is not a regular file",
                 .hint = "choose another name"});
  remove_leftovers(target_.parent_path());
  for (int i = 0; descriptor_ < 0; ++i) {
    temporary_ = target_.parent_path() / (".sterna-" + std::to_string(::getpid()) + "-" + std::to_string(i) + ".part");
    descriptor_ = ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, k_new_file_mode);
    if (descriptor_ >= 0) break;
    const int error_number = errno;
    if (error_number == EEXIST && i < k_max_names) continue;
    temporary_.clear();  // the file was not created by this object
    fail(error_number, "creating a file");
  }
  hold(descriptor_);
  if (exists && ::fchmod(descriptor_, old.st_mode & k_permission_bits) != 0) fail(errno, "setting the permissions");
  struct stat created {};
  if (::fstat(descriptor_, &created) != 0) fail(errno, "reading the file status");
  mode_ = created.st_mode & k_permission_bits;
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::append(std::string_view bytes) {
  write_at(size_, bytes);
  size_ += bytes.size();
  send();
}

void AtomicFile::send() {
  if (size_ < n_sent_ + k_send_bytes) return;
  // Begins the transfer of the bytes; commit() waits for its end and checks it. A file system that cannot begin early transfers everything in commit().
  static_cast<void>(::sync_file_range(descriptor_, static_cast<off_t>(n_sent_), static_cast<off_t>(size_ - n_sent_), SYNC_FILE_RANGE_WRITE));
  n_sent_ = size_;
}

void AtomicFile::put(std::uint64_t offset, std::string_view bytes) {
  write_at(offset, bytes);
  size_ = std::max(size_, offset + bytes.size());
  send();
}

void AtomicFile::get(std::uint64_t offset, std::span<char> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(errno, "reading back");
    if (n == 0) {
      std::fill(bytes.begin(), bytes.end(), '\0');
      return;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

void AtomicFile::resize(std::uint64_t n_bytes) {
  if (::ftruncate(descriptor_, static_cast<off_t>(n_bytes)) != 0) fail(errno, "setting the size");
  size_ = n_bytes;
}

void AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) { write_at(offset, bytes); }

void AtomicFile::adopt() {
  ::close(descriptor_);  // a library may have replaced the file
  descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor_ < 0) fail(errno, "opening the file again");
  hold(descriptor_);
  if (::fchmod(descriptor_, mode_) != 0) fail(errno, "setting the permissions");
  struct stat written {};
  if (::fstat(descriptor_, &written) != 0) fail(errno, "reading the file status");
  size_ = static_cast<std::uint64_t>(written.st_size);
}

void AtomicFile::commit() {
  if (::fsync(descriptor_) != 0) fail(errno, "syncing");
  const int descriptor = descriptor_, held = ::dup(descriptor_);  // the copy keeps the lock until the file has its final name
  descriptor_ = -1;
  const auto do_or_fail = [&](int status, std::string_view doing) {
    if (status == 0) return;
    const int error_number = errno;
    ::close(held);
    fail(error_number, doing);
  };
  do_or_fail(::close(descriptor), "closing");
  do_or_fail(::rename(temporary_.c_str(), target_.c_str()), "renaming");
  ::close(held);
  temporary_.clear();
}

void AtomicFile::write_at(std::uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(errno, "writing");
    if (n == 0) fail(ENOSPC, "writing");
    bytes.remove_prefix(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

void AtomicFile::fail(int error_number, std::string_view doing) {
  discard();
  std::string problem = std::string(doing) + " failed" + (size_ > 0 ? " after " + std::to_string(size_) + " bytes" : "") +
                        (error_number != 0 ? ": " + reason(error_number) : ": the system reports no reason");
  throw Error({.code = ErrorCode::write_failed, .attempted = "writing " + path_.string(), .problem = std::move(problem), .hint = hint_for(error_number)});
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) {
    // Frees the space even if a library has the file open, because the library needs room to write the data required for closing it. Nobody reads the file any
    // more, so a failure is harmless.
    (void)!::ftruncate(descriptor_, 0);
    ::close(descriptor_);
  }
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void write_whole(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.append(bytes);
  file.commit();
}

}  // namespace sterna::io
