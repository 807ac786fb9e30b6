// An output folder that is written completely or not at all. It is filled under a temporary name beside the target, and exchanged with the old folder when
// complete.
#pragma once

#include <filesystem>
#include <string_view>

namespace sterna::io {

/// Output folder. Until commit() an existing folder of that name is unchanged. A folder that is destroyed uncommitted (exception, cancel) leaves no trace.
/// commit() replaces the whole old folder, which must therefore contain a known file: writing never deletes an unrelated folder.
/// \throws Error(write_failed) from every member, with the system's reason
class AtomicFolder {
 public:
  /// Creates missing parent folders, which are kept. \param proof file that an existing non-empty folder must contain to be replaced ("faces" of a polyMesh)
  AtomicFolder(const std::filesystem::path& path, std::string_view proof);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Returns the path at which an AtomicFile must write a file of the folder.
  std::filesystem::path file(std::string_view name) const { return temporary_ / name; }

  /// Returns the folder's temporary path, valid until commit().
  const std::filesystem::path& path() const { return temporary_; }

  void commit();

 private:
  [[noreturn]] void fail(int error_number, std::string_view doing);
  void discard() noexcept;

  std::filesystem::path path_;
  std::filesystem::path target_;     ///< links resolved
  std::filesystem::path temporary_;  ///< empty after commit
  int held_ = -1;                    ///< marks the folder as being filled
};

}  // namespace sterna::io
