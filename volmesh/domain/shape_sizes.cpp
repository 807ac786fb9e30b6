#include "volmesh/domain/shape_sizes.h"

#include "geom/base/error.h"

namespace sterna::volmesh {

void require_affordable(double n_triangles, const std::string& attempted) {
  constexpr double k_most = 20e6;
  if (n_triangles <= k_most) return;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = attempted,
               .problem = "the edge lengths require " + std::to_string(n_triangles / 1e6) + " million triangles, the limit is 20 million",
               .hint = "raise farfield_edge, and the edge lengths in farfield_sides"});
}

double edge_of_side(std::span<const SideRule> rules, const std::string& side, double common) {
  for (const SideRule& rule : rules)
    if (rule.side == side && !is_automatic(rule.edge)) return rule.edge;
  return common;
}

void add_patch(TriMesh& mesh, const std::string& name, std::span<const std::array<std::uint32_t, 3>> triangles, const std::vector<VertexId>& vertices,
               bool is_turned) {
  const PatchId patch = mesh.patches.push_back({name, PatchKind::farfield});
  for (const auto& t : triangles) {
    mesh.triangles.push_back({vertices[t[0]], vertices[t[is_turned ? 2 : 1]], vertices[t[is_turned ? 1 : 2]]});
    mesh.triangle_patch.push_back(patch);
  }
}

}  // namespace sterna::volmesh
