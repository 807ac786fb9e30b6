// HDF5: names of a group's children. Old groups: B-tree of version 1 over symbol nodes, names in a local heap. New groups: link messages in the header, or in a
// fractal heap that a B-tree of version 2 lists; the same for attributes.
#include <algorithm>
#include <bit>

#include "io/hdf5_source.h"

namespace sterna::io {
namespace {

/// Bytes that hold numbers up to `limit`.
unsigned bytes_for(std::uint64_t limit) { return (static_cast<unsigned>(std::bit_width(limit)) + 7) / 8; }

}  // namespace

void Hdf5Links::add_symbol_table(std::uint64_t tree, std::uint64_t heap, std::vector<Hdf5Link>& links) {
  source_.require_signature(heap, "HEAP");
  const std::uint64_t size = source_.number(heap + 8, 8, "the size of a heap"), names = source_.address_at(heap + 24, "a heap of names");
  if (size > source_.buffer_.bytes.size() || names > source_.buffer_.bytes.size() - size) source_.fail(heap, "found a heap of " + std::to_string(size) + " bytes, more than the file has");
  add_symbols(tree, -1, names, names + size, links);
}

void Hdf5Links::add_symbols(std::uint64_t node, int level, std::uint64_t names, std::uint64_t names_end, std::vector<Hdf5Link>& links) {
  source_.require_signature(node, "TREE");
  const int own_level = static_cast<int>(source_.number(node + 5, 1, "a level"));
  if (source_.number(node + 4, 1, "a type") != 0 || (level >= 0 && own_level != level)) source_.fail(node, "found a wrong kind or level of a B-tree's node");
  const std::uint64_t n = source_.number(node + 6, 2, "a count");
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::uint64_t below = source_.address_at(node + 24 + 16 * i + 8, "a node of a B-tree");
    if (own_level > 0) {
      add_symbols(below, own_level - 1, names, names_end, links);
      continue;
    }
    source_.require_signature(below, "SNOD");
    const std::uint64_t n_symbols = source_.number(below + 6, 2, "a count of names");
    for (std::uint64_t k = 0; k < n_symbols; ++k) {
      const std::uint64_t at = below + 8 + 40 * k, name = source_.number(at, 8, "the place of a name");
      if (name >= names_end - names) source_.fail(at, "found a name outside its heap");
      const bool is_soft = source_.number(at + 16, 4, "the kind of an entry") == 2;
      links.push_back({.name = source_.name_at(names + name, names_end), .address = is_soft ? k_hdf5_nowhere : source_.address_at(at + 8, "an object"), .order = 0});
    }
  }
}

void Hdf5Links::add_link(std::uint64_t begin, std::uint64_t end, std::vector<Hdf5Link>& links) {
  if (source_.number(begin, 1, "a link") != 1) source_.fail(begin, "found a link of an unknown version");
  const std::uint64_t flags = source_.number(begin + 1, 1, "a link");
  Hdf5Link link;
  std::uint64_t at = begin + 2;
  const bool is_hard = !(flags & 8) || source_.number(at, 1, "a link") == 0;
  if (flags & 8) ++at;
  if (flags & 4) {
    link.order = source_.number(at, 8, "a link");
    at += 8;
  }
  if (flags & 16) ++at;  // ASCII or UTF-8
  const unsigned size_bytes = 1u << (flags & 3);
  const std::uint64_t size = source_.number(at, size_bytes, "the length of a name");
  at += size_bytes;
  if (at > end || size > end - at) source_.fail(begin, "found a name of " + std::to_string(size) + " bytes, which leaves its link");
  link.name = std::string(source_.metadata(at, size, "a name"));
  if (is_hard && end - at - size < 8) source_.fail(begin, "found a link without an address");
  link.address = is_hard ? source_.address_at(at + size, "an object") : k_hdf5_nowhere;
  links.push_back(std::move(link));
}

void Hdf5Links::add_dense_links(std::uint64_t heap, std::uint64_t tree, std::vector<Hdf5Link>& links) {
  for (const Piece& piece : heap_objects(heap, tree, 11, 4)) add_link(piece.begin, piece.end, links);
}

// ---- fractal heap

Hdf5Links::Heap Hdf5Links::read_heap(std::uint64_t address) {
  source_.require_signature(address, "FRHP");
  constexpr std::uint64_t k_size = 142;  // without filters
  if (source_.number(address + 7, 2, "the filters of a heap") != 0) source_.refuse(address, "a packed heap");
  source_.require_checksum(address, address + k_size);
  Heap heap;
  heap.has_checksums = (source_.number(address + 9, 1, "flags") & 2) != 0;
  heap.width = source_.number(address + 110, 2, "the width of a heap");
  heap.first_block = source_.number(address + 112, 8, "the size of a heap's block");
  heap.largest_direct = source_.number(address + 120, 8, "the size of a heap's block");
  const std::uint64_t bits = source_.number(address + 128, 2, "the size of a heap");
  heap.root = source_.address_at(address + 132, "a heap's first block");
  heap.root_rows = source_.number(address + 140, 2, "a heap's rows");
  const bool is_sound = heap.width > 0 && std::has_single_bit(heap.first_block) && std::has_single_bit(heap.largest_direct) && heap.largest_direct >= heap.first_block && bits > 0 && bits <= 64 &&
                        heap.root_rows < 64 && heap.largest_direct < (std::uint64_t{1} << 40);
  if (!is_sound) source_.fail(address, "found a heap of impossible sizes");
  heap.offset_bytes = static_cast<unsigned>((bits + 7) / 8);
  heap.length_bytes = std::min(bytes_for(heap.largest_direct), bytes_for(source_.number(address + 10, 4, "the largest object of a heap")));
  return heap;
}

