// CGNS reader, docs/method/formats.md, "CGNS reader". Steps per zone: read coordinates; read sections (cells, and boundary faces with their element numbers);
// read boundary conditions, which name the faces.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/base/parallel.h"
#include "io/container/cgns_elements.h"
#include "io/container/cgns_tree.h"
#include "io/container/container_file.h"
#include "io/input/file_buffer.h"
#include "io/mesh/orientation.h"
#include "io/names/patch_names.h"
#include "io/volume/volume_cgns.h"

namespace sterna::io {
namespace {

PatchKind kind_of(std::string_view condition, std::string_view name) {
  if (condition == "BCWallInviscid") return PatchKind::slip;
  if (condition.starts_with("BCWall")) return PatchKind::wall;
  if (condition.starts_with("BCSymmetry")) return PatchKind::symmetry;
  if (condition == "BCFarfield") return PatchKind::farfield;
  if (condition.starts_with("BCInflow") || condition == "BCTunnelInflow") return PatchKind::inflow;
  if (condition.starts_with("BCOutflow") || condition == "BCTunnelOutflow") return PatchKind::outflow;
  return kind_of_name(name);
}

/// A boundary face of the current zone: its index in the mesh, and its element number in the file.
struct Face {
  std::int64_t element = 0;
  std::uint32_t index = 0;
  bool is_quad = false;
};

struct Family {
  std::string condition;   ///< "BCWallViscous"; may be empty
  std::string patch_name;  ///< stored by sterna's writer; may be empty
};

enum class Contents { volume, boundary };

class CgnsReader {
 public:
  CgnsReader(const CgnsTree& tree, Contents contents, const RunContext& context) : tree_(tree), contents_(contents), context_(context) {}

  HybridMesh read() {
    const CgnsNode& base = find_base();
    report_other_bases(base);
    read_families(base);
    int n_zones = 0;
    for (const CgnsNode& node : base.children) {
      if (node.label != "Zone_t") continue;
      read_zone(node);
      ++n_zones;
    }
    if (n_zones == 0) tree_.fail(base, "found no zone");
    if (n_zones > 1) context_.info("zones joined into one mesh: " + std::to_string(n_zones));
    if (n_left_out_ > 0) context_.info("points and bars left out: " + std::to_string(n_left_out_));
    if (n_conditions_left_out_ > 0)
      context_.info("boundary conditions of structured zones that are not walls, left out: " + std::to_string(n_conditions_left_out_));
    drop_empty_patches();
    return std::move(mesh_);
  }

  std::uint64_t n_cells() const { return n_cells_; }  ///< in the file; \pre read()

 private:
  /// Finds the base. Surfaces prefer a base of two dimensions, volume meshes a base of three. A file without a base of three dimensions contains only a
  /// surface, which is read as a surface.
  const CgnsNode& find_base() {
    const CgnsNode *found = nullptr, *surface = nullptr;
    int n_bases = 0;
    for (const CgnsNode& node : tree_.root().children) {
      if (node.label != "CGNSBase_t") continue;
      ++n_bases;
      const NumberArray sizes = tree_.data(node);
      sizes.require_integers(2, "the dimensions of cells and space");
      const std::int64_t cell = sizes.integer(0), space = sizes.integer(1);
      if (space != 3) continue;
      if (contents_ == Contents::boundary && cell == 2) return node;
      if (cell == 3 && !found) found = &node;
      if (cell == 2 && !surface) surface = &node;
    }
    if (!found && surface) {
      contents_ = Contents::boundary;
      return *surface;
    }
    if (!found) throw_unsupported(tree_.source(), "found no base of two or three dimensions in space (" + std::to_string(n_bases) + " bases)");
    return *found;
  }

  void report_other_bases(const CgnsNode& chosen) const {
    std::string names;
    for (const CgnsNode& node : tree_.root().children)
      if (node.label == "CGNSBase_t" && &node != &chosen) names += (names.empty() ? "" : ", ") + node.path;
    if (!names.empty()) context_.warn(tree_.source() + ": " + chosen.path + " is read; other bases are left out: " + names);
  }

  void read_families(const CgnsNode& base) {
    for (const CgnsNode& node : base.children) {
      if (node.label != "Family_t") continue;
      Family family;
      if (const CgnsNode* condition = node.find_label("FamilyBC_t")) family.condition = tree_.data(*condition).text();
      if (const CgnsNode* note = node.find(k_cgns_name_note)) family.patch_name = tree_.data(*note).text();
      families_.emplace(node.name, std::move(family));
    }
  }

