// CGNS writer, docs/method/formats.md, "CGNS writer". The tree is described first; then its arrays are streamed.
#include <algorithm>
#include <cctype>
#include <limits>
#include <set>

#include "geom/base/error.h"
#include "geom/mesh/periodic.h"
#include "io/container/cgns_elements.h"
#include "io/container/cgns_output.h"
#include "io/output/cell_sections.h"
#include "io/volume/volume_cgns.h"

namespace sterna::io {
namespace {

constexpr std::string_view k_quad_suffix = "_quad";
constexpr float k_hdf5_version = 3.4f;  ///< since this version, the fixed-type sections are valid
constexpr float k_adf_version = 2.54f;
/// Zone name of meshio, and its section name for a mesh of tetrahedra only, which is all that meshio reads of CGNS; other programs accept any name.
constexpr const char *k_zone_name = "Zone1", *k_only_section = "GridElements";
/// Names of nodes other than sections, conditions and families.
constexpr std::array<const char*, 14> k_taken_names = {
    "ZoneGridConnectivity", "Zone",    k_zone_name, k_only_section, "ZoneType", "ZoneBC", "GridCoordinates", "DataClass",
    "DimensionalUnits",     "PENTA_6", "PYRA_5",    "HEXA_8",       "TETRA_4",  "."};

/// Cuts a UTF-8 string to at most n bytes, at a character boundary.
std::string cut_text(std::string text, std::size_t n) {
  if (text.size() <= n) return text;
  while (n > 0 && (static_cast<unsigned char>(text[n]) & 0xC0u) == 0x80u) --n;
  text.resize(n);
  return text;
}

/// Returns an ASCII name for ADF nodes, with one underscore for each other character.
std::string ascii_name(std::string_view utf8) {
  std::string name;
  for (const char c : utf8) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continues_character = (byte & 0xC0U) == 0x80U;
    if (byte < 0x80U) name += c;
    else if (!continues_character) name += '_';
  }
  return name;
}

/// Returns node names for the patches. Names of patches with both triangles and quads leave room for the suffix.
std::vector<std::string> node_names(const HybridMesh& mesh, const FacesByPatch& faces, bool is_adf, const RunContext& context) {
  std::set<std::string, std::less<>> taken(k_taken_names.begin(), k_taken_names.end());
  std::vector<std::string> names;
  for (const PatchId patch : mesh.patches.ids()) {
    names.emplace_back();
    if (faces.count(patch) == 0) continue;
    const bool has_both = !faces.triangles(patch).empty() && !faces.quads(patch).empty();
    const std::size_t limit = k_cgns_name - (has_both ? k_quad_suffix.size() : 0);
    std::string stem = is_adf ? ascii_name(mesh.patches[patch].name) : mesh.patches[patch].name;
    std::replace_if(
        stem.begin(), stem.end(), [](char c) { return c == '/' || std::iscntrl(static_cast<unsigned char>(c)) != 0; }, '_');
    while (stem.ends_with(' ')) stem.pop_back();
    while (stem.starts_with(' ')) stem.erase(0, 1);
    if (stem.empty() || stem == "..") stem = "patch_" + std::to_string(patch.value() + 1);
    const auto cut_stem = [&](std::size_t n) {
      std::string text = cut_text(stem, n);
      while (text.ends_with(' ')) text.pop_back();
      return text;
    };
    std::string name = cut_stem(limit);
    const auto is_taken = [&] { return taken.count(name) > 0 || (has_both && taken.count(name + std::string(k_quad_suffix)) > 0); };
    for (int i = 2; is_taken(); ++i) {
      const std::string number = "_" + std::to_string(i);
      name = cut_stem(limit - number.size()) + number;
    }
    taken.insert(name);
    if (has_both) taken.insert(name + std::string(k_quad_suffix));
    if (name != mesh.patches[patch].name) context.warn("patch \"" + mesh.patches[patch].name + "\" is named \"" + name + "\" in the CGNS file");
    names.back() = std::move(name);
  }
  return names;
}

class CgnsWriter {
 public:
  CgnsWriter(const HybridMesh& mesh, bool is_adf, CgnsIntegers integers, const std::string& path, const RunContext& context)
      : mesh_(mesh), cells_(mesh), faces_(mesh), names_(node_names(mesh, faces_, is_adf, context)), is_adf_(is_adf) {
    const std::uint64_t n_faces = mesh.boundary_triangles.size() + mesh.boundary_quads.size();
    std::uint64_t largest = std::max<std::uint64_t>(mesh.points.size(), cells_.total() + n_faces);
    for (const CellKind kind : k_kinds_in_file) largest = std::max(largest, cells_.count(kind) * static_cast<std::uint64_t>(n_nodes(kind)));
    constexpr std::uint64_t k_max_narrow = std::numeric_limits<std::int32_t>::max();
    if (is_adf) require_count(largest, k_max_narrow, "nodes, elements or corners of a section", "CGNS 2.54 in ADF (64-bit: HDF5, .cgns)", path);
    is_wide_ = largest > k_max_narrow || integers == CgnsIntegers::always_64;
    if (is_adf && is_wide_)
      throw Error({.code = ErrorCode::unsupported_format,
                   .attempted = "writing " + path,
                   .problem = "CGNS 2.54 in ADF has no 64-bit integers",
                   .hint = "write HDF5: .cgns"});
  }

