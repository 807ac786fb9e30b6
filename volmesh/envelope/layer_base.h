// Base of the layer: the wall with its derived geometry, including opened ridges.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/truncation.h"
#include "volmesh/envelope/constraint.h"
#include "volmesh/envelope/layer_demand.h"
#include "volmesh/envelope/opened_ridges.h"

namespace sterna::volmesh {

inline constexpr double k_equilateral = 2.309401076758503;  ///< 4 / sqrt(3): square of the edge of an equilateral triangle divided by its area
/// Returns l of eq. (1) in metres: the edge of the equilateral triangle with the same area. For stretched triangles it is at least a third of their mean edge.
double layer_edge_of(double equilateral_edge, double mean_edge);

struct LayerBase {
  /// \pre the wall is manifold, without degenerate triangles, and its normals point into the fluid; there are constraints for the vertices of its open
  /// boundaries, if any; `ridges` are those of the wall (null: none), and are kept by the caller like the wall
  LayerBase(Borrowed<const TriMesh> wall, const RunContext& context, Constraints constraints = {}, const OpenedRidges* ridges = nullptr);

  const TriMesh& wall;
  Topology topology;
  double body_length;                                              ///< m
  Column<VertexId, VertexConstraint> constraint;                   ///< constraints of directions and envelope points; by default all vertices are free
  std::vector<std::shared_ptr<const ConstraintSurface>> surfaces;  ///< indexed by VertexConstraint::on
  Column<VertexId, std::uint64_t> near;                            ///< as in Constraints::near
  Column<TriangleId, Vec3> unit_normal;                            ///< unit normal of each triangle
  Column<TriangleId, double> area;                                 ///< m^2
  Column<VertexId, Vec3> vertex_normal;      ///< unit, within the constraint: angle-weighted mean of the incident normals (Thuermer & Wuethrich 1998)
  Column<VertexId, Vec3> visible_direction;  ///< unit, within the constraint: direction with the largest minimum of the cosines with the incident normals,
                                             ///< which is the axis of the smallest cap that contains all of them
  Column<VertexId, double> visibility;    ///< smallest cosine between visible_direction and the incident normals; <= 0: all faces are visible from no direction
  Column<VertexId, double> facet_cosine;  ///< angle-weighted mean of the cosines between vertex_normal and the incident normals
  Column<VertexId, double> mean_edge;     ///< m, mean of the edges at the vertex
  Column<VertexId, double> longest_edge;  ///< m, longest of the edges at the vertex
  Column<VertexId, double> layer_edge;    ///< m, l_j of eq. (1); see set_layer_edges()
  Column<VertexId, double> vertex_area;   ///< m^2, a third of the area of the incident triangles

  /// Groups of vertices with equal growth (where walls end on periodic sides), each in ascending order, and the group of each vertex. Without groups the second
  /// list is empty; vertices without a group have k_none.
  std::vector<std::vector<VertexId>> groups;
  Column<VertexId, std::uint32_t> group;
  /// Computes normals, directions and edges of these pairs from the triangles of both partners together. Pairs may be chained (two directions of
  /// periodicity).
  /// \pre constraints of partners are equal except for the sense of their axes
  void let_grow_alike(const std::vector<std::array<VertexId, 2>>& partners);

  std::vector<std::array<VertexId, 2>> level;  ///< pairs of vertices whose layers must have equal heights: on both sides of wake sheets

  /// Vertices on free edges of wake sheets, ascending. Their growth lines have no height, but the layer need not be thin beside them, because fluid surrounds
  /// them.
  std::vector<VertexId> sheet_borders;
  bool is_sheet_border(VertexId v) const { return std::binary_search(sheet_borders.begin(), sheet_borders.end(), v); }

  LayerDemand demand;  ///< layer settings of patches that replace the options (patch_layers.h); empty by default

  /// Truncation of each vertex, if patches have another setting than PrismOptions::truncate (patch_layers.h); empty if no patch has one.
  Column<VertexId, Truncation> truncation;

