// Named arrays of numbers in chunks, each packed by LZ4 and hashed: the container under .sterna (docs/sterna_format.md). Knows nothing of meshes.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "io/input/file_buffer.h"
#include "io/output/atomic_file.h"

namespace sterna::io {

enum class NumberType : std::uint8_t { u8 = 1, u32 = 2, i64 = 3, f64 = 4 };
std::size_t size_of(NumberType type);

/// Latest version that is read. A writer marks a file with the first version whose readers understand all that must not be passed over in it.
inline constexpr std::uint32_t k_chunked_version = 4;
inline constexpr std::uint32_t k_first_chunked_version = 1;
/// Values of a chunk take this many bytes at most: enough to pack well, few enough for the cache of a core, and 64 buffers with three times as much fit into
/// 100 MB.
inline constexpr std::uint64_t k_chunk_bytes = 3u << 17;

/// What `fill` writes for [begin, end) are the values' bytes, little endian; called from any thread.
using FillValues = std::function<void(std::uint64_t begin, std::uint64_t end, char* out)>;

/// Array after array, then finish().
/// \throws Error write_failed, cancelled, and what a fill function throws
class ChunkedWriter {
 public:
  /// Begins the file.
  /// \pre `file` is empty and outlives the writer
  explicit ChunkedWriter(AtomicFile& file);

  /// `n_values` counts all components.
  void add(std::string_view name, NumberType type, std::uint32_t n_components, std::uint64_t n_values, const FillValues& fill, const RunContext& context);
  /// The bytes of values that lie in memory as in the file.
  void add_memory(std::string_view name, NumberType type, std::uint32_t n_components, std::uint64_t n_values, const void* values, const RunContext& context);

  /// Writes the directory, and where it is to the head. Does not commit.
  /// \pre version <= k_chunked_version
  void finish(std::uint32_t version = k_first_chunked_version);

 private:
  /// Where the bytes of [begin, end) are: filled into `room`, or where they lie.
  using FindValues = std::function<const char*(std::uint64_t begin, std::uint64_t end, char* room)>;
  void pack(std::string_view name, NumberType type, std::uint32_t n_components, std::uint64_t n_values, const FindValues& find, const RunContext& context);

  AtomicFile& file_;
  std::string directory_;
  std::uint32_t n_arrays_ = 0;
};

/// An array that can be read.
struct StoredArray {
  NumberType type = NumberType::u8;
  std::uint32_t n_components = 1;
  std::uint64_t n_values = 0;
  std::uint64_t values_per_chunk = 0;
  struct Chunk {
    std::uint64_t offset = 0, packed_bytes = 0, hash = 0;
    std::uint8_t codec = 0;
  };
  std::vector<Chunk> chunks;
};

/// The directory of a file, checked; arrays are unpacked when asked for.
class ChunkedReader {
 public:
  /// \pre `buffer` outlives the reader.
  /// \throws Error file_malformed, unsupported_format
  explicit ChunkedReader(const FileBuffer& buffer);

  bool has(std::string_view name) const { return arrays_.find(name) != arrays_.end(); }
  /// Unpacks all values in parallel into `to`.
  /// \pre has(name), as many bytes as the array has.
  /// \throws Error(file_malformed) for a chunk that is not what it was
  void read(std::string_view name, char* to, const RunContext& context) const;
  const StoredArray& at(std::string_view name) const { return arrays_.find(name)->second; }
  [[noreturn]] void fail(std::string_view name, const std::string& problem) const;

 private:
  void read_directory(std::uint64_t begin, std::uint64_t end);
  const FileBuffer& buffer_;
  std::map<std::string, StoredArray, std::less<>> arrays_;
};

/// Whether a file that begins with these bytes is one.
bool is_chunked_file(std::string_view head);

}  // namespace sterna::io