  void write(const std::filesystem::path& path, const RunContext& context) const {
    CgnsOutputNode root = cgns_node("", "");
    root.children.push_back(
        cgns_node("CGNSLibraryVersion", "CGNSLibraryVersion_t", output_numbers<float>(NumberKind::f4, {1}, {is_adf_ ? k_adf_version : k_hdf5_version})));
    root.children.push_back(base());
    if (is_adf_) write_cgns_adf(root, path, context);
    else write_cgns_hdf5(root, path, context);
  }

 private:
  CgnsOutputNode text_node(std::string name, std::string label, std::string_view text) const {
    return cgns_node(std::move(name), std::move(label), output_text(std::string(text)));
  }

  OutputArray sizes(std::vector<std::uint64_t> extents, const std::vector<std::uint64_t>& values) const {
    if (is_wide_) return output_numbers(NumberKind::i8, std::move(extents), std::vector<std::int64_t>(values.begin(), values.end()));
    return output_numbers(NumberKind::i4, std::move(extents), std::vector<std::int32_t>(values.begin(), values.end()));
  }

  bool is_surface() const { return cells_.total() == 0; }

  CgnsOutputNode base() const {
    CgnsOutputNode base = cgns_node("Base", "CGNSBase_t", output_numbers<std::int32_t>(NumberKind::i4, {2}, {is_surface() ? 2 : 3, 3}));
    CgnsOutputNode zone =
        cgns_node(k_zone_name, "Zone_t",
                  sizes({1, 3}, {mesh_.points.size(), is_surface() ? mesh_.boundary_triangles.size() + mesh_.boundary_quads.size() : cells_.total(), 0}));
    zone.children.push_back(text_node("ZoneType", "ZoneType_t", "Unstructured"));
    zone.children.push_back(coordinates());
    std::uint64_t n_elements = 0;
    for (const CellKind kind : k_kinds_in_file)
      if (cells_.count(kind) > 0) zone.children.push_back(cell_section(kind, n_elements));
    CgnsOutputNode conditions = cgns_node("ZoneBC", "ZoneBC_t");
    std::vector<CgnsOutputNode> families;
    for (const PatchId patch : mesh_.patches.ids()) {
      if (faces_.count(patch) == 0) continue;
      const std::uint64_t first = n_elements + 1;
      add_face_sections(patch, zone, n_elements);
      conditions.children.push_back(condition(patch, first, n_elements));
      families.push_back(family(patch));
    }
    if (!conditions.children.empty()) zone.children.push_back(std::move(conditions));
    if (!mesh_.periodic.empty()) zone.children.push_back(connectivity());
    base.children.push_back(std::move(zone));
    for (CgnsOutputNode& family : families) base.children.push_back(std::move(family));
    base.children.push_back(text_node("DataClass", "DataClass_t", "Dimensional"));
    std::string units;
    for (std::string unit : {"Kilogram", "Meter", "Second", "Kelvin", "Degree"}) {
      unit.resize(k_cgns_name, ' ');
      units += unit;
    }
    CgnsOutputNode units_node = text_node("DimensionalUnits", "DimensionalUnits_t", units);
    units_node.array.extents = {k_cgns_name, 5};
    base.children.push_back(std::move(units_node));
    return base;
  }

