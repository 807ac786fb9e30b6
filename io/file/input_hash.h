// Hashes of input files for the manifest.
#pragma once

#include <filesystem>
#include <string>

namespace sterna::io {

/// Returns hash_file() of a file that a reader of the format table accepts, or hash_files() if the format consists of several files (OpenFOAM).
/// \throws Error(file_not_found), Error(file_malformed), Error(unsupported_format) as format_of
std::string hash_input(const std::filesystem::path& path);
/// Returns the hash of any file; a file without a reader in the format table is hashed as a single file.
/// \throws Error(file_not_found)
std::string hash_any_input(const std::filesystem::path& path);

}  // namespace sterna::io
