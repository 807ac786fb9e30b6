// The section of a cell is traced face by face. Around a face, counter-clockwise as seen from outside, the boundary crosses the plane downwards (from above to
// below) as often as upwards. A segment of the section runs from each downward crossing to the matching upward crossing. The two faces at an edge run through
// its crossing in opposite senses, so the segments of all faces join to closed loops, right-handed about the normal.
#include "geom/mesh/cut.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/cell_quality.h"

namespace sterna {
namespace {

/// Dihedral angle of a regular tetrahedron, acos(1/3), radians.
constexpr double k_regular_dihedral = 1.2309594173407747;
/// Cells per chunk: the sign test of one cell takes a few nanoseconds.
constexpr std::size_t k_cell_chunk = 16384;
constexpr std::size_t k_cut_column_chunk = 1024;
/// Edges of a cell are numbered lower local node * 8 + higher.
constexpr std::size_t k_n_keys = 64;

void measure(CutPolygon& polygon, const std::array<Point, 8>& p) {
  polygon.quality = std::numeric_limits<double>::quiet_NaN();
  switch (polygon.kind) {
    case CellKind::tetrahedron: {
      const double smallest = tet_dihedral_range({p[0], p[1], p[2], p[3]})[0];
      polygon.volume = tet_volume(p[0], p[1], p[2], p[3]);
      polygon.quality = smallest / k_degree;
      polygon.shape = polygon.volume > 0.0 ? smallest / k_regular_dihedral : -smallest / k_regular_dihedral;
      return;
    }
    case CellKind::prism: {
      const WedgePoints wedge = {p[0], p[1], p[2], p[3], p[4], p[5]};
      polygon.volume = wedge_volume(wedge);
      polygon.quality = polygon.shape = wedge_quality(wedge);
      return;
    }
    case CellKind::pyramid:
      polygon.volume = pyramid_volume({p[0], p[1], p[2], p[3], p[4]});
      polygon.shape = scaled_jacobian(polygon.kind, std::span(p).first<5>());
      return;
    case CellKind::hexahedron:
      polygon.volume = hexahedron_volume(p);
      polygon.shape = scaled_jacobian(polygon.kind, p);
      return;
  }
}

/// Classifies nodes as above or below the plane, and computes the crossings of edges.
class Sides {
 public:
  Sides(const HybridMesh& mesh, const CutPlane& plane, const RunContext& context)
      : points_(mesh.points.raw()), origin_(plane.origin), normal_(normalized(plane.normal)) {
    if (!(norm(normal_) > 0.0) || !is_finite(origin_))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "cutting the mesh",
                   .problem = "the plane's normal has no length",
                   .hint = "give a normal such as {0, 1, 0}"});
    is_above_.resize(points_.size());
    parallel_for(
        context, points_.size(), [&](std::size_t i) { is_above_[i] = height(i) >= 0.0; }, k_cell_chunk);
  }

  bool is_above(NodeId node) const { return is_above_[node.index()] != 0; }
  double height(NodeId node) const { return height(node.index()); }
  const Point& point(NodeId node) const { return points_[node.index()]; }
  /// Returns the crossing point of an edge, with identical bits for every cell of the edge. \pre the nodes lie on different sides
  Point crossing(NodeId a, NodeId b) const {
    if (b < a) std::swap(a, b);
    const double from = height(a), to = height(b);
    if (from == 0.0) return point(a);
    if (to == 0.0) return point(b);
    return point(a) + (from / (from - to)) * (point(b) - point(a));
  }
  /// Returns 1 if all nodes of a line are above the plane, 0 if none is, 2 if some are.
  int side_of_line(const LayerBlock& layers, std::size_t line) const {
    const std::size_t first = layers.first_node[line], n = static_cast<std::size_t>(layers.n_steps(line)) + 1;
    std::size_t n_above = 0;
    for (std::size_t j = 0; j < n; ++j) n_above += is_above_[first + j];
    return n_above == 0 ? 0 : n_above == n ? 1 : 2;
  }

 private:
  double height(std::size_t node) const { return dot(points_[node] - origin_, normal_); }

  const std::vector<Point>& points_;
  Point origin_;
  Vec3 normal_;
  std::vector<std::uint8_t> is_above_;
};

class CellCutter {
 public:
  CellCutter(const Sides& sides, const std::optional<CutLimits>& limits) : sides_(sides), limits_(limits) {}

