// Tests cells in the way solvers compute them: with rounded sums and products instead of exact signs.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "geom/mesh/check_parts.h"
#include "geom/mesh/computed_volumes.h"

namespace sterna {
namespace {

/// Maximum number of locations in the report.
constexpr std::size_t k_most_lost_locations = 10;

/// Returns the determinant of three vectors over the product of their lengths; zero if one length is zero.
double relative_determinant(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double scale = norm(a) * norm(b) * norm(c);
  return scale > 0.0 ? dot(cross(a, b), c) / scale : 0.0;
}

double least_of_tet(std::span<const Vec3> p) {
  const Vec3 ab = p[1] - p[0], ac = p[2] - p[0], ad = p[3] - p[0];
  const double l_ab = norm2(ab), l_ac = norm2(ac), l_ad = norm2(ad), l_bc = norm2(p[2] - p[1]), l_bd = norm2(p[3] - p[1]), l_cd = norm2(p[3] - p[2]);
  const double largest = std::max({l_ab * l_ac * l_ad, l_ab * l_bc * l_bd, l_ac * l_bc * l_cd, l_ad * l_bd * l_cd});
  return largest > 0.0 ? dot(cross(ab, ac), ad) / std::sqrt(largest) : 0.0;
}

double least_of_pyramid(std::span<const Vec3> p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k) least = std::min(least, relative_determinant(p[(k + 1) % 4] - p[k], p[(k + 3) % 4] - p[k], p[4] - p[k]));
  return least;
}

double least_of_hexahedron(std::span<const Vec3> p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4, previous = (k + 3) % 4;
    least = std::min({least, relative_determinant(p[next] - p[k], p[previous] - p[k], p[k + 4] - p[k]),
                      relative_determinant(p[previous + 4] - p[k + 4], p[next + 4] - p[k + 4], p[k] - p[k + 4])});
  }
  return least;
}

Point mean_location(std::span<const Vec3> p, std::span<const std::uint8_t> nodes) {
  Point sum;
  for (const std::uint8_t k : nodes) sum += p[k];
  return sum / static_cast<double>(nodes.size());
}

}  // namespace

double least_computed_jacobian(CellKind kind, std::span<const Vec3> p) {
  switch (kind) {
    case CellKind::tetrahedron: return least_of_tet(p);
    case CellKind::pyramid: return least_of_pyramid(p);
    case CellKind::prism: return wedge_quality({p[0], p[1], p[2], p[3], p[4], p[5]});
    case CellKind::hexahedron: return least_of_hexahedron(p);
  }
  return 0.0;
}

double least_computed_sub_volume(CellKind kind, std::span<const Vec3> p) {
  constexpr std::array<std::uint8_t, 8> k_all = {0, 1, 2, 3, 4, 5, 6, 7};
  const Point centre = mean_location(p, std::span(k_all).first(p.size()));
  double least = std::numeric_limits<double>::infinity();
  for (const LocalFace& face : cell_faces(kind)) {
    const Point middle = mean_location(p, std::span(face.nodes).first(face.size));
    for (std::size_t k = 0; k < face.size; ++k) {
      // The face runs a, b with its normal out of the cell, so the tet (a, mid-edge, face, cell) has the opposite orientation.
      const Point &a = p[face.nodes[k]], &b = p[face.nodes[(k + 1u) % face.size]];
      const Point mid_edge = (a + b) / 2.0;
      least = std::min({least, relative_determinant(middle - a, mid_edge - a, centre - a), relative_determinant(mid_edge - b, middle - b, centre - b)});
    }
  }
  return least;
}

bool is_positive_in_double(CellKind kind, std::span<const Vec3> points) {
  return least_computed_jacobian(kind, points) > k_solver_margin && least_computed_sub_volume(kind, points) > k_solver_margin;
}

namespace {

/// Compares cells at the mesh's points with cells at the rounded points of a file.
class LostCellSearch {
 public:
  LostCellSearch(const HybridMesh& mesh, std::span<const Point> rounded) : mesh_(mesh), rounded_(rounded) {}

  bool is_lost(const Cell& cell) const { return !is_positive(cell, rounded_) && is_positive(cell, mesh_.points.raw()); }

  /// Appends the numbers of lost cells in a block, ascending. `cell_of(i)` returns cell i.
  template <class CellOf>
  void add(const RunContext& context, std::uint64_t first_number, std::size_t n, const CellOf& cell_of, std::vector<std::uint64_t>& lost) const {
    const std::vector<std::uint64_t> more =
        parallel_collect<std::uint64_t>(context, n, [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& list) {
          for (std::size_t i = begin; i < end; ++i)
            if (is_lost(cell_of(i))) list.push_back(first_number + i);
        });
    lost.insert(lost.end(), more.begin(), more.end());
  }

 private:
  static bool is_positive(const Cell& cell, std::span<const Point> points) {
    const auto nodes = cell.span();
    std::array<Vec3, 8> p;
    for (std::size_t k = 0; k < nodes.size(); ++k) p[k] = points[nodes[k].index()];
    return is_positive_in_double(cell.kind, std::span(p).first(nodes.size()));
  }

  const HybridMesh& mesh_;
  std::span<const Point> rounded_;
};

}  // namespace

LostCells cells_lost_by_rounding(const HybridMesh& mesh, std::span<const Point> rounded, const RunContext& context) {
  const check_parts::CellNumbers cells(mesh);
  const LostCellSearch search(mesh, rounded);
  const auto n_layers = static_cast<std::uint64_t>(std::max(mesh.layers.n_layers, 0));
  std::vector<std::uint64_t> lost =
      parallel_collect<std::uint64_t>(context, mesh.layers.n_columns(), [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& list) {
        for (std::size_t c = begin; c < end; ++c)
          for (int j = 0, n = mesh.layers.layers_of_column(c); j < n; ++j)
            if (search.is_lost(mesh.layers.cell(c, j))) list.push_back(c * n_layers + static_cast<std::uint64_t>(j));
      });
  const std::uint64_t first = cells.first_prism();
  const std::size_t n_explicit = mesh.prisms.size() + mesh.pyramids.size() + mesh.hexahedra.size() + mesh.tetrahedra.size();
  search.add(
      context, first, n_explicit, [&](std::size_t i) { return cells.cell(first + i); }, lost);

  LostCells result{.n = static_cast<std::int64_t>(lost.size()), .locations = {}};
  for (std::size_t i = 0; i < std::min(lost.size(), k_most_lost_locations); ++i) {
    const Point centre = cells.center(lost[i]);
    result.locations.push_back({centre, cells.name(lost[i]) + check_parts::near_patch(mesh, centre)});
  }
  return result;
}

}  // namespace sterna
