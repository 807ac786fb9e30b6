// Content hashes for manifests and caches. Not for security.
#pragma once

#include <filesystem>
#include <string>

namespace sterna {

/// XXH3, 128 bits, of a file's bytes as 32 lower-case hex digits; the same as `xxhsum -H2` prints. Reads in pieces, about 5 GB/s once cached.
/// \throws Error(file_not_found) when it cannot be opened, Error(file_malformed) when reading fails half-way.
std::string hash_file(const std::filesystem::path& path);

}  // namespace sterna
