// Computes the metrics of nodes with cells of any kind around them. All data of a control volume are gathered from the cells and boundary faces of its node, in
// a fixed order.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/math/constants.h"
#include "geom/math/sub_volumes.h"
#include "geom/mesh/dual_parts.h"

namespace sterna {
namespace dual_parts {
namespace {

double arc_sine(double x) { return std::asin(std::clamp(x, -1.0, 1.0)); }

}  // namespace

LineRings::LineRings(const LayerBlock& layers) : first_(layers.n_lines() + 1, 0), columns_(3 * layers.n_columns()) {
  for (const auto& base : layers.base)
    for (const std::uint32_t line : base) ++first_[line + 1];
  for (std::size_t k = 0; k < layers.n_lines(); ++k) first_[k + 1] += first_[k];
  std::vector<std::uint32_t> cursor(first_.begin(), first_.end() - 1);
  for (std::uint32_t column = 0; column < layers.n_columns(); ++column)
    for (const std::uint32_t line : layers.base[column]) columns_[cursor[line]++] = column;
}

std::vector<std::uint8_t> find_regular_lines(const LayerBlock& layers, const LineRings& rings, const RunContext& context) {
  std::vector<std::uint8_t> is_regular(layers.n_lines(), 0);
  parallel_for(context, layers.n_lines(), [&](std::size_t k) {
    const auto line = static_cast<std::uint32_t>(k);
    const auto columns = rings.columns(line);
    if (columns.empty()) return;
    // A ring is closed if each neighbour is the next line of one column and the previous line of one column.
    std::int64_t balance = 0;
    bool is_closed = true;
    for (const std::uint32_t column : columns) {
      if (!layers.is_prismatic(column)) return;
      const auto& base = layers.base[column];
      const std::size_t corner = base[0] == line ? 0 : base[1] == line ? 1 : 2;
      const std::uint32_t next = base[(corner + 1) % 3];
      const auto ends_at_next = [&](std::uint32_t other) {
        const auto& b = layers.base[other];
        const std::size_t c = b[0] == line ? 0 : b[1] == line ? 1 : 2;
        return b[(c + 2) % 3] == next;
      };
      balance = std::count_if(columns.begin(), columns.end(), ends_at_next);
      is_closed = is_closed && balance == 1;
    }
    is_regular[k] = is_closed;
  });
  return is_regular;
}

NodeDual::NodeDual(Borrowed<const HybridMesh> mesh, Borrowed<const LineRings> rings) : mesh_(mesh), rings_(rings) {
  for (const CellKind kind : {CellKind::tetrahedron, CellKind::pyramid, CellKind::prism, CellKind::hexahedron}) {
    for (const LocalFace& face : cell_faces(kind)) {
      for (std::size_t k = 0; k < face.size; ++k) {
        Corner corner;
        corner.next = face.nodes[(k + 1u) % face.size];
        corner.previous = face.nodes[(k + face.size - 1u) % face.size];
        corner.size = face.size;
        corner.nodes = face.nodes;
        corners_[static_cast<std::size_t>(kind)][face.nodes[k]].push_back(corner);
      }
    }
  }
  first_[0] = 0;
  first_[1] = mesh->prisms.size();
  first_[2] = first_[1] + mesh->pyramids.size();
  first_[3] = first_[2] + mesh->hexahedra.size();
  first_[4] = first_[3] + mesh->tetrahedra.size();
  first_[5] = first_[4] + mesh->boundary_triangles.size();
}

NodeDual::Edge& NodeDual::edge_to(std::uint32_t other) {
  for (Edge& edge : edges_)
    if (edge.other == other) return edge;
  return edges_.emplace_back(Edge{other, false, {}});
}

void NodeDual::add_sub_volume(double six_times) {
  least_ = std::min(least_, six_times);
  most_ = std::max(most_, six_times);
  sum_ += six_times;
}

void NodeDual::add_tet(std::span<const NodeId> nodes, std::uint64_t number) {
  // The other corners in the order that makes a positive tet as seen from the corner. Each sub-tet has a 24th of the volume, and the dual faces follow from
  // three cross products.
  constexpr std::array<std::array<std::uint8_t, 3>, 4> k_others = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::size_t corner = 0;
  while (nodes[corner].value() != node_) ++corner;
  std::array<Vec3, 3> u;
  for (std::size_t k = 0; k < 3; ++k) u[k] = mesh_.points[nodes[k_others[corner][k]]] - origin_;
  const std::array<Vec3, 3> c = {cross(u[1], u[2]), cross(u[2], u[0]), cross(u[0], u[1])};
  const Vec3 sum = c[0] + c[1] + c[2];
  for (std::size_t k = 0; k < 3; ++k) edge_to(nodes[k_others[corner][k]].value()).normal += (sum + c[k]) / 24.0;
  const double piece = dot(u[0], c[0]) / 24.0;
  const double size2 = norm2(u[0]) + norm2(u[1]) + norm2(u[2]);
  if (!(piece > certain_sub_volume(reach_, std::sqrt(size2), size2))) suspects_.push_back(number);
  for (int k = 0; k < 6; ++k) add_sub_volume(piece);
}

void NodeDual::add_cell(CellKind kind, std::span<const NodeId> nodes, std::uint64_t number) {
  std::array<Vec3, 8> u;
  Vec3 g;
  double size2 = 0.0;
  std::size_t corner = nodes.size();
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    u[k] = mesh_.points[nodes[k]] - origin_;
    g += u[k];
    size2 += norm2(u[k]);
    if (nodes[k].value() == node_) corner = k;
  }
  g *= 1.0 / static_cast<double>(nodes.size());
  const double bound = certain_sub_volume(reach_, std::sqrt(size2), size2);
  bool is_suspect = false;
  for (const Corner& face : corners_[static_cast<std::size_t>(kind)][corner]) {
    Vec3 f;
    for (std::size_t k = 0; k < face.size; ++k) f += u[face.nodes[k]];
    f *= 1.0 / face.size;
    const auto add_piece = [&](std::size_t other, double sign) {
      const Vec3 m = 0.5 * u[other];
      const Vec3 normal = 0.5 * sign * cross(f - m, g - m);
      const double six_times = sign * dot(f, cross(g, m));
      is_suspect = is_suspect || !(six_times > bound);
      add_sub_volume(six_times);
      Edge& edge = edge_to(nodes[other].value());
      edge.normal += normal;
      const bool is_growth_edge = kind == CellKind::prism && (other + 3 == corner || corner + 3 == other);
      edge.is_stack = edge.is_stack || is_growth_edge;
      edge.is_flat = edge.is_flat || (kind == CellKind::prism && !is_growth_edge);
    };
    add_piece(face.previous, 1.0);
    add_piece(face.next, -1.0);
  }
  if (is_suspect) suspects_.push_back(number);
}

void NodeDual::add_columns(std::uint32_t line, std::uint32_t layer) {
  const LayerBlock& layers = mesh_.layers;
  const auto per_column = static_cast<std::uint32_t>(layers.n_layers);            // cell numbers per column, of which some have no cell
  const bool is_end = layer == static_cast<std::uint32_t>(layers.n_steps(line));  // the last node of a line is also a corner of all cells above
  const std::uint32_t begin = layer == 0 ? 0 : layer - 1;
  for (const std::uint32_t column : rings_.columns(line)) {
    const auto n = static_cast<std::uint32_t>(layers.layers_of_column(column));
    const std::uint32_t end = is_end ? n : std::min(layer + 1, n);
    for (std::uint32_t j = begin; j < end; ++j) {
      const Cell cell = layers.cell(column, static_cast<int>(j));
      if (cell.kind == CellKind::tetrahedron) {
        add_tet(cell.span(), std::uint64_t{column} * per_column + j);
      } else {
        add_cell(cell.kind, cell.span(), std::uint64_t{column} * per_column + j);
      }
    }
  }
}

void NodeDual::add_boundary(std::span<const NodeId> nodes, PatchId patch) {
  std::size_t corner = 0;
  while (nodes[corner].value() != node_) ++corner;
  Vec3 f;
  for (const NodeId node : nodes) f += mesh_.points[node] - origin_;
  f *= 1.0 / static_cast<double>(nodes.size());
  const Vec3 next = mesh_.points[nodes[(corner + 1) % nodes.size()]] - origin_;
  const Vec3 previous = mesh_.points[nodes[(corner + nodes.size() - 1) % nodes.size()]] - origin_;
  const Vec3 normal = 0.25 * cross(next - previous, f);
  for (BoundaryPiece& piece : pieces_) {
    if (piece.patch != patch) continue;
    piece.normal += normal;
    return;
  }
  pieces_.push_back({patch, normal});
}

NodeMetrics NodeDual::result(std::uint32_t line) const {
  NodeMetrics metrics;
  if (edges_.empty()) return {k_nan, k_nan, k_nan, k_nan, k_nan, k_nan, 0.0};
  double edge_area = 0.0, all_area = 0.0, weighted = 0.0, largest = 0.0, smallest = k_infinity, longest = 0.0, shortest = k_infinity, longest_of_all = 0.0;
  Vec3 closure;
  const auto add_face = [&](const Vec3& normal, double area) {
    closure += normal;
    all_area += area;
    largest = std::max(largest, area);
    smallest = std::min(smallest, area);
  };
  const LayerBlock& layers = mesh_.layers;
  const bool has_line = line != NodeId::k_invalid && layers.is_collapsed[line] == 0;
  const std::uint32_t bottom = has_line ? layers.first_node[line] : 0;
  const auto n_steps = has_line ? static_cast<std::uint32_t>(layers.layers_of_line(line)) : 0u;
  const auto is_stack = [&](const Edge& edge) { return edge.is_stack || (has_line && edge.other >= bottom && edge.other - bottom <= n_steps); };
  for (const Edge& edge : edges_) {
    const Vec3 along = mesh_.points.raw()[edge.other] - origin_;
    const double length = norm(along);
    const double area = norm(edge.normal);
    add_face(edge.normal, area);
    edge_area += area;
    longest_of_all = std::max(longest_of_all, length);
    if (area > 0.0 && length > 0.0) weighted += area * arc_sine(dot(edge.normal, along) / (area * length));
    if (is_stack(edge)) continue;
    longest = std::max(longest, length);
    shortest = std::min(shortest, length);
  }
  for (const BoundaryPiece& piece : pieces_) add_face(piece.normal, norm(piece.normal));
  metrics.orthogonality = edge_area > 0.0 ? weighted / edge_area : -0.5 * std::numbers::pi;
  metrics.face_area_ratio = smallest > 0.0 ? largest / smallest : k_infinity;
  metrics.sub_volume_ratio = least_ > 0.0 ? most_ / least_ : k_infinity;
  // Around multi-normal fans of opened ridges, prisms are stacked in more than one direction: no edge is perpendicular to the stack there.
  const bool is_turned = std::ranges::any_of(edges_, [&](const Edge& edge) { return is_stack(edge) && edge.is_flat; });
  metrics.edge_ratio = has_hexahedron_ || is_turned || longest == 0.0 ? k_nan : shortest > 0.0 ? longest / shortest : k_infinity;
  metrics.closure = all_area > 0.0 ? norm(closure) / all_area : k_infinity;
  const double rounding = k_face_rounding * static_cast<double>(edges_.size()) * longest_of_all * longest_of_all;
  if (all_area > 0.0 && norm(closure) <= rounding) metrics.closure = std::min(metrics.closure, k_rounding_closure);
  metrics.volume = sum_ / 6.0;
  metrics.relative_face_area_ratio = k_nan;
  if (has_line && node_ - bottom < n_steps) {
    double height = distance(mesh_.points.raw()[node_ + 1], origin_);
    if (node_ > bottom) height += distance(mesh_.points.raw()[node_ - 1], origin_);
    metrics.relative_face_area_ratio = metrics.face_area_ratio * 0.5 * height / longest;
  }
  return metrics;
}

NodeMetrics NodeDual::measure(std::uint32_t node, std::uint32_t line, std::span<const std::uint32_t> cells) {
  node_ = node;
  origin_ = mesh_.points.raw()[node];
  reach_ = norm(origin_);
  edges_.clear();
  pieces_.clear();
  least_ = k_infinity;
  most_ = -k_infinity;
  sum_ = 0.0;
  has_hexahedron_ = false;
  const std::uint64_t first_explicit = std::uint64_t{mesh_.layers.n_columns()} * static_cast<std::uint64_t>(std::max(mesh_.layers.n_layers, 0));
  if (line != NodeId::k_invalid) add_columns(line, node - mesh_.layers.first_node[line]);
  for (const std::uint32_t i : cells) {
    if (i < first_[1]) {
      add_cell(CellKind::prism, mesh_.prisms[i], first_explicit + i);
    } else if (i < first_[2]) {
      add_cell(CellKind::pyramid, mesh_.pyramids[i - first_[1]], first_explicit + i);
    } else if (i < first_[3]) {
      add_cell(CellKind::hexahedron, mesh_.hexahedra[i - first_[2]], first_explicit + i);
      has_hexahedron_ = true;
    } else if (i < first_[4]) {
      add_tet(mesh_.tetrahedra[i - first_[3]], first_explicit + i);
    } else if (i < first_[5]) {
      add_boundary(mesh_.boundary_triangles[i - first_[4]].nodes, mesh_.boundary_triangles[i - first_[4]].patch);
    } else {
      add_boundary(mesh_.boundary_quads[i - first_[5]].nodes, mesh_.boundary_quads[i - first_[5]].patch);
    }
  }
  return result(line);
}

}  // namespace dual_parts

bool are_sub_volumes_positive(const HybridMesh& mesh, const Cell& cell) {
  const auto nodes = cell.span();
  std::array<Vec3, 8> p;
  for (std::size_t k = 0; k < nodes.size(); ++k) p[k] = mesh.points[nodes[k]];
  for (const LocalFace& face : cell_faces(cell.kind)) {
    const auto is_on_face = [&](std::size_t k) { return std::find(face.nodes.begin(), face.nodes.begin() + face.size, k) != face.nodes.begin() + face.size; };
    std::array<Vec3, 4> rest;
    std::size_t n_rest = 0;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (!is_on_face(k)) rest[n_rest++] = p[k];
    for (std::size_t k = 0; k < face.size; ++k) {
      std::array<Vec3, 2> others;
      for (std::size_t i = 2; i < face.size; ++i) others[i - 2] = p[face.nodes[(k + i) % face.size]];
      if (sub_volume_sign(p[face.nodes[k]], p[face.nodes[(k + 1u) % face.size]], {others.data(), face.size - 2u}, {rest.data(), n_rest}) <= 0) return false;
    }
  }
  return true;
}

}  // namespace sterna
