// Output of CGNS files, described as a tree of nodes. Arrays are streamed. Both containers (HDF5, ADF) are supported.
// Based on: CGNS SIDS File Mapping Manual (node: name, label, type, extents, data, children).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "io/output/output_array.h"

namespace sterna::io {

/// Maximum length of a node name, in bytes.
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

/// Writes the file around the children of the root: with libhdf5 (64-bit sizes), or as ADF with libcgns (32-bit sizes). The file is written completely or not
/// at all; the output is reproducible byte by byte.
/// \pre names are 1 to 32 bytes without '/', siblings' names differ; for ADF extents are below 2^31
/// \throws Error write_failed; errors of the arrays; cancelled
void write_cgns_hdf5(const CgnsOutputNode& root, const std::filesystem::path& path, const RunContext& context);
void write_cgns_adf(const CgnsOutputNode& root, const std::filesystem::path& path, const RunContext& context);

/// Returns the CGNS data type ("I4", ...) of a kind of numbers.
/// \pre kind is one that sterna writes
std::string cgns_type_of(NumberKind kind);

}  // namespace sterna::io
