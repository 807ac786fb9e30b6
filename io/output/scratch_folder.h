// Temporary folders of a run.
#pragma once

#include <filesystem>
#include <string_view>

namespace sterna::io {

/// A new folder in the system's temporary folder (TMPDIR). The destructor removes it with its contents, unless it is kept.
class ScratchFolder {
 public:
  /// Creates the folder. \p purpose: part of its name, "view" of sterna-view-a1b2c3
  /// \throws Error(write_failed)
  explicit ScratchFolder(std::string_view purpose);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void keep() { is_kept_ = true; }

 private:
  std::filesystem::path path_;
  bool is_kept_ = false;
};

}  // namespace sterna::io
