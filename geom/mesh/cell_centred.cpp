#include "geom/mesh/cell_centred.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "geom/mesh/cell_lanes.h"
#include "geom/mesh/column_shapes.h"
#include "geom/mesh/forced_layer.h"
#include "geom/mesh/gate_items.h"
#include "geom/mesh/layer_scans.h"

namespace sterna::check_parts {
namespace {

constexpr std::uint8_t k_top = 7;

struct Corners {
  std::array<Point, 4> points;
  std::size_t n = 0;
  void add(const Point& p) { points[n++] = p; }
  std::span<const Point> span() const { return {points.data(), n}; }
};

void add_face(CellCentredScan& scan, std::uint64_t id, const InnerFace& face, bool is_quad) {
  scan.non_orthogonality.add(face.non_orthogonality, id);
  scan.skewness.add(face.skewness, id);
  scan.face_weight.add(face.weight, id);
  scan.volume_ratio.add(face.volume_ratio, id);
  if (is_quad) scan.face_flatness.add(face.flatness, id);
  scan.face_tets.add(face.tets, id);
}

/// Adds a face between two cells of one column.
void add_stacked(CellCentredScan& scan, std::uint64_t id, const InnerFace& face) {
  add_face(scan, id, face, false);
  scan.stacked_orthogonality.add(face.non_orthogonality, id);
  scan.stacked_skewness.add(face.skewness, id);
}

void add_outer(CellCentredScan& scan, std::uint64_t id, std::span<const Point> corners, const CellCentre& cell) {
  const OuterFace face = outer_face(corners, cell);
  scan.skewness.add(face.skewness, id);
  if (corners.size() == 4) scan.face_flatness.add(face.flatness, id);
  scan.face_tets.add(face.tets, id);
}

/// Faces of cells on the boundary; faces of periodic sides do not count, since flow passes through them.
class OuterFaces {
 public:
  OuterFaces(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match)
      : slots_(slots), has_any_(cells.first_tetrahedron() + mesh.tetrahedra.size(), 0) {
    std::vector<std::uint8_t> is_periodic(mesh.patches.size(), 0);
    for (const PeriodicSides& sides : mesh.periodic) is_periodic[sides.first.index()] = is_periodic[sides.second.index()] = 1;
    for (std::size_t i = 0; i < match.outer.size(); ++i) {
      if (is_periodic[slots.patch(match.outer_boundary[i]).index()] != 0) continue;
      const std::uint64_t owner = slots.owner(match.outer[i]);
      faces_.push_back({owner, match.outer[i]});
      has_any_[owner] = 1;
    }
    std::sort(faces_.begin(), faces_.end());
  }

  bool has_any(std::uint64_t number) const { return has_any_[number] != 0; }
  /// Returns a bit mask; bit f is set if face f of the cell is not a boundary face.
  unsigned inner(std::uint64_t number, const Cell& cell) const {
    unsigned bits = ~0u;
    if (has_any_[number] == 0) return bits;
    const auto local = cell_faces(cell.kind);
    for (auto own = std::lower_bound(faces_.begin(), faces_.end(), std::pair(number, std::uint32_t{0})); own != faces_.end() && own->first == number; ++own) {
      const Face outer = slots_.face(own->second);
      for (std::size_t f = 0; f < local.size(); ++f)
        if (is_same(cell, local[f], outer)) bits &= ~(1u << f);
    }
    return bits;
  }

 private:
  static bool is_same(const Cell& cell, const LocalFace& local, const Face& face) {
    // Faces of one cell share two nodes at most. A face of a degenerate cell repeats nodes, so the test is that every node of `face` is in the local face.
    for (std::size_t k = 0; k < face.size; ++k) {
      const auto has = [&](std::uint8_t node) { return cell.nodes[node] == face.nodes[k]; };
      if (std::none_of(local.nodes.begin(), local.nodes.begin() + local.size, has)) return false;
    }
    return true;
  }

