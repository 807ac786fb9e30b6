// HDF5: types, extents and values of datasets; chunks packed by zlib are unpacked.
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "io/hdf5_source.h"

namespace sterna::io {
namespace {

// Types of messages in object headers.
constexpr std::uint8_t k_space = 0x01;
constexpr std::uint8_t k_type = 0x03;
constexpr std::uint8_t k_layout = 0x08;
constexpr std::uint8_t k_filters = 0x0b;

constexpr unsigned k_deflate = 1;
constexpr unsigned k_shuffle = 2;
constexpr unsigned k_fletcher = 3;
constexpr std::uint64_t k_max_rank = 32;
/// Unpacked over file size, as for gzipped files: meshes reach about 10.
constexpr std::uint64_t k_max_expansion = 200;
constexpr std::uint64_t k_expansion_floor = std::uint64_t{1} << 24;

void unshuffle(std::vector<char>& bytes, std::size_t element_size) {
  const std::size_t n = bytes.size() / element_size;
  std::vector<char> sorted(bytes);
  for (std::size_t k = 0; k < element_size; ++k)
    for (std::size_t i = 0; i < n; ++i) sorted[i * element_size + k] = bytes[k * n + i];
  bytes = std::move(sorted);
}

}  // namespace

Hdf5Source::DataType Hdf5Source::data_type(std::uint64_t begin, std::uint64_t end) {
  if (end - begin < 8) fail(begin, "found a type of " + std::to_string(end - begin) + " bytes");
  const std::uint64_t class_and_version = number(begin, 1, "a type"), bits = number(begin + 1, 3, "a type");
  DataType type{.size = number(begin + 4, 4, "the size of a type")};
  if (type.size == 0) fail(begin, "found a type of no size");
  type.order = (bits & 1) ? std::endian::big : std::endian::little;
  const auto is_whole = [&] { return end - begin >= 12 && number(begin + 8, 2, "a type") == 0 && number(begin + 10, 2, "a type") == 8 * type.size; };
  switch (class_and_version & 0x0f) {
    case 0: {
      const bool is_signed = (bits & 8) != 0;
      type.is_known = is_whole() && (type.size == 1 || type.size == 2 || type.size == 4 || type.size == 8);
      if (type.size == 1) type.kind = is_signed ? NumberKind::i1 : NumberKind::u1;
      if (type.size == 2) type.kind = is_signed ? NumberKind::i2 : NumberKind::u2;
      if (type.size == 4) type.kind = is_signed ? NumberKind::i4 : NumberKind::u4;
      if (type.size == 8) type.kind = is_signed ? NumberKind::i8 : NumberKind::u8;
      break;
    }
    case 1:
      // IEEE: sign in the highest bit, nothing of VAX order.
      type.is_known = is_whole() && (type.size == 4 || type.size == 8) && (bits & 0x40) == 0 && ((bits >> 8) & 0xff) == 8 * type.size - 1;
      type.kind = type.size == 4 ? NumberKind::f4 : NumberKind::f8;
      break;
    case 3:
      type.is_known = true;
      type.kind = NumberKind::text;
      break;
    case 9:
      type.is_variable_text = (bits & 0x0f) == 1 && type.size == 16;
      type.kind = NumberKind::text;
      break;
    default: break;
  }
  return type;
}

std::vector<std::uint64_t> Hdf5Source::extents(std::uint64_t begin, std::uint64_t end) {
  const std::uint64_t version = number(begin, 1, "extents"), rank = number(begin + 1, 1, "extents");
  if (version < 1 || version > 2 || rank > k_max_rank) fail(begin, "found extents of an unknown kind");
  if (version == 2 && number(begin + 3, 1, "extents") == 2) return {0};  // no values at all
  const std::uint64_t first = begin + (version == 1 ? 8 : 4);
  if (first > end || 8 * rank > end - first) fail(begin, "found " + std::to_string(rank) + " extents, which leave their message");
  std::vector<std::uint64_t> result;
  for (std::uint64_t k = 0; k < rank; ++k) result.push_back(number(first + 8 * k, 8, "extents"));
  return result;
}

std::vector<Hdf5Source::Filter> Hdf5Source::filters(const Message& message) {
  std::vector<Filter> result;
  const std::uint64_t version = number(message.begin, 1, "filters"), n = number(message.begin + 1, 1, "filters");
  std::uint64_t at = message.begin + (version == 1 ? 8 : 2);
  for (std::uint64_t i = 0; i < n && at < message.end; ++i) {
    const unsigned id = static_cast<unsigned>(number(at, 2, "a filter"));
    const bool has_name = version == 1 || id >= 256;
    const std::uint64_t name_size = has_name ? number(at + 2, 2, "a filter") : 0, rest = at + (has_name ? 4 : 2);
    const std::uint64_t flags = number(rest, 2, "a filter"), n_values = number(rest + 2, 2, "a filter");
    if (id != k_deflate && id != k_shuffle && id != k_fletcher) refuse(at, "the filter " + std::to_string(id));
    result.push_back({.id = id, .is_optional = (flags & 1) != 0});
    at = rest + 4 + name_size + 4 * (n_values + (version == 1 ? n_values % 2 : 0));
  }
  return result;
}

std::string Hdf5Source::variable_text(std::uint64_t reference) {
  const std::uint64_t length = number(reference, 4, "the length of a text"), heap = address_at(reference + 4, "a heap of texts"), index = number(reference + 12, 4, "a text");
  require_signature(heap, "GCOL");
  const std::uint64_t size = number(heap + 8, 8, "the size of a heap");
  for (std::uint64_t at = 16; at + 16 <= size;) {
    const std::uint64_t found = number(heap + at, 2, "a text's number"), n = number(heap + at + 8, 8, "a text's length");
    if (found == index) return std::string(metadata(heap + at + 16, std::min(n, length), "a text"));
    if (found == 0 || n > size) break;
    at += 16 + (n + 7) / 8 * 8;
  }
  fail(heap, "found no text " + std::to_string(index));
}

NumberArray Hdf5Source::data(const Hdf5Object& dataset) {
  NumberArray array{.source = buffer_.source, .where = dataset.path};
  DataType type;
  std::uint64_t layout = 0, layout_end = 0;
  std::vector<Filter> used_filters;
  for (const Message& message : messages(dataset.address)) {
    if ((message.flags & 2) && (message.type == k_type || message.type == k_space)) refuse(message.begin, "a dataset of a named type");
    if (message.type == k_type) type = data_type(message.begin, message.end);
    if (message.type == k_space) array.extents = extents(message.begin, message.end);
    if (message.type == k_filters) used_filters = filters(message);
    if (message.type == k_layout) layout = message.begin, layout_end = message.end;
  }
  if (layout == 0) array.fail("this is not a dataset");
  if (!type.is_known) refuse(layout, "the type of " + dataset.path);
  array.kind = type.kind;
  array.order = type.order;
  std::uint64_t n_bytes = 0;
  if (__builtin_mul_overflow(count_of(array.extents, array.source, array.where), type.size, &n_bytes)) array.fail("the number of bytes does not fit 64 bits");
  const std::uint64_t version = number(layout, 1, "a layout");
  if (version < 3 || version > 4) refuse(layout, "a layout of version " + std::to_string(version));
  const auto require_size = [&](std::uint64_t size) {
    if (size != n_bytes) array.fail("found room for " + std::to_string(size) + " bytes, the extents need " + std::to_string(n_bytes));
  };
  switch (number(layout + 1, 1, "a layout")) {
    case 0: {
      const std::uint64_t size = number(layout + 2, 2, "a layout");
      if (size > layout_end - layout - 4) fail(layout, "found values that leave their message");
      require_size(size);
      array.bytes = buffer_.text().substr(layout + 4, size);
      break;
    }
    case 1: {
      const std::uint64_t begin = address_at(layout + 2, "a dataset"), size = number(layout + 10, 8, "the size of a dataset");
      require_size(size);
      if (size == 0) break;
      if (begin == k_hdf5_nowhere) array.fail("its " + std::to_string(n_bytes) + " bytes were never written");
      if (begin > buffer_.bytes.size() || size > buffer_.bytes.size() - begin)
        array.fail("its " + std::to_string(size) + " bytes from byte " + std::to_string(begin) + " leave the file of " + std::to_string(buffer_.bytes.size()) + " bytes");
      array.bytes = buffer_.text().substr(begin, size);
      break;
    }
    case 2: {
      if (version != 3) refuse(layout, "chunks with an index of HDF5 1.10");
      const std::uint64_t limit = std::max(k_expansion_floor, k_max_expansion * buffer_.bytes.size());
      if (n_bytes > limit) array.fail("its " + std::to_string(n_bytes) + " bytes are more than a file of " + std::to_string(buffer_.bytes.size()) + " bytes can hold");
      if (n_bytes > 0) read_chunks(layout, used_filters, type.size, array);
      break;
    }
    default: refuse(layout, "a virtual dataset");
  }
  return array;
}

namespace {

struct Chunk {
  std::uint64_t begin = 0, size = 0;
  std::uint64_t skipped_filters = 0;
  std::vector<std::uint64_t> place;  ///< its first element
};

}  // namespace

void Hdf5Source::read_chunks(std::uint64_t layout, const std::vector<Filter>& used_filters, std::size_t element_size, NumberArray& array) {
  const std::uint64_t rank = number(layout + 2, 1, "a layout") - 1;
  if (rank != array.extents.size()) array.fail("found chunks of " + std::to_string(rank) + " extents, expected " + std::to_string(array.extents.size()));
  std::vector<std::uint64_t> shape;
  std::uint64_t chunk_bytes = element_size, padded_bytes = element_size, n_chunks = 1;
  bool is_sound = true;
  for (std::uint64_t k = 0; k < rank; ++k) {
    shape.push_back(number(layout + 11 + 4 * k, 4, "a chunk's extent"));
    if (shape.back() == 0) array.fail("found chunks of no size");
    const std::uint64_t n = (array.extents[k] - 1) / shape.back() + 1;  // extents are not 0 here
    is_sound = is_sound && !__builtin_mul_overflow(chunk_bytes, shape.back(), &chunk_bytes) && !__builtin_mul_overflow(n_chunks, n, &n_chunks) &&
               !__builtin_mul_overflow(padded_bytes, n, &padded_bytes) && !__builtin_mul_overflow(padded_bytes, shape.back(), &padded_bytes);
  }
  if (!is_sound || padded_bytes > std::max(k_expansion_floor, k_max_expansion * buffer_.bytes.size())) array.fail("its chunks are larger than the file can hold");

  std::vector<Chunk> chunks;
  const auto collect = [&](const auto& self, std::uint64_t node, int level) -> void {
    require_signature(node, "TREE");
    const int own_level = static_cast<int>(number(node + 5, 1, "a level"));
    if (number(node + 4, 1, "a type") != 1 || (level >= 0 && own_level != level)) fail(node, "found a wrong kind or level of a B-tree's node");
    const std::uint64_t n = number(node + 6, 2, "a count"), key_size = 8 + 8 * (rank + 1);
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::uint64_t key = node + 24 + i * (key_size + 8), below = address_at(key + key_size, "a chunk");
      if (own_level > 0) {
        self(self, below, own_level - 1);
        continue;
      }
      Chunk chunk{.begin = below, .size = number(key, 4, "a chunk"), .skipped_filters = number(key + 4, 4, "a chunk"), .place = {}};
      for (std::uint64_t k = 0; k < rank; ++k) chunk.place.push_back(number(key + 8 + 8 * k, 8, "a chunk"));
      chunks.push_back(std::move(chunk));
    }
  };
  const std::uint64_t tree = address_at(layout + 3, "the chunks' B-tree");
  if (tree == k_hdf5_nowhere) array.fail("its chunks were never written");
  collect(collect, tree, -1);

