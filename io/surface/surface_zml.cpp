// The file is a standard LZ4 frame around a tree. Each node has a header, a table of strings (its name, then keys and values), its data, and its children.
#include "io/surface/surface_zml.h"

#include <lz4frame.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "io/input/byte_reader.h"
#include "io/input/file_buffer.h"
#include "io/input/text_limits.h"
#include "io/mesh/surface_builder.h"

namespace sterna::io {
namespace {

constexpr std::uint32_t k_frame_magic = 0x184D2204;
constexpr std::uint32_t k_node_magic = 0xBFCF4F8B;
constexpr std::uint32_t k_open_list = 0xFFFFFFFF;
constexpr std::size_t k_zml_header_bytes = 32;
constexpr int k_max_depth = 64;  // real files have 4
/// LZ4 expands a byte to at most 255 bytes.
constexpr std::size_t k_max_zml_expansion = 256;
constexpr std::size_t k_piece = std::size_t{1} << 20;

/// Unpacks the file. Memory grows with the bytes actually unpacked, not with the size stated in the header.
FileBuffer unpack(const FileBuffer& packed, const RunContext& context) {
  LZ4F_dctx* raw_state = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw_state, LZ4F_VERSION)))
    throw Error({.code = ErrorCode::internal, .attempted = "reading " + packed.source, .problem = "LZ4 cannot be started"});
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> state(raw_state, &LZ4F_freeDecompressionContext);
  FileBuffer result{.source = packed.source, .bytes = {}};
  std::size_t at = 0;
  for (std::size_t hint = 1; hint != 0;) {
    context.check_stop();
    const std::size_t n_before = result.bytes.size();
    std::size_t n_out = std::min(k_piece, k_max_zml_expansion * packed.bytes.size());
    std::size_t n_in = packed.bytes.size() - at;
    result.bytes.resize(n_before + n_out);
    hint = LZ4F_decompress(state.get(), result.bytes.data() + n_before, &n_out, packed.bytes.data() + at, &n_in, nullptr);
    if (LZ4F_isError(hint))
      throw_malformed(packed.source, "byte " + std::to_string(at), std::string("the LZ4 frame is damaged (") + LZ4F_getErrorName(hint) + ")",
                      "copy or download the file again");
    result.bytes.resize(n_before + n_out);
    at += n_in;
    if (hint != 0 && n_in == 0 && n_out == 0)
      throw_malformed(packed.source, "byte " + std::to_string(at), "the LZ4 frame ends too early", "copy or download the file again");
  }
  return result;
}

struct Node {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::size_t width = 1;  ///< bytes of one value
  std::size_t data = 0;   ///< offset of the data
  std::size_t n_bytes = 0;
  std::vector<Node> children;

  std::string_view attribute(std::string_view key) const {
    for (const auto& [known, value] : attributes)
      if (known == key) return value;
    return {};
  }
  std::size_t n_values() const { return n_bytes / std::max<std::size_t>(1, width); }
};

class TreeReader {
 public:
  explicit TreeReader(const FileBuffer& buffer) : buffer_(buffer), reader_(buffer) {}

  Node read(int depth = 0) {
    if (depth > k_max_depth) reader_.fail("found more than " + std::to_string(k_max_depth) + " levels of nodes");
    reader_.require(1, k_zml_header_bytes, "the header of a node");
    if (const auto magic = reader_.take<std::uint32_t>(); magic != k_node_magic)
      reader_.fail("found no node before this byte, expected one that begins with 8b 4f cf bf");
    const std::uint32_t n_children = reader_.take<std::uint32_t>();
    const std::uint32_t n_attributes = reader_.take<std::uint32_t>();
    Node node;
    node.width = reader_.take<std::uint32_t>();
    const std::uint64_t n_data = reader_.take<std::uint64_t>();
    const std::uint64_t n_table = reader_.take<std::uint64_t>();
    reader_.require(n_table, 1, "the strings of a node");
    read_strings(node, n_attributes, reader_.offset() + n_table);
    reader_.require(n_data, 1, "the data of node " + quoted_excerpt(node.name));
    node.data = reader_.offset();
    node.n_bytes = n_data;
    reader_.skip(n_data);
    if (n_children == k_open_list)
      throw_unsupported(buffer_.source, "node " + quoted_excerpt(node.name) + " has a list of unknown length",
                        "write the file with sumo's surface export as STL");
    for (std::uint32_t i = 0; i < n_children; ++i) node.children.push_back(read(depth + 1));
    return node;
  }

