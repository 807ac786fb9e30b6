// In HDF5 a CGNS node is a group with the attributes name, label, type and flags. Its values are in a dataset " data" with the extents reversed. adf_nodes.cpp
// maps ADF to the same structure.
#include "io/container/cgns_tree.h"

#include <algorithm>
#include <map>

#include "io/input/file_buffer.h"

namespace sterna::io {
namespace {

constexpr std::string_view k_data = " data";
constexpr std::string_view k_link_hint = "join the files first: cgnscompress or cgnsconvert -l";

NumberKind kind_of(const CgnsNode& node, const std::string& source) {
  static const std::map<std::string, NumberKind, std::less<>> k_kinds = {{"I4", NumberKind::i4},   {"I8", NumberKind::i8}, {"U4", NumberKind::u4},
                                                                         {"U8", NumberKind::u8},   {"R4", NumberKind::f4}, {"R8", NumberKind::f8},
                                                                         {"C1", NumberKind::text}, {"B1", NumberKind::u1}};
  const auto found = k_kinds.find(node.type);
  if (found == k_kinds.end())
    throw_malformed(source, node.path, "found data of the type " + quoted_excerpt(node.type) + ", expected I4, I8, U4, U8, R4, R8, C1 or B1");
  return found->second;
}

}  // namespace

const CgnsNode* CgnsNode::find(std::string_view expected) const {
  const auto found = std::find_if(children.begin(), children.end(), [&](const CgnsNode& child) { return child.name == expected; });
  return found == children.end() ? nullptr : &*found;
}

const CgnsNode* CgnsNode::find_label(std::string_view expected) const {
  const auto found = std::find_if(children.begin(), children.end(), [&](const CgnsNode& child) { return child.label == expected; });
  return found == children.end() ? nullptr : &*found;
}

const std::vector<std::string>& cgns_labels_beside_the_mesh() {
  static const std::vector<std::string> k_labels = {"FlowSolution_t",         "DiscreteData_t",      "ConvergenceHistory_t",  "IntegralData_t",
                                                    "BaseIterativeData_t",    "ZoneIterativeData_t", "ArbitraryGridMotion_t", "RigidGridMotion_t",
                                                    "ZoneGridConnectivity_t", "ZoneSubRegion_t",     "FlowEquationSet_t",     "ReferenceState_t",
                                                    "UserDefinedData_t",      "ParticleZone_t",      "ParticleSolution_t"};
  return k_labels;
}

CgnsTree::CgnsTree(Borrowed<const ContainerImage> image) : image_(image), root_(node_of(image->root())) {}

CgnsNode CgnsTree::node_of(const ContainerNode& group) const {
  CgnsNode node{.path = group.path, .name = group.name, .location = &group};
  const auto text_of = [&](const char* attribute) {
    const NumberArray* const found = group.attribute(attribute);
    if (!found || found->kind != NumberKind::text)
      throw_malformed(source(), group.path, std::string("found no attribute \"") + attribute + "\": this HDF5 file is not CGNS");
    return found->text();
  };
  node.label = text_of("label");
  node.type = text_of("type");
  for (const ContainerNode& child : group.children) {
    if (child.name.starts_with(' ') || child.role == wire::Role::left_out) continue;  // data and marks of the container
    if (child.role == wire::Role::link) throw_unsupported(source(), child.path + " is a link to another node or file", k_link_hint);
    if (child.role == wire::Role::dataset) throw_malformed(source(), child.path, "found a dataset that is not a node: this HDF5 file is not CGNS");
    node.children.push_back(node_of(child));
  }
  return node;
}

NumberArray CgnsTree::data(const CgnsNode& node) const {
  if (node.type == "LK") throw_unsupported(source(), node.path + " is a link to another file", k_link_hint);
  if (node.type == "MT") return {.kind = NumberKind::text, .extents = {0}, .source = source(), .where = node.path};
  NumberArray array = image_.data(image_.child(*node.location, k_data));
  array.where = node.path;
  const NumberKind kind = kind_of(node, source());
  if (kind == NumberKind::text && byte_size(array.kind) == 1) array.kind = kind;
  std::reverse(array.extents.begin(), array.extents.end());
  return array;
}

void CgnsTree::fail(const CgnsNode& node, std::string_view problem) const { throw_malformed(source(), node.path, problem); }

}  // namespace sterna::io
