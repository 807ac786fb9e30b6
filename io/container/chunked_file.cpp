#include "io/container/chunked_file.h"

#include <lz4.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>

#include "geom/base/error.h"
#include "geom/base/hash.h"
#include "geom/base/parallel.h"
#include "io/container/byte_planes.h"
#include "io/input/byte_reader.h"
#include "io/output/ordered_output.h"
#include "io/output/section_output.h"

namespace sterna::io {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

/// Signature in the style of PNG. It detects files that were damaged by a transfer as text.
constexpr std::string_view k_magic("\x89sterna\r\n\x1a\n\0\0\0\0\0", 16);
constexpr std::uint32_t k_byte_order_mark = 0x01020304;
constexpr std::size_t k_head_bytes = 64;
constexpr std::size_t k_hashed_head_bytes = 56;
constexpr std::uint8_t k_plain = 0;
constexpr std::uint8_t k_lz4_planes = 1;               // LZ4 of the byte planes (all first bytes of the values, then all second bytes, and so on)
constexpr std::uint64_t k_max_chunk_bytes = 1u << 24;  // limit for the reader; writers stay below it
constexpr std::uint64_t k_lz4_expansion = 255;         // LZ4 expands a packed byte to at most this many bytes
constexpr std::size_t k_longest_name = 255;
/// A chunk that LZ4 does not shrink by a sixteenth is stored uncompressed: unpacking would take longer than reading.
constexpr std::size_t k_gain = 16;

template <class T>
void append_number(std::string& text, T value) {
  std::array<char, sizeof(T)> bytes;
  put_bytes(bytes.data(), value, std::endian::little);
  text.append(bytes.data(), bytes.size());
}

/// Compares the bytes with their hash. Fuzzing builds skip the test to reach the code after it; the hash is no protection against deliberate changes.
bool is_intact(std::string_view bytes, std::uint64_t hash) {
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
  static_cast<void>(bytes), static_cast<void>(hash);
  return true;
#else
  return hash_bytes(bytes) == hash;
#endif
}

bool is_known(std::uint8_t type) { return type >= static_cast<std::uint8_t>(NumberType::u8) && type <= static_cast<std::uint8_t>(NumberType::f64); }

}  // namespace

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::u8: return 1;
    case NumberType::u32: return 4;
    case NumberType::i64:
    case NumberType::f64: return 8;
  }
  return 1;
}

bool is_chunked_file(std::string_view head) { return head.starts_with(k_magic); }

ChunkedWriter::ChunkedWriter(Borrowed<AtomicFile> file) : file_(file) { file_.append(std::string(k_head_bytes, '\0')); }

void ChunkedWriter::pack(std::string_view name, NumberType type, std::uint32_t n_components, std::uint64_t n_values, const FindValues& find,
                         const RunContext& context) {
  const std::size_t size = size_of(type);
  const std::uint64_t per_chunk = k_chunk_bytes / size, n_chunks = (n_values + per_chunk - 1) / per_chunk;
  std::vector<StoredArray::Chunk> chunks(n_chunks);
  std::uint64_t offset = file_.size();
  write_ordered(
      file_, n_chunks,
      [&](std::size_t c, ByteBuffer& out) {
        const std::uint64_t begin = c * per_chunk, end = std::min(begin + per_chunk, n_values);
        const std::size_t n_bytes = (end - begin) * size;
        const int bound = LZ4_compressBound(static_cast<int>(n_bytes));
        char* const location = out.reserve(static_cast<std::size_t>(bound) + 2 * n_bytes);  // planes and values are in the same buffer behind the packed bytes;
                                                                                            // the buffer is reused, so its pages stay allocated
        char* const planes = location + bound;
        const char* const values = find(begin, end, planes + n_bytes);
        gather_planes(values, end - begin, size, planes);
        const int n_packed = LZ4_compress_default(planes, location, static_cast<int>(n_bytes), bound);
        if (n_packed > 0 && static_cast<std::size_t>(n_packed) < n_bytes - n_bytes / k_gain) {
          out.end_at(location + n_packed);
          chunks[c].codec = k_lz4_planes;
        } else {
          std::memcpy(location, values, n_bytes);
          out.end_at(location + n_bytes);
          chunks[c].codec = k_plain;
        }
        chunks[c].packed_bytes = out.size();
        chunks[c].hash = hash_bytes(out.view());
      },
      context);
  append_number(directory_, static_cast<std::uint32_t>(name.size()));
  directory_ += name;
  append_number(directory_, static_cast<std::uint8_t>(type));
  append_number(directory_, n_components);
  append_number(directory_, n_values);
  append_number(directory_, per_chunk);
  append_number(directory_, n_chunks);
  for (const StoredArray::Chunk& chunk : chunks) {
    append_number(directory_, offset);
    append_number(directory_, chunk.packed_bytes);
    append_number(directory_, chunk.hash);
    append_number(directory_, chunk.codec);
    offset += chunk.packed_bytes;
  }
  ++n_arrays_;
}

