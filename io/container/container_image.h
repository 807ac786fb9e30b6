// A container file (HDF5, NetCDF, ADF) as the tree that sterna-read-container returns: groups, datasets, attributes, values.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/container/container_wire.h"
#include "io/container/number_array.h"

namespace sterna::io {

/// Values, or the reason why they are missing.
struct ContainerValues {
  NumberArray array;
  wire::Trouble trouble = wire::Trouble::none;
  std::string problem;
};

/// A group, a dataset, or a link that was not followed. A NetCDF file is a group whose datasets are the variables.
struct ContainerNode {
  std::string name;
  std::string path;  ///< "/VTKHDF/Points", for messages
  wire::Role role = wire::Role::group;
  std::vector<ContainerNode> children;  ///< in the order of the file
  std::map<std::string, ContainerValues> attributes;
  ContainerValues values;  ///< values, if a dataset

  const ContainerNode* find(std::string_view name) const;
  /// Returns an attribute that has values; nullptr if there is no attribute of that name.
  const NumberArray* attribute(const std::string& name) const;
};

class ContainerImage {
 public:
  /// Checks the image of a file named `source` completely, so that all arrays are views of `bytes`. `owner` keeps the bytes alive.
  /// \throws Error file_malformed, unsupported_format for errors that the helper reports, and if `bytes` is not an image.
  ContainerImage(std::shared_ptr<const void> owner, std::span<const std::byte> bytes, std::string source);

  const std::string& source() const { return source_; }
  const ContainerNode& root() const { return root_; }
  /// \throws Error(file_malformed) if there is no child of that name.
  const ContainerNode& child(const ContainerNode& parent, std::string_view name) const;
  /// Returns the values of a dataset.
  /// \throws Error file_malformed, unsupported_format if they could not be read
  NumberArray data(const ContainerNode& dataset) const;

 private:
  std::shared_ptr<const void> owner_;
  std::string source_;
  ContainerNode root_;
};

}  // namespace sterna::io
