// What a manifest says of its inputs.
#pragma once

#include <filesystem>
#include <string>

namespace sterna::io {

/// hash_file of a file that one of the table's readers takes; of a format whose mesh is several files (OpenFOAM), hash_files of them.
/// \throws Error(file_not_found), Error(file_malformed), Error(unsupported_format) as format_of
std::string hash_input(const std::filesystem::path& path);
/// The same of a file of any kind: whatever no reader of the table takes is one file.
/// \throws Error(file_not_found)
std::string hash_any_input(const std::filesystem::path& path);

}  // namespace sterna::io