  const OpenedRidges* ridges;  ///< null if no ridge is opened
  /// Returns true for triangles between growth lines with a common ridge base vertex. They are not part of the given wall.
  bool is_virtual(TriangleId t) const { return ridges != nullptr && t.index() >= ridges->n_given_triangles; }
  /// Returns true if both vertices have a common ridge base vertex. Edges between such vertices have nearly zero length and are excluded from means.
  bool share_base_vertex(VertexId a, VertexId b) const { return ridges != nullptr && ridges->base_vertex[a] == ridges->base_vertex[b]; }
  /// Returns the multi-normal fan of a vertex; null if the vertex belongs to no fan.
  const OpenedRidges::BaseVertex* multi_normal_of(VertexId v) const;
  /// Returns the reference visibility for growth directions at a vertex: the best smallest cosine between one direction and the face normals. In a multi-normal
  /// fan whose ridge ends, this is at most the visibility of a single growth line, because the lines must be able to converge towards that end.
  double cone_visibility(VertexId v) const;
  /// Returns true if an edge of the wall belongs to a virtual triangle. Such edges are no features.
  bool is_in_gap(HalfedgeId h) const {
    const HalfedgeId twin = topology.twin(h);
    return is_virtual(triangle_of(h)) || (twin.is_valid() && is_virtual(triangle_of(twin)));
  }

  bool concerns(std::size_t surface, VertexId v) const { return near.empty() || (surface < 64 && (near[v] >> surface & 1u) != 0); }

  /// Returns the smallest cosine between d and the normals of v's triangles.
  double worst_cosine(VertexId v, const Vec3& d) const;
  /// Returns the number of copies of the edge v-other that meet at v if the body is mirrored at the surfaces through v: 1, 2 or 4. With this weight in every
  /// mean around v, and the mean projected into the constraint, a half model gives the same results as the full model.
  double mirror_weight(VertexId v, VertexId other) const;

 private:
  void derive(std::span<const VertexId> alike);
  /// Sets the target edges for the height of the last prisms. The target is the edge of an equilateral triangle with the mean area of the triangles at the
  /// vertex, because tetrahedra get this edge, too (for stretched triangles at least a third of the mean edge). Its logarithm is smoothed over some rings. A
  /// layer several edges thick cannot follow the scatter between single triangles: the steps would tilt the tops of all its prisms.
  void set_layer_edges(const RunContext& context);
  void even_out_multi_normals();
};

/// Calls f(w) for v and all vertices that must grow like v, ascending.
template <class F>
void for_each_alike(const LayerBase& base, VertexId v, const F& f) {
  if (base.group.empty() || base.group[v] == k_none) return f(v);
  for (const VertexId w : base.groups[base.group[v]]) f(w);
}

/// Calls f(half-edge, other end) once for every edge at v: for its outgoing half-edges and, on the boundary, for the incoming half-edge without a twin.
template <class F>
void for_each_edge(const Topology& topology, VertexId v, const F& f) {
  for (const HalfedgeId h : topology.outgoing(v)) {
    f(h, topology.to(h));
    const HalfedgeId arriving = previous(h);
    if (topology.is_boundary(arriving)) f(arriving, topology.from(arriving));
  }
}

/// Axis of the smallest spherical cap that contains all `normals`, and the cosine of its half angle (Aubry & Loehner 2008, "most normal normal"). The cap is
/// meaningful if its half angle is below 90 degrees. Otherwise the returned cosine (the true minimum over the normals) is not positive.
struct Cap {
  Vec3 axis;
  double cosine = -1.0;
};
Cap smallest_cap(std::span<const Vec3> normals);

/// Returns the direction within the constraint with the largest minimum of the cosines with the normals, and this minimum. O(m^3) for m normals in a plane.
Cap best_seen(const VertexConstraint& constraint, std::span<const Vec3> normals);

}  // namespace sterna::volmesh
