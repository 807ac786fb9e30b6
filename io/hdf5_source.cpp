// HDF5: superblock, object headers of both versions, attributes. Links are in hdf5_links.cpp, datasets in hdf5_data.cpp.
#include "io/hdf5_source.h"

#include <algorithm>

#include "io/hdf5_checksum.h"

namespace sterna::io {
namespace {

constexpr std::string_view k_signature = "\x89HDF\r\n\x1a\n";
/// Bytes of metadata that may be looked at, as a multiple of the file: each is looked at a few times; only loops need more.
constexpr std::uint64_t k_max_work = 32;

// Types of messages in object headers.
constexpr std::uint8_t k_link_info = 0x02;
constexpr std::uint8_t k_link = 0x06;
constexpr std::uint8_t k_layout = 0x08;
constexpr std::uint8_t k_attribute = 0x0c;
constexpr std::uint8_t k_continuation = 0x10;
constexpr std::uint8_t k_symbol_table = 0x11;
constexpr std::uint8_t k_attribute_info = 0x15;

constexpr std::uint64_t round_up(std::uint64_t n) { return (n + 7) / 8 * 8; }

}  // namespace

bool is_hdf5(std::string_view bytes) { return bytes.starts_with(k_signature); }

const Hdf5Link* Hdf5Object::find(std::string_view name) const {
  const auto found = std::find_if(links.begin(), links.end(), [&](const Hdf5Link& link) { return link.name == name; });
  return found == links.end() ? nullptr : &*found;
}

Hdf5Source::Hdf5Source(const FileBuffer& buffer) : buffer_(buffer) { read_superblock(); }

// ---- bytes

std::string_view Hdf5Source::metadata(std::uint64_t offset, std::uint64_t n, std::string_view expected) {
  const std::uint64_t size = buffer_.bytes.size();
  if (offset > size || n > size - offset) {
    throw_malformed(buffer_.source, "byte " + std::to_string(offset), "the file ends at byte " + std::to_string(size) + ", expected " + std::to_string(n) + " bytes: " + std::string(expected),
                    "the file may have been cut short: copy or write it again");
  }
  work_ += n;
  if (work_ > k_max_work * (size + 4096)) fail(offset, "the file leads to the same bytes again and again");
  return buffer_.text().substr(offset, n);
}

std::uint64_t Hdf5Source::number(std::uint64_t offset, unsigned n_bytes, std::string_view expected) {
  const std::string_view bytes = metadata(offset, n_bytes, expected);
  std::uint64_t value = 0;
  for (unsigned k = 0; k < n_bytes; ++k) value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[k])) << (8 * k);
  return value;
}

void Hdf5Source::require_signature(std::uint64_t offset, std::string_view signature) {
  const std::string_view found = metadata(offset, signature.size(), "\"" + std::string(signature) + "\"");
  if (found != signature) fail(offset, "found " + quoted_excerpt(found) + ", expected \"" + std::string(signature) + "\"");
}

void Hdf5Source::require_checksum(std::uint64_t begin, std::uint64_t end) {
  if (number(end, 4, "a checksum") != hdf5_checksum(metadata(begin, end - begin, "metadata"))) fail(begin, "the checksum of the bytes to " + std::to_string(end) + " does not fit them");
}

std::string Hdf5Source::name_at(std::uint64_t offset, std::uint64_t limit) {
  const std::uint64_t end = limit <= buffer_.bytes.size() ? buffer_.text().substr(0, limit).find('\0', offset) : std::string_view::npos;
  if (end == std::string_view::npos) fail(offset, "found a name without an end");
  return std::string(metadata(offset, end - offset, "a name"));
}

void Hdf5Source::fail(std::uint64_t offset, std::string_view problem) const { throw_malformed(buffer_.source, "byte " + std::to_string(offset), problem); }

void Hdf5Source::refuse(std::uint64_t offset, std::string_view what) const {
  throw_unsupported(buffer_.source, "byte " + std::to_string(offset) + " of the HDF5 file: " + std::string(what) + " is not read", "rewrite the file with: h5repack -f NONE -l CONTI old new");
}

// ---- objects