void ChunkedWriter::add(std::string_view name, NumberType type, std::uint32_t n_components, std::uint64_t n_values, const FillValues& fill,
                        const RunContext& context) {
  const auto filled = [&fill](std::uint64_t begin, std::uint64_t end, char* room) {
    fill(begin, end, room);
    return static_cast<const char*>(room);
  };
  pack(name, type, n_components, n_values, filled, context);
}

void ChunkedWriter::add_memory(std::string_view name, NumberType type, std::uint32_t n_components, std::uint64_t n_values, const void* values,
                               const RunContext& context) {
  const char* const bytes = static_cast<const char*>(values);
  pack(
      name, type, n_components, n_values, [bytes, size = size_of(type)](std::uint64_t begin, std::uint64_t, char*) { return bytes + begin * size; }, context);
}

void ChunkedWriter::finish(std::uint32_t version) {
  std::string directory;
  append_number(directory, n_arrays_);
  directory += directory_;
  const std::uint64_t location = file_.size();
  file_.append(directory);
  std::string head(k_magic);
  append_number(head, version);
  append_number(head, k_byte_order_mark);
  append_number(head, location);
  append_number(head, std::uint64_t{directory.size()});
  append_number(head, hash_bytes(directory));
  append_number(head, file_.size());
  append_number(head, hash_bytes(head));
  file_.overwrite(0, head);
}

ChunkedReader::ChunkedReader(Borrowed<const FileBuffer> buffer) : buffer_(buffer) {
  const std::string_view text = buffer_.text();
  if (!is_chunked_file(text))
    throw_malformed(buffer_.source, "byte 0", "found " + quoted_excerpt(text.substr(0, k_magic.size())) + ", expected the head of a .sterna file");
  ByteReader head(buffer, std::endian::little, k_magic.size());
  head.require(1, k_head_bytes - k_magic.size(), "the head");
  const auto version = head.take<std::uint32_t>();
  if (version == 0 || version > k_chunked_version)
    throw_unsupported(buffer_.source,
                      "the file has version " + std::to_string(version) + " of the container, this program reads up to " + std::to_string(k_chunked_version),
                      "read the file with a newer version of sterna");
  if (head.take<std::uint32_t>() != k_byte_order_mark) head.fail("found another byte order, expected little endian");
  const auto location = head.take<std::uint64_t>(), n_bytes = head.take<std::uint64_t>(), hash = head.take<std::uint64_t>(),
             file_bytes = head.take<std::uint64_t>();
  const auto head_hash = head.take<std::uint64_t>();
  if (!is_intact(text.substr(0, k_hashed_head_bytes), head_hash))
    throw_malformed(buffer_.source, "byte 0", "the head is damaged: its hash does not match", "copy or write the file again");
  if (file_bytes != text.size())
    throw_malformed(buffer_.source, "byte 48", "found " + std::to_string(text.size()) + " bytes in the file, expected " + std::to_string(file_bytes),
                    "the file may have been cut short: copy or write it again");
  if (location < k_head_bytes || location > text.size() || n_bytes != text.size() - location)
    throw_malformed(
        buffer_.source, "byte 24",
        "found the directory at byte " + std::to_string(location) + " with " + std::to_string(n_bytes) + " bytes, expected it to end with the file");
  if (!is_intact(text.substr(location), hash))
    throw_malformed(buffer_.source, "byte " + std::to_string(location), "the directory is damaged: its hash does not match", "copy or write the file again");
  read_directory(location, text.size());
}

