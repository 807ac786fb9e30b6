#include "volmesh/assemble.h"

#include <algorithm>

#include "geom/base/parallel.h"

namespace sterna::volmesh {

FillBoundary fill_boundary(const LayerBase& base, const Extrusion& extrusion, const TriMesh& outer) {
  FillBoundary boundary;
  const LayerBlock& layers = extrusion.layers;
  const std::size_t n_lines = layers.n_lines();
  boundary.points.reserve(n_lines + outer.n_vertices());
  boundary.point2node.reserve(n_lines + outer.n_vertices());
  for (std::uint32_t line = 0; line < n_lines; ++line) {
    const NodeId top = layers.node(line, layers.n_layers);
    boundary.points.push_back(extrusion.points[top.index()]);
    boundary.point2node.push_back(top);
  }
  for (const VertexId v : outer.points.ids()) {
    boundary.points.push_back(outer.points[v]);
    boundary.point2node.push_back(NodeId(extrusion.points.size() + v.index()));
  }
  boundary.triangles.reserve(base.wall.n_triangles() + outer.n_triangles());
  for (const TriangleVertices& v : base.wall.triangles) boundary.triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
  const std::uint32_t shift = static_cast<std::uint32_t>(n_lines);
  for (const TriangleVertices& v : outer.triangles)
    boundary.triangles.push_back({v[0].value() + shift, v[1].value() + shift, v[2].value() + shift});
  for (const TriMesh* mesh : {&base.wall, &outer}) {
    const auto first = static_cast<std::uint32_t>(boundary.patch_names.size());
    for (const Patch& patch : mesh->patches) boundary.patch_names.push_back(patch.name);
    for (const PatchId patch : mesh->triangle_patch) boundary.triangle_patch.push_back(first + patch.value());
  }
  return boundary;
}

namespace {

std::size_t n_layer_nodes(const LayerBlock& layers) {
  std::size_t n = 0;
  for (std::uint32_t line = 0; line < layers.n_lines(); ++line) n = std::max(n, layers.node(line, layers.n_layers).index() + 1);
  return n;
}

/// The first patch of the outer boundary.
std::uint32_t outer_patch_of(const HybridMesh& layers) {
  std::uint32_t patch = static_cast<std::uint32_t>(layers.patches.size());
  for (std::size_t t = layers.layers.n_columns(); t < layers.boundary_triangles.size(); ++t) patch = std::min(patch, layers.boundary_triangles[t].patch.value());
  return patch;
}

/// Corners of a boundary triangle, normal into the fluid, counted from the first node of the outer boundary.
TriangleVertices outer_corners(const sterna::BoundaryTriangle& face, std::size_t first_node) {
  const auto corner = [&](std::size_t k) { return VertexId(face.nodes[k].index() - first_node); };
  return {corner(0), corner(2), corner(1)};
}

}  // namespace

TriMesh outer_of(const HybridMesh& layers) {
  const std::size_t first_node = n_layer_nodes(layers.layers), n_wall = layers.layers.n_columns();
  TriMesh outer;
  for (std::size_t i = first_node; i < layers.points.size(); ++i) outer.points.push_back(layers.points.raw()[i]);
  const std::uint32_t first_patch = outer_patch_of(layers);
  for (std::size_t p = first_patch; p < layers.patches.size(); ++p) outer.patches.push_back(layers.patches.raw()[p]);
  for (std::size_t t = n_wall; t < layers.boundary_triangles.size(); ++t) {
    outer.triangles.push_back(outer_corners(layers.boundary_triangles[t], first_node));
    outer.triangle_patch.push_back(PatchId(layers.boundary_triangles[t].patch.value() - first_patch));
  }
  return outer;
}

FillBoundary boundary_of(const HybridMesh& layers) {
  FillBoundary boundary;
  const LayerBlock& block = layers.layers;
  const std::size_t first_node = n_layer_nodes(block), n_columns = block.n_columns();
  for (std::uint32_t line = 0; line < block.n_lines(); ++line) boundary.point2node.push_back(block.node(line, block.n_layers));
  for (std::size_t i = first_node; i < layers.points.size(); ++i) boundary.point2node.push_back(NodeId(i));
  for (const NodeId node : boundary.point2node) boundary.points.push_back(layers.points[node]);
  boundary.triangles = block.base;
  const auto shift = static_cast<std::uint32_t>(block.n_lines());
  for (std::size_t t = n_columns; t < layers.boundary_triangles.size(); ++t) {
    const TriangleVertices v = outer_corners(layers.boundary_triangles[t], first_node);
    boundary.triangles.push_back({v[0].value() + shift, v[1].value() + shift, v[2].value() + shift});
  }
  for (const Patch& patch : layers.patches) boundary.patch_names.push_back(patch.name);
  for (const sterna::BoundaryTriangle& face : layers.boundary_triangles) boundary.triangle_patch.push_back(face.patch.value());
  return boundary;
}

HybridMesh assemble_layers(const LayerBase& base, Extrusion extrusion, const TriMesh& outer) {
  HybridMesh mesh;
  mesh.layers = std::move(extrusion.layers);
  const std::size_t n_layer_nodes = extrusion.points.size();
  std::vector<Point> points = std::move(extrusion.points);
  points.insert(points.end(), outer.points.begin(), outer.points.end());
  mesh.points = Column<NodeId, Point>(std::move(points));

  mesh.patches = base.wall.patches;
  const std::size_t n_wall_patches = mesh.patches.size();
  for (const Patch& patch : outer.patches) mesh.patches.push_back(patch);
  const auto add_reversed = [&](const std::array<NodeId, 3>& n, PatchId patch) { mesh.boundary_triangles.push_back({{n[0], n[2], n[1]}, patch}); };
  mesh.boundary_triangles.reserve(base.wall.n_triangles() + outer.n_triangles());
  for (const TriangleId t : base.wall.triangles.ids()) {
    const TriangleVertices& v = base.wall.triangles[t];
    add_reversed({mesh.layers.node(v[0].value(), 0), mesh.layers.node(v[1].value(), 0), mesh.layers.node(v[2].value(), 0)}, base.wall.triangle_patch[t]);
  }
  for (const TriangleId t : outer.triangles.ids()) {
    const TriangleVertices& v = outer.triangles[t];
    const auto node = [&](std::size_t k) { return NodeId(n_layer_nodes + v[k].index()); };
    add_reversed({node(0), node(1), node(2)}, PatchId(n_wall_patches + outer.triangle_patch[t].index()));
  }
  return mesh;
}

void add_tetrahedra(const FillBoundary& boundary, const TetraResult& tets, HybridMesh& mesh, const RunContext& context) {
  const std::size_t n_boundary = boundary.points.size();
  const std::size_t n_before = mesh.points.size();
  std::vector<Point>& points = mesh.points.raw();
  points.insert(points.end(), tets.new_points.begin(), tets.new_points.end());
  mesh.tetrahedra.resize(tets.tetrahedra.size());
  parallel_for(context, tets.tetrahedra.size(), [&](std::size_t i) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t p = tets.tetrahedra[i][k];
      mesh.tetrahedra[i][k] = p < n_boundary ? boundary.point2node[p] : NodeId(n_before + (p - n_boundary));
    }
  });
}

}  // namespace sterna::volmesh