void Hdf5Source::read_superblock() {
  require_signature(0, k_signature);
  const std::uint64_t version = number(8, 1, "the version of the superblock");
  if (version > 3) refuse(8, "a superblock of version " + std::to_string(version));
  const std::uint64_t sizes = version < 2 ? 13 : 9;
  if (number(sizes, 1, "the size of addresses") != 8 || number(sizes + 1, 1, "the size of lengths") != 8) refuse(sizes, "an address of other than 8 bytes");
  const std::uint64_t base_at = version == 0 ? 24 : version == 1 ? 28 : 12;
  if (number(base_at, 8, "the base address") != 0) refuse(base_at, "a base address other than 0");
  const std::uint64_t end = number(base_at + 16, 8, "the end of the file");
  if (end > buffer_.bytes.size())
    throw_malformed(buffer_.source, "byte " + std::to_string(base_at + 16), "the file has " + std::to_string(buffer_.bytes.size()) + " bytes, its head says " + std::to_string(end),
                    "the file may have been cut short: copy or write it again");
  if (version >= 2) require_checksum(0, 44);
  root_ = version < 2 ? address_at(base_at + 40, "the root group") : address_at(36, "the root group");
}

std::vector<Hdf5Source::Message> Hdf5Source::messages(std::uint64_t address) {
  std::vector<Message> found;
  bool has_order = false;
  const bool is_v2 = metadata(address, 4, "an object") == "OHDR";
  if (is_v2) {
    if (number(address + 4, 1, "a version") != 2) fail(address + 4, "found an object header of an unknown version");
    const std::uint64_t flags = number(address + 5, 1, "flags");
    has_order = (flags & 4) != 0;
    const std::uint64_t size_at = address + 6 + ((flags & 0x20) ? 16 : 0) + ((flags & 0x10) ? 4 : 0);
    const unsigned size_bytes = 1u << (flags & 3);
    const std::uint64_t begin = size_at + size_bytes, size = number(size_at, size_bytes, "the size of an object header");
    metadata(begin, size, "an object header");
    require_checksum(address, begin + size);
    read_block_v2(begin, begin + size, has_order, found);
  } else {
    if (number(address, 1, "an object") != 1) fail(address, "found no object header");
    const std::uint64_t size = number(address + 8, 4, "the size of an object header");
    metadata(address + 16, size, "an object header");
    read_block_v1(address + 16, address + 16 + size, found);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {  // grows as blocks are added
    if (found[i].type != k_continuation) continue;
    const std::uint64_t begin = address_at(found[i].begin, "a further block of an object header"), size = number(found[i].begin + 8, 8, "the size of a block");
    metadata(begin, size, "a further block of an object header");
    if (is_v2) {
      require_signature(begin, "OCHK");
      if (size < 8) fail(begin, "found a block of " + std::to_string(size) + " bytes");
      require_checksum(begin, begin + size - 4);
      read_block_v2(begin + 4, begin + size - 4, has_order, found);
    } else {
      read_block_v1(begin, begin + size, found);
    }
  }
  return found;
}

void Hdf5Source::read_block_v1(std::uint64_t begin, std::uint64_t end, std::vector<Message>& found) {
  while (end - begin >= 8) {
    const std::uint64_t type = number(begin, 2, "a message"), size = number(begin + 2, 2, "a message"), flags = number(begin + 4, 1, "a message");
    if (size > end - begin - 8) fail(begin, "found a message of " + std::to_string(size) + " bytes, which leaves its header");
    if (type <= 0xff) found.push_back({static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(flags), begin + 8, begin + 8 + size});
    begin += 8 + size;
  }
}

void Hdf5Source::read_block_v2(std::uint64_t begin, std::uint64_t end, bool has_order, std::vector<Message>& found) {
  const std::uint64_t head = has_order ? 6 : 4;
  while (end - begin >= head) {  // what is less is a gap
    const std::uint64_t size = number(begin + 1, 2, "a message");
    if (size > end - begin - head) fail(begin, "found a message of " + std::to_string(size) + " bytes, which leaves its header");
    found.push_back({static_cast<std::uint8_t>(number(begin, 1, "a message")), static_cast<std::uint8_t>(number(begin + 3, 1, "a message")), begin + head, begin + head + size});
    begin += head + size;
  }
}

Hdf5Object Hdf5Source::object(std::uint64_t address, std::string path) {
  Hdf5Object object{.path = std::move(path), .address = address};
  Hdf5Links links(*this);
  for (const Message& message : messages(address)) {
    const std::uint64_t at = message.begin;
    switch (message.type) {
      case k_layout: object.is_dataset = true; break;
      case k_link: links.add_link(at, message.end, object.links); break;
      case k_symbol_table: links.add_symbol_table(address_at(at, "a B-tree"), address_at(at + 8, "a heap"), object.links); break;
      case k_attribute: read_attribute(message, object); break;
      case k_link_info: {
        const std::uint64_t heap_at = at + 2 + ((number(at + 1, 1, "flags") & 1) ? 8 : 0);
        const std::uint64_t heap = address_at(heap_at, "a heap of links");
        if (heap != k_hdf5_nowhere) links.add_dense_links(heap, address_at(heap_at + 8, "a B-tree of links"), object.links);
        break;
      }
      case k_attribute_info: {
        const std::uint64_t heap_at = at + 2 + ((number(at + 1, 1, "flags") & 1) ? 2 : 0);
        const std::uint64_t heap = address_at(heap_at, "a heap of attributes");
        if (heap == k_hdf5_nowhere) break;
        for (const Hdf5Links::Piece& piece : links.heap_objects(heap, address_at(heap_at + 8, "a B-tree of attributes"), 17, 0))
          read_attribute({.type = k_attribute, .flags = 0, .begin = piece.begin, .end = piece.end}, object);
        break;
      }
      default: break;
    }
  }
  std::stable_sort(object.links.begin(), object.links.end(), [](const Hdf5Link& a, const Hdf5Link& b) { return a.order < b.order; });
  return object;
}

Hdf5Object Hdf5Source::child(const Hdf5Object& parent, std::string_view name) {
  const std::string path = (parent.path == "/" ? "" : parent.path) + "/" + std::string(name);
  const Hdf5Link* const link = parent.find(name);
  if (!link) throw_malformed(buffer_.source, path, "there is no such group or dataset in the file");
  if (link->address == k_hdf5_nowhere) throw_unsupported(buffer_.source, path + " is a link by name, perhaps to another file", "copy the data into one file: h5copy, h5repack");
  return object(link->address, path);
}

void Hdf5Source::read_attribute(const Message& message, Hdf5Object& object) {
  const std::uint64_t at = message.begin;
  const std::uint64_t version = number(at, 1, "an attribute");
  if (version < 1 || version > 3) fail(at, "found an attribute of an unknown version");
  if (message.flags & 2) return;  // shared between objects
  if (version > 1 && (number(at + 1, 1, "flags") & 3)) return;  // of a named type, which no mesh format uses
  const std::uint64_t name_size = number(at + 2, 2, "an attribute"), type_size = number(at + 4, 2, "an attribute"), space_size = number(at + 6, 2, "an attribute");
  const auto padded = [version](std::uint64_t n) { return version == 1 ? round_up(n) : n; };
  const std::uint64_t name = at + (version == 3 ? 9 : 8), type = name + padded(name_size), space = type + padded(type_size), value = space + padded(space_size);
  if (value > message.end) fail(at, "found an attribute that leaves its message");
  const std::string text = name_at(name, name + name_size);
  const DataType data = data_type(type, type + type_size);
  if (!data.is_known && !data.is_variable_text) return;
  NumberArray array{.kind = data.kind, .order = data.order, .extents = extents(space, space + space_size), .source = buffer_.source, .where = object.path + ", attribute \"" + text + "\""};
  std::uint64_t n_bytes = 0;
  if (__builtin_mul_overflow(count_of(array.extents, array.source, array.where), data.size, &n_bytes) || n_bytes > message.end - value) fail(value, "found an attribute that leaves its message");
  array.bytes = buffer_.text().substr(value, n_bytes);
  if (data.is_variable_text) {
    if (n_bytes != data.size) return;  // lists of texts are no part of a mesh
    const std::string content = variable_text(value);
    array.unpacked = std::make_shared<const std::vector<char>>(content.begin(), content.end());
    array.bytes = {array.unpacked->data(), array.unpacked->size()};
  }
  object.attributes[text] = std::move(array);
}

}  // namespace sterna::io
