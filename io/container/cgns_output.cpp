// In HDF5 a node is a group with the attributes name, label, type and flags. Its values are a dataset " data" with the extents reversed.
#include "io/container/cgns_output.h"

#include <algorithm>

#include "io/container/hdf5_output.h"

namespace sterna::io {
namespace {

constexpr std::string_view k_data_node = " data";

Hdf5OutputNode hdf5_node(const CgnsOutputNode& node) {
  Hdf5OutputNode group{.name = node.name};
  group.attributes.push_back(text_attribute("name", node.name, k_cgns_name + 1));
  group.attributes.push_back(text_attribute("label", node.label, k_cgns_name + 1));
  group.attributes.push_back(text_attribute("type", node.has_data ? cgns_type_of(node.array.kind) : "MT", 3));
  group.attributes.push_back({.name = "flags", .kind = NumberKind::i4, .extents = {1}, .bytes = std::string("\1\0\0\0", 4)});  // 1: the extents are reversed
  if (node.has_data) {
    Hdf5OutputNode data{.name = std::string(k_data_node), .is_dataset = true, .array = node.array};
    std::reverse(data.array.extents.begin(), data.array.extents.end());
    group.children.push_back(std::move(data));
  }
  for (const CgnsOutputNode& child : node.children) group.children.push_back(hdf5_node(child));
  return group;
}

}  // namespace

std::string cgns_type_of(NumberKind kind) {
  switch (kind) {
    case NumberKind::i4: return "I4";
    case NumberKind::i8: return "I8";
    case NumberKind::f4: return "R4";
    case NumberKind::f8: return "R8";
    default: return "C1";
  }
}

CgnsOutputNode cgns_node(std::string name, std::string label) { return {.name = std::move(name), .label = std::move(label), .children = {}, .array = {}}; }
CgnsOutputNode cgns_node(std::string name, std::string label, OutputArray array) {
  return {.name = std::move(name), .label = std::move(label), .children = {}, .has_data = true, .array = std::move(array)};
}

void write_cgns_hdf5(const CgnsOutputNode& root, const std::filesystem::path& path, const RunContext& context) {
  Hdf5OutputNode file = hdf5_node(root);
  file.attributes = {text_attribute("name", "HDF5 MotherNode", k_cgns_name + 1), text_attribute("label", "Root Node of HDF5 File", k_cgns_name + 1),
                     text_attribute("type", "MT", 3)};
  // Entries that the CGNS library writes to every file: the byte order of its numbers, and the HDF5 version.
  std::string version = "HDF5 file format, sterna";
  version.resize(k_cgns_name + 1, '\0');
  file.children.insert(file.children.begin(), {{.name = " format", .is_dataset = true, .array = output_text(std::string("IEEE_LITTLE_32", 15))},
                                               {.name = " hdf5version", .is_dataset = true, .array = output_text(std::move(version))}});
  write_hdf5(file, path, context);
}

}  // namespace sterna::io
