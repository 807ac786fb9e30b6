// A CGNS file as a tree of nodes, read from either container (HDF5, ADF).
// Based on: CGNS SIDS File Mapping Manual (node: name, label, type, extents, data, children).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/borrowed.h"
#include "io/container/container_image.h"

namespace sterna::io {

struct CgnsNode {
  std::string path;   ///< "/Base/Zone/wall"
  std::string name;   ///< "wall"
  std::string label;  ///< "Elements_t"
  std::string type;   ///< "I4", "MT" (no data), "LK" (a link to another file)
  std::vector<CgnsNode> children;
  const ContainerNode* location = nullptr;  ///< the node in the container

  const CgnsNode* find(std::string_view name) const;
  /// Returns the first child with that label.
  const CgnsNode* find_label(std::string_view label) const;
};

/// Returns the labels of nodes that are not part of a mesh: solutions, motions, zone connectivities.
const std::vector<std::string>& cgns_labels_beside_the_mesh();

/// Readers throw Error file_malformed (path, expectation) and unsupported_format.
class CgnsTree {
 public:
  explicit CgnsTree(Borrowed<const ContainerImage> image);
  const CgnsNode& root() const { return root_; }
  /// Returns the data of a node; extents are fastest first, as in CGNS. Empty (count() == 0) for a node of type "MT".
  NumberArray data(const CgnsNode& node) const;
  [[noreturn]] void fail(const CgnsNode& node, std::string_view problem) const;
  const std::string& source() const { return image_.source(); }

 private:
  CgnsNode node_of(const ContainerNode& group) const;

  const ContainerImage& image_;
  CgnsNode root_;
};

}  // namespace sterna::io
