// Content hashes for manifests and caches. Not for security.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace sterna {

/// XXH3, 128 bits, of a file's bytes as 32 lower-case hex digits; the same as `xxhsum -H2` prints. Reads in pieces, about 5 GB/s once cached.
/// \throws Error(file_not_found) when it cannot be opened or is a folder, Error(file_malformed) when reading fails half-way; with the system's reason.
std::string hash_file(const std::filesystem::path& path);

/// Of several files in one: the hash of the text that `xxhsum -H2 NAME NAME ...` prints in their folder (each line the file's hash, two blanks, its name).
/// Their order counts.
/// \throws Error as hash_file
std::string hash_files(std::span<const std::filesystem::path> paths);

/// XXH3, 64 bits, seed 0; the same on every machine. About 20 GB/s.
std::uint64_t hash_bytes(std::string_view bytes);

/// XXH3, 128 bits, of bytes that come piece by piece; how they are cut does not matter.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(ContentHash&&) noexcept;
  ContentHash& operator=(ContentHash&&) noexcept;

  void append(std::span<const std::byte> bytes);
  /// Of all bytes so far, the most significant one first; more may follow.
  std::array<std::uint8_t, 16> digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sterna
