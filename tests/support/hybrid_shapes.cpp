#include "tests/support/hybrid_shapes.h"

#include <algorithm>
#include <cmath>

#include "geom/mesh/topology.h"
#include "tests/support/test_shapes.h"

namespace sterna::test {
namespace {

/// Returns the fraction of the total height at layer j of n with a constant growth ratio.
double height_share(int j, int n, double ratio) {
  if (ratio == 1.0) return static_cast<double>(j) / n;
  return (std::pow(ratio, j) - 1.0) / (std::pow(ratio, n) - 1.0);
}

/// Splits the prism (a, b, c) -> (d, e, f) of three growth lines into tets. Each side's diagonal starts below at the lower line number: neighbours agree.
void split_prism(HybridMesh& mesh, const std::array<std::uint32_t, 3>& lines, const std::array<NodeId, 3>& bottom, const std::array<NodeId, 3>& top) {
  std::array<std::size_t, 3> order = {0, 1, 2};
  bool is_odd = false;
  const auto sort_two = [&](std::size_t i, std::size_t j) {
    if (lines[order[i]] <= lines[order[j]]) return;
    std::swap(order[i], order[j]);
    is_odd = !is_odd;
  };
  sort_two(0, 1);
  sort_two(1, 2);
  sort_two(0, 1);
  const NodeId a0 = bottom[order[0]], b0 = bottom[order[1]], c0 = bottom[order[2]];
  const NodeId a1 = top[order[0]], b1 = top[order[1]], c1 = top[order[2]];
  for (std::array<NodeId, 4> tet : {std::array{a0, b0, c0, c1}, std::array{a0, b1, b0, c1}, std::array{a0, a1, b1, c1}}) {
    if (is_odd) std::swap(tet[2], tet[3]);
    mesh.tetrahedra.push_back(tet);
  }
}

void add_triangle(HybridMesh& mesh, NodeId a, NodeId b, NodeId c, PatchId patch) { mesh.boundary_triangles.push_back({{a, b, c}, patch}); }
void add_quad(HybridMesh& mesh, NodeId a, NodeId b, NodeId c, NodeId d, PatchId patch) { mesh.boundary_quads.push_back({{a, b, c, d}, patch}); }

/// Adds the layer's side above a boundary edge u -> v of the wall: quads, and triangles where one of the growth lines has ended.
void close_layer_side(HybridMesh& mesh, std::uint32_t u, std::uint32_t v, PatchId patch) {
  const LayerBlock& layers = mesh.layers;
  for (int j = 0; j < std::max(layers.n_steps(u), layers.n_steps(v)); ++j) {
    const bool u_goes_on = j < layers.n_steps(u), v_goes_on = j < layers.n_steps(v);
    const NodeId u0 = layers.node(u, j), u1 = layers.node(u, j + 1), v0 = layers.node(v, j), v1 = layers.node(v, j + 1);
    if (u_goes_on && v_goes_on) add_quad(mesh, u0, v0, v1, u1, patch);
    if (!u_goes_on && v_goes_on) add_triangle(mesh, u0, v0, v1, patch);
    if (u_goes_on && !v_goes_on) add_triangle(mesh, u0, v0, u1, patch);
  }
}

TriMesh plate(int n) {
  TriMesh mesh;
  mesh.patches.push_back({"plate", PatchKind::wall});
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.points.push_back({static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0});
  const auto at = [n](int i, int j) { return VertexId(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  mesh.triangle_patch.assign(mesh.n_triangles(), PatchId(0));
  return mesh;
}

}  // namespace

HybridMesh extrude(const TriMesh& wall, const std::vector<Vec3>& rays, const ShellOptions& options) {
  const Topology topology(wall, RunContext({.threads = 1}));
  HybridMesh mesh;
  mesh.patches = wall.patches;
  const PatchId farfield = mesh.patches.push_back({"farfield", PatchKind::farfield});
  const PatchId side = topology.n_boundary_halfedges() > 0 ? mesh.patches.push_back({"side", PatchKind::slip}) : PatchId{};

  LayerBlock& layers = mesh.layers;
  layers.n_layers = options.n_layers;
  layers.line_layers = options.line_layers;
  layers.is_collapsed.assign(wall.n_vertices(), 0);
  for (const std::uint32_t v : options.collapsed) layers.is_collapsed[v] = 1;
  for (const VertexId v : wall.points.ids()) {
    layers.first_node.push_back(static_cast<std::uint32_t>(mesh.points.size()));
    const int n_up = layers.n_steps(v.index());
    for (int j = 0; j <= n_up; ++j) {
      const double height = n_up == 0 ? 0.0 : options.layer_height * height_share(j, n_up, options.ratio);
      mesh.points.push_back(wall.points[v] + height * rays[v.index()]);
    }
  }
  const auto first_shell_node = static_cast<std::uint32_t>(mesh.points.size());
  const auto n_lines = static_cast<std::uint32_t>(wall.n_vertices());
  for (int s = 1; s <= options.n_shells; ++s) {
    const double height = options.layer_height + (options.outer_height - options.layer_height) * s / options.n_shells;
    for (const VertexId v : wall.points.ids()) mesh.points.push_back(wall.points[v] + height * rays[v.index()]);
  }
  const auto shell_node = [&](std::uint32_t line, int s) {
    return s == 0 ? layers.top(line) : NodeId(first_shell_node + static_cast<std::uint32_t>(s - 1) * n_lines + line);
  };

  for (const TriangleId t : wall.triangles.ids()) {
    const auto& v = wall.triangles[t];
    const std::array<std::uint32_t, 3> lines = {v[0].value(), v[1].value(), v[2].value()};
    const auto at = [&](int s) { return std::array{shell_node(lines[0], s), shell_node(lines[1], s), shell_node(lines[2], s)}; };
    layers.base.push_back(lines);
    add_triangle(mesh, layers.node(lines[0], 0), layers.node(lines[2], 0), layers.node(lines[1], 0), wall.triangle_patch[t]);
    for (int s = 0; s < options.n_shells; ++s) split_prism(mesh, lines, at(s), at(s + 1));
    const auto top = at(options.n_shells);
    add_triangle(mesh, top[0], top[1], top[2], farfield);
    for (int corner = 0; corner < 3; ++corner) {
      const HalfedgeId h = halfedge(t, corner);
      if (!topology.is_boundary(h)) continue;
      const std::uint32_t from = topology.from(h).value(), to = topology.to(h).value();
      close_layer_side(mesh, from, to, side);
      for (int s = 0; s < options.n_shells; ++s) {
        const NodeId u0 = shell_node(from, s), u1 = shell_node(from, s + 1), v0 = shell_node(to, s), v1 = shell_node(to, s + 1);
        add_triangle(mesh, u0, v0, from < to ? v1 : u1, side);
        add_triangle(mesh, from < to ? u0 : v0, v1, u1, side);
      }
    }
  }
  return mesh;
}

std::vector<Vec3> rays_from(const TriMesh& wall, const Point& center) {
  std::vector<Vec3> rays;
  for (const Point& p : wall.points) rays.push_back(p - center);
  return rays;
}

std::vector<std::uint16_t> stepped_layers(std::size_t n_lines, int n) {
  std::vector<std::uint16_t> layers;
  for (std::size_t i = 0; i < n_lines; ++i) layers.push_back(static_cast<std::uint16_t>(n - (i * i % 7 < 3 ? 1 : 0)));
  return layers;
}

HybridMesh stepped_sphere_shell(int f, ShellOptions options) {
  options.line_layers = stepped_layers(sphere(f).n_vertices(), options.n_layers);
  return sphere_shell(f, options);
}

HybridMesh stepped_plate_block(int n, ShellOptions options) {
  options.line_layers = stepped_layers(static_cast<std::size_t>((n + 1) * (n + 1)), options.n_layers);
  return plate_block(n, options);
}

HybridMesh sphere_shell(int f, const ShellOptions& options) {
  const TriMesh wall = sphere(f);
  return extrude(wall, rays_from(wall, {}), options);
}

HybridMesh two_shells(int f, int n_first, int n_second, ShellOptions options) {
  const TriMesh first = sphere(f);
  TriMesh wall = first;
  for (const Point& p : first.points) wall.points.push_back(p + Vec3{10.0, 0.0, 0.0});
  const auto shifted = [&](VertexId v) { return VertexId(v.index() + first.n_vertices()); };
  for (const TriangleVertices& v : first.triangles) wall.triangles.push_back({shifted(v[0]), shifted(v[1]), shifted(v[2])});
  wall.patches.push_back({"second", PatchKind::wall});
  wall.triangle_patch.raw().resize(wall.n_triangles(), PatchId(wall.patches.size() - 1));
  std::vector<Vec3> rays = rays_from(first, {});
  rays.insert(rays.end(), rays.begin(), rays.end());
  options.n_layers = std::max(n_first, n_second);
  options.line_layers.assign(first.n_vertices(), static_cast<std::uint16_t>(n_first));
  options.line_layers.resize(wall.n_vertices(), static_cast<std::uint16_t>(n_second));
  return extrude(wall, rays, options);
}

HybridMesh cube_shell(int n, const ShellOptions& options) {
  const TriMesh wall = cube(n);
  return extrude(wall, rays_from(wall, {0.5, 0.5, 0.5}), options);
}

HybridMesh plate_block(int n, const ShellOptions& options) {
  const TriMesh wall = plate(n);
  return extrude(wall, std::vector<Vec3>(wall.n_vertices(), Vec3{0, 0, 1}), options);
}

HybridMesh hexahedra_block(int n) {
  HybridMesh mesh;
  const PatchId box = mesh.patches.push_back({"box", PatchKind::wall});
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.points.push_back({static_cast<double>(i) / n, static_cast<double>(j) / n, static_cast<double>(k) / n});
  const auto at = [n](int i, int j, int k) { return NodeId((k * (n + 1) + j) * (n + 1) + i); };
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        mesh.hexahedra.push_back({at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1), at(i + 1, j, k + 1),
                                  at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)});
        const auto& v = mesh.hexahedra.back();
        const std::array<bool, 6> is_outer = {k == 0, j == 0, i == n - 1, j == n - 1, i == 0, k == n - 1};
        const auto faces = cell_faces(CellKind::hexahedron);
        for (std::size_t f = 0; f < 6; ++f) {
          const auto& local = faces[f].nodes;
          if (is_outer[f]) add_quad(mesh, v[local[0]], v[local[1]], v[local[2]], v[local[3]], box);
        }
      }
    }
  }
  return mesh;
}

