// Gmsh MSH: sections between $Name and $EndName in any order (4.1: entities before elements). Tags are sparse: a map leads to point numbers.
#include "io/surface_msh.h"

#include <cstdlib>
#include <map>
#include <string>
#include <unordered_map>

#include "io/file_buffer.h"
#include "io/surface_builder.h"
#include "io/text_scanner.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_stop_interval = 1 << 16;
constexpr std::int64_t k_surface_dimension = 2;
constexpr std::int64_t k_max_physical_tag = 2147483647;
/// Shortest line of a node block (tag and newline) and of an element; bounds for the memory that a count may ask for.
constexpr std::size_t k_min_node_bytes = 2;
constexpr std::size_t k_min_element_bytes = 4;

/// Nodes of each Gmsh element type that may occur; 0 = not known.
std::size_t nodes_of_type(std::int64_t type) {
  switch (type) {
    case 15: return 1;  // point
    case 1: return 2;   // line
    case 2: return 3;   // triangle
    case 3: return 4;   // quadrangle
    case 4: return 4;   // tetrahedron
    case 5: return 8;   // hexahedron
    case 6: return 6;   // prism
    case 7: return 5;   // pyramid
    case 8: return 3;   // line of second order
    case 9: return 6;   // triangle of second order
    case 10: return 9;  // quadrangle of second order, with and (16) without a node in its middle
    case 16: return 8;
    case 11: return 10; // tetrahedron of second order
    case 12: return 27; // hexahedra, prisms, pyramids of second order: complete, serendipity
    case 17: return 20;
    case 13: return 18;
    case 18: return 15;
    case 14: return 14;
    case 19: return 13;
    default: return 0;
  }
}

/// Faces of second order give their corners.
bool is_triangle(std::int64_t type) { return type == 2 || type == 9; }
bool is_quadrangle(std::int64_t type) { return type == 3 || type == 10 || type == 16; }

class MshReader {
 public:
  MshReader(const FileBuffer& buffer, const RunContext& context) : scanner_(buffer), builder_(buffer.source), context_(context) {}

  SurfaceSoup read() {
    if (scanner_.peek().starts_with('(')) throw_unsupported(scanner_.source(), "this is a Fluent mesh, not one of Gmsh", "save as MSH 4.1 ASCII of Gmsh, or as STL");
    scanner_.keyword("$MeshFormat");
    const std::string version(scanner_.token("the format's version"));
    if (version != "4.1" && version != "2.2") throw_unsupported(scanner_.source(), "MSH version " + version + " (4.1 and 2.2 are read)", "save as MSH 4.1 ASCII");
    if (scanner_.integer("0 for ASCII") != 0) throw_unsupported(scanner_.source(), "binary MSH", "save as MSH 4.1 ASCII");
    scanner_.integer("the size of a real number");
    scanner_.keyword("$EndMeshFormat");
    const bool is_v4 = version == "4.1";
    while (!scanner_.at_end()) {
      const std::string section(scanner_.token("a section such as $Nodes"));
      if (section.empty() || section.front() != '$') scanner_.fail_expected("a section such as $Nodes");
      if (section == "$PhysicalNames") read_physical_names();
      else if (section == "$Entities" && is_v4) read_entities();
      else if (section == "$Nodes") is_v4 ? read_nodes_v4() : read_nodes_v2();
      else if (section == "$Elements") is_v4 ? read_elements_v4() : read_elements_v2();
      else if (section == "$PartitionedEntities") throw_unsupported(scanner_.source(), "a partitioned MSH file", "save the mesh without partitions");
      else skip_to_end(section);
      if (is_known(section)) scanner_.keyword("$End" + section.substr(1));
    }
    SurfaceSoup soup = builder_.finish(true);
    soup.has_names = has_names_ || soup.patch_names.size() > 1;
    return soup;
  }

 private:
  static bool is_known(const std::string& section) {
    return section == "$PhysicalNames" || section == "$Entities" || section == "$Nodes" || section == "$Elements";
  }

  void skip_to_end(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    while (!scanner_.at_end())
      if (scanner_.token("the end of a section") == end) return;
    scanner_.fail("found the end of the file, expected " + end);
  }

  /// Without the sign, which tells that the group turns the entity round.
  std::int64_t read_physical_tag() {
    const std::int64_t tag = scanner_.integer("the tag of a physical group");
    if (std::abs(tag + (tag < 0 ? 1 : 0)) > k_max_physical_tag)
      scanner_.fail("found " + std::to_string(tag) + " as the tag of a physical group, expected a number of 32 bits");
    return std::abs(tag);
  }