  void read_zone(const CgnsNode& zone) {
    context_.check_stop();
    zone_ = &zone;
    first_node_ = mesh_.points.size();
    faces_.clear();
    last_cell_ = 0;
    const CgnsNode* const type = zone.find("ZoneType");
    const bool is_structured = !type || tree_.data(*type).text() == "Structured";
    if (is_structured && contents_ == Contents::volume)
      throw_unsupported(tree_.source(), zone.path + ": the zone is structured", "convert it to an unstructured mesh: cgnsconvert, cgns_to_...");
    const NumberArray sizes = tree_.data(zone);
    const std::uint64_t rank = is_structured ? sizes.count() / 3 : 1;
    sizes.require_integers(3 * rank, "the numbers of nodes, cells and boundary nodes of a zone");
    if (rank < 1 || rank > 3) sizes.fail("found a zone of " + std::to_string(rank) + " indices");
    n_nodes_ = 1;
    shape_ = {1, 1, 1};
    for (std::uint64_t k = 0; k < rank; ++k) {
      shape_[k] = sizes.integer(k);
      if (shape_[k] < 0 || __builtin_mul_overflow(n_nodes_, shape_[k], &n_nodes_))
        sizes.fail("found a zone of " + std::to_string(shape_[k]) + " nodes along an index");
    }
    read_points(zone);
    if (is_structured) return read_structured(zone, rank);  // reads the walls of the zone only, so that a volume mesh is not used as a surface
    for (const CgnsNode& node : zone.children)
      if (node.label == "Elements_t") read_section(node);
    std::sort(faces_.begin(), faces_.end(), [](const Face& a, const Face& b) { return std::pair(a.element, a.index) < std::pair(b.element, b.index); });
    for_each_condition(zone, [&](const CgnsNode& node) { read_condition(node); });
  }

  template <class F>
  void for_each_condition(const CgnsNode& zone, const F& f) {
    for (const CgnsNode& list : zone.children) {
      if (list.label != "ZoneBC_t") continue;
      for (const CgnsNode& node : list.children)
        if (node.label == "BC_t") f(node);
    }
  }

  void read_points(const CgnsNode& zone) {
    const CgnsNode* grid = zone.find("GridCoordinates");
    if (!grid) grid = zone.find_label("GridCoordinates_t");
    if (!grid) {
      if (n_nodes_ > 0) tree_.fail(zone, "found no GridCoordinates");
      return;
    }
    constexpr std::array<const char*, 3> k_axis_names = {"CoordinateX", "CoordinateY", "CoordinateZ"};
    std::array<NumberArray, 3> values;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const CgnsNode* const node = grid->find(k_axis_names[axis]);
      if (!node) tree_.fail(*grid, std::string("found no ") + k_axis_names[axis]);
      values[axis] = tree_.data(*node);
      values[axis].require_reals(static_cast<std::uint64_t>(n_nodes_), "coordinates of the nodes of " + zone.path);  // so the file holds that many values
    }
    const std::size_t n = static_cast<std::size_t>(n_nodes_);
    if (first_node_ + n >= NodeId::k_invalid) throw_id_overflow(first_node_ + n);
    mesh_.points.resize(first_node_ + n);
    parallel_for(context_, n, [&](std::size_t i) {
      const Point p = {values[0].real(i), values[1].real(i), values[2].real(i)};
      if (!is_finite(p) && contents_ == Contents::volume) tree_.fail(*grid, "the coordinates of node " + std::to_string(i + 1) + " are not finite");
      mesh_.points.raw()[first_node_ + i] = p;
    });
  }

  // ---- sections