  const FaceSlots& slots_;
  std::vector<std::uint8_t> has_any_;                           ///< per cell number
  std::vector<std::pair<std::uint64_t, std::uint32_t>> faces_;  ///< cell and slot, ascending
};

/// Returns the corners of a side of a column's cell, with its normal out of the cell; none if both lines of the side have ended.
Corners side_of(const HybridMesh& mesh, std::size_t column, std::size_t corner, int layer) {
  const LayerBlock::Side side = mesh.layers.side(column, corner, layer);
  Corners corners;
  for (std::size_t k = 0; k < side.size; ++k) corners.add(mesh.points[side.nodes[k]]);
  return corners;
}

Corners top_of(const HybridMesh& mesh, std::size_t column, int layer) {
  Corners corners;
  for (const std::uint32_t line : mesh.layers.base[column]) corners.add(mesh.points[mesh.layers.node(line, layer + 1)]);
  return corners;
}

Corners corners_of(const HybridMesh& mesh, const Face& face) {
  Corners corners;
  for (std::size_t k = 0; k < face.size; ++k) corners.add(mesh.points[face.nodes[k]]);
  return corners;
}

template <class Add>
CellCentredScan gathered(CellCentredScan scan, std::size_t n, const Add& add, const GateTable& limits, const RunContext& context,
                         std::size_t chunk = k_default_chunk) {
  return parallel_reduce(
      context, n, std::move(scan),
      [&](std::size_t begin, std::size_t end) {
        CellCentredScan part(limits);
        add(begin, end, part);
        return part;
      },
      [](CellCentredScan all, const CellCentredScan& more) { return joined(std::move(all), more); }, chunk);
}

/// Returns true if all faces of a cell of a column are between cells of columns. \pre prismatic
bool is_amid_columns(const LayerBlock& layers, std::span<const std::uint32_t> neighbours, std::size_t column, int layer) {
  if (layer == 0 || layer + 1 == layers.layers_of_column(column)) return false;
  return neighbours[3 * column] != k_no_slot && neighbours[3 * column + 1] != k_no_slot && neighbours[3 * column + 2] != k_no_slot;
}

/// Cells of columns and the faces between them, one chunk of columns after the other.
class ColumnCentres {
 public:
  ColumnCentres(const HybridMesh& mesh, std::span<const std::uint32_t> neighbours)
      : mesh_(mesh),
        neighbours_(neighbours),
        n_layers_(static_cast<std::uint64_t>(mesh.layers.n_layers)),
        stride_(n_layers_ + lanes::k_width),
        own_(mesh),
        beyond_(mesh),
        locations_beyond_(stride_) {}

  void add(std::size_t begin, std::size_t end, CellCentredScan& scan) {
    begin_ = begin;
    end_ = end;
    locations_.resize((end - begin) * stride_);
    for (std::size_t c = begin; c < end; ++c) {
      if (mesh_.layers.is_prismatic(c)) add_prisms(c, scan);
      else add_cells(c, scan);
    }
    for (std::size_t c = begin; c < end; ++c) {
      if (mesh_.layers.is_prismatic(c)) add_faces_of_prisms(c, scan);
      else add_faces(c, scan);
    }
  }

 private:
  CellCentre* locations_of(std::size_t column) { return locations_.data() + (column - begin_) * stride_; }

  /// Returns the places of a column after a given one.
  const CellCentre* locations_after(std::size_t column) {
    if (column < end_) return locations_of(column);
    if (mesh_.layers.is_prismatic(column)) {
      beyond_.read(column);
      beyond_.locations(locations_beyond_.data());
    } else {
      for (int j = 0, n = mesh_.layers.layers_of_column(column); j < n; ++j) {
        const CellShape shape = cell_shape(mesh_, mesh_.layers.cell(column, j));
        locations_beyond_[static_cast<std::size_t>(j)] = {shape.centre, shape.volume};
      }
    }
    return locations_beyond_.data();
  }

  void add_prisms(std::size_t c, CellCentredScan& scan) {
    own_.read(c);
    const std::span<const CellShape> cells = own_.cells();
    CellCentre* const locations = locations_of(c);
    for (std::size_t j = 0; j < cells.size(); ++j) {
      const std::uint64_t number = c * n_layers_ + j;
      locations[j] = {cells[j].centre, cells[j].volume};
      scan.cell_aspect_ratio.add(cells[j].aspect_ratio, number);
      scan.cell_openness.add(cells[j].openness, number);
      if (is_amid_columns(mesh_.layers, neighbours_, c, static_cast<int>(j))) scan.cell_determinant.add(cells[j].determinant, number);
    }
  }