 private:
  void read_strings(Node& node, std::uint32_t n_attributes, std::size_t end) {
    const auto next = [&] {
      if (reader_.offset() >= end)
        reader_.fail("the strings of a node end before this byte, expected its name and " + std::to_string(n_attributes) + " attributes");
      const std::int32_t n = reader_.read<std::int32_t>("the length of a string");
      if (n < 0 || reader_.offset() > end || static_cast<std::size_t>(n) > end - reader_.offset())
        reader_.fail("found a string of " + std::to_string(n) + " bytes, longer than its table");
      std::string text(buffer_.text().substr(reader_.offset(), static_cast<std::size_t>(n)));
      reader_.skip(static_cast<std::size_t>(n));
      return text;
    };
    node.name = next();
    for (std::uint32_t i = 0; i < n_attributes; ++i) {
      std::string key = next();
      node.attributes.emplace_back(std::move(key), next());
    }
    if (reader_.offset() != end)
      reader_.fail("found " + std::to_string(end - reader_.offset()) + " more bytes in the strings of node " + quoted_excerpt(node.name));
  }

  const FileBuffer& buffer_;
  ByteReader reader_;
};

/// Corners of the elements of a section; only surfaces are read.
struct ElementType {
  std::string_view name;
  std::size_t n_nodes;
  bool is_face;
};
constexpr std::array<ElementType, 6> k_element_types = {
    {{"Triangle3", 3, true}, {"Quad4", 4, true}, {"Tetra4", 4, false}, {"Penta6", 6, false}, {"Pyramid5", 5, false}, {"Hexa8", 8, false}}};

class MeshReader {
 public:
  MeshReader(const FileBuffer& buffer, const RunContext& context) : buffer_(buffer), context_(context), builder_(buffer.source) {}

  SurfaceSoup read(const Node& root) {
    visit(root);
    if (!has_mesh_) throw_malformed(buffer_.source, "byte 0", "found no node \"MxMesh\" with vertices");
    SurfaceSoup soup = builder_.finish(context_, true);
    soup.has_names = has_names_;
    return soup;
  }

 private:
  void visit(const Node& node) {
    if (node.name == "MxMesh") take_mesh(node);
    for (const Node& child : node.children) visit(child);
  }

  void take_mesh(const Node& mesh) {
    const Node* vertices = nullptr;
    std::uint64_t n_elements = 0;
    for (const Node& child : mesh.children) {
      if (child.name == "MxMeshVertices") vertices = &child;
      if (child.name == "MxMeshSection") n_elements += n_elements_of(child);
    }
    if (!vertices) return;
    has_mesh_ = true;
    first_point_ = builder_.n_points();
    take_vertices(*vertices);
    take_bocos(mesh, n_elements);
    std::uint64_t first_element = 0;
    for (const Node& child : mesh.children) {
      if (child.name != "MxMeshSection") continue;
      take_section(child, first_element);
      first_element += n_elements_of(child);
    }
  }

  ByteReader data_of(const Node& node, std::size_t width, std::string_view what) const {
    ByteReader reader(buffer_, std::endian::little, node.data);
    if (node.width != width || node.n_bytes % width != 0)
      reader.fail("node " + node.name + " has " + std::to_string(node.n_bytes) + " bytes in values of " + std::to_string(node.width) + ", expected values of " +
                  std::to_string(width) + " bytes: " + std::string(what));
    return reader;
  }

  void take_vertices(const Node& node) {
    ByteReader reader = data_of(node, sizeof(double), "coordinates");
    if (node.n_values() % 3 != 0) reader.fail("found " + std::to_string(node.n_values()) + " coordinates, not a multiple of 3");
    n_points_ = node.n_values() / 3;
    builder_.reserve_points(first_point_ + n_points_);
    for (std::size_t i = 0; i < n_points_; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      Vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = reader.take<double>();
      builder_.add_point(p);
    }
  }

