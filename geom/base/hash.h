// Content hashes for manifests and caches. Not for security.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace sterna {

/// XXH3, 128 bits, of a file's bytes as 32 lower-case hex digits; the same as `xxhsum -H2` prints. Reads in pieces, about 5 GB/s once cached.
/// \throws Error(file_not_found) when it cannot be opened, Error(file_malformed) when reading fails half-way.
std::string hash_file(const std::filesystem::path& path);

/// XXH3, 64 bits, seed 0; the same on every machine. About 20 GB/s.
std::uint64_t hash_bytes(std::string_view bytes);

}  // namespace sterna
