// A file as a sequence of sections of like items (nodes, cells of a kind, faces of a patch): cut into chunks, made by all threads, written in order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "geom/base/run_context.h"
#include "io/output/atomic_file.h"
#include "io/output/ordered_output.h"

namespace sterna::io {

/// Items that are formatted alike: `format` appends the items [begin, end); called from any thread.
struct OutputSection {
  std::uint64_t n_items = 0;
  std::function<void(std::uint64_t begin, std::uint64_t end, ByteBuffer& out)> format;
};

/// Bytes as they are: headers, keywords.
OutputSection fixed_section(std::string bytes);

/// Appends the sections to `file`; the same bytes for any number of threads.
/// \throws what the sections and AtomicFile::append throw; Error(cancelled)
void write_sections(AtomicFile& file, const std::vector<OutputSection>& sections, const RunContext& context);

/// The same to `take`, in chunks of a number of items.
void write_sections(const TakeBytes& take, const std::vector<OutputSection>& sections, std::uint64_t items_per_chunk, const RunContext& context);

/// Items per chunk where they are numbers or short rows of them: below 1 MB.
inline constexpr std::uint64_t k_items_per_chunk_of_numbers = 16384;

/// Room that text needs at most: "-2.2250738585072014e-308", a 64-bit number with its sign.
inline constexpr std::size_t k_max_real_text = 24;
inline constexpr std::size_t k_max_integer_text = 20;

/// Writes a number's bytes at `at`. \returns the place behind them
template <class T>
requires std::is_arithmetic_v<T>
char* put_bytes(char* at, T value, std::endian order) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  std::memcpy(at, raw.data(), sizeof(T));
  return at + sizeof(T);
}

/// Writes the shortest decimals that read back to the same number.
/// \pre room for k_max_real_text bytes
char* put_real_text(char* at, double value);
/// \pre room for k_max_integer_text bytes
char* put_integer_text(char* at, std::int64_t value);

/// Throws Error(overflow) "N WHAT, but FORMAT counts no further than LIMIT" when n > limit.
void require_count(std::uint64_t n, std::uint64_t limit, const std::string& what, const std::string& format, const std::string& path);
/// Throws Error(mesh_invalid) for a node whose coordinates are not finite.
[[noreturn]] void throw_node_not_finite(std::uint64_t node);

}  // namespace sterna::io
