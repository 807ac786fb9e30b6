// Based on: P. Liepa, "Filling holes in meshes" (2003), and the CGAL 5.5 manual, Polygon Mesh Processing, Hole filling.
#define CGAL_EIGEN3_ENABLED 1
#include "geom/boolean/cgal_fill_hole.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/exceptions.h>

#include <map>
#include <utility>

namespace sterna {
namespace {

using FillKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using FlatVertex = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, FillKernel>;
using FlatFace = CGAL::Triangulation_face_base_with_info_2<int, FillKernel, CGAL::Constrained_triangulation_face_base_2<FillKernel>>;
using Flat =
    CGAL::Constrained_Delaunay_triangulation_2<FillKernel, CGAL::Triangulation_data_structure_2<FlatVertex, FlatFace>, CGAL::No_constraint_intersection_tag>;
using FillMesh = CGAL::Surface_mesh<FillKernel::Point_3>;
constexpr int k_unknown = -1;

/// Marks the inside by the even-odd rule: each constraint crossed on the way from outside changes the side.
void mark_inside(Flat& flat) {
  for (const auto f : flat.all_face_handles()) f->info() = k_unknown;
  std::vector<Flat::Face_handle> now{flat.infinite_face()}, later;
  for (int side = 0; !now.empty(); ++side, now.swap(later), later.clear()) {
    while (!now.empty()) {
      const auto f = now.back();
      now.pop_back();
      if (f->info() != k_unknown) continue;
      f->info() = side % 2;
      for (int k = 0; k < 3; ++k) {
        const auto g = f->neighbor(k);
        if (g->info() == k_unknown) (f->is_constrained(k) ? later : now).push_back(g);
      }
    }
  }
}

FillKernel::Point_3 cgal_point(const Vec3& p) { return {p.x, p.y, p.z}; }

HolePatch fill_by_loop(const HoleBorder& border) {
  std::vector<FillKernel::Point_3> loop, third;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> opposite;
  for (const auto& t : border.triangles)
    for (std::size_t k = 0; k < 3; ++k) opposite[{t[(k + 1) % 3], t[k]}] = t[(k + 2) % 3];
  for (std::uint32_t i = 0; i < border.n_loop; ++i) {
    loop.push_back(cgal_point(border.points[i]));
    const auto found = opposite.find({i, (i + 1) % border.n_loop});
    if (found != opposite.end()) third.push_back(cgal_point(border.points[found->second]));
  }
  std::vector<CGAL::Triple<int, int, int>> triangles;
  if (third.size() == loop.size()) CGAL::Polygon_mesh_processing::triangulate_hole_polyline(loop, third, std::back_inserter(triangles));
  else CGAL::Polygon_mesh_processing::triangulate_hole_polyline(loop, std::back_inserter(triangles));
  HolePatch patch;
  for (const auto& t : triangles)
    patch.triangles.push_back({static_cast<std::uint32_t>(t.first), static_cast<std::uint32_t>(t.second), static_cast<std::uint32_t>(t.third)});
  return patch;
}

HolePatch fill_smoothly(const HoleBorder& border) {
  FillMesh mesh;
  std::vector<FillMesh::Vertex_index> vertex;
  for (const Vec3& p : border.points) vertex.push_back(mesh.add_vertex(cgal_point(p)));
  for (const auto& t : border.triangles)
    if (mesh.add_face(vertex[t[0]], vertex[t[1]], vertex[t[2]]) == FillMesh::null_face()) return {};
  const auto hole = mesh.halfedge(vertex[0], vertex[1]);
  if (hole == FillMesh::null_halfedge() || !mesh.is_border(hole)) return {};
  std::uint32_t n_around = 0;
  for (const auto h : CGAL::halfedges_around_face(hole, mesh)) n_around += mesh.is_border(h);
  if (n_around != border.n_loop) return {};
  std::vector<FillMesh::Face_index> faces;
  std::vector<FillMesh::Vertex_index> vertices;
  CGAL::Polygon_mesh_processing::triangulate_refine_and_fair_hole(mesh, hole, std::back_inserter(faces), std::back_inserter(vertices));
  HolePatch patch;
  std::map<std::uint32_t, std::uint32_t> number;
  for (const auto v : vertices) {
    const auto& p = mesh.point(v);
    if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z())) return {};
    number[static_cast<std::uint32_t>(v)] = border.n_loop + static_cast<std::uint32_t>(patch.points.size());
    patch.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : faces) {
    std::array<std::uint32_t, 3> triangle{};
    std::size_t k = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) {
      const auto id = static_cast<std::uint32_t>(v);
      const auto found = number.find(id);
      if (found == number.end() && id >= border.n_loop) return {};
      triangle[k++] = found == number.end() ? id : found->second;
    }
    patch.triangles.push_back(triangle);
  }
  return patch;
}

}  // namespace

HolePatch fill_flat(const std::vector<std::vector<Vec3>>& loops, const Vec3& normal) {
  const Vec3 n = normalized(normal);
  const Vec3 u = normalized(cross(std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, n)), v = cross(n, u);
  const bool is_along_axis = (n.x != 0.0) + (n.y != 0.0) + (n.z != 0.0) == 1;
  const std::size_t axis = n.x != 0.0 ? 0 : n.y != 0.0 ? 1 : 2;
  const auto flat_point = [&](const Vec3& p) {
    if (!is_along_axis) return FillKernel::Point_2(dot(p, u), dot(p, v));
    const double a = p[(axis + 1) % 3], b = p[(axis + 2) % 3];
    return n[axis] > 0.0 ? FillKernel::Point_2(a, b) : FillKernel::Point_2(b, a);
  };
  HolePatch patch;
  try {
    Flat flat;
    std::uint32_t number = 0;
    for (const auto& loop : loops) {
      std::vector<Flat::Vertex_handle> border;
      for (const Vec3& p : loop) {
        const std::size_t n_before = flat.number_of_vertices();
        border.push_back(flat.insert(flat_point(p)));
        if (flat.number_of_vertices() == n_before) return {};  // the loop touches itself
        border.back()->info() = number++;
      }
      for (std::size_t i = 0; i < border.size(); ++i) flat.insert_constraint(border[i], border[(i + 1) % border.size()]);
    }
    mark_inside(flat);
    for (const auto f : flat.finite_face_handles())
      if (f->info() == 1) patch.triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  } catch (const Flat::Intersection_of_constraints_exception&) {
    return {};
  } catch (const CGAL::Failure_exception&) {
    return {};
  }
  return patch;
}

HolePatch fill_curved(const HoleBorder& border, bool is_smooth) {
  try {
    HolePatch patch;
    if (is_smooth && !border.triangles.empty()) patch = fill_smoothly(border);
    if (patch.triangles.empty()) patch = fill_by_loop(border);
    return patch;
  } catch (const CGAL::Failure_exception&) {
    return {};  // the caller reports the hole that remains
  }
}

}  // namespace sterna