  void read_section(const CgnsNode& section) {
    context_.check_stop();
    const NumberArray types = tree_.data(section);
    if (!is_integer(types.kind) || types.count() < 1) types.fail("found no type of elements");
    const std::int64_t type = types.integer(0);
    const CgnsNode* const range_node = section.find("ElementRange");
    if (!range_node) tree_.fail(section, "found no ElementRange");
    const NumberArray range = tree_.data(*range_node);
    range.require_integers(2, "first and last element");
    const std::int64_t start = range.integer(0), end = range.integer(1);
    if (start < 1 || end < start - 1 || end == std::numeric_limits<std::int64_t>::max())
      range.fail("found the element range " + std::to_string(start) + " to " + std::to_string(end));
    const std::int64_t n = end - start + 1;
    if (type != k_cgns_mixed) size_of(section, type);  // rejects unsupported types by their names
    const CgnsNode* const corners_node = section.find("ElementConnectivity");
    if (!corners_node) tree_.fail(section, "found no ElementConnectivity");
    const NumberArray corners = tree_.data(*corners_node);
    if (n > 0 && !is_integer(corners.kind)) corners.fail("found no integers");
    section_ = &section;
    section_patch_.reset();
    if (type == k_cgns_mixed) {
      read_mixed(corners, start, n);
      return;
    }
    const std::uint64_t size = size_of(section, type);
    if (static_cast<std::uint64_t>(n) > corners.count() || corners.count() != static_cast<std::uint64_t>(n) * size)
      corners.fail("found " + std::to_string(corners.count()) + " numbers of nodes for " + std::to_string(n) + " elements of " + std::to_string(size));
    switch (type) {
      case cgns_type(CellKind::tetrahedron): add_cells(mesh_.tetrahedra, corners, start, n); break;
      case cgns_type(CellKind::pyramid): add_cells(mesh_.pyramids, corners, start, n); break;
      case cgns_type(CellKind::prism): add_cells(mesh_.prisms, corners, start, n); break;
      case cgns_type(CellKind::hexahedron): add_cells(mesh_.hexahedra, corners, start, n); break;
      default:
        for (std::int64_t i = 0; i < n; ++i) add_element(type, corners, static_cast<std::uint64_t>(i) * size, start + i);
    }
  }

  /// Reads a section of cells of one type, which makes up most of a file.
  template <std::size_t N>
  void add_cells(std::vector<std::array<NodeId, N>>& cells, const NumberArray& corners, std::int64_t start, std::int64_t n) {
    if (n == 0) return;
    last_cell_ = std::max(last_cell_, start + n - 1);
    n_cells_ += static_cast<std::uint64_t>(n);
    std::vector<std::array<NodeId, N>> ignored;  // for a surface only the node numbers must be valid, the cells are not needed
    std::vector<std::array<NodeId, N>>& found = contents_ == Contents::volume ? cells : ignored;
    const std::size_t first = found.size();
    found.resize(first + static_cast<std::size_t>(n));
    parallel_for(context_, static_cast<std::size_t>(n),
                 [&](std::size_t i) { found[first + i] = nodes_of<N>(corners, i * N, start + static_cast<std::int64_t>(i)); });
  }

  /// Reads a section with a type before each element; the offsets that some versions add are not needed.
  void read_mixed(const NumberArray& corners, std::int64_t start, std::int64_t n) {
    std::uint64_t at = 0;
    for (std::int64_t i = 0; i < n; ++i) {
      if (at >= corners.count()) corners.fail("element " + std::to_string(start + i) + " is missing");
      const std::int64_t type = corners.integer(at++);
      const std::uint64_t size = size_of(*section_, type);
      if (size > corners.count() - at) corners.fail("element " + std::to_string(start + i) + " lacks nodes");
      add_element(type, corners, at, start + i);
      at += size;
    }
    if (at != corners.count())
      corners.fail("found " + std::to_string(corners.count()) + " numbers, the " + std::to_string(n) + " elements have " + std::to_string(at));
  }

  /// Returns the number of nodes of a supported element type.
  std::uint64_t size_of(const CgnsNode& section, std::int64_t type) const {
    switch (type) {
      case k_cgns_node: return 1;
      case k_cgns_bar: return 2;
      case k_cgns_triangle: return 3;
      case k_cgns_quad: return 4;
      case cgns_type(CellKind::tetrahedron): return 4;
      case cgns_type(CellKind::pyramid): return 5;
      case cgns_type(CellKind::prism): return 6;
      case cgns_type(CellKind::hexahedron): return 8;
      default: break;
    }
    const std::string name = type == 22 ? " (NGON_n)" : type == 23 ? " (NFACE_n)" : "";
    throw_unsupported(tree_.source(), section.path + " has elements of type " + std::to_string(type) + name,
                      "TRI_3, QUAD_4, TETRA_4, PYRA_5, PENTA_6, HEXA_8 and MIXED are read");
  }