  CgnsOutputNode coordinates() const {
    CgnsOutputNode grid = cgns_node("GridCoordinates", "GridCoordinates_t");
    if (mesh_.points.empty()) return grid;
    constexpr std::array<const char*, 3> k_axis_names = {"CoordinateX", "CoordinateY", "CoordinateZ"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto format = [&mesh = mesh_, axis](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
        char* at = out.reserve((end - begin) * sizeof(double));
        for (std::uint64_t i = begin; i < end; ++i) {
          const Point& p = mesh.points.raw()[i];
          if (!is_finite(p)) throw_node_not_finite(i);
          at = put_bytes(at, p[axis], std::endian::little);
        }
        out.end_at(at);
      };
      CgnsOutputNode values =
          cgns_node(k_axis_names[axis], "DataArray_t",
                    {.kind = NumberKind::f8, .extents = {mesh_.points.size()}, .content = {{.n_items = mesh_.points.size(), .format = format}}});
      values.children.push_back(cgns_node("DimensionalExponents", "DimensionalExponents_t", output_numbers<float>(NumberKind::f4, {5}, {0, 1, 0, 0, 0})));
      grid.children.push_back(std::move(values));
    }
    return grid;
  }

  /// Returns a section of n elements after the n_elements before it; `format` gives the corners.
  CgnsOutputNode section(std::string name, std::int64_t type, std::uint64_t n, std::uint64_t size, std::uint64_t& n_elements,
                         decltype(OutputSection::format) format) const {
    CgnsOutputNode node = cgns_node(std::move(name), "Elements_t", output_numbers<std::int32_t>(NumberKind::i4, {2}, {static_cast<std::int32_t>(type), 0}));
    node.children.push_back(cgns_node("ElementRange", "IndexRange_t", sizes({2}, {n_elements + 1, n_elements + n})));
    node.children.push_back(
        cgns_node("ElementConnectivity", "DataArray_t",
                  {.kind = is_wide_ ? NumberKind::i8 : NumberKind::i4, .extents = {n * size}, .content = {{.n_items = n, .format = std::move(format)}}}));
    n_elements += n;
    return node;
  }

  static char* put_nodes(char* at, std::span<const NodeId> nodes, bool is_wide) {
    for (const NodeId node : nodes) {
      const std::int64_t number = static_cast<std::int64_t>(node.value()) + 1;
      at = is_wide ? put_bytes(at, number, std::endian::little) : put_bytes(at, static_cast<std::int32_t>(number), std::endian::little);
    }
    return at;
  }

  CgnsOutputNode cell_section(CellKind kind, std::uint64_t& n_elements) const {
    const std::uint64_t size = static_cast<std::uint64_t>(n_nodes(kind));
    const bool is_only_kind = kind == CellKind::tetrahedron && cells_.count(kind) == cells_.total();
    return section(is_only_kind ? k_only_section : std::string(cgns_name(kind)), cgns_type(kind), cells_.count(kind), size, n_elements,
                   [&cells = cells_, kind, size, is_wide = is_wide_](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                     char* at = out.reserve((end - begin) * size * 8);
                     cells.for_each(kind, begin, end, [&](std::span<const NodeId> nodes, int) { at = put_nodes(at, nodes, is_wide); });
                     out.end_at(at);
                   });
  }

  template <class Face>
  static decltype(OutputSection::format) face_format(const std::vector<Face>& faces, std::span<const std::uint32_t> which, bool is_wide) {
    return [&faces, which, is_wide](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
      char* at = out.reserve((end - begin) * 4 * 8);
      for (std::uint64_t i = begin; i < end; ++i) at = put_nodes(at, faces[which[i]].nodes, is_wide);
      out.end_at(at);
    };
  }

  void add_face_sections(PatchId patch, CgnsOutputNode& zone, std::uint64_t& n_elements) const {
    const std::string& name = names_[patch.index()];
    const std::span<const std::uint32_t> triangles = faces_.triangles(patch), quads = faces_.quads(patch);
    if (!triangles.empty())
      zone.children.push_back(section(name, k_cgns_triangle, triangles.size(), 3, n_elements, face_format(mesh_.boundary_triangles, triangles, is_wide_)));
    if (!quads.empty())
      zone.children.push_back(section(triangles.empty() ? name : name + std::string(k_quad_suffix), k_cgns_quad, quads.size(), 4, n_elements,
                                      face_format(mesh_.boundary_quads, quads, is_wide_)));
  }