  void read_physical_names() {
    const std::size_t n = scanner_.count("the number of physical names", 4);
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t dimension = scanner_.integer("the dimension of a physical group");
      const std::int64_t tag = scanner_.integer("the tag of a physical group");
      std::string name(scanner_.rest_of_line());
      if (name.size() < 2 || name.front() != '"' || name.back() != '"') scanner_.fail("found " + quoted_excerpt(name) + ", expected a name in double quotes");
      if (dimension == k_surface_dimension) names_[tag] = name.substr(1, name.size() - 2);
    }
  }

  void read_entities() {
    std::size_t n[4];
    for (std::size_t& count : n) count = scanner_.count("the number of entities of a dimension", 4);
    for (std::size_t dimension = 0; dimension < 4; ++dimension) {
      for (std::size_t i = 0; i < n[dimension]; ++i) {
        const std::int64_t tag = scanner_.integer("the tag of an entity");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) scanner_.real("a coordinate of an entity's box");
        const std::size_t n_physical = scanner_.count("the number of physical groups of an entity", 2);
        for (std::size_t k = 0; k < n_physical; ++k) {
          const std::int64_t physical = read_physical_tag();
          if (dimension == 2 && k == 0) physical_of_surface_[tag] = physical;
        }
        if (dimension == 0) continue;
        const std::size_t n_bounding = scanner_.count("the number of bounding entities", 2);
        for (std::size_t k = 0; k < n_bounding; ++k) scanner_.integer("the tag of a bounding entity");
      }
    }
  }

  Vec3 read_point() {
    Vec3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = scanner_.real("a coordinate of a node");
    return p;
  }

  void add_node(std::int64_t tag, const Vec3& p) {
    if (!point_of_tag_.emplace(tag, builder_.add_point(p)).second) scanner_.fail("node " + std::to_string(tag) + " occurs twice");
  }

  void read_nodes_v4() {
    const std::size_t n_blocks = scanner_.count("the number of node blocks", 4);
    const std::size_t n_nodes = scanner_.count("the number of nodes", k_min_node_bytes);
    scanner_.integer("the smallest node tag");
    scanner_.integer("the largest node tag");
    point_of_tag_.reserve(n_nodes);
    std::vector<std::int64_t> tags;
    for (std::size_t block = 0; block < n_blocks; ++block) {
      context_.check_stop();
      const std::int64_t dimension = scanner_.integer("the dimension of an entity");
      if (dimension < 0 || dimension > 3) scanner_.fail("found " + std::to_string(dimension) + " as the dimension of an entity, expected 0 to 3");
      scanner_.integer("the tag of an entity");
      const bool is_parametric = scanner_.integer("0 or 1 for parametric nodes") != 0;
      tags.resize(scanner_.count("the number of nodes of a block", k_min_node_bytes));
      for (std::int64_t& tag : tags) tag = scanner_.integer("the tag of a node");
      for (const std::int64_t tag : tags) {
        add_node(tag, read_point());
        for (std::int64_t k = 0; is_parametric && k < dimension; ++k) scanner_.real("a parametric coordinate of a node");
      }
    }
  }

  void read_nodes_v2() {
    const std::size_t n = scanner_.count("the number of nodes", k_min_node_bytes);
    point_of_tag_.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      const std::int64_t tag = scanner_.integer("the tag of a node");
      add_node(tag, read_point());
    }
  }

  void set_patch(std::int64_t physical, std::int64_t entity) {
    const auto named = names_.find(physical);
    has_names_ = has_names_ || named != names_.end();
    builder_.set_patch(named != names_.end() ? named->second : numbered_patch(physical > 0 ? physical : entity));
  }

  /// Reads the nodes of one element; adds it when it is a face.
  void read_element(std::int64_t type, std::size_t n_nodes) {
    std::uint32_t corners[4] = {};
    for (std::size_t k = 0; k < n_nodes; ++k) {
      const std::int64_t tag = scanner_.integer("the tag of an element's node");
      const auto found = point_of_tag_.find(tag);
      if (found == point_of_tag_.end()) scanner_.fail("found node " + std::to_string(tag) + ", which $Nodes does not list");
      if (k < 4) corners[k] = found->second;
    }
    if (is_triangle(type)) builder_.add_triangle(corners[0], corners[1], corners[2]);
    if (is_quadrangle(type)) builder_.add_polygon(corners);
  }

  std::size_t require_type(std::int64_t type) {
    const std::size_t n = nodes_of_type(type);
    if (n == 0) throw_unsupported(scanner_.source(), "elements of type " + std::to_string(type), "save linear triangles, quadrangles and volume elements only");
    return n;
  }

  void read_elements_v4() {
    const std::size_t n_blocks = scanner_.count("the number of element blocks", 4);
    scanner_.count("the number of elements", k_min_element_bytes);
    scanner_.integer("the smallest element tag");
    scanner_.integer("the largest element tag");
    for (std::size_t block = 0; block < n_blocks; ++block) {
      scanner_.integer("the dimension of an entity");
      const std::int64_t entity = scanner_.integer("the tag of an entity");
      const std::int64_t type = scanner_.integer("an element type");
      const std::size_t n = scanner_.count("the number of elements of a block", k_min_element_bytes);
      const std::size_t n_nodes = require_type(type);
      if (is_triangle(type) || is_quadrangle(type)) {
        const auto physical = physical_of_surface_.find(entity);
        set_patch(physical == physical_of_surface_.end() ? 0 : physical->second, entity);
      }
      for (std::size_t i = 0; i < n; ++i) {
        if (i % k_stop_interval == 0) context_.check_stop();
        scanner_.integer("the tag of an element");
        read_element(type, n_nodes);
      }
    }
  }

  void read_elements_v2() {
    const std::size_t n = scanner_.count("the number of elements", k_min_element_bytes);
    for (std::size_t i = 0; i < n; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      scanner_.integer("the tag of an element");
      const std::int64_t type = scanner_.integer("an element type");
      const std::size_t n_tags = scanner_.count("the number of tags of an element", 2);
      std::int64_t physical = 0, entity = 0;
      for (std::size_t k = 0; k < n_tags; ++k) {
        if (k == 0) physical = read_physical_tag();
        else if (k == 1) entity = scanner_.integer("the entity of an element");
        else scanner_.integer("a tag of an element");
      }
      const std::size_t n_nodes = require_type(type);
      if (is_triangle(type) || is_quadrangle(type)) set_patch(physical, entity);
      read_element(type, n_nodes);
    }
  }

  TextScanner scanner_;
  SurfaceBuilder builder_;
  const RunContext& context_;
  std::unordered_map<std::int64_t, std::uint32_t> point_of_tag_;
  std::map<std::int64_t, std::string> names_;
  std::map<std::int64_t, std::int64_t> physical_of_surface_;
  bool has_names_ = false;
};

}  // namespace

SurfaceSoup read_msh(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  return MshReader(buffer, context).read();
}

}  // namespace sterna::io
