// An output file that is written completely or not at all. It is written under a temporary name in the same folder, and renamed when complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace sterna::io {

/// Output file. Until commit() an existing file of that name is unchanged. A file that is destroyed uncommitted (exception, cancel) leaves no trace.
/// A symbolic link is followed: the link is kept and its target is replaced. Anything but a regular file is refused.
/// \throws Error(write_failed) from every member, with the system's reason; the temporary file is removed then.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes without a buffer. Use pieces of about 100 kB where speed matters.
  void append(std::string_view bytes);
  /// Overwrites bytes written earlier.
  /// \pre offset + bytes.size() <= size()
  void overwrite(std::uint64_t offset, std::string_view bytes);
  std::uint64_t size() const { return size_; }

  /// Random access for libraries: writes bytes at any offset, reads written bytes back (zeros in gaps), sets the end.
  void put(std::uint64_t offset, std::string_view bytes);
  void get(std::uint64_t offset, std::span<char> bytes);
  void resize(std::uint64_t n_bytes);

  const std::filesystem::path& path() const { return path_; }  ///< as given by the caller

  /// Returns the path of the contents until commit(), for a library that writes a file itself in place of append(). Call adopt() afterwards to take over the
  /// library's file.
  const std::filesystem::path& temporary() const { return temporary_; }
  void adopt();
  /// Throws Error(write_failed) with the system's reason, e.g. errno of a library's failure; 0 = no reason known.
  [[noreturn]] void fail(int error_number, std::string_view doing);

  /// Syncs the contents to the disk and renames the file. After a system crash either the old or the new file exists, complete.
  void commit();

 private:
  void send();
  void write_at(std::uint64_t offset, std::string_view bytes);
  void discard() noexcept;

  std::filesystem::path path_;    ///< as given by the caller, for messages
  std::filesystem::path target_;  ///< links resolved
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  unsigned mode_ = 0;  ///< permissions at creation
  std::uint64_t size_ = 0;
  std::uint64_t n_sent_ = 0;  ///< number of bytes whose transfer to the disk has begun
};

/// Writes these bytes to an AtomicFile and commits it.
void write_whole(const std::filesystem::path& path, std::string_view bytes);

}  // namespace sterna::io
