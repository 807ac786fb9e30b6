#include "volmesh/layer/assemble.h"

#include <algorithm>
#include <span>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::volmesh {

namespace {

/// Returns the number of each outer vertex as a point of the boundary: the number of its growth line, or a number after all growth lines.
std::vector<std::uint32_t> outer_points(const ClosedOuter& outer, std::size_t n_lines) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(outer.mesh.n_vertices());
  auto next = static_cast<std::uint32_t>(n_lines);
  for (const VertexId v : outer.mesh.points.ids()) numbers.push_back(outer.line[v].is_valid() ? outer.line[v].value() : next++);
  return numbers;
}

/// Returns the volume of the last prism of each column.
std::vector<double> last_prism_volumes(const LayerBlock& layers, std::span<const Point> points) {
  std::vector<double> volumes(layers.n_columns());
  for (std::size_t column = 0; column < volumes.size(); ++column) volumes[column] = last_prism_volume(layers, points, column);
  return volumes;
}

}  // namespace

TetraBoundary engine_boundary(Borrowed<const FillBoundary> boundary, std::span<const Vec3> holes, ClearProof clear, BoundaryTraits traits) {
  return {.points = boundary->points,
          .triangles = boundary->triangles,
          .hole_points = holes,
          .clear = clear,
          .patch_names = boundary->patch_names,
          .triangle_patch = boundary->triangle_patch,
          .traits = traits};
}

TetraBoundary improvement_boundary(Borrowed<const FillBoundary> boundary) {
  return {.points = boundary->points, .triangles = boundary->triangles, .hole_points = {}, .layer_volumes = boundary->layer_volumes};
}

double last_prism_volume(const LayerBlock& layers, std::span<const Point> points, std::size_t column) {
  if (layers.n_layers == 0 || layers.n_collapsed(column) > 0) return 0.0;
  WedgePoints p;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t top = layers.top(layers.base[column][k]).index();
    p[k] = points[top - 1];
    p[k + 3] = points[top];
  }
  return wedge_volume(p);
}

FillBoundary fill_boundary(const LayerBase& base, const Extrusion& extrusion, const ClosedOuter& outer) {
  FillBoundary boundary;
  const LayerBlock& layers = extrusion.layers;
  const std::size_t n_lines = layers.n_lines();
  boundary.points.reserve(n_lines + outer.mesh.n_vertices());
  boundary.point2node.reserve(n_lines + outer.mesh.n_vertices());
  for (std::uint32_t line = 0; line < n_lines; ++line) {
    const NodeId top = layers.top(line);
    boundary.points.push_back(extrusion.points[top.index()]);
    boundary.point2node.push_back(top);
  }
  const std::vector<std::uint32_t> point = outer_points(outer, n_lines);
  for (const VertexId v : outer.mesh.points.ids()) {
    if (outer.line[v].is_valid()) continue;
    boundary.point2node.push_back(NodeId(extrusion.points.size() + (point[v.index()] - n_lines)));
    boundary.points.push_back(outer.mesh.points[v]);
  }
  boundary.triangles.reserve(base.wall.n_triangles() + outer.mesh.n_triangles());
  boundary.triangles.insert(boundary.triangles.end(), layers.base.begin(), layers.base.end());
  for (const TriangleVertices& v : outer.mesh.triangles) boundary.triangles.push_back({point[v[0].index()], point[v[1].index()], point[v[2].index()]});
  boundary.layer_volumes = last_prism_volumes(layers, extrusion.points);
  boundary.layer_volumes.resize(boundary.triangles.size(), 0.0);
  for (const TriMesh* mesh : {&base.wall, &outer.mesh}) {
    const auto first = static_cast<std::uint32_t>(boundary.patch_names.size());
    for (const Patch& patch : mesh->patches) boundary.patch_names.push_back(patch.name);
    for (const PatchId patch : mesh->triangle_patch) boundary.triangle_patch.push_back(first + patch.value());
  }
  return boundary;
}

