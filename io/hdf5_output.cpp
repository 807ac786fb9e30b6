// The file: superblock, all object headers, then the datasets' values, each on a multiple of 8 bytes.
#include "io/hdf5_output.h"

#include <functional>

#include "io/hdf5_checksum.h"

namespace sterna::io {
namespace {

constexpr std::uint64_t k_superblock = 48;
constexpr std::uint64_t k_nowhere = ~std::uint64_t{0};
/// Links that the header of a group may hold before a library that adds some moves them into a heap.
constexpr std::uint16_t k_max_compact_links = 0xffff;

void put(std::string& bytes, std::uint64_t value, unsigned n_bytes) {
  for (unsigned k = 0; k < n_bytes; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xff);
}

std::string type_message(NumberKind kind, std::uint64_t text_size, bool ends_with_nul = true) {
  std::string bytes;
  const std::uint64_t size = kind == NumberKind::text ? text_size : byte_size(kind);
  if (kind == NumberKind::text) {
    put(bytes, 0x13, 1);
    put(bytes, ends_with_nul ? 0 : 1, 3);  // ASCII (bytes of UTF-8 pass)
    put(bytes, size, 4);
  } else if (is_real(kind)) {
    const bool is_double = kind == NumberKind::f8;
    put(bytes, 0x11, 1);
    put(bytes, 0x20, 1);  // little endian, highest bit of the mantissa not stored
    put(bytes, 8 * size - 1, 1);
    put(bytes, 0, 1);
    put(bytes, size, 4);
    put(bytes, 0, 2);
    put(bytes, 8 * size, 2);
    put(bytes, is_double ? 52 : 23, 1);
    put(bytes, is_double ? 11 : 8, 1);
    put(bytes, 0, 1);
    put(bytes, is_double ? 52 : 23, 1);
    put(bytes, is_double ? 1023 : 127, 4);
  } else {
    const bool is_signed = kind == NumberKind::i1 || kind == NumberKind::i2 || kind == NumberKind::i4 || kind == NumberKind::i8;
    put(bytes, 0x10, 1);
    put(bytes, is_signed ? 0x08 : 0, 3);
    put(bytes, size, 4);
    put(bytes, 0, 2);
    put(bytes, 8 * size, 2);
  }
  return bytes;
}

std::string space_message(const std::vector<std::uint64_t>& extents) {
  std::string bytes;
  put(bytes, 2, 1);
  put(bytes, extents.size(), 1);
  put(bytes, 0, 1);
  put(bytes, extents.empty() ? 0 : 1, 1);
  for (const std::uint64_t extent : extents) put(bytes, extent, 8);
  return bytes;
}

std::string attribute_message(const Hdf5OutputAttribute& attribute) {
  const std::string type = type_message(attribute.kind, attribute.bytes.size(), attribute.bytes.ends_with('\0')), space = space_message(attribute.extents);
  std::string bytes;
  put(bytes, 3, 1);
  put(bytes, 0, 1);
  put(bytes, attribute.name.size() + 1, 2);
  put(bytes, type.size(), 2);
  put(bytes, space.size(), 2);
  put(bytes, 0, 1);
  bytes += attribute.name;
  bytes += '\0';
  return bytes + type + space + attribute.bytes;
}

std::string link_message(const std::string& name, std::uint64_t order, std::uint64_t address) {
  std::string bytes;
  const unsigned size_bytes = name.size() < 256 ? 1 : 2;
  put(bytes, 1, 1);
  put(bytes, 4 | (size_bytes - 1), 1);  // order of creation given
  put(bytes, order, 8);
  put(bytes, name.size(), size_bytes);
  bytes += name;
  put(bytes, address, 8);
  return bytes;
}

/// One node with the places that are found before anything is written.
struct PlacedNode {
  const Hdf5OutputNode* node = nullptr;
  std::vector<std::size_t> children;
  std::uint64_t header = 0;
  std::uint64_t values = 0;
};

class Hdf5Layout {
 public:
  explicit Hdf5Layout(const Hdf5OutputNode& root) {
    add(root);
    std::uint64_t end = k_superblock;
    for (PlacedNode& placed : nodes_) {  // sizes do not depend on places
      placed.header = end;
      end += header_of(placed).size();
    }
    for (PlacedNode& placed : nodes_) {
      if (!placed.node->is_dataset) continue;
      end = (end + 7) / 8 * 8;
      placed.values = end;
      end += byte_size(placed.node->array);
    }
    file_end_ = end;
  }

