// Where an envelope vertex may go: free, in a plane, on a surface, on the line of two planes, or fixed on the wall. Rims of walls that end on a symmetry
// plane or a tunnel wall carry such constraints, so that the layer ends flush with it (docs/method/envelope.md, "Half models").
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
  free,     ///< anywhere: height and two tangential unknowns
  plane,    ///< height and one tangential unknown
  surface,  ///< as plane, in the tangent plane at the wall vertex; points are put back on the surface
  line,     ///< height alone
  fixed,    ///< stays on the wall vertex: the layer has no height there
};

/// A surface that ends the fluid domain: vertices on it stay on it, all others stay on its inner side.
class ConstraintSurface {
 public:
  virtual ~ConstraintSurface() = default;
  /// Nearest point of the surface.
  virtual Point closest(const Point& p) const = 0;
  /// Unit normal at the nearest point, into the domain.
  virtual Vec3 normal(const Point& p) const = 0;
  /// Distance in metres, positive inside the domain, negative beyond the surface.
  virtual double inside_distance(const Point& p) const = 0;
  /// Whether a body that ends on it stands for its half of a whole one.
  virtual bool is_mirror() const { return true; }
};

/// Plane through `point`; `normal` (unit) points into the domain. With a normal along a coordinate axis everything that is constrained to the plane keeps
/// that coordinate of its wall vertex to the bit.
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

/// One side of an actuator disc's plane, `normal` away from the disc: the body goes on beyond it.
class ConstraintSheet final : public ConstraintSurface {
 public:
  ConstraintSheet(const Point& point, const Vec3& normal) : plane_(point, normal) {}
  Point closest(const Point& p) const override { return plane_.closest(p); }
  Vec3 normal(const Point& p) const override { return plane_.normal(p); }
  double inside_distance(const Point& p) const override { return plane_.inside_distance(p); }
  bool is_mirror() const override { return false; }

 private:
  ConstraintPlane plane_;
};

/// Infinite circular cylinder about the line through `point` along `axis`; the domain is inside it (a round tunnel) or, with is_domain_outside, outside.
class ConstraintCylinder final : public ConstraintSurface {
 public:
  ConstraintCylinder(const Point& point, const Vec3& axis, double radius, bool is_domain_outside = false);
  Point closest(const Point& p) const override;
  Vec3 normal(const Point& p) const override;
  double inside_distance(const Point& p) const override;

 private:
  Vec3 radial(const Point& p) const;  ///< from the axis to p
  Point point_;
  Vec3 axis_;
  double radius_;
  double side_;  ///< +1: the domain is outside
};

/// Triangulated surface whose triangle normals point into the domain; normals are those of the nearest triangle. The mesh is copied.
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
  Vec3 axis;  ///< unit; plane, surface: normal at the wall vertex, into the domain; line: its direction; else unused
  /// Numbers (in Constraints::surfaces) of what holds the vertex: plane and surface use the first, line both; -1: none.
  std::array<std::int32_t, 2> on = {-1, -1};
  bool is_on(std::size_t surface) const { return on[0] == static_cast<std::int32_t>(surface) || on[1] == static_cast<std::int32_t>(surface); }
};

/// What LayerBase takes: one constraint per wall vertex (an empty column: all free) and the surfaces that they and the whole envelope obey.
struct Constraints {
  Column<VertexId, VertexConstraint> vertex;
  std::vector<std::shared_ptr<const ConstraintSurface>> surfaces;
  /// Bit k of a vertex: its layer could reach surface k (k < 64), so it keeps inside of it. Empty: every surface concerns every vertex.
  Column<VertexId, std::uint64_t> near = {};
};

/// The part of `v` that the constraint allows; zero for fixed.
Vec3 project(const VertexConstraint& constraint, const Vec3& v);

/// `direction` projected into the constraint, unit; on a line the sense that is nearer. Zero when nothing of it lies in the constraint, and for fixed.
Vec3 constrained(const VertexConstraint& constraint, const Vec3& direction);

/// Tangential unknowns of the optimiser beside the height: 2 free, 1 plane or surface, 0 line or fixed (fixed has no height either).
int tangential_unknowns(const VertexConstraint& constraint);

/// The first `count` axes are unit, orthogonal to `normal` and to each other, and lie inside the constraint. count = tangential_unknowns().
struct TangentAxes {
  std::array<Vec3, 2> axis;
  int count = 0;
};
/// \pre `normal` is unit and satisfies the constraint (as LayerBase::vertex_normal and envelope directions do).
TangentAxes tangent_axes(const VertexConstraint& constraint, const Vec3& normal);

}  // namespace sterna::volmesh