  std::vector<char> values(count_of(array.extents, array.source, array.where) * element_size);
  if (chunks.size() > n_chunks) array.fail("found " + std::to_string(chunks.size()) + " chunks, its extents have " + std::to_string(n_chunks));
  std::uint64_t n_filled = 0;
  for (const Chunk& chunk : chunks) {
    const std::string_view packed = metadata(chunk.begin, chunk.size, "a chunk of " + array.where);
    std::vector<char> bytes(packed.begin(), packed.end());
    for (std::size_t f = used_filters.size(); f-- > 0;) {
      if (chunk.skipped_filters >> f & 1) continue;
      if (used_filters[f].id == k_fletcher) {
        if (bytes.size() < 4) fail(chunk.begin, "found a chunk without its checksum");
        bytes.resize(bytes.size() - 4);
      } else if (used_filters[f].id == k_shuffle) {
        unshuffle(bytes, element_size);
      } else {
        std::vector<char> unpacked(chunk_bytes + 4);  // a checksum may have been packed, too
        uLongf n = unpacked.size();
        if (::uncompress(reinterpret_cast<Bytef*>(unpacked.data()), &n, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != Z_OK) fail(chunk.begin, "the packed chunk is damaged");
        unpacked.resize(n);
        bytes = std::move(unpacked);
      }
    }
    if (bytes.size() != chunk_bytes) fail(chunk.begin, "found a chunk of " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(chunk_bytes));
    // Rows along the last extent, as far as they lie in the array.
    std::vector<std::uint64_t> at(rank, 0);
    std::uint64_t n_rows = 1;
    for (std::uint64_t k = 0; k < rank; ++k) {
      if (chunk.place[k] >= array.extents[k] || chunk.place[k] % shape[k] != 0) fail(chunk.begin, "found a chunk outside its dataset");
      if (k + 1 < rank) n_rows *= shape[k];
    }
    const std::uint64_t row = rank == 0 ? 1 : std::min(shape[rank - 1], array.extents[rank - 1] - chunk.place[rank - 1]);
    const std::uint64_t row_bytes = (rank == 0 ? 1 : shape[rank - 1]) * element_size;
    for (std::uint64_t r = 0; r < n_rows; ++r) {
      bool is_inside = true;
      std::uint64_t index = 0;
      for (std::uint64_t k = 0, rest = r, below = n_rows; k + 1 < rank; ++k) {
        below /= shape[k];
        const std::uint64_t i = chunk.place[k] + rest / below;
        rest %= below;
        is_inside = is_inside && i < array.extents[k];
        index = index * array.extents[k] + i;
      }
      if (!is_inside) continue;
      if (rank > 0) index = index * array.extents[rank - 1] + chunk.place[rank - 1];
      std::memcpy(values.data() + index * element_size, bytes.data() + r * row_bytes, row * element_size);
      n_filled += row * element_size;
    }
  }
  if (n_filled < values.size()) array.fail("chunks are missing: found " + std::to_string(n_filled) + " of " + std::to_string(values.size()) + " bytes");
  array.unpacked = std::make_shared<const std::vector<char>>(std::move(values));
  array.bytes = {array.unpacked->data(), array.unpacked->size()};
}

}  // namespace sterna::io
