// Writer of HDF5 files with libhdf5: a tree of groups and datasets whose values are streamed. Contains no time stamps, so that the output is reproducible.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "io/output/output_array.h"

namespace sterna::io {

struct Hdf5OutputAttribute {
  std::string name;
  NumberKind kind = NumberKind::text;
  std::vector<std::uint64_t> extents;  ///< empty for a scalar; a string is a scalar of bytes.size() bytes
  std::string bytes;                   ///< little endian
};
/// Returns a string attribute of `size` bytes, truncated or padded with NUL. If no NUL is left at the end, the string type is one that needs no terminator.
Hdf5OutputAttribute text_attribute(std::string name, std::string text, std::size_t size);

/// A group (no array) or a dataset.
struct Hdf5OutputNode {
  std::string name;
  std::vector<Hdf5OutputAttribute> attributes;
  std::vector<Hdf5OutputNode> children;  ///< children of a group, in creation order, which the file keeps
  bool is_dataset = false;
  OutputArray array;
};

/// Writes the file under `root`, completely or not at all. It is readable from HDF5 1.8 on.
/// \pre names of siblings differ, attributes are below 64 kB
/// \throws Error write_failed; errors of the arrays; cancelled
void write_hdf5(const Hdf5OutputNode& root, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
