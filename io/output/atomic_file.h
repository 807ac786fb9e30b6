// A file that appears whole or not at all: written under a temporary name in the same folder, renamed when complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace sterna::io {

/// Output file. Until commit() an existing file of that name stays as it was; a file that is destroyed uncommitted (exception, cancel) leaves no trace.
/// A symbolic link is followed, so that the link stays and its target is replaced; anything but a regular file is refused.
/// \throws Error(write_failed) from every member, with the system's reason; the temporary is gone then.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Adds bytes at the end. Not buffered: give it pieces of some 100 kB where speed matters.
  void append(std::string_view bytes);
  /// Replaces bytes that were written before.
  /// \pre offset + bytes.size() <= size()
  void overwrite(std::uint64_t offset, std::string_view bytes);
  std::uint64_t size() const { return size_; }

  /// For a library that places its bytes itself: writes them anywhere, reads back what was written (zeros where nothing was), sets the end.
  void put(std::uint64_t offset, std::string_view bytes);
  void get(std::uint64_t offset, std::span<char> bytes);
  void resize(std::uint64_t n_bytes);

  const std::filesystem::path& path() const { return path_; }  ///< as the caller named it

  /// Where the contents are until commit(): for a library that writes a file of that name itself, in place of append(). Afterwards adopt() takes what it has
  /// written.
  const std::filesystem::path& temporary() const { return temporary_; }
  void adopt();
  /// Throws Error(write_failed) with the system's reason, e.g. errno of a library's failure; 0 = it has none.
  [[noreturn]] void fail(int error_number, std::string_view doing);

  /// Syncs the contents to the disk and renames. After a crash of the machine either the old or the new file is there, each whole.
  void commit();

 private:
  void send();
  void write_at(std::uint64_t offset, std::string_view bytes);
  void discard() noexcept;

  std::filesystem::path path_;    ///< as the caller named it, for messages
  std::filesystem::path target_;  ///< links resolved
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  unsigned mode_ = 0;  ///< permissions, as it was created
  std::uint64_t size_ = 0;
  std::uint64_t n_sent_ = 0;  ///< of them, those whose way to the disk has begun
};

/// An AtomicFile of these bytes, committed.
void write_whole(const std::filesystem::path& path, std::string_view bytes);

}  // namespace sterna::io