  CgnsOutputNode condition(PatchId patch, std::uint64_t first, std::uint64_t last) const {
    CgnsOutputNode node = text_node(names_[patch.index()], "BC_t", "FamilySpecified");
    // In a base of two dimensions the faces are the cells. Before version 3 a condition refers to elements directly.
    if (is_adf_ && !is_surface()) {
      node.children.push_back(cgns_node("ElementRange", "IndexRange_t", sizes({1, 2}, {first, last})));
    } else {
      node.children.push_back(cgns_node("PointRange", "IndexRange_t", sizes({1, 2}, {first, last})));
      node.children.push_back(text_node("GridLocation", "GridLocation_t", is_surface() ? "CellCenter" : "FaceCenter"));
    }
    node.children.push_back(text_node("FamilyName", "FamilyName_t", names_[patch.index()]));
    return node;
  }

  /// Returns the connectivity of periodic sides, once from each side: their nodes in the same order, and the translation to the other side. CGNS uses 32-bit
  /// numbers here.
  CgnsOutputNode connectivity() const {
    CgnsOutputNode all = cgns_node("ZoneGridConnectivity", "ZoneGridConnectivity_t");
    for (const PeriodicSides& sides : mesh_.periodic) {
      const PeriodicMatch match = match_periodic(mesh_, sides.first, sides.second, periodic_tolerance(mesh_));
      for (const std::size_t from : {std::size_t{0}, std::size_t{1}}) {
        std::vector<std::uint64_t> own, others;
        for (const auto& pair : match.nodes) {
          own.push_back(pair[from].value() + 1ull);
          others.push_back(pair[1 - from].value() + 1ull);
        }
        const auto vector_node = [](const char* name, const Vec3& v, bool is_angle = false) {
          CgnsOutputNode node = cgns_node(
              name, "DataArray_t", output_numbers<float>(NumberKind::f4, {3}, {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}));
          node.children.push_back(cgns_node("DimensionalExponents", "DimensionalExponents_t",
                                            output_numbers<float>(NumberKind::f4, {5}, {0, is_angle ? 0.0f : 1.0f, 0, 0, is_angle ? 1.0f : 0.0f})));
          return node;
        };
        CgnsOutputNode periodic = cgns_node("Periodic", "Periodic_t");
        periodic.children.push_back(vector_node("RotationCenter", {}));
        periodic.children.push_back(vector_node("RotationAngle", {}, true));
        periodic.children.push_back(vector_node("Translation", from == 0 ? sides.translation : -sides.translation));
        CgnsOutputNode property = cgns_node("GridConnectivityProperty", "GridConnectivityProperty_t");
        property.children.push_back(std::move(periodic));
        CgnsOutputNode node = text_node(names_[(from == 0 ? sides.first : sides.second).index()], "GridConnectivity_t", k_zone_name);
        node.children.push_back(text_node("GridConnectivityType", "GridConnectivityType_t", "Abutting1to1"));
        node.children.push_back(cgns_node("PointList", "IndexArray_t", sizes({1, own.size()}, own)));
        node.children.push_back(cgns_node("PointListDonor", "IndexArray_t", sizes({1, others.size()}, others)));
        node.children.push_back(std::move(property));
        all.children.push_back(std::move(node));
      }
    }
    return all;
  }

  CgnsOutputNode family(PatchId patch) const {
    const Patch& data = mesh_.patches[patch];
    CgnsOutputNode node = cgns_node(names_[patch.index()], "Family_t");
    node.children.push_back(text_node("FamBC", "FamilyBC_t", cgns_condition(data.kind)));
    if (names_[patch.index()] != data.name && !data.name.empty()) node.children.push_back(text_node(std::string(k_cgns_name_note), "Descriptor_t", data.name));
    return node;
  }

  const HybridMesh& mesh_;
  CellSections cells_;
  FacesByPatch faces_;
  std::vector<std::string> names_;
  bool is_adf_;
  bool is_wide_ = false;  ///< 64-bit integers
};

bool is_adf_name(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.ends_with(".adf.cgns");
}

}  // namespace

void write_volume_cgns(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_volume_cgns(mesh, path, CgnsIntegers::as_needed, context);
}

void write_volume_cgns(const HybridMesh& mesh, const std::filesystem::path& path, CgnsIntegers integers, const RunContext& context) {
  CgnsWriter(mesh, is_adf_name(path), integers, path.string(), context).write(path, context);
}

}  // namespace sterna::io