  const ElementType& type_of(const Node& section) const {
    for (const ElementType& type : k_element_types)
      if (type.name == section.attribute("element_type")) return type;
    throw_unsupported(buffer_.source, "a section of elements " + quoted_excerpt(section.attribute("element_type")));
  }
  std::uint64_t n_elements_of(const Node& section) const { return section.n_values() / type_of(section).n_nodes; }

  /// Reads boundary conditions; the first condition that lists an element names it.
  void take_bocos(const Node& mesh, std::uint64_t n_elements) {
    boco_of_element_.clear();
    boco_names_.clear();
    for (const Node& child : mesh.children) {
      if (child.name != "MxMeshBoco" || child.n_bytes == 0) continue;
      if (child.attribute("use_range") == "true") {
        context_.warn(buffer_.source + ": the boundary condition " + quoted_excerpt(child.attribute("name")) +
                      " gives its elements as a range; sections name the patches instead");
        continue;
      }
      ByteReader reader = data_of(child, sizeof(std::int32_t), "elements of a boundary condition");
      boco_of_element_.resize(n_elements, 0);
      boco_names_.emplace_back(child.attribute("name"));
      for (std::size_t i = 0; i < child.n_values(); ++i) {
        const std::int32_t element = reader.take<std::int32_t>();
        if (element < 0 || static_cast<std::uint64_t>(element) >= n_elements)
          reader.fail("found the element " + std::to_string(element) + " before this byte in " + quoted_excerpt(boco_names_.back()) + ", there are " +
                      std::to_string(n_elements));
        std::uint32_t& boco = boco_of_element_[static_cast<std::size_t>(element)];
        if (boco == 0) boco = static_cast<std::uint32_t>(boco_names_.size());
      }
    }
  }

  void take_section(const Node& section, std::uint64_t first_element) {
    const ElementType& type = type_of(section);
    if (!type.is_face) return;
    ByteReader reader = data_of(section, sizeof(std::int32_t), "nodes of elements");
    if (section.n_values() % type.n_nodes != 0)
      reader.fail("found " + std::to_string(section.n_values()) + " nodes, not a multiple of " + std::to_string(type.n_nodes));
    std::optional<std::uint32_t> last_boco;
    std::array<std::uint32_t, 4> corners{};
    for (std::uint64_t i = 0; i < section.n_values() / type.n_nodes; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      const std::uint32_t boco = boco_of_element_.empty() ? 0 : boco_of_element_[first_element + i];
      if (boco != last_boco) set_patch(boco == 0 ? std::string(section.attribute("name")) : boco_names_[boco - 1]);
      last_boco = boco;
      for (std::size_t k = 0; k < type.n_nodes; ++k) {
        const std::int32_t node = reader.take<std::int32_t>();
        if (node < 0 || static_cast<std::size_t>(node) >= n_points_)
          reader.fail("found the node " + std::to_string(node) + " before this byte, there are " + std::to_string(n_points_));
        corners[k] = static_cast<std::uint32_t>(first_point_ + static_cast<std::size_t>(node));
      }
      builder_.add_polygon(std::span(corners).first(type.n_nodes));
    }
  }

  void set_patch(const std::string& name) {
    builder_.set_patch(name);
    has_names_ = has_names_ || !name.empty();
  }

  const FileBuffer& buffer_;
  const RunContext& context_;
  SurfaceBuilder builder_;
  bool has_mesh_ = false;
  bool has_names_ = false;
  std::size_t first_point_ = 0, n_points_ = 0;
  std::vector<std::uint32_t> boco_of_element_;  ///< index into boco_names_ from 1, 0 = none
  std::vector<std::string> boco_names_;
};

}  // namespace

SurfaceSoup read_zml(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer packed = load_file(path, context);
  ByteReader reader(packed);
  if (packed.bytes.size() < sizeof(std::uint32_t) || reader.take<std::uint32_t>() != k_frame_magic)
    throw_unsupported(packed.source,
                      "found " + quoted_excerpt(packed.text().substr(0, 8)) + ", expected an LZ4 frame; older kinds of zml (text, ZIP) are not read",
                      "open and save the file with a newer sumo, or save as STL");
  const FileBuffer buffer = unpack(packed, context);
  return MeshReader(buffer, context).read(TreeReader(buffer).read());
}

}  // namespace sterna::io