  void add_cells(std::size_t c, CellCentredScan& scan) {
    CellCentre* const locations = locations_of(c);
    for (int j = 0, n = mesh_.layers.layers_of_column(c); j < n; ++j) {
      const std::uint64_t number = c * n_layers_ + static_cast<std::uint64_t>(j);
      const CellShape shape = cell_shape(mesh_, mesh_.layers.cell(c, j));
      locations[j] = {shape.centre, shape.volume};
      scan.cell_aspect_ratio.add(shape.aspect_ratio, number);
      scan.cell_openness.add(shape.openness, number);
    }
  }

  void add_faces_of_prisms(std::size_t c, CellCentredScan& scan) {
    own_.read(c);
    const std::uint64_t first = 8 * c * n_layers_;
    const std::span<const InnerFace> tops = own_.tops(locations_of(c));
    for (std::size_t j = 0; j < tops.size(); ++j) add_stacked(scan, first + 8 * j + k_top, tops[j]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = neighbours_[3 * c + k];
      if (other == k_no_slot || other < c) continue;
      const std::span<const InnerFace> sides = own_.side(k, locations_of(c), locations_after(other));
      for (std::size_t j = 0; j < sides.size(); ++j) add_face(scan, first + 8 * j + k, sides[j], true);
    }
  }

  void add_faces(std::size_t c, CellCentredScan& scan) {
    const int n = mesh_.layers.layers_of_column(c);
    const std::uint64_t first = 8 * c * n_layers_;
    const CellCentre* const locations = locations_of(c);
    for (int j = 0; j + 1 < n; ++j)
      add_stacked(scan, first + 8 * static_cast<std::uint64_t>(j) + k_top, inner_face(top_of(mesh_, c, j).span(), locations[j], locations[j + 1]));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = neighbours_[3 * c + k];
      if (other == k_no_slot || other < c) continue;
      const CellCentre* const beyond = locations_after(other);
      for (int j = 0; j < n; ++j) {
        const Corners side = side_of(mesh_, c, k, j);
        if (side.n >= 3) add_face(scan, first + 8 * static_cast<std::uint64_t>(j) + k, inner_face(side.span(), locations[j], beyond[j]), side.n == 4);
      }
    }
  }

  const HybridMesh& mesh_;
  std::span<const std::uint32_t> neighbours_;
  std::uint64_t n_layers_, stride_;
  std::size_t begin_ = 0, end_ = 0;
  ColumnShapes own_, beyond_;
  std::vector<CellCentre> locations_, locations_beyond_;
};

/// Explicit tetrahedra and the faces between them, four at a time.
class TetLanes {
 public:
  explicit TetLanes(const HybridMesh& mesh) : mesh_(mesh) {}

  static CellCentre location(const HybridMesh& mesh, std::uint32_t tet) {
    const auto& n = mesh.tetrahedra[tet];
    const Point &a = mesh.points[n[0]], &b = mesh.points[n[1]], &c = mesh.points[n[2]], &d = mesh.points[n[3]];
    return {(a + b + c + d) * 0.25, dot(b - a, cross(c - a, d - a)) / 6.0};
  }

  /// Adds n <= 4 consecutive tets, starting with `first`.
  void add_cells(std::uint32_t first, std::size_t n, std::uint64_t number, CellCentredScan& scan) {
    std::array<lanes::Vec3x4, 4> p{};
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < 4; ++i) lanes::set_lane(p[i], k, mesh_.points[mesh_.tetrahedra[first + k][i]]);
    std::array<lanes::FaceShapes, 4> faces;
    const auto local = cell_faces(CellKind::tetrahedron);
    for (std::size_t f = 0; f < 4; ++f)
      faces[f] = lanes::face_shapes(std::array<lanes::Vec3x4, 3>{p[local[f].nodes[0]], p[local[f].nodes[1]], p[local[f].nodes[2]]});
    const lanes::CellShapes shapes = lanes::cell_shapes(faces);
    for (std::size_t k = 0; k < n; ++k) {
      scan.cell_aspect_ratio.add(shapes.aspect_ratio[k], number + k);
      scan.cell_openness.add(shapes.openness[k], number + k);
    }
    determinants_ = shapes.determinant;
  }
  /// Returns the determinant of a tet of the last add_cells(), as if no face were on the boundary.
  double determinant(std::size_t k) const { return determinants_[k]; }

