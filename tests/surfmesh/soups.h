// Triangle soups for the tests of stitching, and the requirements for stitched surfaces.
#pragma once

#include <cmath>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/test_shapes.h"

namespace sterna::test {

/// Returns a soup in which each facet has three vertices of its own, as in an STL file.
inline SurfaceSoup soup_of(const TriMesh& mesh, const std::string& source = "shape.stl") {
  SurfaceSoup soup;
  soup.source = source;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto n = static_cast<std::uint32_t>(soup.points.size());
    for (const Point& p : corners(mesh, t)) soup.points.push_back(p);
    soup.triangles.push_back({n, n + 1, n + 2});
    soup.patch.push_back(0);
  }
  soup.patch_names = {""};
  return soup;
}

/// Adds one facet from its corners.
inline void add_facet(SurfaceSoup& soup, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto n = static_cast<std::uint32_t>(soup.points.size());
  soup.points.insert(soup.points.end(), {a, b, c});
  soup.triangles.push_back({n, n + 1, n + 2});
  soup.patch.push_back(0);
}

inline SurfaceSoup shifted(SurfaceSoup soup, const Vec3& by, double scale = 1.0) {
  for (Vec3& p : soup.points) p = scale * p + by;
  return soup;
}

inline SurfaceSoup inside_out(SurfaceSoup soup) {
  for (auto& t : soup.triangles) std::swap(t[1], t[2]);
  return soup;
}

inline SurfaceSoup joined(SurfaceSoup a, const SurfaceSoup& b) {
  const auto n = static_cast<std::uint32_t>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (auto t : b.triangles) {
    for (std::uint32_t& v : t) v += n;
    a.triangles.push_back(t);
    a.patch.push_back(0);
  }
  return a;
}

inline RunContext quiet(int threads = 2) { return RunContext({.threads = threads}); }

inline surfmesh::StitchResult stitch(const std::vector<SurfaceSoup>& soups, const surfmesh::StitchOptions& options = {}, int threads = 2) {
  return surfmesh::stitch_surface(soups, options, quiet(threads));
}

/// Returns the error of a surface that must be refused; a bug shows as code internal.
inline ErrorInfo stitch_error(const std::vector<SurfaceSoup>& soups, const surfmesh::StitchOptions& options = {}) {
  try {
    stitch(soups, options);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = error.what();  // the whole message, for tests of the wording
    info.n_locations = error.n_locations();
    return info;
  }
  ADD_FAILURE() << "the surface was accepted";
  return {};
}

inline double volume(const TriMesh& mesh) {
  double sum = 0.0;
  const Vec3 origin = bounding_box(mesh).center();
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    sum += tet_volume(origin, c[0], c[1], c[2]);
  }
  return sum;
}

inline double area(const TriMesh& mesh) {
  double sum = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    sum += triangle_area(c[0], c[1], c[2]);
  }
  return sum;
}

/// Checks the postconditions of the contract for a closed surface.
inline void expect_stitched(const TriMesh& mesh) {
  const RunContext context = quiet();
  const Topology topology(mesh, context);  // throws when not manifold or not consistently oriented
  EXPECT_EQ(topology.n_boundary_halfedges(), 0u);
  for (std::size_t v = 0; v < mesh.n_vertices(); ++v) EXPECT_FALSE(topology.outgoing(VertexId(std::uint64_t{v})).empty()) << "vertex " << v << " is unused";
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  EXPECT_EQ(find_crossings(mesh.points.raw(), triangles, context).total, 0);
  EXPECT_GT(volume(mesh), 0.0);
  EXPECT_EQ(mesh.triangle_patch.size(), mesh.n_triangles());
  for (const PatchId p : mesh.triangle_patch) EXPECT_LT(p.index(), mesh.patches.size());
  for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
    EXPECT_FALSE(mesh.patches.raw()[i].name.empty());
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(mesh.patches.raw()[i].name, mesh.patches.raw()[j].name);
  }
}

}  // namespace sterna::test
