// A CGNS file as the tree of nodes that it is, in either container (HDF5, ADF): read from a loaded file, or described and written.
// Based on: CGNS SIDS File Mapping Manual (node: name, label, type, extents, data, children).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_buffer.h"
#include "io/hdf5_output.h"
#include "io/number_array.h"

namespace sterna::io {

/// Longest name of a node, in bytes.
inline constexpr std::size_t k_cgns_name = 32;

struct CgnsNode {
  std::string path;   ///< "/Base/Zone/wall"
  std::string name;   ///< "wall"
  std::string label;  ///< "Elements_t"
  std::string type;   ///< "I4", "MT" (no data), "LK" (a link to another file)
  std::vector<CgnsNode> children;
  std::uint64_t place = 0;  ///< in the container

  const CgnsNode* find(std::string_view name) const;
  /// First child with that label.
  const CgnsNode* find_label(std::string_view label) const;
};

class CgnsContainer;

/// Readers throw Error file_malformed (byte or path, expectation) and unsupported_format.
class CgnsTree {
 public:
  /// \pre `buffer` outlives the tree and its data
  explicit CgnsTree(const FileBuffer& buffer);
  ~CgnsTree();
  const CgnsNode& root() const { return root_; }
  /// Data of a node; extents fastest first, as CGNS counts them. Nothing (count() == 0) for a node of type "MT".
  NumberArray data(const CgnsNode& node) const;
  [[noreturn]] void fail(const CgnsNode& node, std::string_view problem) const;
  const std::string& source() const { return source_; }

 private:
  std::string source_;
  std::unique_ptr<CgnsContainer> container_;
  CgnsNode root_;
};

/// The container behind a tree.
class CgnsContainer {
 public:
  virtual ~CgnsContainer() = default;
  virtual CgnsNode read_root() = 0;
  virtual NumberArray data(const CgnsNode& node) = 0;
};
std::unique_ptr<CgnsContainer> open_cgns_adf(const FileBuffer& buffer);
bool is_adf(std::string_view bytes);
/// "I4" -> i4, "C1" -> text, ...; fails for what is no array of numbers.
NumberKind cgns_kind(const FileBuffer& buffer, const CgnsNode& node);

/// A node to be written. Extents of `array` are fastest first.
struct CgnsOutputNode {
  std::string name;
  std::string label;
  std::vector<CgnsOutputNode> children;
  bool has_data = false;
  OutputArray array;
};
CgnsOutputNode cgns_node(std::string name, std::string label);
CgnsOutputNode cgns_node(std::string name, std::string label, OutputArray array);

/// The file around the children of the root. \pre names are 1 to 32 bytes without '/', siblings' names differ
std::vector<OutputSection> cgns_hdf5_sections(const CgnsOutputNode& root);
std::vector<OutputSection> cgns_adf_sections(const CgnsOutputNode& root);

/// The type of CGNS ("I4", ...) for a kind of numbers. \pre kind is written by us
std::string cgns_type_of(NumberKind kind);

}  // namespace sterna::io
