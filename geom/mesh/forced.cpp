#include "geom/mesh/forced.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/base/number_text.h"
#include "geom/base/print_text.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"

namespace sterna::check_parts {
namespace {

constexpr int k_proof_digits = 3;  ///< digits of lengths in messages
constexpr const char* k_remesh = "remesh the wall there (surface_mesh), or split its sliver triangles";
constexpr const char* k_open_edge = "open or fill the edge in the input surface";

}  // namespace

GivenBoundary::GivenBoundary(Borrowed<const HybridMesh> mesh) : mesh_(mesh) {
  const auto is_wall = [&](PatchId patch) { return patch.index() < mesh->patches.size() && mesh->patches[patch].kind == PatchKind::wall; };
  for (std::size_t t = 0; t < mesh->boundary_triangles.size(); ++t) {
    const BoundaryTriangle& triangle = mesh->boundary_triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle.nodes[k].value(), b = triangle.nodes[(k + 1) % 3].value();
      boundary_sides_.push_back({std::minmax(a, b), static_cast<std::uint32_t>(t)});
      if (!is_wall(triangle.patch)) continue;
      wall_edges_.push_back({a, b});
      wall_edges_.push_back({b, a});
    }
  }
  std::sort(boundary_sides_.begin(), boundary_sides_.end());
  std::sort(wall_edges_.begin(), wall_edges_.end());
  wall_edges_.erase(std::unique(wall_edges_.begin(), wall_edges_.end()), wall_edges_.end());
  for (std::size_t k = 0; k < mesh->layers.n_lines(); ++k) line_at_.push_back({mesh->layers.first_node[k], static_cast<std::uint32_t>(k)});
  std::sort(line_at_.begin(), line_at_.end());
}

std::optional<GivenBoundary::OnLine> GivenBoundary::on_line(std::uint32_t node) const {
  const auto next = std::upper_bound(line_at_.begin(), line_at_.end(), node, [](std::uint32_t n, const auto& entry) { return n < entry.first; });
  if (next == line_at_.begin()) return std::nullopt;
  const auto [first, line] = *std::prev(next);
  if (node - first > static_cast<std::uint32_t>(mesh_.layers.n_steps(line))) return std::nullopt;
  return OnLine{line, node - first};
}

double GivenBoundary::off_base(const OnLine& location) const {
  const NodeId base_node = mesh_.layers.node(location.line, 0);
  return distance(mesh_.points[base_node], mesh_.points[NodeId(base_node.value() + location.layer)]);
}

std::optional<GivenBoundary::Ring> GivenBoundary::ring_of(NodeId node) const {
  const OnLine location = on_line(node.value()).value_or(OnLine{0, 0});
  const std::uint32_t base_node = location.layer == 0 ? node.value() : mesh_.layers.first_node[location.line];
  const double own_shift = location.layer == 0 ? 0.0 : off_base(location);
  Ring ring{0.0, k_infinity};
  for (auto edge = std::lower_bound(wall_edges_.begin(), wall_edges_.end(), Edge{base_node, 0}); edge != wall_edges_.end() && edge->first == base_node;
       ++edge) {
    double shift = 0.0;
    if (location.layer > 0) {
      const std::optional<OnLine> other = on_line(edge->second);
      if (!other || other->layer != 0 || mesh_.layers.n_steps(other->line) != mesh_.layers.n_steps(location.line)) return std::nullopt;
      shift = own_shift + off_base({other->line, location.layer});
    }
    const double length = distance(mesh_.points[NodeId(base_node)], mesh_.points[NodeId(edge->second)]);
    ring.longest = std::max(ring.longest, length - shift);
    ring.shortest = std::min(ring.shortest, length + shift);
  }
  if (!(ring.longest > 0.0)) return std::nullopt;
  return ring;
}

std::optional<Forcing> GivenBoundary::edge_ratio(NodeId node, double limit) const {
  const std::optional<Ring> ring = ring_of(node);
  if (!ring || !(ring->longest > limit * ring->shortest)) return std::nullopt;
  return Forcing{"the wall has an edge of at least " + in_metres(ring->longest, k_proof_digits) + " beside an edge of at most " +
                     in_metres(ring->shortest, k_proof_digits) + " here",
                 k_remesh};
}

/// Returns the angle of the fluid between two boundary triangles at their common side; `a` and `b` run along the side in opposite directions.
double GivenBoundary::fluid_angle(std::uint32_t a, std::uint32_t b) const {
  const auto corner = [&](std::uint32_t t, std::size_t k) { return mesh_.points[mesh_.boundary_triangles[t].nodes[k % 3]]; };
  const Vec3 na = area_vector(corner(a, 0), corner(a, 1), corner(a, 2)), nb = area_vector(corner(b, 0), corner(b, 1), corner(b, 2));
  const auto& others = mesh_.boundary_triangles[b].nodes;
  const auto is_shared = [&](std::size_t k) { return std::find(others.begin(), others.end(), mesh_.boundary_triangles[a].nodes[k % 3]) != others.end(); };
  std::size_t k = 0;
  while (k < 2 && !(is_shared(k) && is_shared(k + 1))) ++k;
  const Vec3 along = normalized(corner(a, k + 1) - corner(a, k));
  return std::numbers::pi - std::atan2(dot(cross(na, nb), along), dot(na, nb));
}

std::optional<Forcing> GivenBoundary::min_dihedral(const std::array<NodeId, 4>& tet, double limit) const {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const Edge side = std::minmax(tet[i].value(), tet[j].value());
      const auto first = std::lower_bound(boundary_sides_.begin(), boundary_sides_.end(), std::pair(side, std::uint32_t{0}));
      if (boundary_sides_.end() - first < 2 || first->first != side || std::next(first)->first != side) continue;
      if (boundary_sides_.end() - first > 2 && std::next(first, 2)->first == side) continue;  // baffles and disc cuts: the facing sides are unknown
      const double angle = fluid_angle(first->second, std::next(first)->second);
      if (angle > 0.0 && angle < limit)
        return Forcing{"the boundary triangles at this edge enclose only " + print_text("%.3g deg", angle * k_degrees) + " of fluid", k_open_edge};
    }
  return std::nullopt;
}

}  // namespace sterna::check_parts