HybridMesh hexahedron_with_roof() {
  HybridMesh mesh = hexahedra_block(1);
  const PatchId roof = mesh.patches.push_back({"roof", PatchKind::wall});
  const NodeId apex = mesh.points.push_back({0.5, 0.5, 1.5});
  const auto v = mesh.hexahedra.front();
  mesh.pyramids.push_back({v[4], v[5], v[6], v[7], apex});
  mesh.boundary_quads.pop_back();  // the hexahedron's top, the last local face, is now an inner face
  for (std::size_t k = 0; k < 4; ++k) add_triangle(mesh, v[4 + k], v[4 + (k + 1) % 4], apex, roof);
  return mesh;
}

HybridMesh box_of_patches(const std::vector<std::pair<std::string, PatchKind>>& kinds) {
  HybridMesh mesh;
  for (const Point& p : {Point{0, 0, 0}, Point{1, 0, 0}, Point{1, 1, 0}, Point{0, 1, 0}, Point{0, 0, 1}, Point{1, 0, 1}, Point{1, 1, 1}, Point{0, 1, 1}})
    mesh.points.push_back(p);
  for (const auto& [name, kind] : kinds) mesh.patches.push_back({name, kind});
  const std::array<std::array<std::uint32_t, 4>, 6> faces = {
      {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};  // x-, x+, y-, y+, z-, z+
  for (std::size_t f = 0; f < faces.size(); ++f)
    mesh.boundary_quads.push_back(
        {{NodeId(faces[f][0]), NodeId(faces[f][1]), NodeId(faces[f][2]), NodeId(faces[f][3])}, PatchId(std::min(f, kinds.size() - 1))});
  return mesh;
}

}  // namespace sterna::test
