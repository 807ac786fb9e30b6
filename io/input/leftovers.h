// Temporary files and folders of runs that were killed before they could remove them.
#pragma once

#include <filesystem>

namespace sterna::io {

/// Marks a temporary file or folder as in use for remove_leftovers() of other processes. The mark ends when `descriptor` and its copies are closed, also by the
/// death of the process. Does nothing on file systems without locks; there remove_leftovers() removes nothing, either.
void hold(int descriptor) noexcept;

/// Removes entries named ".sterna-*.part" in `folder` that no process holds and that have not changed for a minute. Entries that cannot be removed, or whose
/// lock state is unknown, are kept.
void remove_leftovers(const std::filesystem::path& folder) noexcept;

}  // namespace sterna::io