  /// Adds a face between two tets; it is measured together with the following faces.
  void add_face(std::uint64_t id, const Face& face, std::uint32_t tet, std::uint32_t other, CellCentredScan& scan) {
    for (std::size_t i = 0; i < 3; ++i) lanes::set_lane(corners_[i], n_, mesh_.points[face.nodes[i]]);
    const auto set = [&](lanes::CellCentres& locations, std::uint32_t of) {
      const CellCentre one = location(mesh_, of);
      lanes::set_lane(locations.centre, n_, one.centre);
      locations.volume[n_] = one.volume;
    };
    set(here_, tet);
    set(there_, other);
    ids_[n_++] = id;
    if (n_ == lanes::k_width) flush(scan);
  }
  void flush(CellCentredScan& scan) {
    const lanes::InnerFaces faces = lanes::inner_faces(corners_, lanes::face_shapes(corners_), here_, there_, n_);
    for (std::size_t k = 0; k < n_; ++k)
      check_parts::add_face(scan, ids_[k], {faces.non_orthogonality[k], faces.skewness[k], faces.weight[k], faces.volume_ratio[k], 1.0, faces.tets[k]}, false);
    n_ = 0;
  }

 private:
  const HybridMesh& mesh_;
  std::size_t n_ = 0;
  std::array<std::uint64_t, lanes::k_width> ids_{};
  std::array<lanes::Vec3x4, 3> corners_{};
  lanes::CellCentres here_{}, there_{};
  lanes::Packed determinants_{};
};

/// All cells and faces that scan_column_centres() leaves out.
class OtherCentres {
 public:
  OtherCentres(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match, std::span<const std::uint32_t> neighbours)
      : mesh_(mesh),
        cells_(cells),
        slots_(slots),
        match_(match),
        neighbours_(neighbours),
        outer_(mesh, cells, slots, match),
        kept_(cells.first_tetrahedron() - cells.first_prism()) {}

  /// Adds the determinants of cells at the ends and open sides of columns.
  void add_columns(std::size_t begin, std::size_t end, CellCentredScan& scan) const {
    const LayerBlock& layers = mesh_.layers;
    for (std::size_t c = begin; c < end; ++c) {
      const bool is_prismatic = layers.is_prismatic(c);
      for (int j = 0, n = layers.layers_of_column(c); j < n; ++j) {
        if (is_prismatic && is_amid_columns(layers, neighbours_, c, j)) {
          j = std::max(j, n - 2);  // the same holds for all layers below the last one
          continue;
        }
        const std::uint64_t number = c * static_cast<std::uint64_t>(layers.n_layers) + static_cast<std::uint64_t>(j);
        const Cell cell = layers.cell(c, j);
        scan.cell_determinant.add(cell_shape(mesh_, cell, outer_.inner(number, cell)).determinant, number);
      }
    }
  }

  /// Adds the explicit cells except tetrahedra.
  void add_explicit(std::size_t begin, std::size_t end, CellCentredScan& scan) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t number = cells_.first_prism() + i;
      const Cell cell = cells_.cell(number);
      const CellShape shape = cell_shape(mesh_, cell, outer_.inner(number, cell));
      kept_[i] = {shape.centre, shape.volume};
      scan.cell_aspect_ratio.add(shape.aspect_ratio, number);
      scan.cell_openness.add(shape.openness, number);
      scan.cell_determinant.add(shape.determinant, number);
    }
  }

  void add_tets(std::size_t begin, std::size_t end, CellCentredScan& scan) const {
    TetLanes four(mesh_);
    for (std::size_t i = begin; i < end; i += lanes::k_width) {
      const std::size_t n = std::min(lanes::k_width, end - i);
      const std::uint64_t first = cells_.first_tetrahedron() + i;
      four.add_cells(static_cast<std::uint32_t>(i), n, first, scan);
      for (std::size_t k = 0; k < n; ++k) {
        const bool is_inner = !outer_.has_any(first + k);
        const Cell cell = is_inner ? Cell{} : cells_.cell(first + k);
        scan.cell_determinant.add(is_inner ? four.determinant(k) : cell_shape(mesh_, cell, outer_.inner(first + k, cell)).determinant, first + k);
      }
    }
  }

  void add_pairs(std::size_t begin, std::size_t end, CellCentredScan& scan) const {
    TetLanes four(mesh_);
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b] = match_.pairs[i];
      const std::uint64_t id = CellCentredScan::k_of_slot + a;
      const Face face = slots_.face(a);
      if (!slots_.is_layer(a) && !slots_.is_layer(b)) {
        four.add_face(id, face, slots_.tet_of(a), slots_.tet_of(b), scan);
      } else {
        add_face(scan, id, inner_face(corners_of(mesh_, face).span(), location(slots_.owner(a)), location(slots_.owner(b))), face.size == 4);
      }
    }
    four.flush(scan);
  }

  void add_outer_faces(std::size_t begin, std::size_t end, CellCentredScan& scan) const {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t slot = match_.outer[i];
      add_outer(scan, CellCentredScan::k_of_slot + slot, corners_of(mesh_, slots_.face(slot)).span(), location(slots_.owner(slot)));
    }
  }

 private:
  CellCentre location(std::uint64_t number) const {
    if (number >= cells_.first_tetrahedron()) return TetLanes::location(mesh_, static_cast<std::uint32_t>(number - cells_.first_tetrahedron()));
    if (number >= cells_.first_prism()) return kept_[number - cells_.first_prism()];
    const CellShape shape = cell_shape(mesh_, cells_.cell(number));
    return {shape.centre, shape.volume};
  }

  const HybridMesh& mesh_;
  const CellNumbers& cells_;
  const FaceSlots& slots_;
  const FaceMatch& match_;
  std::span<const std::uint32_t> neighbours_;
  OuterFaces outer_;
  std::vector<CellCentre> kept_;  ///< explicit cells except tetrahedra
};

