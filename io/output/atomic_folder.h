// A folder that appears whole or not at all: filled under a temporary name beside its place, exchanged with the old one when complete.
#pragma once

#include <filesystem>
#include <string_view>

namespace sterna::io {

/// Output folder. Until commit() an existing folder of that name stays as it was; a folder that is destroyed uncommitted (exception, cancel) leaves no trace.
/// commit() replaces the whole old folder, so it must be known by a file: writing never deletes a folder of something else.
/// \throws Error(write_failed) from every member, with the system's reason
class AtomicFolder {
 public:
  /// Makes missing parent folders, which stay. \param proof a file that an existing, not empty folder must hold to be replaced ("faces" of a polyMesh)
  AtomicFolder(const std::filesystem::path& path, std::string_view proof);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Where a file of the folder is to be written, by AtomicFile.
  std::filesystem::path file(std::string_view name) const { return temporary_ / name; }

  /// The folder itself, until commit().
  const std::filesystem::path& path() const { return temporary_; }

  void commit();

 private:
  [[noreturn]] void fail(int error_number, std::string_view doing);
  void discard() noexcept;

  std::filesystem::path path_;
  std::filesystem::path target_;     ///< links resolved
  std::filesystem::path temporary_;  ///< empty after commit
  int held_ = -1;                    ///< says that it is being filled
};

}  // namespace sterna::io