  std::vector<OutputSection> sections() const {
    std::string head = superblock();
    for (const PlacedNode& placed : nodes_) head += header_of(placed);
    std::uint64_t end = head.size();
    std::vector<OutputSection> sections{fixed_section(std::move(head))};
    for (const PlacedNode& placed : nodes_) {
      if (!placed.node->is_dataset) continue;
      if (placed.values > end) sections.push_back(fixed_section(std::string(placed.values - end, '\0')));
      sections.insert(sections.end(), placed.node->array.content.begin(), placed.node->array.content.end());
      end = placed.values + byte_size(placed.node->array);
    }
    return sections;
  }

 private:
  std::size_t add(const Hdf5OutputNode& node) {
    const std::size_t own = nodes_.size();
    nodes_.push_back({.node = &node});
    for (const Hdf5OutputNode& child : node.children) {
      const std::size_t place = add(child);
      nodes_[own].children.push_back(place);
    }
    return own;
  }

  std::string superblock() const {
    std::string bytes = "\x89HDF\r\n\x1a\n";
    put(bytes, 2, 1);
    put(bytes, 8, 1);
    put(bytes, 8, 1);
    put(bytes, 0, 1);
    put(bytes, 0, 8);
    put(bytes, k_nowhere, 8);
    put(bytes, file_end_, 8);
    put(bytes, nodes_.front().header, 8);
    put(bytes, hdf5_checksum(bytes), 4);
    return bytes;
  }

  std::string header_of(const PlacedNode& placed) const {
    std::string messages;
    const auto add_message = [&](std::uint8_t type, const std::string& content, std::uint8_t flags = 0) {
      put(messages, type, 1);
      put(messages, content.size(), 2);
      put(messages, flags, 1);
      messages += content;
    };
    std::string content;
    if (placed.node->is_dataset) {
      const OutputArray& array = placed.node->array;
      add_message(0x01, space_message(array.extents));
      add_message(0x03, type_message(array.kind, 1), 1);  // 1: never changes
      add_message(0x05, "\x03\x09", 1);                   // space allocated early, filled where a value is set (none is)
      put(content, 3, 1);
      put(content, 1, 1);
      put(content, byte_size(array) == 0 ? k_nowhere : placed.values, 8);
      put(content, byte_size(array), 8);
      add_message(0x08, content);
    } else {
      put(content, 0, 1);
      put(content, 3, 1);  // the order of creation is kept and indexed: CGNS lists children by it
      put(content, placed.children.size(), 8);
      for (int k = 0; k < 3; ++k) put(content, k_nowhere, 8);
      add_message(0x02, content);
      content.clear();
      put(content, 0, 1);
      put(content, 1, 1);
      put(content, k_max_compact_links, 2);
      put(content, 0, 2);
      add_message(0x0a, content, 1);
      for (std::size_t i = 0; i < placed.children.size(); ++i) {
        const PlacedNode& child = nodes_[placed.children[i]];
        add_message(0x06, link_message(child.node->name, i, child.header));
      }
    }
    for (const Hdf5OutputAttribute& attribute : placed.node->attributes) add_message(0x0c, attribute_message(attribute));
    std::string bytes = "OHDR";
    put(bytes, 2, 1);
    put(bytes, 2, 1);  // the size has 4 bytes; no times
    put(bytes, messages.size(), 4);
    bytes += messages;
    put(bytes, hdf5_checksum(bytes), 4);
    return bytes;
  }

  std::vector<PlacedNode> nodes_;
  std::uint64_t file_end_ = 0;
};

}  // namespace

OutputArray output_text(std::string text, NumberKind kind) { return {.kind = kind, .extents = {text.size()}, .content = {fixed_section(std::move(text))}}; }

std::uint64_t byte_size(const OutputArray& array) {
  std::uint64_t n = byte_size(array.kind);
  for (const std::uint64_t extent : array.extents) n *= extent;
  return n;
}

Hdf5OutputAttribute text_attribute(std::string name, std::string text, std::size_t size) {
  text.resize(size, '\0');
  return {.name = std::move(name), .kind = NumberKind::text, .extents = {}, .bytes = std::move(text)};
}

std::vector<OutputSection> hdf5_sections(const Hdf5OutputNode& root) { return Hdf5Layout(root).sections(); }

}  // namespace sterna::io