/// Items with the ids of CellCentredScan.
struct CentredFaceItems {
  const HybridMesh& mesh;
  const CellNumbers& cells;
  const FaceSlots& slots;

  std::pair<Point, std::string> operator()(std::uint64_t id) const {
    if (id >= CellCentredScan::k_of_slot) return SlotItems{slots, "face of "}(id - CellCentredScan::k_of_slot);
    return {face_shape(corners_of_column(id).span()).centre, (id % 8 == k_top ? "top of " : "side of ") + cells.name(id / 8)};
  }
  void gather(std::uint64_t id, GateExtent& extent) const {
    if (id >= CellCentredScan::k_of_slot) return SlotItems{slots, {}}.gather(id - CellCentredScan::k_of_slot, extent);
    const auto [column, layer] = location_of(id);
    if (id % 8 == k_top) {
      std::array<NodeId, 3> nodes;
      for (std::size_t k = 0; k < 3; ++k) nodes[k] = mesh.layers.node(mesh.layers.base[column][k], layer + 1);
      gather_face(nodes, id / 8, extent);
    } else {
      const LayerBlock::Side side = mesh.layers.side(column, id % 8, layer);
      gather_face(std::span(side.nodes).first(side.size), id / 8, extent);
    }
  }

 private:
  std::pair<std::size_t, int> location_of(std::uint64_t id) const {
    const std::uint64_t number = id / 8, n_layers = static_cast<std::uint64_t>(mesh.layers.n_layers);
    return {number / n_layers, static_cast<int>(number % n_layers)};
  }
  Corners corners_of_column(std::uint64_t id) const {
    const auto [column, layer] = location_of(id);
    return id % 8 == k_top ? top_of(mesh, column, layer) : side_of(mesh, column, id % 8, layer);
  }
};

GateScan scan_of(Measure measure, const GateTable& limits) { return {info_of(measure), limits[measure]}; }

}  // namespace

CellCentredScan::CellCentredScan(const GateTable& limits)
    : non_orthogonality(scan_of(Measure::non_orthogonality, limits)),
      skewness(scan_of(Measure::skewness, limits)),
      face_weight(scan_of(Measure::face_weight, limits)),
      volume_ratio(scan_of(Measure::volume_ratio, limits)),
      face_flatness(scan_of(Measure::face_flatness, limits)),
      cell_aspect_ratio(scan_of(Measure::cell_aspect_ratio, limits)),
      cell_openness(scan_of(Measure::cell_openness, limits)),
      face_tets(scan_of(Measure::face_tets, limits)),
      stacked_orthogonality(scan_of(Measure::stacked_orthogonality, limits)),
      stacked_skewness(scan_of(Measure::stacked_skewness, limits)),
      cell_determinant(scan_of(Measure::cell_determinant, limits)) {}

