// CGNS nodes in HDF5: a group with the attributes name, label, type, flags; its values in a dataset " data" with the extents reversed.
#include "io/cgns_tree.h"

#include <algorithm>
#include <map>
#include <set>

#include "io/hdf5_source.h"

namespace sterna::io {
namespace {

constexpr std::string_view k_data = " data";
/// The SIDS use about 10 levels.
constexpr int k_max_depth = 64;

class Hdf5Container : public CgnsContainer {
 public:
  explicit Hdf5Container(const FileBuffer& buffer) : buffer_(buffer), source_(buffer) {}

  CgnsNode read_root() override { return node_of(source_.root(), "", 0); }

  NumberArray data(const CgnsNode& node) override {
    const Hdf5Object group = source_.object(node.place, node.path);
    NumberArray array = source_.data(source_.child(group, k_data));
    array.where = node.path;
    const NumberKind kind = cgns_kind(buffer_, node);
    if (kind == NumberKind::text && byte_size(array.kind) == 1) array.kind = kind;
    std::reverse(array.extents.begin(), array.extents.end());
    return array;
  }

 private:
  CgnsNode node_of(const Hdf5Object& group, const std::string& name, int depth) {
    if (depth > k_max_depth) throw_malformed(buffer_.source, group.path, "nodes are nested more than " + std::to_string(k_max_depth) + " deep");
    if (!seen_.insert(group.address).second) throw_malformed(buffer_.source, group.path, "the node has two parents");
    CgnsNode node{.path = group.path, .name = name, .place = group.address};
    const auto text_of = [&](const char* attribute) {
      const auto found = group.attributes.find(attribute);
      if (found == group.attributes.end() || found->second.kind != NumberKind::text) throw_malformed(buffer_.source, group.path, std::string("found no attribute \"") + attribute + "\": this HDF5 file is not CGNS");
      return found->second.text();
    };
    node.label = text_of("label");
    node.type = text_of("type");
    for (const Hdf5Link& link : group.links) {
      if (link.name.starts_with(' ')) continue;  // data and marks of the container
      if (link.address == k_hdf5_nowhere) throw_unsupported(buffer_.source, group.path + "/" + link.name + " is a link to another file", "join the files first: cgnscompress or cgnsconvert -l");
      const Hdf5Object child = source_.object(link.address, (group.path == "/" ? "" : group.path) + "/" + link.name);
      node.children.push_back(node_of(child, link.name, depth + 1));
    }
    return node;
  }

  const FileBuffer& buffer_;
  Hdf5Source source_;
  std::set<std::uint64_t> seen_;
};

Hdf5OutputNode hdf5_node(const CgnsOutputNode& node) {
  Hdf5OutputNode group{.name = node.name};
  group.attributes.push_back(text_attribute("name", node.name, k_cgns_name + 1));
  group.attributes.push_back(text_attribute("label", node.label, k_cgns_name + 1));
  group.attributes.push_back(text_attribute("type", node.has_data ? cgns_type_of(node.array.kind) : "MT", 3));
  group.attributes.push_back({.name = "flags", .kind = NumberKind::i4, .extents = {1}, .bytes = std::string("\1\0\0\0", 4)});  // 1: extents are reversed
  if (node.has_data) {
    Hdf5OutputNode data{.name = std::string(k_data), .is_dataset = true, .array = node.array};
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

const CgnsNode* CgnsNode::find(std::string_view wanted) const {
  const auto found = std::find_if(children.begin(), children.end(), [&](const CgnsNode& child) { return child.name == wanted; });
  return found == children.end() ? nullptr : &*found;
}

const CgnsNode* CgnsNode::find_label(std::string_view wanted) const {
  const auto found = std::find_if(children.begin(), children.end(), [&](const CgnsNode& child) { return child.label == wanted; });
  return found == children.end() ? nullptr : &*found;
}

CgnsTree::CgnsTree(const FileBuffer& buffer) : source_(buffer.source) {
  if (is_hdf5(buffer.text())) container_ = std::make_unique<Hdf5Container>(buffer);
  else if (is_adf(buffer.text())) container_ = open_cgns_adf(buffer);
  else throw_malformed(buffer.source, "byte 0", "found " + quoted_excerpt(buffer.text().substr(0, 8)) + ", expected the beginning of an HDF5 or ADF file");
  root_ = container_->read_root();
}

CgnsTree::~CgnsTree() = default;

NumberArray CgnsTree::data(const CgnsNode& node) const {
  if (node.type == "LK") throw_unsupported(source_, node.path + " is a link to another file", "join the files first: cgnsconvert -l");
  if (node.type == "MT") return {.kind = NumberKind::text, .extents = {0}, .source = source_, .where = node.path};
  return container_->data(node);
}

void CgnsTree::fail(const CgnsNode& node, std::string_view problem) const { throw_malformed(source_, node.path, problem); }

NumberKind cgns_kind(const FileBuffer& buffer, const CgnsNode& node) {
  static const std::map<std::string, NumberKind, std::less<>> k_kinds = {{"I4", NumberKind::i4}, {"I8", NumberKind::i8}, {"U4", NumberKind::u4}, {"U8", NumberKind::u8}, {"R4", NumberKind::f4},
                                                                         {"R8", NumberKind::f8}, {"C1", NumberKind::text}, {"B1", NumberKind::u1}};
  const auto found = k_kinds.find(node.type);
  if (found == k_kinds.end()) throw_malformed(buffer.source, node.path, "found data of the type " + quoted_excerpt(node.type) + ", expected I4, I8, U4, U8, R4, R8, C1 or B1");
  return found->second;
}

CgnsOutputNode cgns_node(std::string name, std::string label) { return {.name = std::move(name), .label = std::move(label), .children = {}, .array = {}}; }
CgnsOutputNode cgns_node(std::string name, std::string label, OutputArray array) {
  return {.name = std::move(name), .label = std::move(label), .children = {}, .has_data = true, .array = std::move(array)};
}

std::vector<OutputSection> cgns_hdf5_sections(const CgnsOutputNode& root) {
  Hdf5OutputNode file = hdf5_node(root);
  file.attributes = {text_attribute("name", "HDF5 MotherNode", k_cgns_name + 1), text_attribute("label", "Root Node of HDF5 File", k_cgns_name + 1), text_attribute("type", "MT", 3)};
  // What the CGNS library puts into every file: the byte order of its numbers, and which HDF5 wrote them.
  std::string version = "HDF5 file format, sterna";
  version.resize(k_cgns_name + 1, '\0');
  file.children.insert(file.children.begin(), {{.name = " format", .is_dataset = true, .array = output_text(std::string("IEEE_LITTLE_32", 15))},
                                               {.name = " hdf5version", .is_dataset = true, .array = output_text(std::move(version))}});
  return hdf5_sections(file);
}

}  // namespace sterna::io
