// A file as a sequence of sections of uniform items (nodes, cells of a kind, faces of a patch). Sections are cut into chunks, generated in parallel and written
// in order.
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

/// Items of uniform format: `format` appends the items [begin, end); called from any thread.
struct OutputSection {
  std::uint64_t n_items = 0;
  std::function<void(std::uint64_t begin, std::uint64_t end, ByteBuffer& out)> format;
};

/// Returns a section of constant bytes: headers, keywords.
OutputSection fixed_section(std::string bytes);

/// Appends the sections to `file`; the bytes do not depend on the number of threads.
/// \throws errors of the sections and of AtomicFile::append; Error(cancelled)
void write_sections(AtomicFile& file, const std::vector<OutputSection>& sections, const RunContext& context);

/// Passes the sections to `take`, in chunks of a number of items.
void write_sections(const TakeBytes& take, const std::vector<OutputSection>& sections, std::uint64_t items_per_chunk, const RunContext& context);

/// Number of items per chunk if they are numbers or short rows of numbers. A chunk is then below 1 MB.
inline constexpr std::uint64_t k_items_per_chunk_of_numbers = 16384;

/// Maximum length of a number as text: a real such as "-2.2250738585072014e-308", and a 64-bit integer with its sign.
inline constexpr std::size_t k_max_real_text = 24;
inline constexpr std::size_t k_max_integer_text = 20;

/// Writes a number's bytes at `at`. \returns the end of the written bytes
template <class T>
requires std::is_arithmetic_v<T>
char* put_bytes(char* at, T value, std::endian order) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  std::memcpy(at, raw.data(), sizeof(T));
  return at + sizeof(T);
}

/// Writes the shortest decimal string that reads back to the same number.
/// \pre room for k_max_real_text bytes
char* put_real_text(char* at, double value);
/// Writes an integer as decimal text.
/// \pre room for k_max_integer_text bytes
char* put_integer_text(char* at, std::int64_t value);

/// Throws Error(overflow) "N WHAT, but FORMAT counts no further than LIMIT" if n > limit.
void require_count(std::uint64_t n, std::uint64_t limit, const std::string& what, const std::string& format, const std::string& path);
/// Throws Error(mesh_invalid) for a node whose coordinates are not finite.
[[noreturn]] void throw_node_not_finite(std::uint64_t node);

}  // namespace sterna::io
