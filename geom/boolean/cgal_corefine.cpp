// Based on: S. Loriot et al., "Polygon Mesh Processing" in the CGAL 5.5 manual, chapter Boolean operations.
// The two meshes of each step are stored in one array, because CGAL orders some of its work by their addresses: the result is therefore the same in every run.
#include "geom/boolean/cgal_corefine.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/exceptions.h>

namespace sterna {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = Mesh::Face_index;
using Vertex = Mesh::Vertex_index;
using TagMap = Mesh::Property_map<Face, std::uint32_t>;
constexpr const char* k_tag = "f:tag";

/// Copies the tags of triangles to their pieces and copies.
struct TagVisitor : pmp::Corefinement::Default_visitor<Mesh> {
  const std::array<Mesh, 2>* meshes = nullptr;
  std::array<TagMap, 2> tags;
  std::uint32_t current = 0;

  std::size_t side(const Mesh& mesh) const { return &mesh == &(*meshes)[0] ? 0 : 1; }
  void before_subface_creations(Face split, Mesh& mesh) { current = tags[side(mesh)][split]; }
  void after_subface_created(Face piece, Mesh& mesh) { tags[side(mesh)][piece] = current; }
  void after_face_copy(Face from, const Mesh& from_mesh, Face to, Mesh& to_mesh) { tags[side(to_mesh)][to] = tags[side(from_mesh)][from]; }
};

void fill(Mesh& mesh, const TaggedSolid& solid) {
  mesh.clear();  // also removes property maps
  TagMap tag = mesh.add_property_map<Face, std::uint32_t>(k_tag, 0).first;
  for (const Vec3& p : solid.points) mesh.add_vertex(Kernel::Point_3(p.x, p.y, p.z));
  for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
    const auto& v = solid.triangles[t];
    tag[mesh.add_face(Vertex(v[0]), Vertex(v[1]), Vertex(v[2]))] = solid.tag[t];
  }
}

/// Evaluates the coordinates now: lazy numbers would otherwise keep the history of all earlier cuts.
void make_exact(const Mesh& mesh) {
  for (const Vertex v : mesh.vertices()) CGAL::exact(mesh.point(v));
}

TaggedSolid rounded(Mesh& mesh) {
  TaggedSolid solid;
  std::vector<std::uint32_t> number(mesh.number_of_vertices() + mesh.number_of_removed_vertices(), 0);
  for (const Vertex v : mesh.vertices()) {
    number[v] = static_cast<std::uint32_t>(solid.points.size());
    const auto& exact = CGAL::exact(mesh.point(v));
    solid.points.push_back({CGAL::to_double(exact.x()), CGAL::to_double(exact.y()), CGAL::to_double(exact.z())});
  }
  const TagMap tag = mesh.property_map<Face, std::uint32_t>(k_tag).first;
  for (const Face f : mesh.faces()) {
    auto& triangle = solid.triangles.emplace_back();
    std::size_t corner = 0;
    for (const Vertex v : mesh.vertices_around_face(mesh.halfedge(f))) triangle[corner++] = number[v];
    solid.tag.push_back(tag[f]);
  }
  return solid;
}

/// Returns an empty string on success, else the cause of the failure.
std::string add_second_to_first(std::array<Mesh, 2>& meshes) {
  TagVisitor visitor;
  visitor.meshes = &meshes;
  for (std::size_t i = 0; i < 2; ++i) visitor.tags[i] = meshes[i].property_map<Face, std::uint32_t>(k_tag).first;
  try {
    const bool is_solid = pmp::corefine_and_compute_union(meshes[0], meshes[1], meshes[0], CGAL::parameters::visitor(visitor).throw_on_self_intersection(true));
    return is_solid ? "" : "their common surface is not manifold: they touch in a point or along an edge";
  } catch (const pmp::Corefinement::Self_intersection_exception&) {
    return "three or more triangles meet where these two solids cross";
  } catch (const CGAL::Failure_exception& failure) {
    return "CGAL failed (" + failure.expression() + ")";
  }
}

}  // namespace

CorefinedUnion corefine_union(const std::vector<TaggedSolid>& solids, const RunContext& context) {
  CorefinedUnion result;
  if (solids.empty()) return result;
  std::array<Mesh, 2> meshes;
  fill(meshes[0], solids.front());
  for (std::size_t i = 1; i < solids.size(); ++i) {
    context.progress(static_cast<double>(i) / static_cast<double>(solids.size()));
    fill(meshes[1], solids[i]);
    result.reason = add_second_to_first(meshes);
    if (!result.reason.empty()) {
      result.is_solid = false;
      result.failed = i;
      return result;
    }
    make_exact(meshes[0]);
    meshes[0].collect_garbage();
  }
  result.surface = rounded(meshes[0]);
  return result;
}

}  // namespace sterna
