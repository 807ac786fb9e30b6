// Named arrays of numbers in chunks, each compressed with LZ4 and hashed: the container of .sterna files (docs/sterna_format.md). Independent of meshes.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "io/input/file_buffer.h"
#include "io/output/atomic_file.h"

namespace sterna::io {

enum class NumberType : std::uint8_t { u8 = 1, u32 = 2, i64 = 3, f64 = 4 };
std::size_t size_of(NumberType type);

/// Latest version that can be read. A writer stamps a file with the first version whose readers understand all contents that must not be ignored.
inline constexpr std::uint32_t k_chunked_version = 4;
inline constexpr std::uint32_t k_first_chunked_version = 1;
/// Maximum bytes of values in a chunk: large enough to compress well, small enough for the cache of a core. 64 buffers of three times this size fit into 100
/// MB.
inline constexpr std::uint64_t k_chunk_bytes = 3u << 17;

/// Fills `out` with the bytes of the values [begin, end), little endian; called from any thread.
using FillValues = std::function<void(std::uint64_t begin, std::uint64_t end, char* out)>;

/// Writes a chunked file: add() for each array, then finish().
/// \throws Error write_failed, cancelled, and errors of fill functions
class ChunkedWriter {
 public:
  /// Begins the file with room for the header.
  /// \pre `file` is empty
  explicit ChunkedWriter(Borrowed<AtomicFile> file);

  /// Adds an array. `n_values` counts all components.
  void add(std::string_view name, NumberType type, std::uint32_t n_components, std::uint64_t n_values, const FillValues& fill, const RunContext& context);
  /// Adds an array whose memory layout equals the file layout.
  void add_memory(std::string_view name, NumberType type, std::uint32_t n_components, std::uint64_t n_values, const void* values, const RunContext& context);

  /// Writes the directory, and its offset into the file header. Does not commit.
  /// \pre version <= k_chunked_version
  void finish(std::uint32_t version = k_first_chunked_version);

 private:
  /// Returns the address of the bytes of [begin, end): either `room` after filling it, or the existing memory.
  using FindValues = std::function<const char*(std::uint64_t begin, std::uint64_t end, char* room)>;
  void pack(std::string_view name, NumberType type, std::uint32_t n_components, std::uint64_t n_values, const FindValues& find, const RunContext& context);

  AtomicFile& file_;
  std::string directory_;
  std::uint32_t n_arrays_ = 0;
};

/// Directory entry of an array.
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

/// Reader of a chunked file. The directory is checked at construction; arrays are unpacked on request.
class ChunkedReader {
 public:
  /// \throws Error file_malformed, unsupported_format
  explicit ChunkedReader(Borrowed<const FileBuffer> buffer);

  bool has(std::string_view name) const { return arrays_.find(name) != arrays_.end(); }
  /// Unpacks all values in parallel into `to`.
  /// \pre has(name); `to` has room for all bytes of the array
  /// \throws Error(file_malformed) for a chunk that does not match its hash
  void read(std::string_view name, char* to, const RunContext& context) const;
  const StoredArray& at(std::string_view name) const { return arrays_.find(name)->second; }
  [[noreturn]] void fail(std::string_view name, const std::string& problem) const;

 private:
  void read_directory(std::uint64_t begin, std::uint64_t end);
  const FileBuffer& buffer_;
  std::map<std::string, StoredArray, std::less<>> arrays_;
};

/// Returns true if a file that begins with these bytes is a chunked file.
bool is_chunked_file(std::string_view head);

}  // namespace sterna::io
