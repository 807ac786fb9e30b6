// Temporary files and folders of runs that were killed before they could remove them.
#pragma once

#include <filesystem>

namespace sterna::io {

/// Tells remove_leftovers() of other processes that a temporary file or folder is being written: until `descriptor` and its copies are closed, also by the
/// death of the process. Does nothing on file systems without locks, on which nothing is removed either.
void hold(int descriptor) noexcept;

/// Removes what is called ".sterna-*.part" in `folder`, is held by nobody and has not changed for a minute. What cannot be removed, or not be proved to be held
/// by nobody, stays.
void remove_leftovers(const std::filesystem::path& folder) noexcept;

}  // namespace sterna::io