  template <std::size_t N>
  std::array<NodeId, N> nodes_of(const NumberArray& corners, std::uint64_t at, std::int64_t element) const {
    std::array<NodeId, N> nodes;
    for (std::size_t k = 0; k < N; ++k) {
      const std::int64_t node = corners.integer(at + k);
      if (node < 1 || node > n_nodes_)
        corners.fail("element " + std::to_string(element) + " has node " + std::to_string(node) + ", expected 1 to " + std::to_string(n_nodes_));
      nodes[k] = NodeId(static_cast<std::uint32_t>(first_node_ + static_cast<std::size_t>(node) - 1));
    }
    return nodes;
  }

  void add_element(std::int64_t type, const NumberArray& corners, std::uint64_t at, std::int64_t element) {
    switch (type) {
      case cgns_type(CellKind::tetrahedron): add_cell(mesh_.tetrahedra, nodes_of<4>(corners, at, element), element); return;
      case cgns_type(CellKind::pyramid): add_cell(mesh_.pyramids, nodes_of<5>(corners, at, element), element); return;
      case cgns_type(CellKind::prism): add_cell(mesh_.prisms, nodes_of<6>(corners, at, element), element); return;
      case cgns_type(CellKind::hexahedron): add_cell(mesh_.hexahedra, nodes_of<8>(corners, at, element), element); return;
      case k_cgns_triangle:
        faces_.push_back({element, static_cast<std::uint32_t>(mesh_.boundary_triangles.size()), false});
        mesh_.boundary_triangles.push_back({nodes_of<3>(corners, at, element), section_patch()});
        return;
      case k_cgns_quad:
        faces_.push_back({element, static_cast<std::uint32_t>(mesh_.boundary_quads.size()), true});
        mesh_.boundary_quads.push_back({nodes_of<4>(corners, at, element), section_patch()});
        return;
      default: ++n_left_out_; return;
    }
  }

  template <std::size_t N>
  void add_cell(std::vector<std::array<NodeId, N>>& cells, const std::array<NodeId, N>& nodes, std::int64_t element) {
    last_cell_ = std::max(last_cell_, element);
    ++n_cells_;
    if (contents_ == Contents::volume) cells.push_back(nodes);
  }

  PatchId section_patch() {
    if (!section_patch_) section_patch_ = patch_named(section_->name);
    return *section_patch_;
  }

  PatchId patch_named(const std::string& name) {
    const auto found = patches_.find(name);
    if (found != patches_.end()) return found->second;
    const PatchId patch = mesh_.patches.push_back({.name = name, .kind = kind_of_name(name)});
    patches_.emplace(name, patch);
    return patch;
  }

  // ---- boundary conditions

  struct Condition {
    PatchId patch;
    NumberArray points;
    bool is_range = false;
    bool is_by_node = false;
    bool is_empty = false;
  };

  /// Returns the patch and point set of a condition.
  Condition condition_of(const CgnsNode& node) {
    Condition condition;
    std::string type = tree_.data(node).text(), name = node.name;
    const CgnsNode* family_name = node.find("FamilyName");
    if (!family_name) family_name = node.find_label("FamilyName_t");
    if (family_name) {
      const std::string family = tree_.data(*family_name).text();
      if (!family.empty()) name = family;
      const auto found = families_.find(family);
      if (found != families_.end()) {
        if (!found->second.patch_name.empty()) name = found->second.patch_name;
        if ((type == "FamilySpecified" || type == "Null" || type.empty()) && !found->second.condition.empty()) type = found->second.condition;
      }
    }
    condition.patch = patch_named(name);
    mesh_.patches[condition.patch].kind = kind_of(type, name);
    if (!type.starts_with("BC") && mesh_.patches[condition.patch].kind == PatchKind::wall)
      context_.warn(tree_.source() + ": patch \"" + name + "\" has no type of boundary condition (" + (type.empty() ? "none" : type) +
                    "): the kind wall is used");
    const CgnsNode* set = nullptr;
    for (const char* const spelling : {"PointRange", "PointList", "ElementRange", "ElementList"})
      if (!set) set = node.find(spelling);
    if (!set) {
      condition.is_empty = true;
      context_.warn(tree_.source() + ": " + node.path + " has neither a range nor a list of elements or nodes");
      return condition;
    }
    condition.points = tree_.data(*set);
    condition.is_empty = condition.points.count() == 0;
    if (!condition.is_empty && !is_integer(condition.points.kind)) condition.points.fail("found no integers");
    condition.is_range = set->name.ends_with("Range");
    const CgnsNode* const location = node.find("GridLocation");
    condition.is_by_node = set->name.starts_with("Point") && (!location || tree_.data(*location).text() == "Vertex");
    return condition;
  }

