// Bodies of revolution about x on which actuator discs end.
#pragma once

#include <cmath>
#include <numbers>

#include "tests/support/test_shapes.h"

namespace sterna::volmesh {

/// An ellipsoid of half length 2 and radius 0.5; patch "hub".
inline TriMesh hub(int f = 10) {
  TriMesh mesh = test::sphere(f);
  for (Point& p : mesh.points) p = {2.0 * p.x, 0.5 * p.y, 0.5 * p.z};
  mesh.patches = Column<PatchId, Patch>{{"hub", PatchKind::wall}};
  return mesh;
}
inline double hub_radius(double x) { return 0.5 * std::sqrt(1.0 - 0.25 * x * x); }

/// A duct: an ellipse of half length 1 and thickness 0.5, revolved about x at radius 1.5; patch "duct".
inline TriMesh duct(int n_around = 48, int n_section = 28) {
  TriMesh mesh;
  mesh.patches = Column<PatchId, Patch>{{"duct", PatchKind::wall}};
  const auto at = [&](int i, int j) { return VertexId(static_cast<std::uint32_t>((i % n_around) * n_section + j % n_section)); };
  for (int i = 0; i < n_around; ++i)
    for (int j = 0; j < n_section; ++j) {
      const double a = 2.0 * std::numbers::pi * i / n_around, s = 2.0 * std::numbers::pi * j / n_section, r = 1.5 + 0.25 * std::sin(s);
      mesh.points.push_back(Point{std::cos(s), r * std::cos(a), r * std::sin(a)});
    }
  for (int i = 0; i < n_around; ++i)
    for (int j = 0; j < n_section; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  mesh.triangle_patch.assign(mesh.n_triangles(), PatchId(0));
  return mesh;
}
/// Radius of the inner face of the duct.
inline double duct_radius(double x) { return 1.5 - 0.25 * std::sqrt(1.0 - x * x); }

}  // namespace sterna::volmesh
