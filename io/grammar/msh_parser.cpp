// Gmsh MSH has sections between $Name and $EndName in any order (4.1: entities before elements). Tags are sparse, so a map gives the point numbers. In binary
// files the sections contain bytes, but section names, and in 2.2 their counts, are text. The text scanner therefore controls the parsing, and a byte reader is
// used inside a section.
#include "io/grammar/msh_parser.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "geom/base/error.h"
#include "io/input/byte_reader.h"
#include "io/input/left_out.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"

namespace sterna::io {
namespace {

constexpr std::int64_t k_surface_dimension = 2;
/// Versions with the same layout of nodes and elements. Physical names have no dimension in files of version 2.0.
constexpr std::array<std::string_view, 4> k_versions_2 = {"2", "2.0", "2.1", "2.2"};
constexpr std::int64_t k_max_physical_tag = 2147483647;
/// Shortest line of a node block (tag and newline) and of an element; they bound the memory that a count may request.
constexpr std::size_t k_min_node_bytes = 2;
constexpr std::size_t k_min_element_bytes = 4;
constexpr std::size_t k_binary_node_bytes = 32;     // tag and coordinates
constexpr std::size_t k_binary_element_bytes = 16;  // tag and one node
constexpr std::size_t k_max_element_nodes = 27;
constexpr std::size_t k_most_nodes_of_lines = 3;
constexpr std::size_t k_max_points = 4294967294;  // 32-bit indices

/// Returns the number of nodes of a Gmsh element type; 0 = unknown.
std::size_t nodes_of_type(std::int64_t type) {
  switch (type) {
    case 15: return 1;  // point
    case 1: return 2;   // line
    case 2: return 3;   // triangle
    case 3: return 4;   // quadrangle
    case 4: return 4;   // tetrahedron
    case 5: return 8;   // prism
    case 6: return 6;   // prism
    case 7: return 5;   // pyramid
    case 8: return 3;   // second-order line
    case 9: return 6;   // second-order triangle
    case 10: return 9;  // second-order quadrangle; type 16 has no centre node
    case 16: return 8;
    case 11: return 10;  // second-order tetrahedron
    case 12: return 27;  // second-order hexahedra, prisms and pyramids, first complete, then serendipity
    case 17: return 20;
    case 13: return 18;
    case 18: return 15;
    case 14: return 14;
    case 19: return 13;
    default: return 0;
  }
}

constexpr std::int64_t k_msh_triangle6 = 9, k_msh_quad9 = 10, k_msh_quad8 = 16;

/// Returns true for triangles; second-order triangles are reduced to their corners.
bool is_triangle(std::int64_t type) { return type == 2 || type == 9; }
bool is_quadrangle(std::int64_t type) { return type == 3 || type == 10 || type == 16; }

class MshParser {
 public:
  MshParser(const FileBuffer& buffer, const RunContext& context, MshSink& sink) : buffer_(buffer), scanner_(buffer), context_(context), sink_(sink) {}