  void read_condition(const CgnsNode& node) {
    const Condition condition = condition_of(node);
    if (condition.is_empty) return;
    if (condition.is_range) condition.points.require_integers(2, "first and last of a range");
    const std::size_t n_named = condition.is_by_node ? name_by_nodes(condition) : name_by_elements(condition, node);
    if (n_named == 0) context_.warn(tree_.source() + ": " + node.path + " lists no boundary face");
  }

  void set_patch(const Face& face, PatchId patch) {
    (face.is_quad ? mesh_.boundary_quads[face.index].patch : mesh_.boundary_triangles[face.index].patch) = patch;
  }

  /// Names faces by element numbers. \returns the number of named faces
  std::size_t name_by_elements(const Condition& condition, const CgnsNode& node) {
    const NumberArray& points = condition.points;
    std::int64_t lowest = points.integer(0), highest = lowest;
    for (std::uint64_t i = 1; i < points.count(); ++i) {
      lowest = std::min(lowest, points.integer(i));
      highest = std::max(highest, points.integer(i));
    }
    if (lowest < 1) points.fail("found the element " + std::to_string(lowest));
    // Some non-conforming files number boundary faces from 1 without counting the volume cells first (HLPW1 files of DLR).
    const bool are_cells =
        !faces_.empty() && faces_.front().element > last_cell_ && highest <= last_cell_ && highest <= static_cast<std::int64_t>(faces_.size());
    const std::int64_t shift = are_cells ? last_cell_ : 0;
    if (are_cells) context_.warn(tree_.source() + ": " + node.path + " lists volume cells; its numbers are read as numbers of boundary faces");
    std::size_t n = 0;
    const auto name_range = [&](std::int64_t first, std::int64_t last) {
      auto face = std::lower_bound(faces_.begin(), faces_.end(), first, [](const Face& f, std::int64_t element) { return f.element < element; });
      for (; face != faces_.end() && face->element <= last; ++face, ++n) set_patch(*face, condition.patch);
    };
    if (condition.is_range) name_range(lowest + shift, highest + shift);
    else
      for (std::uint64_t i = 0; i < points.count(); ++i) name_range(points.integer(i) + shift, points.integer(i) + shift);
    return n;
  }

  /// Names the faces whose nodes are all listed.
  std::size_t name_by_nodes(const Condition& condition) {
    const NumberArray& points = condition.points;
    std::vector<bool> is_listed(static_cast<std::size_t>(n_nodes_), false);
    const auto list = [&](std::int64_t node) {
      if (node < 1 || node > n_nodes_) points.fail("found the node " + std::to_string(node) + ", expected 1 to " + std::to_string(n_nodes_));
      is_listed[static_cast<std::size_t>(node - 1)] = true;
    };
    if (condition.is_range) {
      const std::int64_t first = std::min(points.integer(0), points.integer(1)), last = std::max(points.integer(0), points.integer(1));
      list(first);
      list(last);
      for (std::int64_t node = first; node <= last; ++node) list(node);
    } else {
      for (std::uint64_t i = 0; i < points.count(); ++i) list(points.integer(i));
    }
    std::size_t n = 0;
    for (const Face& face : faces_) {
      const std::span<const NodeId> nodes =
          face.is_quad ? std::span<const NodeId>(mesh_.boundary_quads[face.index].nodes) : mesh_.boundary_triangles[face.index].nodes;
      if (!std::all_of(nodes.begin(), nodes.end(), [&](NodeId node) { return is_listed[node.index() - first_node_]; })) continue;
      set_patch(face, condition.patch);
      ++n;
    }
    return n;
  }

  // ---- structured zones, as surfaces

  void read_structured(const CgnsNode& zone, std::uint64_t rank) {
    if (rank == 2) {
      const CgnsNode* const family = zone.find_label("FamilyName_t");
      add_quads({1, 1, 1}, {shape_[0], shape_[1], 1}, patch_named(family ? tree_.data(*family).text() : zone.name));
      return;
    }
    for_each_condition(zone, [&](const CgnsNode& node) {
      const Condition condition = condition_of(node);
      if (condition.is_empty) return;
      const PatchKind kind = mesh_.patches[condition.patch].kind;
      if (kind != PatchKind::wall && kind != PatchKind::slip) {
        ++n_conditions_left_out_;
        return;
      }
      if (!condition.is_range || rank != 3) throw_unsupported(tree_.source(), node.path + ": a structured condition that is not a range of nodes");
      condition.points.require_integers(6, "first and last node of a range");
      std::array<std::int64_t, 3> first, last;
      for (std::size_t k = 0; k < 3; ++k) {
        first[k] = std::min(condition.points.integer(k), condition.points.integer(k + 3));
        last[k] = std::max(condition.points.integer(k), condition.points.integer(k + 3));
        if (first[k] < 1 || last[k] > shape_[k])
          condition.points.fail("found the nodes " + std::to_string(first[k]) + " to " + std::to_string(last[k]) + " of " + std::to_string(shape_[k]));
      }
      add_quads(first, last, condition.patch);
    });
  }

