#include "io/volume/single_precision.h"

#include <algorithm>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"

namespace sterna::io {
namespace {

class EdgeScan {
 public:
  EdgeScan(const HybridMesh& mesh, std::span<const Point> rounded) : mesh_(mesh), rounded_(rounded) {}

  RoundedEdge scan(CellKind kind, std::span<const NodeId> nodes, RoundedEdge worst) const {
    for (const LocalFace& face : cell_faces(kind))
      for (std::size_t k = 0; k < face.size; ++k) {
        const NodeId a = nodes[face.nodes[k]], b = nodes[face.nodes[(k + 1) % face.size]];
        if (a < b) add(a, b, worst);  // the other face of the edge has it in the opposite direction
        else if (b < a) add(b, a, worst);
      }
    return worst;
  }

 private:
  void add(NodeId a, NodeId b, RoundedEdge& worst) const {
    const Point &p = mesh_.points[a], &q = mesh_.points[b];
    const Vec3 edge = q - p, after = rounded_[b.index()] - rounded_[a.index()];
    const double length = norm(edge), change = norm(after - edge);
    if (change > worst.share * length) worst = {length > 0.0 ? change / length : 1.0, length, p + 0.5 * edge};
  }

  const HybridMesh& mesh_;
  std::span<const Point> rounded_;
};

RoundedEdge worse(const RoundedEdge& a, const RoundedEdge& b) { return b.share > a.share ? b : a; }

}  // namespace

std::vector<Point> in_single_precision(const HybridMesh& mesh, const RunContext& context) {
  const auto rounded = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  std::vector<Point> locations(mesh.points.size());
  parallel_for(context, locations.size(), [&](std::size_t i) {
    const Point& p = mesh.points.raw()[i];
    locations[i] = {rounded(p.x), rounded(p.y), rounded(p.z)};
  });
  return locations;
}

RoundedEdge worst_rounded_edge(const HybridMesh& mesh, std::span<const Point> rounded, const RunContext& context) {
  const EdgeScan edges(mesh, rounded);
  RoundedEdge worst = parallel_reduce(
      context, mesh.layers.n_columns(), RoundedEdge{},
      [&](std::size_t begin, std::size_t end) {
        RoundedEdge part;
        for (std::size_t c = begin; c < end; ++c)
          for (int j = 0, n = mesh.layers.layers_of_column(c); j < n; ++j) {
            const Cell cell = mesh.layers.cell(c, j);
            part = edges.scan(cell.kind, cell.span(), part);
          }
        return part;
      },
      worse);
  const auto scan_cells = [&](CellKind kind, const auto& cells) {
    worst = worse(worst, parallel_reduce(
                             context, cells.size(), RoundedEdge{},
                             [&](std::size_t begin, std::size_t end) {
                               RoundedEdge part;
                               for (std::size_t i = begin; i < end; ++i) part = edges.scan(kind, cells[i], part);
                               return part;
                             },
                             worse));
  };
  scan_cells(CellKind::prism, mesh.prisms);
  scan_cells(CellKind::pyramid, mesh.pyramids);
  scan_cells(CellKind::hexahedron, mesh.hexahedra);
  scan_cells(CellKind::tetrahedron, mesh.tetrahedra);
  return worst;
}

std::string rounding_text(const RoundedEdge& edge) {
  constexpr double k_percent = 100.0;
  if (!(edge.share > k_most_rounding)) return {};
  return "single precision moves nodes against each other by up to " + number_text(k_percent * edge.share, 2) + " % of the length of their edge, " +
         number_text(edge.length, 3) + " m at " + format_point(edge.position) + " (limit " + number_text(k_percent * k_most_rounding, 2) + " %)";
}

}  // namespace sterna::io