std::uint64_t Hdf5Links::place_in(const Heap& heap, std::uint64_t offset) {
  std::uint64_t block = heap.root, n_rows = heap.root_rows;
  std::uint64_t within = offset;
  while (n_rows > 0) {  // an indirect block: rows of `width` blocks, each row twice as large as the one before
    source_.require_signature(block, "FHIB");
    std::uint64_t row = 0, row_begin = 0;
    while (row < n_rows && within - row_begin >= heap.width * heap.size_of_row(row)) row_begin += heap.width * heap.size_of_row(row++);
    if (row == n_rows) source_.fail(block, "a heap's object lies outside its heap");
    const std::uint64_t size = heap.size_of_row(row), column = (within - row_begin) / size;
    const std::uint64_t entry = block + 13 + heap.offset_bytes + 8 * (row * heap.width + column);  // no filters: addresses only
    block = source_.address_at(entry, "a block of a heap");
    within -= row_begin + column * size;
    n_rows = size <= heap.largest_direct ? 0 : static_cast<std::uint64_t>(std::bit_width(size / (heap.first_block * heap.width)));
    if (n_rows >= 64) source_.fail(entry, "found a heap of impossible sizes");
  }
  source_.require_signature(block, "FHDB");
  if (within > source_.buffer_.bytes.size()) source_.fail(block, "a heap's object lies outside the file");
  return block + within;
}

std::vector<Hdf5Links::Piece> Hdf5Links::heap_objects(std::uint64_t heap_address, std::uint64_t tree, std::uint64_t record_size, std::uint64_t id_at) {
  const Heap heap = read_heap(heap_address);
  source_.require_signature(tree, "BTHD");
  source_.require_checksum(tree, tree + 34);
  const std::uint64_t node_size = source_.number(tree + 6, 4, "the size of a node"), found_size = source_.number(tree + 10, 2, "the size of a record");
  const unsigned depth = static_cast<unsigned>(source_.number(tree + 12, 2, "a depth"));
  if (found_size != record_size || node_size < 10 + record_size || depth > 16) source_.fail(tree, "found a B-tree of impossible sizes");
  const std::uint64_t root = source_.address_at(tree + 16, "a B-tree's root"), n = source_.number(tree + 24, 2, "a count of records");
  std::vector<std::uint64_t> records;
  if (n > 0) add_records(root, depth, n, record_size, node_size, records);
  std::vector<Piece> pieces;
  for (const std::uint64_t record : records) {
    const std::uint64_t id = record + id_at;
    if ((source_.number(id, 1, "a heap's id") & 0x30) != 0) source_.refuse(id, "a link or attribute of more than 64 kB");
    const std::uint64_t offset = source_.number(id + 1, heap.offset_bytes, "a heap's id"), size = source_.number(id + 1 + heap.offset_bytes, heap.length_bytes, "a heap's id");
    const std::uint64_t begin = place_in(heap, offset);
    source_.metadata(begin, size, "an object of a heap");
    pieces.push_back({begin, begin + size});
  }
  return pieces;
}

void Hdf5Links::add_records(std::uint64_t node, unsigned depth, std::uint64_t n, std::uint64_t record_size, std::uint64_t node_size, std::vector<std::uint64_t>& records) {
  source_.require_signature(node, depth == 0 ? "BTLF" : "BTIN");
  // Records a node of each level holds at most, and the bytes that count them: as the library derives them.
  const std::uint64_t in_leaf = (node_size - 10) / record_size;
  const unsigned count_bytes = bytes_for(in_leaf);
  std::uint64_t below = in_leaf;  // in the tree under a child
  unsigned total_bytes = 0;
  for (unsigned level = 1; level < depth; ++level) {
    const std::uint64_t pointer = 8 + count_bytes + total_bytes;
    const std::uint64_t in_node = (node_size - 10 - pointer) / (record_size + pointer);
    if (__builtin_mul_overflow(in_node + 1, below, &below) || __builtin_add_overflow(below, in_node, &below)) source_.fail(node, "found a B-tree of impossible sizes");
    total_bytes = bytes_for(below);
  }
  if (n > in_leaf) source_.fail(node, "found a node of " + std::to_string(n) + " records, at most " + std::to_string(in_leaf) + " have room");
  const std::uint64_t first = node + 6;
  const std::uint64_t pointers = first + n * record_size, pointer_size = 8 + count_bytes + total_bytes;
  source_.metadata(first, n * record_size, "the records of a B-tree");
  for (std::uint64_t i = 0; i <= n; ++i) {
    if (depth > 0) {
      const std::uint64_t at = pointers + i * pointer_size;
      add_records(source_.address_at(at, "a node of a B-tree"), depth - 1, source_.number(at + 8, count_bytes, "a count of records"), record_size, node_size, records);
    }
    if (i < n) records.push_back(first + i * record_size);
  }
}

}  // namespace sterna::io
