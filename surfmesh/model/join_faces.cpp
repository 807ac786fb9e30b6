#include "surfmesh/model/join_faces.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/base/parallel.h"

namespace sterna::surfmesh {
namespace {

/// Creates one patch per name and kind, in the order of the faces.
Column<FaceId, PatchId> make_patches(const Model& model, TriMesh& mesh) {
  std::map<std::pair<std::string, PatchKind>, PatchId> known;
  Column<FaceId, PatchId> patch_of(model.faces.size());
  for (const FaceId f : model.faces.ids()) {
    const Patch patch{model.faces[f].name, patch_kind(model.faces[f])};
    const auto [at, is_new] = known.try_emplace({patch.name, patch.kind}, PatchId(static_cast<std::uint64_t>(mesh.patches.size())));
    if (is_new) mesh.patches.push_back(patch);
    patch_of[f] = at->second;
  }
  return patch_of;
}

struct EdgeEntry {
  std::uint32_t low, high;
  std::uint32_t triangle;
  std::uint32_t corner;  ///< the edge starts at this corner
  auto operator<=>(const EdgeEntry&) const = default;
};

}  // namespace

SurfaceMesh join_faces(const Model& model, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                       const Column<FaceId, MeshedFace>& faces) {
  SurfaceMesh result;
  TriMesh& mesh = result.mesh;
  const Column<FaceId, PatchId> patch_of = make_patches(model, mesh);
  mesh.points.resize(numbers.n);
  result.edge_locations.resize(numbers.n);
  result.locations.resize(numbers.n);
  for (const CornerId c : model.corners.ids())
    if (topology.corner[c] == c && numbers.of_corner[c].is_valid()) mesh.points[numbers.of_corner[c]] = model.corners[c].point;
  for (const EdgeId e : model.edges.ids())
    for (std::size_t k = 0; topology.same_as[e].edge == e && k < cuts[e].t.size(); ++k) {
      const VertexId v(numbers.first_of_edge[e] + static_cast<std::uint32_t>(k));
      mesh.points[v] = cuts[e].points[k];
      result.edge_locations[v] = {e, cuts[e].t[k]};
    }
  for (const FaceId f : faces.ids()) {
    const MeshedFace& face = faces[f];
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    const std::uint32_t n_border = face.mesh.n_border;
    if (face.failure || topology.is_absorbed[f] != 0) continue;
    for (std::uint32_t i = 0; i < n_border; ++i)
      if (VertexLocation& location = result.locations[face.border_ids[i]]; !location.face.is_valid()) location = {f, face.mesh.uv[i]};
    for (std::size_t i = n_border; i < face.mesh.points.size(); ++i) {
      mesh.points.push_back(face.mesh.points[i]);
      result.locations.push_back({f, face.mesh.uv[i]});
      result.edge_locations.push_back({});
    }
    for (std::size_t t = 0; t < face.mesh.triangles.size(); ++t) {
      TriangleVertices v = face.mesh.triangles[t];
      for (VertexId& w : v) w = w.value() < n_border ? face.border_ids[w.index()] : VertexId(first + w.value() - n_border);
      if (model.faces[f].is_reversed) std::swap(v[1], v[2]);
      mesh.triangles.push_back(v);
      mesh.triangle_patch.push_back(patch_of[f]);
      result.triangle_face.push_back(f);
      result.is_band.push_back(t + face.mesh.n_band >= face.mesh.triangles.size() ? 1 : 0);
    }
  }
  // Corners that only absorbed edges had, and additional numbers of poles, belong to no triangle. They are removed.
  Column<VertexId, VertexId> number(mesh.points.size());
  for (const TriangleVertices& v : mesh.triangles)
    for (const VertexId w : v) number[w] = w;
  std::uint32_t n = 0;
  for (const VertexId v : number.ids()) {
    if (!number[v].is_valid()) continue;
    number[v] = VertexId(n);
    mesh.points[VertexId(n)] = mesh.points[v];
    result.locations[VertexId(n)] = result.locations[v];
    result.edge_locations[VertexId(n)] = result.edge_locations[v];
    ++n;
  }
  mesh.points.resize(n);
  result.locations.resize(n);
  result.edge_locations.resize(n);
  for (TriangleVertices& v : mesh.triangles)
    for (VertexId& w : v) w = number[w];
  result.corner_vertices.resize(model.corners.size());
  for (const CornerId c : model.corners.ids())
    if (const VertexId v = numbers.of_corner[topology.corner[c]]; v.is_valid()) result.corner_vertices[c] = number[v];
  return result;
}

JoinFaults check_joins(const Model& model, const ModelTopology& topology, const Column<FaceId, MeshedFace>& meshes, const SurfaceMesh& surface,
                       const RunContext& context) {
  const TriMesh& mesh = surface.mesh;
  std::vector<EdgeEntry> entries(3 * mesh.n_triangles());
  JoinFaults faults;
  parallel_for(context, mesh.n_triangles(), [&](std::size_t t) {
    const TriangleVertices& v = mesh.triangles[TriangleId(static_cast<std::uint64_t>(t))];
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t a = v[c].value(), b = v[(c + 1) % 3].value();
      entries[3 * t + c] = {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), c};
    }
  });
  parallel_sort(context, entries, std::less<>{});
  Column<FaceId, std::uint8_t> has_free_edge(model.faces.size(), 0);
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
  Column<EdgeId, std::uint8_t> is_free(model.edges.size(), 0);
  for (const EdgeId e : free_edges(model)) is_free[e] = 1;
  for (const FaceId f : model.faces.ids())
    if (meshes[f].failure)
      for (const Border& border : model.faces[f].borders)
        for (const EdgeUse& use : border) is_free[topology.same_as[use.edge].edge] = 1;
  for (const EdgeId e : model.edges.ids())
    if (is_free[topology.same_as[e].edge] != 0)
      for (const EdgeUseLocation& location : uses[e]) has_free_edge[location.face] = 1;
  for (std::size_t i = 0; i < entries.size();) {
    std::size_t end = i + 1;
    while (end < entries.size() && entries[end].low == entries[i].low && entries[end].high == entries[i].high) ++end;
    const auto from = [&](const EdgeEntry& e) { return mesh.triangles[TriangleId(e.triangle)][e.corner].value(); };
    bool is_wrong = end - i > 2 || entries[i].low == entries[i].high;
    if (end - i == 2) is_wrong = is_wrong || from(entries[i]) == from(entries[i + 1]);
    if (end - i == 1) {
      ++faults.n_free_edges;
      is_wrong = is_wrong || has_free_edge[surface.triangle_face[TriangleId(entries[i].triangle)]] == 0;
    }
    if (is_wrong)
      for (std::size_t k = i; k < end; ++k) faults.triangles.push_back(TriangleId(entries[k].triangle));
    i = end;
  }
  std::sort(faults.triangles.begin(), faults.triangles.end());
  faults.triangles.erase(std::unique(faults.triangles.begin(), faults.triangles.end()), faults.triangles.end());
  return faults;
}

}  // namespace sterna::surfmesh
