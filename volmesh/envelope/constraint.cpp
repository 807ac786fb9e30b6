#include "volmesh/envelope/constraint.h"

#include <cmath>

#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"

namespace sterna::volmesh {

ConstraintPlane::ConstraintPlane(const Point& point, const Vec3& normal) : point_(point), normal_(normalized(normal)) {}

Point ConstraintPlane::closest(const Point& p) const { return p - inside_distance(p) * normal_; }

ConstraintCylinder::ConstraintCylinder(const Point& point, const Vec3& axis, double radius, bool is_domain_outside)
    : point_(point), axis_(normalized(axis)), radius_(radius), side_(is_domain_outside ? 1.0 : -1.0) {}

Vec3 ConstraintCylinder::radial(const Point& p) const {
  const Vec3 q = p - point_;
  return q - dot(q, axis_) * axis_;
}

Point ConstraintCylinder::closest(const Point& p) const {
  const Vec3 r = radial(p);
  return p + (radius_ - norm(r)) * normalized(r);
}

Vec3 ConstraintCylinder::normal(const Point& p) const { return side_ * normalized(radial(p)); }

double ConstraintCylinder::inside_distance(const Point& p) const { return side_ * (norm(radial(p)) - radius_); }

struct ConstraintTriangles::Data {
  TriMesh mesh;
  TriangleTree tree;
};

ConstraintTriangles::ConstraintTriangles(TriMesh mesh, const RunContext& context) {
  TriangleTree tree(mesh, context);
  data_ = std::make_unique<const Data>(Data{std::move(mesh), std::move(tree)});
}

ConstraintTriangles::~ConstraintTriangles() = default;

Point ConstraintTriangles::closest(const Point& p) const { return data_->tree.nearest(p).point; }

Vec3 ConstraintTriangles::normal(const Point& p) const {
  const auto [a, b, c] = corners(data_->mesh, data_->tree.nearest(p).triangle);
  return normalized(area_vector(a, b, c));
}

double ConstraintTriangles::inside_distance(const Point& p) const {
  const NearestHit hit = data_->tree.nearest(p);
  const auto [a, b, c] = corners(data_->mesh, hit.triangle);
  return std::copysign(hit.distance, dot(area_vector(a, b, c), p - hit.point));
}

Vec3 project(const VertexConstraint& constraint, const Vec3& v) {
  const Vec3& axis = constraint.axis;
  switch (constraint.freedom) {
    case Freedom::free: return v;
    case Freedom::plane:
    case Freedom::surface: return v - dot(v, axis) * axis;
    case Freedom::line: return dot(v, axis) * axis;
    case Freedom::fixed: break;
  }
  return {};
}

Vec3 constrained(const VertexConstraint& constraint, const Vec3& direction) {
  if (constraint.freedom != Freedom::line) return normalized(project(constraint, direction));
  const double along = dot(direction, constraint.axis);
  return along == 0.0 ? Vec3{} : along > 0.0 ? constraint.axis : -constraint.axis;
}

int tangential_unknowns(const VertexConstraint& constraint) {
  switch (constraint.freedom) {
    case Freedom::free: return 2;
    case Freedom::plane:
    case Freedom::surface: return 1;
    case Freedom::line:
    case Freedom::fixed: break;
  }
  return 0;
}

TangentAxes tangent_axes(const VertexConstraint& constraint, const Vec3& normal) {
  TangentAxes tangent;
  tangent.count = tangential_unknowns(constraint);
  if (tangent.count == 1) tangent.axis[0] = normalized(cross(constraint.axis, normal));
  if (tangent.count < 2) return tangent;
  // Orthonormal basis without a branch on near-parallel axes (Duff et al. 2017, Building an orthonormal basis, revisited).
  const double sign = std::copysign(1.0, normal.z);
  const double a = -1.0 / (sign + normal.z);
  const double b = normal.x * normal.y * a;
  tangent.axis[0] = {1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
  tangent.axis[1] = {b, sign + normal.y * normal.y * a, -normal.y};
  return tangent;
}

}  // namespace sterna::volmesh