namespace {

std::size_t n_layer_nodes(const LayerBlock& layers) {
  std::size_t n = 0;
  for (std::uint32_t line = 0; line < layers.n_lines(); ++line) n = std::max(n, layers.top(line).index() + 1);
  return n;
}

/// For each node of the layer: the growth line whose top it is; k_none for nodes below the tops.
std::vector<std::uint32_t> lines_of_tops(const LayerBlock& layers, std::size_t n_nodes) {
  std::vector<std::uint32_t> lines(n_nodes, k_none);
  for (std::uint32_t line = 0; line < layers.n_lines(); ++line) lines[layers.top(line).index()] = line;
  return lines;
}

/// Returns true for a triangle of the outer boundary, whose nodes are tops of growth lines or nodes outside the layer. Sides of cells beside a growth line that
/// has ended have nodes below the tops.
bool is_outer(const sterna::BoundaryTriangle& face, std::span<const std::uint32_t> line_of_top) {
  return std::ranges::all_of(face.nodes, [&](NodeId node) { return node.index() >= line_of_top.size() || line_of_top[node.index()] != k_none; });
}

/// Returns the boundary triangles that belong to the outer boundary, ascending.
std::vector<std::size_t> outer_faces(const HybridMesh& layers, std::span<const std::uint32_t> line_of_top) {
  std::vector<std::size_t> faces;
  for (std::size_t t = layers.layers.n_columns(); t < layers.boundary_triangles.size(); ++t)
    if (is_outer(layers.boundary_triangles[t], line_of_top)) faces.push_back(t);
  return faces;
}

void add_sides(std::span<const LayerSide> sides, std::size_t n_wall_patches, HybridMesh& mesh) {
  const LayerBlock& layers = mesh.layers;
  for (const auto& [a, b, of_outer] : sides) {
    const PatchId patch(n_wall_patches + of_outer.index());
    for (int j = 0, n = std::max(layers.n_steps(a), layers.n_steps(b)); j < n; ++j) {
      const bool a_down = j >= layers.n_steps(a), b_down = j >= layers.n_steps(b);
      const NodeId a0 = layers.node(a, j), a1 = layers.node(a, j + 1), b0 = layers.node(b, j), b1 = layers.node(b, j + 1);
      if (a_down) mesh.boundary_triangles.push_back({{a0, b0, b1}, patch});
      else if (b_down) mesh.boundary_triangles.push_back({{a0, b0, a1}, patch});
      else mesh.boundary_quads.push_back({{a0, b0, b1, a1}, patch});
    }
  }
}

}  // namespace

ClosedOuter outer_of(const HybridMesh& layers, std::size_t n_wall_patches) {
  const std::size_t first_node = n_layer_nodes(layers.layers);
  const std::vector<std::uint32_t> line_of_top = lines_of_tops(layers.layers, first_node);
  ClosedOuter outer;
  for (std::size_t p = n_wall_patches; p < layers.patches.size(); ++p) outer.mesh.patches.push_back(layers.patches.raw()[p]);
  std::vector<VertexId> vertex(layers.points.size());
  for (std::size_t i = first_node; i < layers.points.size(); ++i) {
    vertex[i] = outer.mesh.points.push_back(layers.points.raw()[i]);
    outer.line.push_back({});
  }
  for (const std::size_t t : outer_faces(layers, line_of_top)) {
    const sterna::BoundaryTriangle& face = layers.boundary_triangles[t];
    for (const NodeId node : face.nodes) {
      if (vertex[node.index()].is_valid()) continue;
      vertex[node.index()] = outer.mesh.points.push_back(layers.points[node]);
      outer.line.push_back(VertexId(line_of_top[node.index()]));
    }
    outer.mesh.triangles.push_back({vertex[face.nodes[0].index()], vertex[face.nodes[2].index()], vertex[face.nodes[1].index()]});
    outer.mesh.triangle_patch.push_back(PatchId(face.patch.index() - n_wall_patches));
  }
  return outer;
}