  /// Adds quads between the nodes first .. last, where one of the three ranges is a single index.
  void add_quads(const std::array<std::int64_t, 3>& first, const std::array<std::int64_t, 3>& last, PatchId patch) {
    std::vector<std::size_t> along;
    for (std::size_t k = 0; k < 3; ++k)
      if (last[k] > first[k]) along.push_back(k);
    if (along.size() == 3) throw_unsupported(tree_.source(), zone_->path + ": a condition over a volume");
    if (along.size() < 2) return;  // a line has no faces
    const std::array<std::int64_t, 3> stride = {1, shape_[0], shape_[0] * shape_[1]};
    const auto node = [&](std::int64_t i, std::int64_t j) {
      std::array<std::int64_t, 3> at = first;
      at[along[0]] = i;
      at[along[1]] = j;
      std::int64_t index = 0;
      for (std::size_t k = 0; k < 3; ++k) index += (at[k] - 1) * stride[k];
      return NodeId(static_cast<std::uint32_t>(first_node_ + static_cast<std::size_t>(index)));
    };
    for (std::int64_t j = first[along[1]]; j < last[along[1]]; ++j)
      for (std::int64_t i = first[along[0]]; i < last[along[0]]; ++i)
        mesh_.boundary_quads.push_back({{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)}, patch});
  }

  /// Removes patches named after sections whose faces were all assigned to conditions.
  void drop_empty_patches() {
    std::vector<bool> is_used(mesh_.patches.size(), false);
    for (const auto& face : mesh_.boundary_triangles) is_used[face.patch.index()] = true;
    for (const auto& face : mesh_.boundary_quads) is_used[face.patch.index()] = true;
    Column<PatchId, Patch> kept;
    std::vector<PatchId> position(mesh_.patches.size());
    for (const PatchId patch : mesh_.patches.ids())
      if (is_used[patch.index()]) position[patch.index()] = kept.push_back(mesh_.patches[patch]);
    for (auto& face : mesh_.boundary_triangles) face.patch = position[face.patch.index()];
    for (auto& face : mesh_.boundary_quads) face.patch = position[face.patch.index()];
    mesh_.patches = std::move(kept);
  }

  const CgnsTree& tree_;
  Contents contents_;
  const RunContext& context_;
  HybridMesh mesh_;
  std::map<std::string, PatchId> patches_;
  std::map<std::string, Family> families_;
  // zone state
  const CgnsNode* zone_ = nullptr;
  std::size_t first_node_ = 0;
  std::int64_t n_nodes_ = 0;
  std::array<std::int64_t, 3> shape_{};
  std::int64_t last_cell_ = 0;  ///< highest element number of a volume cell
  std::vector<Face> faces_;
  // section state
  const CgnsNode* section_ = nullptr;
  std::optional<PatchId> section_patch_;

  std::uint64_t n_left_out_ = 0, n_conditions_left_out_ = 0;
  std::uint64_t n_cells_ = 0;  ///< in the file
};

FileBoundary read(const std::filesystem::path& path, Contents contents, const RunContext& context) {
  const ContainerImage image = read_container(path, ContainerFormat::cgns, cgns_labels_beside_the_mesh(), context);
  const CgnsTree tree(image);
  CgnsReader reader(tree, contents, context);
  FileBoundary result;
  result.mesh = reader.read();
  result.n_cells = reader.n_cells();
  return result;
}

}  // namespace

HybridMesh read_volume_cgns(const std::filesystem::path& path, const RunContext& context) {
  HybridMesh mesh = read(path, Contents::volume, context).mesh;
  context.progress(0.7);
  orient_mesh(mesh, context);
  return mesh;
}

FileBoundary read_boundary_cgns(const std::filesystem::path& path, const RunContext& context) { return read(path, Contents::boundary, context); }

}  // namespace sterna::io