  bool parse() {
    if (scanner_.peek().starts_with('('))
      throw_unsupported(scanner_.source(), "this is a Fluent mesh, not one of Gmsh", "save as MSH 4.1 ASCII of Gmsh, or as STL");
    scanner_.keyword("$MeshFormat");
    const std::string version(scanner_.token("the format's version"));
    is_v4_ = version == "4.1";
    if (!is_v4_ && std::find(k_versions_2.begin(), k_versions_2.end(), version) == k_versions_2.end())
      throw_unsupported(scanner_.source(), "MSH version " + version + " (4.1 and 2 to 2.2 are read)", "save as MSH 4.1 or 2.2 in Gmsh");
    const std::int64_t file_type = scanner_.integer("0 for text or 1 for binary");
    if (file_type != 0 && file_type != 1) scanner_.fail_expected("0 for text or 1 for binary");
    is_binary_ = file_type == 1;
    const std::int64_t real_size = scanner_.integer("the size of a real number");
    if (is_binary_) {
      if (real_size != static_cast<std::int64_t>(sizeof(double)))
        throw_unsupported(scanner_.source(), "binary MSH with reals of " + std::to_string(real_size) + " bytes (8 are read)", "save as MSH 4.1");
      find_byte_order();
    }
    scanner_.keyword("$EndMeshFormat");
    bool has_nodes = false, has_elements = false;
    while (!scanner_.at_end()) {
      const std::string section(scanner_.token("a section such as $Nodes"));
      if (section.empty() || section.front() != '$') scanner_.fail_expected("a section such as $Nodes");
      if (section == "$PhysicalNames") read_physical_names();
      else if (section == "$Entities" && is_v4_) read_entities();
      else if (section == "$Nodes") is_v4_ ? read_nodes_v4() : read_nodes_v2();
      else if (section == "$Elements") is_v4_ ? read_elements_v4() : read_elements_v2();
      else if (section == "$PartitionedEntities") throw_unsupported(scanner_.source(), "a partitioned MSH file", "save the mesh without partitions");
      else skip_to_end(section);
      if (is_known(section)) scanner_.keyword("$End" + section.substr(1));
      has_nodes = has_nodes || section == "$Nodes";
      has_elements = has_elements || section == "$Elements";
    }
    if (!has_nodes || !has_elements)
      scanner_.fail("found the end of the file, expected the section " + std::string(has_nodes ? "$Elements" : "$Nodes"),
                    "the file may have been cut short: copy or write it again");
    if (volume_groups_.size() > 1) regions_.add("regions of cells (physical volumes), which become one", volume_groups_.size());
    curved_.warn(scanner_.source(), context_);
    regions_.warn(scanner_.source(), context_);
    lines_.report(scanner_.source(), context_);
    return has_names_;
  }

 private:
  bool is_known(const std::string& section) const {
    return section == "$PhysicalNames" || (section == "$Entities" && is_v4_) || section == "$Nodes" || section == "$Elements";
  }

  // ---- numbers of a section, text or binary

  void begin_bytes() {
    if (!is_binary_) return;
    scanner_.next_line();
    bytes_.emplace(buffer_, order_, scanner_.offset());
  }
  void end_bytes() {
    if (!bytes_) return;
    scanner_.seek(bytes_->offset());
    bytes_.reset();
  }

  void find_byte_order() {
    begin_bytes();
    const std::int32_t one = bytes_->read<std::int32_t>("the number 1 that marks the byte order");
    constexpr std::int32_t k_swapped_one = 0x01000000;
    if (one != 1 && one != k_swapped_one) bytes_->fail("found " + std::to_string(one) + " before this byte, expected the number 1 that marks the byte order");
    if (one == k_swapped_one) order_ = std::endian::big;
    end_bytes();
  }

  /// Reads an integer; 32 bits in binary files.
  std::int64_t integer(std::string_view expected) { return bytes_ ? bytes_->read<std::int32_t>(expected) : scanner_.integer(expected); }
  /// Reads a tag; 64 bits in binary files of version 4.1.
  std::int64_t tag(std::string_view expected) {
    if (!bytes_) return scanner_.integer(expected);
    return is_v4_ ? bytes_->read<std::int64_t>(expected) : bytes_->read<std::int32_t>(expected);
  }
  double real(std::string_view expected) {
    if (!bytes_) return scanner_.real(expected);
    const double value = bytes_->read<double>(expected);
    if (!std::isfinite(value)) bytes_->fail("found a number that is not finite before this byte, expected " + std::string(expected));
    return value;
  }
  double coordinate(std::string_view expected) { return bytes_ ? bytes_->read<double>(expected) : scanner_.coordinate(expected); }
  /// Reads a number of items of at least the given bytes each.
  std::size_t count(std::string_view expected, std::size_t min_text, std::size_t min_binary) {
    if (!bytes_) return scanner_.count(expected, min_text);
    const std::int64_t n = tag(expected);
    if (n < 0 || static_cast<std::uint64_t>(n) > bytes_->remaining() / min_binary)
      fail("found " + std::to_string(n) + " as " + std::string(expected) + ", but the " + std::to_string(bytes_->remaining()) +
           " bytes left in the file hold at most " + std::to_string(bytes_->remaining() / min_binary));
    return static_cast<std::size_t>(n);
  }
  [[noreturn]] void fail(const std::string& problem) const {
    if (bytes_) bytes_->fail(problem);
    scanner_.fail(problem);
  }
  void require_total(std::size_t found, std::size_t announced, std::string_view what) const {
    if (found != announced) fail("found " + std::to_string(found) + " " + std::string(what) + " in the blocks, expected " + std::to_string(announced));
  }

