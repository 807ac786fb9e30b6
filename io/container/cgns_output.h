// A CGNS file to be written: described as the tree of nodes that it is, its arrays streamed, in either container (HDF5, ADF).
// Based on: CGNS SIDS File Mapping Manual (node: name, label, type, extents, data, children).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "io/output/output_array.h"

namespace sterna::io {

/// Longest name of a node, in bytes.
inline constexpr std::size_t k_cgns_name = 32;

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

/// Writes the file around the children of the root, by libhdf5 (so that sizes have 64 bits), or as ADF by libcgns, whose sizes have 32 bits. Whole or not at
/// all, the same bytes each time.
/// \pre names are 1 to 32 bytes without '/', siblings' names differ; for ADF extents are below 2^31
/// \throws Error write_failed; what the arrays throw; cancelled
void write_cgns_hdf5(const CgnsOutputNode& root, const std::filesystem::path& path, const RunContext& context);
void write_cgns_adf(const CgnsOutputNode& root, const std::filesystem::path& path, const RunContext& context);

/// The type of CGNS ("I4", ...) for a kind of numbers.
/// \pre kind is written by us
std::string cgns_type_of(NumberKind kind);

}  // namespace sterna::io
