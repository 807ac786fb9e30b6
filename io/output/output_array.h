// Arrays that a library writes into a container file. They are described first, then generated in parallel and streamed.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "io/input/number_kind.h"
#include "io/output/section_output.h"

namespace sterna::io {

/// An array to be written: kind and extents (slowest first). The sections of `content` together give byte_size(kind) * product of extents bytes, little endian,
/// in items of any size.
struct OutputArray {
  NumberKind kind = NumberKind::i4;
  std::vector<std::uint64_t> extents;
  std::vector<OutputSection> content;
};

OutputArray output_text(std::string text, NumberKind kind = NumberKind::i1);
template <class T>
OutputArray output_numbers(NumberKind kind, std::vector<std::uint64_t> extents, const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) put_bytes(bytes.data() + i * sizeof(T), values[i], std::endian::little);
  return {.kind = kind, .extents = std::move(extents), .content = {fixed_section(std::move(bytes))}};
}
std::uint64_t count_of(const OutputArray& array);  ///< product of the extents

/// Receives the next values of an array: whole items of its sections, in order, one call at a time, from any thread.
using PutValues = std::function<void(std::size_t array, std::uint64_t first_value, std::string_view bytes)>;

/// Passes the values of all arrays to `put`, one array after the other.
/// \throws errors of the sections and of `put`; Error(cancelled)
void stream_arrays(const std::vector<const OutputArray*>& arrays, const PutValues& put, const RunContext& context);

/// Locks the container libraries, which have global state. Every writer that uses them must hold this lock.
std::unique_lock<std::mutex> hold_container_libraries();

}  // namespace sterna::io
