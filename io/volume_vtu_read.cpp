// VTU reader: tags, then the arrays of each piece, then cells by type; windings are repaired at the end.
#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "geom/base/error.h"
#include "io/orientation.h"
#include "io/patch_names.h"
#include "io/volume_vtu.h"
#include "io/vtk_cells.h"
#include "io/vtu_arrays.h"

namespace sterna::io {
namespace {

/// Cell arrays that number boundaries, in order of preference.
constexpr std::array<std::string_view, 5> k_marker_names = {"marker", "boundary", "CellEntityIds", "gmsh:physical", "ids"};
constexpr std::string_view k_patch_prefix = "patch:";

/// Tags of the arrays of one piece.
struct Piece {
  const XmlTag* tag = nullptr;
  const XmlTag* points = nullptr;
  const XmlTag* connectivity = nullptr;
  const XmlTag* offsets = nullptr;
  const XmlTag* types = nullptr;
  std::vector<const XmlTag*> cell_data;
};

struct Outline {
  std::vector<Piece> pieces;
  std::vector<const XmlTag*> field_data;
};

Outline outline_of(const std::vector<XmlTag>& tags, std::string_view source) {
  Outline outline;
  std::string section;
  for (const XmlTag& tag : tags) {
    if (tag.name == "VTKFile" && tag.attribute("type") != "UnstructuredGrid")
      throw_unsupported(source, "the file holds " + quoted_excerpt(tag.attribute("type")) + ", not an UnstructuredGrid");
    if (tag.name == "Piece") outline.pieces.push_back({.tag = &tag});
    if (tag.name == "Points" || tag.name == "Cells" || tag.name == "CellData" || tag.name == "PointData" || tag.name == "FieldData") section = tag.name;
    if (tag.name == "/FieldData") section.clear();
    if (tag.name != "DataArray") continue;
    if (section == "FieldData") outline.field_data.push_back(&tag);
    if (outline.pieces.empty()) continue;
    Piece& piece = outline.pieces.back();
    if (section == "Points") piece.points = &tag;
    if (section == "CellData") piece.cell_data.push_back(&tag);
    if (section == "Cells" && tag.attribute("Name") == "connectivity") piece.connectivity = &tag;
    if (section == "Cells" && tag.attribute("Name") == "offsets") piece.offsets = &tag;
    if (section == "Cells" && tag.attribute("Name") == "types") piece.types = &tag;
  }
  if (outline.pieces.empty()) throw_malformed(source, "byte 0", "found no <Piece> of an UnstructuredGrid");
  return outline;
}

std::optional<PatchKind> kind_named(std::string_view name) {
  for (const PatchKind kind : {PatchKind::wall, PatchKind::slip, PatchKind::symmetry, PatchKind::inflow, PatchKind::outflow, PatchKind::farfield, PatchKind::interface})
    if (to_string(kind) == name) return kind;
  return std::nullopt;
}

/// Patches by marker: the named ones of the field data first, others as they appear.
class PatchTable {
 public:
  explicit PatchTable(Column<PatchId, Patch>& patches) : patches_(patches) {}

  void add_named(std::string_view field_name, std::uint64_t marker) {
    if (!field_name.starts_with(k_patch_prefix)) return;
    const std::string_view rest = field_name.substr(k_patch_prefix.size());
    const std::size_t colon = rest.find(':');
    const auto kind = kind_named(rest.substr(0, colon));
    if (colon == std::string_view::npos || !kind) return;
    by_marker_[marker] = patches_.push_back({.name = std::string(rest.substr(colon + 1)), .kind = *kind});
  }

  PatchId patch_of(std::uint64_t marker) {
    const auto [entry, is_new] = by_marker_.try_emplace(marker);
    if (is_new) entry->second = find_or_add_patch(patches_, "patch_" + std::to_string(static_cast<std::int64_t>(marker)));
    return entry->second;
  }

 private:
  Column<PatchId, Patch>& patches_;
  std::map<std::uint64_t, PatchId> by_marker_;
};

class PieceReader {
 public:
  PieceReader(const VtuDecoder& decoder, std::string_view source, HybridMesh& mesh, PatchTable& patches)
      : decoder_(decoder), source_(source), mesh_(mesh), patches_(patches) {}

  std::int64_t n_dropped() const { return n_dropped_; }

  void read(const Piece& piece) {
    piece_ = &piece;
    const std::size_t first_node = mesh_.points.size();
    read_points();
    const VtuValues connectivity = decode_integers(piece.connectivity, "connectivity");
    const VtuValues offsets = decode_integers(piece.offsets, "offsets");
    const VtuValues types = decode_integers(piece.types, "types");
    if (types.size() != offsets.size()) fail("found " + std::to_string(types.size()) + " types for " + std::to_string(offsets.size()) + " offsets");
    const std::optional<VtuValues> markers = decode_markers(types.size());
    const std::uint64_t n_nodes = mesh_.points.size() - first_node;
    std::uint64_t begin = 0;
    for (std::size_t i = 0; i < types.size(); ++i) {
      const std::uint64_t end = offsets.id(i);
      if (end < begin || end > connectivity.size())
        fail("cell " + std::to_string(i) + " has the offset " + std::to_string(end) + ", expected " + std::to_string(begin) + " to " + std::to_string(connectivity.size()));
      nodes_.clear();
      for (std::uint64_t k = begin; k < end; ++k) {
        const std::uint64_t node = connectivity.id(k);
        if (node >= n_nodes) fail("cell " + std::to_string(i) + " has the node " + std::to_string(static_cast<std::int64_t>(node)) + ", there are " + std::to_string(n_nodes));
        nodes_.push_back(NodeId(std::uint64_t{first_node + node}));
      }
      add_cell(i, static_cast<std::int64_t>(types.id(i)), markers ? markers->id(i) : 0);
      begin = end;
    }
  }