void ChunkedReader::read_directory(std::uint64_t begin, std::uint64_t end) {
  ByteReader bytes(buffer_, std::endian::little, begin);
  const auto n_arrays = bytes.read<std::uint32_t>("the number of arrays");
  std::uint64_t free = k_head_bytes;  // chunks are contiguous, so that a small file cannot claim to unpack to a large one
  for (std::uint32_t a = 0; a < n_arrays; ++a) {
    const auto n_name = bytes.read<std::uint32_t>("the length of a name");
    if (n_name > k_longest_name) bytes.fail("found a name of " + std::to_string(n_name) + " bytes, expected at most " + std::to_string(k_longest_name));
    bytes.require(n_name, 1, "the name of an array");
    const std::string name(buffer_.text().substr(bytes.offset(), n_name));
    bytes.skip(n_name);
    StoredArray array;
    const auto type = bytes.read<std::uint8_t>("the type of an array");
    if (!is_known(type)) bytes.fail("found the type " + std::to_string(type) + " of array " + quoted_excerpt(name));
    array.type = static_cast<NumberType>(type);
    array.n_components = bytes.read<std::uint32_t>("the number of components");
    array.n_values = bytes.read<std::uint64_t>("the number of values");
    array.values_per_chunk = bytes.read<std::uint64_t>("the values of a chunk");
    const auto n_chunks = bytes.read<std::uint64_t>("the number of chunks");
    const std::size_t size = size_of(array.type);
    if (array.n_components == 0 || array.n_values % array.n_components != 0 || array.values_per_chunk == 0 ||
        array.values_per_chunk > k_max_chunk_bytes / size ||
        n_chunks != array.n_values / array.values_per_chunk + (array.n_values % array.values_per_chunk != 0 ? 1 : 0))
      bytes.fail("array " + quoted_excerpt(name) + " has " + std::to_string(array.n_values) + " values of " + std::to_string(array.n_components) +
                 " components in " + std::to_string(n_chunks) + " chunks of " + std::to_string(array.values_per_chunk) + ", which is impossible");
    bytes.require(n_chunks, 25, "the chunks of an array");
    array.chunks.resize(n_chunks);
    for (std::uint64_t c = 0; c < n_chunks; ++c) {
      StoredArray::Chunk& chunk = array.chunks[c];
      chunk.offset = bytes.take<std::uint64_t>();
      chunk.packed_bytes = bytes.take<std::uint64_t>();
      chunk.hash = bytes.take<std::uint64_t>();
      chunk.codec = bytes.take<std::uint8_t>();
      const std::uint64_t n_bytes = std::min(array.values_per_chunk, array.n_values - c * array.values_per_chunk) * size;
      const bool is_inside = chunk.offset >= free && chunk.offset <= begin && chunk.packed_bytes <= begin - chunk.offset;
      const bool can_unpack =
          chunk.codec == k_plain ? chunk.packed_bytes == n_bytes : chunk.codec == k_lz4_planes && n_bytes <= k_lz4_expansion * chunk.packed_bytes;
      if (!is_inside || !can_unpack)
        bytes.fail("chunk " + std::to_string(c) + " of array " + quoted_excerpt(name) + " has an impossible position, size or codec in the directory");
      free = chunk.offset + chunk.packed_bytes;
    }
    if (!arrays_.emplace(name, std::move(array)).second) bytes.fail("array " + quoted_excerpt(name) + " occurs twice");
  }
  if (bytes.offset() != end) bytes.fail("found " + std::to_string(end - bytes.offset()) + " bytes behind the last array");
}

void ChunkedReader::read(std::string_view name, char* to, const RunContext& context) const {
  const StoredArray& array = at(name);
  const std::size_t size = size_of(array.type);
  parallel_for(
      context, array.chunks.size(),
      [&](std::size_t c) {
        const StoredArray::Chunk& chunk = array.chunks[c];
        const std::string_view packed = buffer_.text().substr(chunk.offset, chunk.packed_bytes);
        const std::uint64_t begin = c * array.values_per_chunk, n = std::min(array.values_per_chunk, array.n_values - begin);
        const auto damaged = [&](const char* what) {
          throw_malformed(buffer_.source, "byte " + std::to_string(chunk.offset),
                          "chunk " + std::to_string(c) + " of array " + quoted_excerpt(name) + " is damaged: " + what, "copy or write the file again");
        };
        if (!is_intact(packed, chunk.hash)) damaged("its hash does not match");
        char* const location = to + begin * size;
        if (chunk.codec == k_plain) {
          std::memcpy(location, packed.data(), n * size);
          return;
        }
        const auto planes = std::make_unique_for_overwrite<char[]>(n * size);
        if (LZ4_decompress_safe(packed.data(), planes.get(), static_cast<int>(packed.size()), static_cast<int>(n * size)) != static_cast<int>(n * size))
          damaged("LZ4 cannot decompress it");
        scatter_planes(planes.get(), n, size, location);
      },
      1);
}

void ChunkedReader::fail(std::string_view name, const std::string& problem) const {
  const auto found = arrays_.find(name);
  const std::uint64_t location = found == arrays_.end() || found->second.chunks.empty() ? k_head_bytes : found->second.chunks[0].offset;
  throw_malformed(buffer_.source, "byte " + std::to_string(location), "array " + quoted_excerpt(name) + ": " + problem);
}

}  // namespace sterna::io