  // ---- sections

  void skip_to_end(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    while (!scanner_.at_end())
      if (scanner_.token("the end of a section") == end) return;
    scanner_.fail("found the end of the file, expected " + end);
  }

  /// Reads a physical tag without its sign, which marks that the group reverses the entity.
  std::int64_t read_physical_tag() {
    const std::int64_t tag = integer("the tag of a physical group");
    if (std::abs(tag + (tag < 0 ? 1 : 0)) > k_max_physical_tag)
      fail("found " + std::to_string(tag) + " as the tag of a physical group, expected a number of 32 bits");
    return std::abs(tag);
  }

  void read_physical_names() {
    const std::size_t n = scanner_.count("the number of physical names", 4);
    for (std::size_t i = 0; i < n; ++i) {
      std::int64_t dimension = scanner_.integer("the dimension of a physical group");
      const bool has_dimension = !scanner_.peek().starts_with('"');
      const std::int64_t tag = has_dimension ? scanner_.integer("the tag of a physical group") : dimension;
      if (!has_dimension) dimension = k_surface_dimension;
      std::string name(scanner_.rest_of_line());
      if (name.size() < 2 || name.front() != '"' || name.back() != '"') scanner_.fail("found " + quoted_excerpt(name) + ", expected a name in double quotes");
      if (dimension == k_surface_dimension) names_[tag] = name.substr(1, name.size() - 2);
    }
  }

  void read_entities() {
    begin_bytes();
    std::size_t n[4];
    for (std::size_t& n_entities : n) n_entities = count("the number of entities of a dimension", 4, 4);
    for (std::size_t dimension = 0; dimension < 4; ++dimension) {
      for (std::size_t i = 0; i < n[dimension]; ++i) {
        const std::int64_t entity = integer("the tag of an entity");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) coordinate("a coordinate of an entity's box");
        const std::size_t n_physical = count("the number of physical groups of an entity", 2, 4);
        for (std::size_t k = 0; k < n_physical; ++k) {
          const std::int64_t physical = read_physical_tag();
          if (dimension == 2 && k == 0) physical_of_surface_[entity] = physical;
          if (dimension == 2 && k > 0) regions_.add("further physical groups of surfaces, of which the first names the patch");
          if (dimension == 3 && k == 0) physical_of_volume_[entity] = physical;
        }
        if (dimension == 0) continue;
        const std::size_t n_bounding = count("the number of bounding entities", 2, 4);
        for (std::size_t k = 0; k < n_bounding; ++k) integer("the tag of a bounding entity");
      }
    }
    end_bytes();
  }

  Vec3 read_point() {
    Vec3 p;
    const bool takes_any = sink_.takes_any_point();
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = takes_any ? coordinate("a coordinate of a node") : real("a coordinate of a node");
    return p;
  }

  void add_node(std::int64_t tag, const Vec3& p) {
    const std::size_t number = point_of_tag_.size();
    if (number >= k_max_points)
      throw Error(
          {.code = ErrorCode::overflow, .attempted = "reading " + scanner_.source(), .problem = "more than " + std::to_string(k_max_points) + " nodes"});
    if (!point_of_tag_.emplace(tag, static_cast<std::uint32_t>(number)).second) fail("node " + std::to_string(tag) + " occurs twice");
    sink_.add_point(p);
  }