 private:
  void read_points() {
    const VtuValues values = decode(piece_->points, "Points");
    if (values.size() % 3 != 0) fail("found " + std::to_string(values.size()) + " coordinates, not a multiple of 3");
    const std::size_t first = mesh_.points.size();
    const std::size_t n = values.size() / 3;
    if (first + n >= NodeId::k_invalid) throw_id_overflow(first + n);
    if (piece_->tag->attribute("NumberOfPoints") != std::to_string(n))
      fail("found " + std::to_string(n) + " points, expected " + std::string(piece_->tag->attribute("NumberOfPoints")) + " (NumberOfPoints)");
    mesh_.points.resize(first + n);
    for (std::size_t i = 0; i < n; ++i) {
      const Point p{values.real(3 * i), values.real(3 * i + 1), values.real(3 * i + 2)};
      if (!is_finite(p)) fail("the coordinates of point " + std::to_string(i) + " are not finite");
      mesh_.points.raw()[first + i] = p;
    }
  }

  VtuValues decode(const XmlTag* tag, const char* what) const {
    if (!tag) fail(std::string("found no array \"") + what + "\"");
    return decoder_.decode(*tag);
  }

  VtuValues decode_integers(const XmlTag* tag, const char* what) const {
    VtuValues values = decode(tag, what);
    if (!values.is_integer()) fail(std::string("the array \"") + what + "\" is not of integers");
    return values;
  }

  std::optional<VtuValues> decode_markers(std::size_t n_cells) const {
    for (const std::string_view name : k_marker_names) {
      for (const XmlTag* tag : piece_->cell_data) {
        if (tag->attribute("Name") != name || tag->attribute("type").starts_with("Float")) continue;
        VtuValues values = decoder_.decode(*tag);
        if (values.size() != n_cells) fail("found " + std::to_string(values.size()) + " values of \"" + std::string(name) + "\" for " + std::to_string(n_cells) + " cells");
        return values;
      }
    }
    return std::nullopt;
  }

  template <std::size_t N>
  std::array<NodeId, N> taken(std::size_t cell, const std::array<std::uint8_t, 8>& order) const {
    if (nodes_.size() != N) fail("cell " + std::to_string(cell) + " has " + std::to_string(nodes_.size()) + " nodes, expected " + std::to_string(N));
    std::array<NodeId, N> result;
    for (std::size_t k = 0; k < N; ++k) result[order[k]] = nodes_[k];
    return result;
  }

  void add_cell(std::size_t cell, std::int64_t type, std::uint64_t marker) {
    constexpr std::array<std::uint8_t, 8> k_same = {0, 1, 2, 3, 4, 5, 6, 7};
    if (const auto kind = kind_of_vtk_type(type)) {
      switch (*kind) {
        case CellKind::tetrahedron: mesh_.tetrahedra.push_back(taken<4>(cell, k_same)); break;
        case CellKind::pyramid: mesh_.pyramids.push_back(taken<5>(cell, k_same)); break;
        case CellKind::prism: mesh_.prisms.push_back(taken<6>(cell, vtk_order(CellKind::prism))); break;
        case CellKind::hexahedron: mesh_.hexahedra.push_back(taken<8>(cell, k_same)); break;
      }
    } else if (type == k_vtk_triangle) {
      mesh_.boundary_triangles.push_back({taken<3>(cell, k_same), patches_.patch_of(marker)});
    } else if (type == k_vtk_quad) {
      mesh_.boundary_quads.push_back({taken<4>(cell, k_same), patches_.patch_of(marker)});
    } else if (type >= k_vtk_vertex && type < k_vtk_triangle) {
      ++n_dropped_;  // vertices and lines bound nothing
    } else {
      throw_unsupported(source_, "cell " + std::to_string(cell) + " is of VTK type " + std::to_string(type),
                        "tetrahedra, pyramids, wedges, hexahedra, triangles and quads are read");
    }
  }

  [[noreturn]] void fail(const std::string& problem) const { throw_malformed(source_, "piece at byte " + std::to_string(piece_->tag->offset), problem); }

  const VtuDecoder& decoder_;
  std::string_view source_;
  HybridMesh& mesh_;
  PatchTable& patches_;
  const Piece* piece_ = nullptr;
  std::vector<NodeId> nodes_;
  std::int64_t n_dropped_ = 0;
};

}  // namespace

HybridMesh read_volume_vtu(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  const std::vector<XmlTag> tags = scan_xml_tags(buffer.text(), "AppendedData", buffer.source);
  const Outline outline = outline_of(tags, buffer.source);
  const VtuDecoder decoder(buffer, tags, context);
  HybridMesh mesh;
  PatchTable patches(mesh.patches);
  for (const XmlTag* tag : outline.field_data) {
    if (!tag->attribute("Name").starts_with(k_patch_prefix)) continue;
    const VtuValues values = decoder.decode(*tag);
    if (values.size() == 1 && values.is_integer()) patches.add_named(tag->attribute("Name"), values.id(0));
  }
  PieceReader reader(decoder, buffer.source, mesh, patches);
  for (const Piece& piece : outline.pieces) reader.read(piece);
  if (reader.n_dropped() > 0) context.info("vertices and lines left out: " + std::to_string(reader.n_dropped()));
  context.progress(0.8);
  orient_mesh(mesh, context);
  return mesh;
}

}  // namespace sterna::io