void CellCentredScan::merge(const CellCentredScan& other) {
  non_orthogonality.merge(other.non_orthogonality);
  skewness.merge(other.skewness);
  face_weight.merge(other.face_weight);
  volume_ratio.merge(other.volume_ratio);
  face_flatness.merge(other.face_flatness);
  cell_aspect_ratio.merge(other.cell_aspect_ratio);
  cell_openness.merge(other.cell_openness);
  face_tets.merge(other.face_tets);
  stacked_orthogonality.merge(other.stacked_orthogonality);
  stacked_skewness.merge(other.stacked_skewness);
  cell_determinant.merge(other.cell_determinant);
}

CellCentredScan joined(CellCentredScan all, const CellCentredScan& more) {
  all.merge(more);
  return all;
}

CellCentredScan scan_centre_chunk(const HybridMesh& mesh, std::span<const std::uint32_t> neighbours, const GateTable& limits, std::size_t begin,
                                  std::size_t end) {
  CellCentredScan scan(limits);
  ColumnCentres(mesh, neighbours).add(begin, end, scan);
  return scan;
}

CellCentredScan scan_column_centres(const HybridMesh& mesh, std::span<const std::uint32_t> neighbours, const GateTable& limits, const RunContext& context) {
  return parallel_reduce(
      context, mesh.layers.n_columns(), CellCentredScan(limits),
      [&](std::size_t begin, std::size_t end) { return scan_centre_chunk(mesh, neighbours, limits, begin, end); },
      [](CellCentredScan all, const CellCentredScan& more) { return joined(std::move(all), more); }, k_centre_chunk);
}

CellCentredScan scan_cell_centred(CellCentredScan scan, const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match,
                                  std::span<const std::uint32_t> neighbours, const GateTable& limits, const RunContext& context) {
  OtherCentres others(mesh, cells, slots, match, neighbours);
  const auto add = [&](std::size_t n, auto member) {
    scan = gathered(
        std::move(scan), n, [&](std::size_t begin, std::size_t end, CellCentredScan& part) { (others.*member)(begin, end, part); }, limits, context);
  };
  add(mesh.layers.n_columns(), &OtherCentres::add_columns);
  add(cells.first_tetrahedron() - cells.first_prism(), &OtherCentres::add_explicit);
  add(mesh.tetrahedra.size(), &OtherCentres::add_tets);
  add(match.pairs.size(), &OtherCentres::add_pairs);  // needs the places of explicit cells
  add(match.outer.size(), &OtherCentres::add_outer_faces);
  return scan;
}

void judge_cell_centred(const CellCentredScan& scan, const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots,
                        std::span<const std::uint32_t> neighbours, const GateTable& limits, LazyGivenLayer& given, CheckReport& report) {
  const CellItems cell{cells};
  const CentredFaceItems face{mesh, cells, slots};
  const auto put = [&](const GateScan& measure, const auto& describe) {
    GateResult result = measure.result(describe);
    report.gates[static_cast<std::size_t>(result.measure)] = std::move(result);
  };
  const auto put_sides = [&](const GateScan& measure, Measure which, const auto& prove) {
    report.gates[static_cast<std::size_t>(which)] = measure.result(face, [&](std::uint64_t id, double value) {
      if (id >= CellCentredScan::k_of_slot || id % 8 == k_top) return std::optional<Forcing>();
      const std::uint64_t number = id / 8, n_layers = static_cast<std::uint64_t>(mesh.layers.n_layers);
      const std::size_t column = number / n_layers, corner = id % 8;
      return prove(ColumnSide{column, corner, neighbours[3 * column + corner], static_cast<int>(number % n_layers)}, limits[which].hard, value);
    });
  };
  put_sides(scan.face_weight, Measure::face_weight, [&](const ColumnSide& side, double limit, double) { return given.get().face_weight(side, limit); });
  put_sides(scan.volume_ratio, Measure::volume_ratio, [&](const ColumnSide& side, double limit, double) { return given.get().volume_ratio(side, limit); });
  put_sides(scan.skewness, Measure::skewness, [&](const ColumnSide& side, double limit, double value) {
    const std::optional<Forcing> any_direction = given.get().skewness(side, limit);
    return any_direction ? any_direction : given.get().skewness_of_edge(side, limit, value);
  });
  for (const GateScan* measure : {&scan.non_orthogonality, &scan.face_flatness, &scan.face_tets, &scan.stacked_orthogonality, &scan.stacked_skewness})
    put(*measure, face);
  for (const GateScan* measure : {&scan.cell_aspect_ratio, &scan.cell_openness, &scan.cell_determinant}) put(*measure, cell);
}

}  // namespace sterna::check_parts
