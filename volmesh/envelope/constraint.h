// Freedom of an envelope vertex: free, in a plane, on a surface, on the line of two planes, or fixed on the wall. Vertices on open boundaries of walls that end
// on a symmetry plane or a tunnel wall have such constraints, so that the layer ends flush with that plane or wall (docs/method/envelope.md, "Half models").
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

enum class Freedom : std::uint8_t {
  free,     ///< may move anywhere: unknowns are the height and two tangential components
  plane,    ///< unknowns are the height and one tangential component
  surface,  ///< like plane, in the tangent plane at the wall vertex; points are projected back onto the surface
  line,     ///< the height is the only unknown
  fixed,    ///< stays on the wall vertex: the layer has no height there
};

/// A surface that bounds the fluid domain. Vertices on it stay on it, all other vertices stay on its inner side.
class ConstraintSurface {
 public:
  virtual ~ConstraintSurface() = default;
  /// Returns the nearest point of the surface.
  virtual Point closest(const Point& p) const = 0;
  /// Returns the unit normal at the nearest point, into the domain.
  virtual Vec3 normal(const Point& p) const = 0;
  /// Returns the distance in metres, positive inside the domain, negative beyond the surface.
  virtual double inside_distance(const Point& p) const = 0;
  /// Returns true if a body that ends on the surface represents half of a mirrored body.
  virtual bool is_mirror() const { return true; }
};

/// Plane through `point`; `normal` (unit) points into the domain. If the normal is along a coordinate axis, every point constrained to the plane keeps
/// bit-exactly the coordinate of its wall vertex on that axis.
class ConstraintPlane final : public ConstraintSurface {
 public:
  ConstraintPlane(const Point& point, const Vec3& normal);
  Point closest(const Point& p) const override;
  Vec3 normal(const Point&) const override { return normal_; }
  double inside_distance(const Point& p) const override { return dot(normal_, p - point_); }

 private:
  Point point_;
  Vec3 normal_;
};

/// One side of the plane of an actuator disc. `normal` points away from the disc, and the body continues beyond the plane.
class ConstraintBaffle final : public ConstraintSurface {
 public:
  ConstraintBaffle(const Point& point, const Vec3& normal) : plane_(point, normal) {}
  Point closest(const Point& p) const override { return plane_.closest(p); }
  Vec3 normal(const Point& p) const override { return plane_.normal(p); }
  double inside_distance(const Point& p) const override { return plane_.inside_distance(p); }
  bool is_mirror() const override { return false; }

 private:
  ConstraintPlane plane_;
};

/// Infinite circular cylinder about the axis through `point` along `axis`. The domain is inside (a round tunnel) or, with is_domain_outside, outside.
class ConstraintCylinder final : public ConstraintSurface {
 public:
  ConstraintCylinder(const Point& point, const Vec3& axis, double radius, bool is_domain_outside = false);
  Point closest(const Point& p) const override;
  Vec3 normal(const Point& p) const override;
  double inside_distance(const Point& p) const override;

 private:
  Vec3 radial(const Point& p) const;  ///< returns the vector from the axis to p
  Point point_;
  Vec3 axis_;
  double radius_;
  double side_;  ///< +1: the domain is outside
};

/// Triangulated surface whose triangle normals point into the domain. normal() returns the normal of the nearest triangle. The mesh is copied.
class ConstraintTriangles final : public ConstraintSurface {
 public:
  ConstraintTriangles(TriMesh mesh, const RunContext& context);
  ~ConstraintTriangles() override;
  Point closest(const Point& p) const override;
  Vec3 normal(const Point& p) const override;
  double inside_distance(const Point& p) const override;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

struct VertexConstraint {
  Freedom freedom = Freedom::free;
  Vec3 axis;  ///< unit; plane and surface: normal at the wall vertex, into the domain; line: direction of the line; otherwise unused
  /// Numbers (in Constraints::surfaces) of the surfaces on which the vertex lies. Plane and surface use the first number, line uses both; -1: none.
  std::array<std::int32_t, 2> on = {-1, -1};
  bool is_on(std::size_t surface) const { return on[0] == static_cast<std::int32_t>(surface) || on[1] == static_cast<std::int32_t>(surface); }
};

/// Constraints of a LayerBase: one constraint per wall vertex (an empty column: all vertices are free), and the surfaces for these constraints and for the
/// whole envelope.
struct Constraints {
  Column<VertexId, VertexConstraint> vertex;
  std::vector<std::shared_ptr<const ConstraintSurface>> surfaces;
  /// Bit k of a vertex is set if its layer could reach surface k (k < 64). The vertex then stays on the inner side of this surface. Empty: every surface
  /// applies to every vertex.
  Column<VertexId, std::uint64_t> near = {};
};

/// Returns the component of `v` that the constraint allows; the zero vector for fixed.
Vec3 project(const VertexConstraint& constraint, const Vec3& v);

/// Returns the unit vector of `direction` projected into the constraint. On a line it is the nearer of the two directions. Returns zero if `direction` has no
/// component in the constraint, and for fixed.
Vec3 constrained(const VertexConstraint& constraint, const Vec3& direction);

/// Returns the number of tangential unknowns of the optimiser besides the height: 2 for free, 1 for plane or surface, 0 for line or fixed. (A fixed vertex has
/// no height either.)
int tangential_unknowns(const VertexConstraint& constraint);

/// Axes of the tangential unknowns. The first `count` = tangential_unknowns() axes are unit vectors, orthogonal to `normal` and to each other, and lie inside
/// the constraint.
struct TangentAxes {
  std::array<Vec3, 2> axis;
  int count = 0;
};
/// \pre `normal` is unit and satisfies the constraint, as LayerBase::vertex_normal and the directions of the envelope do
TangentAxes tangent_axes(const VertexConstraint& constraint, const Vec3& normal);

}  // namespace sterna::volmesh