  MeshCut take() { return std::move(cut_); }

  /// Appends the polygons of a cell; `polygon` holds the properties of the cell.
  void add(std::span<const NodeId> nodes, CutPolygon polygon) {
    unsigned above = 0;
    for (std::size_t k = 0; k < nodes.size(); ++k) above |= static_cast<unsigned>(sides_.is_above(nodes[k])) << k;
    if (above == 0 || above == (1u << nodes.size()) - 1) return;
    above_ = above;
    link(nodes, polygon.kind);
    bool is_measured = false;
    while (open_ != 0) {
      const std::size_t start = cut_.corners.size();
      trace(nodes);
      if (!keep(start)) {
        cut_.corners.resize(start);
        continue;
      }
      if (!is_measured) {
        std::array<Point, 8> p;
        for (std::size_t k = 0; k < nodes.size(); ++k) p[k] = sides_.point(nodes[k]);
        measure(polygon, p);
        is_measured = true;
      }
      cut_.first.push_back(cut_.corners.size());
      cut_.polygons.push_back(polygon);
    }
  }

 private:
  bool is_above(std::size_t local) const { return ((above_ >> local) & 1u) != 0; }
  static std::size_t key(std::size_t a, std::size_t b) { return 8 * std::min(a, b) + std::max(a, b); }

  /// Fills next_: from each downward crossing to the upward crossing of the same segment.
  void link(std::span<const NodeId> nodes, CellKind kind) {
    open_ = 0;
    for (const LocalFace& face : cell_faces(kind)) {
      const std::size_t n = face.size;
      std::array<std::size_t, 2> down{};
      std::array<std::size_t, 4> up_at{};  // key of the edge that starts at a corner, if it is crossed upwards
      std::size_t n_down = 0, up = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t a = face.nodes[i], b = face.nodes[(i + 1) % n];
        if (is_above(a) == is_above(b)) continue;
        if (is_above(a)) {
          down[n_down++] = i;
        } else {
          up = up_at[i] = key(a, b);
        }
      }
      for (std::size_t k = 0; k < n_down; ++k) {
        const std::size_t i = down[k], from = key(face.nodes[i], face.nodes[(i + 1) % n]);
        if (n_down == 2) up = up_at[(i + (joins_above(nodes, face) ? 1 : 3)) % 4];
        next_[from] = static_cast<std::uint8_t>(up);
        open_ |= std::uint64_t{1} << from;
      }
    }
  }

  /// Returns true if the two corners above the plane are connected within a bilinear face, which the sign of its saddle decides.
  bool joins_above(std::span<const NodeId> nodes, const LocalFace& face) const {
    const std::size_t odd = is_above(face.nodes[0]) ? 0 : 1;
    const auto height = [&](std::size_t i) { return sides_.height(nodes[face.nodes[i % 4]]); };
    return height(odd) * height(odd + 2) >= height(odd + 1) * height(odd + 3);
  }

  /// Appends the corners of the loop that starts at the lowest open crossing. Coincident neighbours are merged.
  void trace(std::span<const NodeId> nodes) {
    const std::size_t start = cut_.corners.size();
    for (auto at = static_cast<std::size_t>(std::countr_zero(open_)); ((open_ >> at) & 1u) != 0; at = next_[at]) {
      open_ &= ~(std::uint64_t{1} << at);
      const Point p = sides_.crossing(nodes[at / 8], nodes[at % 8]);
      if (cut_.corners.size() == start || cut_.corners.back() != p) cut_.corners.push_back(p);
    }
    while (cut_.corners.size() > start + 1 && cut_.corners.back() == cut_.corners[start]) cut_.corners.pop_back();
  }

  bool keep(std::size_t start) const {
    const std::span<const Point> corners(cut_.corners.data() + start, cut_.corners.size() - start);
    if (corners.size() < 3) return false;
    if (!limits_) return true;
    Vec3 middle;
    for (const Point& p : corners) middle += p / static_cast<double>(corners.size());
    double reach = 0.0;
    for (const Point& p : corners) reach = std::max(reach, distance(middle, p));
    return distance(middle, limits_->center) <= limits_->radius + reach;
  }

  const Sides& sides_;
  const std::optional<CutLimits>& limits_;
  MeshCut cut_;
  unsigned above_ = 0;
  std::array<std::uint8_t, k_n_keys> next_{};
  std::uint64_t open_ = 0;  ///< downward crossings that are not yet part of a polygon
};