  void reserve_points(std::size_t n) {
    point_of_tag_.reserve(n);
    sink_.reserve_points(n);
  }

  void read_nodes_v4() {
    begin_bytes();
    const std::size_t n_blocks = count("the number of node blocks", 4, 20);
    const std::size_t n_nodes = count("the number of nodes", k_min_node_bytes, k_binary_node_bytes);
    tag("the smallest node tag");
    tag("the largest node tag");
    reserve_points(n_nodes);
    std::vector<std::int64_t> tags;
    std::size_t n_found = 0;
    for (std::size_t block = 0; block < n_blocks; ++block) {
      context_.check_stop();
      const std::int64_t dimension = integer("the dimension of an entity");
      if (dimension < 0 || dimension > 3) fail("found " + std::to_string(dimension) + " as the dimension of an entity, expected 0 to 3");
      integer("the tag of an entity");
      const bool is_parametric = integer("0 or 1 for parametric nodes") != 0;
      tags.resize(count("the number of nodes of a block", k_min_node_bytes, k_binary_node_bytes));
      n_found += tags.size();
      for (std::int64_t& node : tags) node = tag("the tag of a node");
      for (const std::int64_t node : tags) {
        add_node(node, read_point());
        for (std::int64_t k = 0; is_parametric && k < dimension; ++k) coordinate("a parametric coordinate of a node");
      }
    }
    require_total(n_found, n_nodes, "nodes");
    end_bytes();
  }

  void read_nodes_v2() {
    const std::size_t n = scanner_.count("the number of nodes", k_min_node_bytes);
    begin_bytes();
    if (bytes_) bytes_->require(n, sizeof(std::int32_t) + 3 * sizeof(double), "tag and coordinates of the nodes");
    reserve_points(n);
    for (std::size_t i = 0; i < n; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      const std::int64_t node = tag("the tag of a node");
      add_node(node, read_point());
    }
    end_bytes();
  }

  void set_patch(std::int64_t physical, std::int64_t entity) {
    const auto named = names_.find(physical);
    has_names_ = has_names_ || named != names_.end();
    sink_.set_patch(named != names_.end() ? named->second : numbered_patch(physical > 0 ? physical : entity));
  }

  void read_element(std::int64_t type, std::size_t n_nodes) {
    std::uint32_t nodes[k_max_element_nodes] = {};
    for (std::size_t k = 0; k < n_nodes; ++k) {
      const std::int64_t node = tag("the tag of an element's node");
      const auto found = point_of_tag_.find(node);
      if (found == point_of_tag_.end()) fail("found node " + std::to_string(node) + ", which $Nodes does not list");
      nodes[k] = found->second;
    }
    if (type == k_msh_triangle6 || type == k_msh_quad9 || type == k_msh_quad8)
      curved_.add("mid-side nodes of second-order faces, which become flat", n_nodes - (type == k_msh_triangle6 ? 3 : 4));
    if (n_nodes <= k_most_nodes_of_lines && !is_triangle(type)) lines_.add(n_nodes == 1 ? "points" : "lines");
    if (is_triangle(type)) sink_.add_face(std::span(nodes).first(3));
    else if (is_quadrangle(type)) sink_.add_face(std::span(nodes).first(4));
    else if (type >= k_msh_tetrahedron && type <= k_msh_pyramid) sink_.add_cell(type, std::span(nodes).first(n_nodes));
    else if (n_nodes > k_most_nodes_of_lines) sink_.add_curved_cell();
  }

  std::size_t require_type(std::int64_t type) {
    const std::size_t n = nodes_of_type(type);
    if (n == 0) throw_unsupported(scanner_.source(), "elements of type " + std::to_string(type), "save linear triangles, quadrangles and volume elements only");
    return n;
  }