FillBoundary boundary_of(const HybridMesh& layers) {
  FillBoundary boundary;
  const LayerBlock& block = layers.layers;
  const std::size_t first_node = n_layer_nodes(block), n_columns = block.n_columns();
  for (std::uint32_t line = 0; line < block.n_lines(); ++line) boundary.point2node.push_back(block.top(line));
  for (std::size_t i = first_node; i < layers.points.size(); ++i) boundary.point2node.push_back(NodeId(i));
  for (const NodeId node : boundary.point2node) boundary.points.push_back(layers.points[node]);
  boundary.triangles = block.base;
  for (const Patch& patch : layers.patches) boundary.patch_names.push_back(patch.name);
  for (std::size_t t = 0; t < n_columns; ++t) boundary.triangle_patch.push_back(layers.boundary_triangles[t].patch.value());
  const std::vector<std::uint32_t> line_of_top = lines_of_tops(block, first_node);
  const auto point = [&](NodeId node) {
    return node.index() < first_node ? line_of_top[node.index()] : static_cast<std::uint32_t>(block.n_lines() + node.index() - first_node);
  };
  for (const std::size_t t : outer_faces(layers, line_of_top)) {
    const sterna::BoundaryTriangle& face = layers.boundary_triangles[t];
    boundary.triangles.push_back({point(face.nodes[0]), point(face.nodes[2]), point(face.nodes[1])});
    boundary.triangle_patch.push_back(face.patch.value());
  }
  boundary.layer_volumes = last_prism_volumes(block, layers.points.raw());
  boundary.layer_volumes.resize(boundary.triangles.size(), 0.0);
  return boundary;
}

HybridMesh assemble_layers(const LayerBase& base, Extrusion extrusion, const ClosedOuter& outer, std::span<const LayerSide> sides) {
  HybridMesh mesh;
  mesh.layers = std::move(extrusion.layers);
  const std::size_t n_lines = mesh.layers.n_lines(), n_layer_nodes = extrusion.points.size();
  const std::vector<std::uint32_t> point = outer_points(outer, n_lines);
  std::vector<Point> points = std::move(extrusion.points);
  for (const VertexId v : outer.mesh.points.ids())
    if (!outer.line[v].is_valid()) points.push_back(outer.mesh.points[v]);
  mesh.points = Column<NodeId, Point>(std::move(points));

  mesh.patches = base.wall.patches;
  const std::size_t n_wall_patches = mesh.patches.size();
  for (const Patch& patch : outer.mesh.patches) mesh.patches.push_back(patch);
  const auto add_reversed = [&](const std::array<NodeId, 3>& n, PatchId patch) { mesh.boundary_triangles.push_back({{n[0], n[2], n[1]}, patch}); };
  mesh.boundary_triangles.reserve(base.wall.n_triangles() + outer.mesh.n_triangles());
  for (const TriangleId t : base.wall.triangles.ids()) {
    const std::array<std::uint32_t, 3>& lines = mesh.layers.base[t.index()];
    add_reversed({mesh.layers.node(lines[0], 0), mesh.layers.node(lines[1], 0), mesh.layers.node(lines[2], 0)}, base.wall.triangle_patch[t]);
  }
  for (const TriangleId t : outer.mesh.triangles.ids()) {
    const TriangleVertices& v = outer.mesh.triangles[t];
    const auto node = [&](std::size_t k) {
      const std::uint32_t p = point[v[k].index()];
      return p < n_lines ? mesh.layers.top(p) : NodeId(n_layer_nodes + (p - n_lines));
    };
    add_reversed({node(0), node(1), node(2)}, PatchId(n_wall_patches + outer.mesh.triangle_patch[t].index()));
  }
  add_sides(sides, n_wall_patches, mesh);
  return mesh;
}

void add_tetrahedra(const FillBoundary& boundary, const TetraResult& tets, HybridMesh& mesh, const RunContext& context) {
  const std::size_t n_boundary = boundary.points.size();
  const std::size_t n_before = mesh.points.size();
  std::vector<Point>& points = mesh.points.raw();
  points.insert(points.end(), tets.new_points.begin(), tets.new_points.end());
  const std::size_t n_of_multi_normals = mesh.tetrahedra.size();
  mesh.tetrahedra.resize(n_of_multi_normals + tets.tetrahedra.size());
  parallel_for(context, tets.tetrahedra.size(), [&](std::size_t i) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t p = tets.tetrahedra[i][k];
      mesh.tetrahedra[n_of_multi_normals + i][k] = p < n_boundary ? boundary.point2node[p] : NodeId(n_before + (p - n_boundary));
    }
  });
}

}  // namespace sterna::volmesh
