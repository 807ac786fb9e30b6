#include "geom/mesh/line_measures.h"

#include <algorithm>
#include <limits>

#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/math/spherical_cap.h"

namespace sterna::check_parts {
namespace {

/// Number of cells at the wall whose lean angle is measured (docs/method/quality.md, "Gates", G10).
constexpr int k_wall_cells = 5;

}  // namespace

Fans::Fans(const LayerLines& lines) : first_(lines.n_lines() + 1, 0), triangles_(3 * lines.triangles().size()) {
  for (const auto& t : lines.triangles())
    for (const std::uint32_t line : t) ++first_[line + 1];
  for (std::size_t k = 0; k < lines.n_lines(); ++k) first_[k + 1] += first_[k];
  std::vector<std::uint32_t> cursor(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < lines.triangles().size(); ++t)
    for (const std::uint32_t line : lines.triangles()[t]) triangles_[cursor[line]++] = t;
}

MirrorNormals::MirrorNormals(const HybridMesh& mesh) {
  for (const BoundaryQuad& quad : mesh.boundary_quads) {
    if (quad.patch.index() >= mesh.patches.size() || mesh.patches[quad.patch].kind != PatchKind::symmetry) continue;
    const auto& p = mesh.points;
    const Vec3 normal = normalized(cross(p[quad.nodes[2]] - p[quad.nodes[0]], p[quad.nodes[3]] - p[quad.nodes[1]]));
    for (const NodeId node : quad.nodes) base_normals_.push_back({node, quad.patch, normal});
  }
  std::sort(base_normals_.begin(), base_normals_.end(),
            [](const BaseNormal& a, const BaseNormal& b) { return std::pair(a.node, a.patch) < std::pair(b.node, b.patch); });
  base_normals_.erase(
      std::unique(base_normals_.begin(), base_normals_.end(), [](const BaseNormal& a, const BaseNormal& b) { return a.node == b.node && a.patch == b.patch; }),
      base_normals_.end());
}

std::span<const MirrorNormals::BaseNormal> MirrorNormals::of(NodeId node) const {
  const auto first = std::lower_bound(base_normals_.begin(), base_normals_.end(), node, [](const BaseNormal& a, NodeId b) { return a.node < b; });
  auto last = first;
  while (last != base_normals_.end() && last->node == node) ++last;
  return {first, last};
}

Vec3 MirrorNormals::mirrored(NodeId node, Vec3 normal) const {
  for (const BaseNormal& base_normal : of(node)) normal = normal - dot(normal, base_normal.normal) * base_normal.normal;
  return normalized(normal);
}

void MirrorNormals::add_images(NodeId node, std::vector<Vec3>& normals) const {
  for (const BaseNormal& base_normal : of(node))
    for (std::size_t i = 0, n = normals.size(); i < n; ++i) normals.push_back(normals[i] - 2.0 * dot(normals[i], base_normal.normal) * base_normal.normal);
}

FacetsOfExplicitPrisms::FacetsOfExplicitPrisms(const HybridMesh& mesh, const LayerLines& lines) {
  if (!lines.are_columns() || mesh.prisms.empty()) return;
  constexpr std::uint32_t k_none = ~0u;
  std::vector<std::uint32_t> line_at(mesh.points.size(), k_none);  // line of each base vertex
  for (std::uint32_t line = 0; line < lines.n_lines(); ++line)
    if (lines.n_layers(line) > 0) line_at[lines.node(line, 0).index()] = line;
  for (const std::array<NodeId, 6>& prism : mesh.prisms)
    for (std::size_t k = 0; k < 6; ++k) {
      const std::size_t base = k < 3 ? 0 : 3;
      const NodeId base_node = prism[k], above = prism[(k + 3) % 6];
      const std::uint32_t line = line_at[base_node.index()];
      if (line == k_none || lines.node(line, 1) != above) continue;
      const Point &p = mesh.points[base_node], &a = mesh.points[prism[base + (k + 1) % 3]], &b = mesh.points[prism[base + (k + 2) % 3]];
      const Vec3 normal = normalized(area_vector(p, a, b));
      facets_.push_back({line, dot(normal, mesh.points[above] - p) < 0.0 ? -normal : normal, corner_angle(p, a, b)});
    }
  std::ranges::stable_sort(facets_, {}, &Facet::line);
}

std::span<const FacetsOfExplicitPrisms::Facet> FacetsOfExplicitPrisms::around(std::uint32_t line) const {
  const auto first = std::ranges::lower_bound(facets_, line, {}, &Facet::line), last = std::ranges::upper_bound(facets_, line, {}, &Facet::line);
  return {first, last};
}

double worst_growth(std::span<const double> heights) {
  double worst = 1.0;
  for (std::size_t j = 1; j < heights.size(); ++j) {
    const double ratio = heights[j] / heights[j - 1];
    worst = std::max({worst, ratio, 1.0 / ratio});
  }
  return worst;
}

double stack_angle(const HybridMesh& mesh, const LayerLines& lines, std::uint32_t line, const std::vector<Vec3>& normals) {
  double steepest = 0.0;
  for (int j = 0; j < std::min(lines.n_layers(line), k_wall_cells); ++j) {
    const Vec3 along = mesh.points[lines.node(line, j + 1)] - mesh.points[lines.node(line, j)];
    for (const Vec3& normal : normals) steepest = std::max(steepest, angle_between(normal, along));
  }
  return std::max(0.0, steepest - smallest_spherical_cap(normals).angle);
}

double deviation(double ratio) { return ratio > 0.0 ? std::max(ratio, 1.0 / ratio) : std::numeric_limits<double>::infinity(); }

double interface_jump(double last_height, double mean_edge) { return deviation(last_height / (k_regular_height * mean_edge)); }
bool is_interface_low(double last_height, double mean_edge) { return last_height < k_regular_height * mean_edge; }

bool is_request_usable(const HybridMesh& mesh) {
  const LayerRequest& request = mesh.request;
  const std::size_t n = mesh.layers.n_lines();
  return request.is_known() && request.target_height.size() == n && request.reason.size() == n &&
         (request.line_first_height.empty() || request.line_first_height.size() == n) &&
         (request.line_first_room.empty() || request.line_first_room.size() == n) &&
         (request.line_boundary_layer.empty() || request.line_boundary_layer.size() == n) &&
         (request.line_max_growth.empty() || request.line_max_growth.size() == n) && (request.line_layers.empty() || request.line_layers.size() == n) &&
         std::all_of(request.reason.begin(), request.reason.end(), [&](std::uint8_t r) { return r < request.reasons.size(); });
}

}  // namespace sterna::check_parts
