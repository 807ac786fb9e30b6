#include "geom/base/hash.h"

#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "geom/base/error.h"

namespace sterna {
namespace {

constexpr std::size_t k_piece = 1 << 20;  // bytes per read: large against the cost of a system call

struct FreeState {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

std::string to_hex(const XXH128_hash_t& hash) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, hash);
  std::string hex;
  for (const unsigned char byte : canonical.digest) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    hex += digits;
  }
  return hex;
}

[[noreturn]] void fail(ErrorCode code, const std::filesystem::path& path, std::string problem) {
  throw Error({.code = code, .attempted = "reading " + path.string(), .problem = std::move(problem)});
}

}  // namespace

std::string hash_file(const std::filesystem::path& path) {
  std::error_code ignored;  // error of an inaccessible path: fopen reports the cause
  if (std::filesystem::is_directory(path, ignored)) fail(ErrorCode::file_not_found, path, "this is a folder, not a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) fail(ErrorCode::file_not_found, path, "the file cannot be opened: " + std::generic_category().message(errno));
  const std::unique_ptr<XXH3_state_t, FreeState> state(XXH3_createState());
  XXH3_128bits_reset(state.get());
  std::vector<char> piece(k_piece);
  while (const std::size_t n = std::fread(piece.data(), 1, piece.size(), file.get())) XXH3_128bits_update(state.get(), piece.data(), n);
  if (std::ferror(file.get())) fail(ErrorCode::file_malformed, path, "reading failed half-way: " + std::generic_category().message(errno));
  return to_hex(XXH3_128bits_digest(state.get()));
}

std::string hash_files(std::span<const std::filesystem::path> paths) {
  std::string lines;
  for (const std::filesystem::path& path : paths) lines += hash_file(path) + "  " + path.filename().string() + "\n";
  return to_hex(XXH3_128bits(lines.data(), lines.size()));
}

struct ContentHash::State {
  State() : xxh(XXH3_createState()) { XXH3_128bits_reset(xxh.get()); }
  std::unique_ptr<XXH3_state_t, FreeState> xxh;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {}
ContentHash::~ContentHash() = default;
ContentHash::ContentHash(ContentHash&&) noexcept = default;
ContentHash& ContentHash::operator=(ContentHash&&) noexcept = default;

void ContentHash::append(std::span<const std::byte> bytes) { XXH3_128bits_update(state_->xxh.get(), bytes.data(), bytes.size()); }

std::array<std::uint8_t, 16> ContentHash::digest() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_->xxh.get()));
  std::array<std::uint8_t, 16> result{};
  std::copy(std::begin(canonical.digest), std::end(canonical.digest), result.begin());
  return result;
}

std::uint64_t hash_bytes(std::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

}  // namespace sterna
