// Writer of HDF5 files that are known beforehand: a tree of groups and datasets whose values are streamed, in slabs, by all threads. No times, no padding
// of chance: the same bytes each time. Based on: HDF5 File Format Specification, version 3.0; readable from HDF5 1.8 on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/number_array.h"
#include "io/section_output.h"

namespace sterna::io {

/// Values to be written: kind and extents (slowest first); the sections of `content` together give byte_size(kind) * product of extents bytes, little endian, in items of any size.
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
std::uint64_t byte_size(const OutputArray& array);

struct Hdf5OutputAttribute {
  std::string name;
  NumberKind kind = NumberKind::text;
  std::vector<std::uint64_t> extents;  ///< empty = a scalar; a text is a scalar of bytes.size()
  std::string bytes;                   ///< little endian
};
/// A text of `size` bytes, cut or filled with NUL; without a NUL at its end it is stored as one that needs none.
Hdf5OutputAttribute text_attribute(std::string name, std::string text, std::size_t size);

/// A group (no array) or a dataset.
struct Hdf5OutputNode {
  std::string name;
  std::vector<Hdf5OutputAttribute> attributes;
  std::vector<Hdf5OutputNode> children;  ///< of a group, in the order of creation
  bool is_dataset = false;
  OutputArray array;
};

/// The file as sections for write_sections. \pre names of siblings differ, attributes are below 64 kB
std::vector<OutputSection> hdf5_sections(const Hdf5OutputNode& root);

}  // namespace sterna::io
