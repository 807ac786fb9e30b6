// Lock that permits one run at a time in the folder of a series.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"

namespace sterna::scripting {

/// Holds the lock of a folder until the object and all processes that inherited its descriptor have ended, in whatever way. The system releases the lock, so no
/// cleanup is needed after kill -9. Works across machines if the file system has locks.
class FolderLock {
 public:
  /// Acquires the lock; waits a short time for workers of a killed run to end.
  /// \throws Error(write_failed) if another run holds the lock, naming it, or if the folder cannot be written
  FolderLock(const std::filesystem::path& folder, const RunContext& context);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

}  // namespace sterna::scripting