  void read_elements_v4() {
    begin_bytes();
    const std::size_t n_blocks = count("the number of element blocks", 4, 20);
    const std::size_t n_elements = count("the number of elements", k_min_element_bytes, k_binary_element_bytes);
    tag("the smallest element tag");
    tag("the largest element tag");
    std::size_t n_found = 0;
    for (std::size_t block = 0; block < n_blocks; ++block) {
      integer("the dimension of an entity");
      const std::int64_t entity = integer("the tag of an entity");
      const std::int64_t type = integer("an element type");
      const std::size_t n = count("the number of elements of a block", k_min_element_bytes, k_binary_element_bytes);
      n_found += n;
      const std::size_t n_nodes = require_type(type);
      if (is_triangle(type) || is_quadrangle(type)) {
        const auto physical = physical_of_surface_.find(entity);
        set_patch(physical == physical_of_surface_.end() ? 0 : physical->second, entity);
      } else if (n_nodes > k_most_nodes_of_lines && n > 0) {
        const auto physical = physical_of_volume_.find(entity);
        volume_groups_.insert(physical == physical_of_volume_.end() ? 0 : physical->second);
      }
      for (std::size_t i = 0; i < n; ++i) {
        if (i % k_stop_interval == 0) context_.check_stop();
        tag("the tag of an element");
        read_element(type, n_nodes);
      }
    }
    require_total(n_found, n_elements, "elements");
    end_bytes();
  }

  /// Reads the tag of an element with its groups, then its nodes. \param n_tags number of group tags
  void read_element_v2(std::int64_t type, std::size_t n_tags) {
    std::int64_t physical = 0, entity = 0;
    for (std::size_t k = 0; k < n_tags; ++k) {
      if (k == 0) physical = read_physical_tag();
      else if (k == 1) entity = integer("the entity of an element");
      else integer("a tag of an element");
    }
    const std::size_t n_nodes = require_type(type);
    if (is_triangle(type) || is_quadrangle(type)) set_patch(physical, entity);
    else if (n_nodes > k_most_nodes_of_lines) volume_groups_.insert(physical);
    read_element(type, n_nodes);
  }

  void read_elements_v2() {
    const std::size_t n = scanner_.count("the number of elements", k_min_element_bytes);
    begin_bytes();
    for (std::size_t i = 0; i < n;) {
      if (i % k_stop_interval == 0) context_.check_stop();
      if (!bytes_) {
        scanner_.integer("the tag of an element");
        const std::int64_t type = scanner_.integer("an element type");
        read_element_v2(type, scanner_.count("the number of tags of an element", 2));
        ++i;
        continue;
      }
      const std::int64_t type = integer("an element type");  // type of the block
      const std::size_t n_follow = count("the number of elements of a block", 1, 8);
      const std::size_t n_tags = count("the number of tags of an element", 1, 4);
      if (n_follow == 0 || n_follow > n - i) fail("found a block of " + std::to_string(n_follow) + " elements, expected 1 to " + std::to_string(n - i));
      for (const std::size_t end = i + n_follow; i < end; ++i) {
        integer("the tag of an element");
        read_element_v2(type, n_tags);
      }
    }
    end_bytes();
  }

  const FileBuffer& buffer_;
  TextScanner scanner_;
  std::optional<ByteReader> bytes_;  ///< inside a binary section
  const RunContext& context_;
  MshSink& sink_;
  bool is_v4_ = true;
  bool is_binary_ = false;
  std::endian order_ = std::endian::little;
  std::unordered_map<std::int64_t, std::uint32_t> point_of_tag_;
  std::map<std::int64_t, std::string> names_;
  std::map<std::int64_t, std::int64_t> physical_of_surface_, physical_of_volume_;
  bool has_names_ = false;
  LeftOut curved_, regions_, lines_;
  std::set<std::int64_t> volume_groups_;  ///< physical groups of volume elements
};

}  // namespace

bool parse_msh(const FileBuffer& buffer, const RunContext& context, MshSink& sink) { return MshParser(buffer, context, sink).parse(); }

}  // namespace sterna::io
