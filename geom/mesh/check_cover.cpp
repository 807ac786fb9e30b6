// Tests of faces, cells and crossings cannot distinguish a tiling from two meshes, one inside the other, that do not touch. The number of cells that cover a
// point is the winding number of the boundary there. It is constant between boundaries, so one test per piece of boundary suffices: on the fluid side of every
// piece the number must be 1. At a point of a boundary triangle, the winding number of all other triangles is the mean of the numbers on both sides, here 1/2.
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "geom/base/disjoint_sets.h"
#include "geom/math/measures.h"
#include "geom/mesh/baffles.h"
#include "geom/mesh/bvh.h"
#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {
namespace {

/// Winding numbers on a boundary are integers plus one half; the error of the tree's approximation is far below this tolerance.
constexpr double k_winding_tolerance = 0.25;

struct BoundarySurface {
  TriMesh mesh;                      ///< normals out of the fluid; quads cut along one diagonal
  std::vector<std::uint32_t> slots;  ///< per triangle
};

BoundarySurface collect_boundary(const HybridMesh& mesh, const FaceSlots& slots) {
  BoundarySurface surface;
  surface.mesh.points = Column<VertexId, Point>(mesh.points.raw());
  const BaffleSides baffles = find_baffle_sides(mesh);  // the two sides of a baffle enclose no volume
  for (std::uint32_t slot = slots.first_boundary(); slot < slots.size(); ++slot) {
    if (baffles.is_baffle(slot - slots.first_boundary())) continue;
    const Face face = slots.face(slot);
    for (std::size_t k = 2; k < face.size; ++k) {
      surface.mesh.triangles.push_back({VertexId(face.nodes[0].value()), VertexId(face.nodes[k - 1].value()), VertexId(face.nodes[k].value())});
      surface.slots.push_back(slot);
    }
  }
  return surface;
}

/// Labels pieces connected over edges that exactly two triangles share, because nothing can separate the two sides of such an edge.
std::vector<std::uint32_t> label_pieces(const TriMesh& mesh, const RunContext& context) {
  struct Edge {
    std::uint32_t lower, upper, triangle;
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.n_triangles());
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto& v = mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [lower, upper] = std::minmax({v[k].value(), v[(k + 1) % 3].value()});
      edges.push_back({lower, upper, t.value()});
    }
  }
  parallel_sort(context, edges, std::less<>{});
  DisjointSets pieces(mesh.n_triangles());
  for (std::size_t i = 0, e = 0; i < edges.size(); i = e) {
    for (e = i; e < edges.size() && edges[e].lower == edges[i].lower && edges[e].upper == edges[i].upper;) ++e;
    if (e - i == 2) pieces.join(edges[i].triangle, edges[i + 1].triangle);
  }
  return std::move(pieces).roots();
}

/// Returns the largest triangle of each piece, ascending.
std::vector<TriangleId> choose_witnesses(const TriMesh& mesh, const std::vector<std::uint32_t>& piece) {
  const auto area = [&](TriangleId t) {
    const auto c = corners(mesh, t);
    return triangle_area(c[0], c[1], c[2]);
  };
  std::vector<TriangleId> largest(piece.size());
  for (const TriangleId t : mesh.triangles.ids()) {
    TriangleId& best = largest[piece[t.index()]];
    if (!best.is_valid() || area(t) > area(best)) best = t;
  }
  std::erase_if(largest, [](TriangleId t) { return !t.is_valid(); });
  std::sort(largest.begin(), largest.end());
  return largest;
}

/// Returns the solid angle of a triangle seen from p as a fraction of the full sphere, positive from behind its normal (van Oosterom & Strackee 1983).
double solid_angle_share(const std::array<Point, 3>& corner, const Point& p) {
  const Vec3 a = corner[0] - p, b = corner[1] - p, c = corner[2] - p;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  return std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb) / (2.0 * std::numbers::pi);
}

}  // namespace

void check_cover(const HybridMesh& mesh, const FaceSlots& slots, const RunContext& context, Findings& findings) {
  if (findings.has_any_of("G1") || findings.has_any_of("G2")) return;
  const BoundarySurface surface = collect_boundary(mesh, slots);
  const std::vector<TriangleId> witnesses = choose_witnesses(surface.mesh, label_pieces(surface.mesh, context));
  if (witnesses.size() < 2) return;  // one closed piece that does not cross itself has only the winding numbers 0 and 1 on its sides

  TriMesh rest;  // without the witnesses, whose own contribution is undefined at their centre
  rest.points = surface.mesh.points;
  for (const TriangleId t : surface.mesh.triangles.ids())
    if (!std::binary_search(witnesses.begin(), witnesses.end(), t)) rest.triangles.push_back(surface.mesh.triangles[t]);
  std::optional<TriangleTree> tree;
  if (rest.n_triangles() > 0) tree.emplace(rest, context);
  std::vector<double> winding(witnesses.size());
  const auto middle = [&](TriangleId t) {
    const auto c = corners(surface.mesh, t);
    return (c[0] + c[1] + c[2]) / 3.0;
  };
  parallel_for(
      context, witnesses.size(),
      [&](std::size_t i) {
        const Point p = middle(witnesses[i]);
        if (tree) winding[i] = tree->winding_number(p);
        for (const TriangleId other : witnesses)
          if (other != witnesses[i]) winding[i] += solid_angle_share(corners(surface.mesh, other), p);
      },
      1);
  for (std::size_t i = 0; i < witnesses.size(); ++i) {
    if (std::abs(winding[i] - 0.5) < k_winding_tolerance) continue;
    findings.add(Violation::overlapping_parts, [&] {
      return std::pair(middle(witnesses[i]), slots.name(surface.slots[witnesses[i].index()]) + ": the fluid side of this part of the boundary is covered " +
                                                 std::to_string(std::lround(winding[i] + 0.5)) + " times");
    });
  }
}

}  // namespace sterna::check_parts
