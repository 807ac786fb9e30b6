// A container file (HDF5, NetCDF, ADF) as the tree that sterna-read-container has made of it: groups, datasets, attributes, values.
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

/// Values, or why there are none.
struct ContainerValues {
  NumberArray array;
  wire::Trouble trouble = wire::Trouble::none;
  std::string problem;
};

/// A group, a dataset, or a name of one that was not followed. A NetCDF file is a group whose datasets are the variables.
struct ContainerNode {
  std::string name;
  std::string path;  ///< "/VTKHDF/Points", for messages
  wire::Role role = wire::Role::group;
  std::vector<ContainerNode> children;  ///< in the order of the file
  std::map<std::string, ContainerValues> attributes;
  ContainerValues values;  ///< of a dataset

  const ContainerNode* find(std::string_view name) const;
  /// An attribute that has values; nullptr: none of that name.
  const NumberArray* attribute(const std::string& name) const;
};

class ContainerImage {
 public:
  /// Checks the image of a file named `source` in every respect, so that all arrays are views of `bytes`. `owner` keeps these alive.
  /// \throws Error file_malformed, unsupported_format: what the helper says of the file; also where the image is not one.
  ContainerImage(std::shared_ptr<const void> owner, std::span<const std::byte> bytes, std::string source);

  const std::string& source() const { return source_; }
  const ContainerNode& root() const { return root_; }
  /// \throws Error(file_malformed) when there is none of that name.
  const ContainerNode& child(const ContainerNode& parent, std::string_view name) const;
  /// The values of a dataset.
  /// \throws Error file_malformed, unsupported_format where they are not to be had
  NumberArray data(const ContainerNode& dataset) const;

 private:
  std::shared_ptr<const void> owner_;
  std::string source_;
  ContainerNode root_;
};

}  // namespace sterna::io
