#include "surfmesh/stitch/patches.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

bool is_allowed(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '-'; }

/// `name`, or name_2, name_3 ... when that is taken; remembers it.
std::string unique_name(const std::string& name, std::set<std::string>& taken) {
  std::string candidate = name;
  for (int n = 2; !taken.insert(candidate).second; ++n) candidate = name + "_" + std::to_string(n);
  return candidate;
}

/// File name without folder, ".gz" and extension.
std::string stem_of(const std::string& source) {
  std::filesystem::path path = std::filesystem::path(source).filename();
  if (path.extension() == ".gz") path = path.stem();
  return clean_name(path.stem().string());
}

}  // namespace

std::string clean_name(std::string_view name) {
  std::string clean;
  for (const char c : name) {
    if (is_allowed(c)) clean += c;
    else if (!clean.empty() && clean.back() != '_') clean += '_';
  }
  while (!clean.empty() && clean.back() == '_') clean.pop_back();
  if (!clean.empty() && clean.front() >= '0' && clean.front() <= '9') clean.insert(0, "patch_");
  return clean;
}

std::vector<std::string> clean_patch_names(const std::vector<SurfaceSoup>& soups) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const SurfaceSoup& soup : soups) {
    for (const std::string& given : soup.patch_names) {
      std::string name = soup.has_names ? clean_name(given) : std::string();
      if (name.empty() && soups.size() > 1) name = stem_of(soup.source);
      if (name.empty()) name = "wall";
      names.push_back(unique_name(name, taken));
    }
  }
  return names;
}

TriMesh make_mesh(const WorkingSurface& surface, const std::vector<std::string>& names) {
  TriMesh mesh;
  std::vector<VertexId> vertex(surface.points.size());
  std::vector<char> is_used(names.size(), 0);
  for (const std::uint32_t p : surface.patch) is_used[p] = 1;
  std::vector<PatchId> patch(names.size());
  for (std::size_t p = 0; p < names.size(); ++p)
    if (is_used[p]) patch[p] = mesh.patches.push_back({names[p], PatchKind::wall});
  mesh.triangles.reserve(surface.n_facets());
  mesh.triangle_patch.reserve(surface.n_facets());
  for (std::size_t t = 0; t < surface.n_facets(); ++t) {
    TriangleVertices triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      VertexId& v = vertex[surface.facets[t][k]];
      if (!v.is_valid()) v = mesh.points.push_back(surface.points[surface.facets[t][k]]);
      triangle[k] = v;
    }
    mesh.triangles.push_back(triangle);
    mesh.triangle_patch.push_back(patch[surface.patch[t]]);
  }
  return mesh;
}

void split_patches(TriMesh& mesh, double angle, const RunContext& context) {
  const Topology topology(mesh, context);
  Column<TriangleId, Vec3> normal(mesh.n_triangles());
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    normal[t] = area_vector(c[0], c[1], c[2]);
  }
  Column<TriangleId, PatchId> region(mesh.n_triangles(), PatchId());
  std::vector<PatchId> region2patch;
  std::vector<std::uint32_t> n_regions(mesh.patches.size(), 0);
  std::vector<TriangleId> stack;
  for (const TriangleId start : mesh.triangles.ids()) {
    if (region[start].is_valid()) continue;
    const PatchId patch = mesh.triangle_patch[start];
    const PatchId current(static_cast<std::uint64_t>(region2patch.size()));
    region2patch.push_back(patch);
    ++n_regions[patch.index()];
    region[start] = current;
    stack.push_back(start);
    while (!stack.empty()) {
      const TriangleId t = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        const HalfedgeId twin = topology.twin(halfedge(t, k));
        if (!twin.is_valid()) continue;
        const TriangleId u = triangle_of(twin);
        if (region[u].is_valid() || mesh.triangle_patch[u] != patch || angle_between(normal[t], normal[u]) > angle) continue;
        region[u] = current;
        stack.push_back(u);
      }
    }
  }
  std::set<std::string> taken;
  for (const Patch& patch : mesh.patches)
    if (n_regions[static_cast<std::size_t>(&patch - mesh.patches.raw().data())] == 1) taken.insert(patch.name);
  Column<PatchId, Patch> patches;
  std::vector<std::uint32_t> number(mesh.patches.size(), 0);
  for (const PatchId from : region2patch) {
    Patch patch = mesh.patches[from];
    if (n_regions[from.index()] > 1) patch.name = unique_name(patch.name + "_" + std::to_string(++number[from.index()]), taken);
    patches.push_back(std::move(patch));
  }
  mesh.patches = std::move(patches);
  mesh.triangle_patch = std::move(region);
}

}  // namespace sterna::surfmesh