MeshCut join(MeshCut all, MeshCut more) {
  if (more.polygons.empty()) return all;
  if (all.polygons.empty()) return more;
  const std::uint64_t shift = all.corners.size();
  all.corners.insert(all.corners.end(), more.corners.begin(), more.corners.end());
  for (std::size_t i = 1; i < more.first.size(); ++i) all.first.push_back(shift + more.first[i]);
  all.polygons.insert(all.polygons.end(), more.polygons.begin(), more.polygons.end());
  return all;
}

using KindCounts = std::array<std::uint64_t, 4>;

/// Appends the polygons of the columns; counts their cells by kind.
MeshCut cut_columns(const HybridMesh& mesh, const Sides& sides, const std::optional<CutLimits>& limits, const RunContext& context, KindCounts& counts) {
  const LayerBlock& layers = mesh.layers;
  std::vector<std::uint8_t> side(layers.n_lines());
  parallel_for(context, side.size(), [&](std::size_t line) { side[line] = static_cast<std::uint8_t>(sides.side_of_line(layers, line)); });
  std::vector<KindCounts> first_cell(layers.n_columns());  // per column, counted as if its cells of this kind continued down to the wall
  for (std::size_t c = 0; c < layers.n_columns(); ++c)
    for (const CellKind kind : {CellKind::prism, CellKind::pyramid, CellKind::tetrahedron}) {
      const auto [begin, end] = layers.layers_of_kind(c, kind);
      std::uint64_t& count = counts[static_cast<std::size_t>(kind)];
      first_cell[c][static_cast<std::size_t>(kind)] = count - static_cast<std::uint64_t>(begin);
      count += static_cast<std::uint64_t>(end - begin);
    }
  return parallel_reduce(
      context, layers.n_columns(), MeshCut{},
      [&](std::size_t begin, std::size_t end) {
        CellCutter cutter(sides, limits);
        for (std::size_t c = begin; c < end; ++c) {
          const auto& base = layers.base[c];
          if (side[base[0]] != 2 && side[base[0]] == side[base[1]] && side[base[0]] == side[base[2]]) continue;
          for (int j = 0, n = layers.layers_of_column(c); j < n; ++j) {
            const Cell cell = layers.cell(c, j);
            cutter.add(cell.span(), {.kind = cell.kind,
                                     .is_in_layer = true,
                                     .layer = j,
                                     .cell = first_cell[c][static_cast<std::size_t>(cell.kind)] + static_cast<std::uint64_t>(j)});
          }
        }
        return cutter.take();
      },
      join, k_cut_column_chunk);
}

}  // namespace

MeshCut cut_mesh(const HybridMesh& mesh, const CutPlane& plane, const RunContext& context) {
  const Sides sides(mesh, plane, context);
  KindCounts counts{};
  MeshCut cut = cut_columns(mesh, sides, plane.limits, context, counts);
  const auto add_block = [&](CellKind kind, const auto& cells) {
    cut = parallel_reduce(
        context, cells.size(), std::move(cut),
        [&](std::size_t begin, std::size_t end) {
          CellCutter cutter(sides, plane.limits);
          for (std::size_t c = begin; c < end; ++c)
            cutter.add(cells[c], {.kind = kind, .is_in_layer = kind != CellKind::tetrahedron, .cell = counts[static_cast<std::size_t>(kind)] + c});
          return cutter.take();
        },
        join, k_cell_chunk);
  };
  add_block(CellKind::prism, mesh.prisms);
  add_block(CellKind::pyramid, mesh.pyramids);
  add_block(CellKind::hexahedron, mesh.hexahedra);
  add_block(CellKind::tetrahedron, mesh.tetrahedra);
  return cut;
}

std::string clear_plane_text(const HybridMesh& mesh, const CutPlane& plane) {
  const Vec3 along = normalized(plane.normal);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Point& p : mesh.points) {
    low = std::min(low, dot(p, along));
    high = std::max(high, dot(p, along));
  }
  return "the plane is at " + in_metres(dot(plane.origin, along)) + " along " + format_point(along) + ", the mesh extends from " + in_metres(low) + " to " +
         in_metres(high);
}

}  // namespace sterna
