// What the layer grows from: the wall with its derived geometry. Later also opened ridges and doubled sheets.
#pragma once

#include <span>

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/envelope/constraint.h"

namespace sterna::volmesh {

struct LayerBase {
  /// \pre wall manifold, no degenerate triangle, normals into the fluid; constraints for the vertices of its rims if it has a boundary.
  /// `wall` must outlive this.
  LayerBase(const TriMesh& wall, const RunContext& context, Constraints constraints = {});

  const TriMesh& wall;
  Topology topology;
  double body_length;                          ///< m
  Column<VertexId, VertexConstraint> constraint;                    ///< what directions and envelope points obey; all free by default
  std::vector<std::shared_ptr<const ConstraintSurface>> surfaces;  ///< that VertexConstraint::on numbers
  Column<TriangleId, Vec3> unit_normal;        ///< of each triangle
  Column<TriangleId, double> area;             ///< m^2
  Column<VertexId, Vec3> vertex_normal;        ///< unit, angle-weighted mean of the incident normals (Thuermer & Wuethrich 1998)
  Column<VertexId, Vec3> visible_direction;    ///< unit, axis of the smallest cap that holds all incident normals
  Column<VertexId, double> visibility;         ///< cosine between visible_direction and the worst incident normal; <= 0: no direction sees all faces
  Column<VertexId, double> mean_edge;          ///< m, l_j of eq. (1)
  Column<VertexId, double> vertex_area;        ///< m^2, a third of the incident triangles

  /// Smallest cosine between d and the normals of v's triangles.
  double worst_cosine(VertexId v, const Vec3& d) const;
};

/// Axis of the smallest spherical cap that holds all `normals`, and the cosine of its half angle (Aubry & Loehner 2008, "most normal normal").
/// Meaningful for caps below 90 degrees; else the returned cosine (the true minimum over the normals) is not positive.
struct Cap {
  Vec3 axis;
  double cosine = -1.0;
};
Cap smallest_cap(std::span<const Vec3> normals);

}  // namespace sterna::volmesh
