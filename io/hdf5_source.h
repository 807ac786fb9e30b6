// Strict reader of HDF5 files over a loaded file: groups of either style, attributes, datasets of numbers and text.
// Own code rather than the library's, because a damaged file must give a message with its byte and never a crash or a large allocation.
// Based on: HDF5 File Format Specification, version 3.0.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_buffer.h"
#include "io/number_array.h"

namespace sterna::io {

bool is_hdf5(std::string_view bytes);

struct Hdf5Link {
  std::string name;
  std::uint64_t address = 0;  ///< of the object; k_hdf5_nowhere = a soft or external link
  std::uint64_t order = 0;    ///< of creation, where the file tracks it
};
inline constexpr std::uint64_t k_hdf5_nowhere = ~std::uint64_t{0};

/// A group or a dataset.
struct Hdf5Object {
  std::string path;                               ///< "/VTKHDF/Points", for messages
  std::vector<Hdf5Link> links;                    ///< in order of creation, else of name
  std::map<std::string, NumberArray> attributes;  ///< those of numbers or text; others are left out
  std::uint64_t address = 0;
  bool is_dataset = false;

  const Hdf5Link* find(std::string_view name) const;
};

/// Every function throws Error file_malformed (byte offset, expectation) or unsupported_format (what this reader leaves to the library).
/// Work is bounded by a multiple of the file's size, whatever the file says.
class Hdf5Source {
 public:
  /// \pre `buffer` outlives the source and the arrays.
  explicit Hdf5Source(const FileBuffer& buffer);

  Hdf5Object root() { return object(root_, "/"); }
  Hdf5Object object(std::uint64_t address, std::string path);
  /// The object a link of `parent` leads to. \throws Error(file_malformed) when there is none of that name.
  Hdf5Object child(const Hdf5Object& parent, std::string_view name);
  /// The values of a dataset; a view of the file where they lie in one piece. \pre is_dataset
  NumberArray data(const Hdf5Object& dataset);

 private:
  friend class Hdf5Links;
  struct Message {
    std::uint8_t type = 0;
    std::uint8_t flags = 0;
    std::uint64_t begin = 0, end = 0;
  };
  struct DataType {
    NumberKind kind = NumberKind::i4;
    std::endian order = std::endian::little;
    std::uint64_t size = 0;        ///< bytes of an element; of a text its length
    bool is_known = false;         ///< a kind of ours
    bool is_variable_text = false;
  };
  struct Filter {
    unsigned id = 0;
    bool is_optional = false;
  };

  // Bytes. Each access to metadata counts against the bound of work.
  std::string_view metadata(std::uint64_t offset, std::uint64_t n, std::string_view expected);
  std::uint64_t number(std::uint64_t offset, unsigned n_bytes, std::string_view expected);
  std::uint64_t address_at(std::uint64_t offset, std::string_view expected) { return number(offset, 8, expected); }
  void require_signature(std::uint64_t offset, std::string_view signature);
  void require_checksum(std::uint64_t begin, std::uint64_t end);
  std::string name_at(std::uint64_t offset, std::uint64_t limit);
  [[noreturn]] void fail(std::uint64_t offset, std::string_view problem) const;
  [[noreturn]] void refuse(std::uint64_t offset, std::string_view what) const;

  // Objects.
  void read_superblock();
  std::vector<Message> messages(std::uint64_t address);
  void read_block_v1(std::uint64_t begin, std::uint64_t end, std::vector<Message>& found);
  void read_block_v2(std::uint64_t begin, std::uint64_t end, bool has_order, std::vector<Message>& found);
  void read_attribute(const Message& message, Hdf5Object& object);

  // Data.
  DataType data_type(std::uint64_t begin, std::uint64_t end);
  std::vector<std::uint64_t> extents(std::uint64_t begin, std::uint64_t end);
  std::vector<Filter> filters(const Message& message);
  std::string variable_text(std::uint64_t reference);
  void read_chunks(std::uint64_t layout, const std::vector<Filter>& filters, std::size_t element_size, NumberArray& array);

  const FileBuffer& buffer_;
  std::uint64_t root_ = 0;
  std::uint64_t work_ = 0;  ///< bytes of metadata looked at
};

/// The links of a group and the messages of attributes kept apart from their object: symbol tables, fractal heaps, B-trees.
class Hdf5Links {
 public:
  explicit Hdf5Links(Hdf5Source& source) : source_(source) {}
  void add_symbol_table(std::uint64_t tree, std::uint64_t heap, std::vector<Hdf5Link>& links);
  void add_link(std::uint64_t begin, std::uint64_t end, std::vector<Hdf5Link>& links);
  void add_dense_links(std::uint64_t heap, std::uint64_t tree, std::vector<Hdf5Link>& links);

  struct Piece {
    std::uint64_t begin = 0, end = 0;
  };
  /// Where the objects of a heap lie that a B-tree of version 2 lists; records of `record_size` bytes with the heap's id at `id_at`.
  std::vector<Piece> heap_objects(std::uint64_t heap, std::uint64_t tree, std::uint64_t record_size, std::uint64_t id_at);

 private:
  struct Heap {
    std::uint64_t width = 0, first_block = 0, largest_direct = 0, root = 0, root_rows = 0;
    unsigned offset_bytes = 0, length_bytes = 0;
    bool has_checksums = false;
    std::uint64_t size_of_row(std::uint64_t row) const { return row < 2 ? first_block : first_block << (row - 1); }
  };
  void add_symbols(std::uint64_t node, int level, std::uint64_t names, std::uint64_t names_end, std::vector<Hdf5Link>& links);
  Heap read_heap(std::uint64_t address);
  std::uint64_t place_in(const Heap& heap, std::uint64_t offset);
  void add_records(std::uint64_t node, unsigned depth, std::uint64_t n, std::uint64_t record_size, std::uint64_t node_size, std::vector<std::uint64_t>& records);

  Hdf5Source& source_;
};

}  // namespace sterna::io
