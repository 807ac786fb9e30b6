// Overlapping coplanar triangles form a group. Each group is one constrained triangulation (in the two coordinates in which its normal is smallest) of its
// triangles' edges and of their intersections with triangles of other planes. A point shared by several planes is computed by each of them exactly, and
// therefore becomes one vertex.
#include "geom/boolean/cgal_arrange.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/exceptions.h>

#include <map>
#include <utility>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"
#include "geom/math/predicates.h"

namespace sterna {
namespace {

using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = ExactKernel::FT;
using Point2 = ExactKernel::Point_2;
using Point3 = ExactKernel::Point_3;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, ExactKernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<ExactKernel>;
using Planar =
    CGAL::Constrained_Delaunay_triangulation_2<ExactKernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_intersections_tag>;

struct PointOrder {
  bool operator()(const Point3& a, const Point3& b) const { return CGAL::compare_xyz(a, b) == CGAL::SMALLER; }
};

struct Piece {
  Point3 a, b;
  bool is_point = false;
};

/// Triangles of one plane, and the intersections of other triangles with that plane.
struct Group {
  std::vector<std::uint32_t> triangles;
  std::vector<Piece> pieces;
};

class Arranger {
 public:
  Arranger(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles) : points_(points), triangles_(triangles) {
    result_.points.assign(points.begin(), points.end());
  }

  Arrangement run(std::span<const std::array<std::uint32_t, 2>> pairs, const RunContext& context) {
    std::vector<char> is_cut(triangles_.size(), 0);
    DisjointSets planes(triangles_.size());
    for (const auto& [i, j] : pairs) {
      is_cut[i] = is_cut[j] = 1;
      if (are_coplanar(i, j)) planes.join(i, j);
    }
    const std::vector<std::uint32_t> root = std::move(planes).roots();
    std::map<std::uint32_t, Group> groups;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (is_cut[t]) {
        groups[root[t]].triangles.push_back(t);
        for (const std::uint32_t v : triangles_[t]) vertex_.try_emplace(exact_point(v), v);
      } else {
        add(triangles_[t], t);
      }
    }
    std::size_t n_done = 0;
    for (const auto& [i, j] : pairs) {
      if (n_done++ % 64 == 0) context.progress(0.5 * static_cast<double>(n_done) / static_cast<double>(pairs.size()));
      if (root[i] == root[j]) continue;
      intersect(i, j, groups[root[i]].pieces, groups[root[j]].pieces);
    }
    n_done = 0;
    for (auto& [first, group] : groups) {
      if (n_done++ % 16 == 0) context.progress(0.5 + 0.5 * static_cast<double>(n_done) / static_cast<double>(groups.size()));
      triangulate(group);
      group = {};
    }
    return std::move(result_);
  }

 private:
  Point3 exact_point(std::uint32_t v) const { return Point3(points_[v].x, points_[v].y, points_[v].z); }
  const Vec3& corner(std::uint32_t t, std::size_t k) const { return points_[triangles_[t][k]]; }

  bool are_coplanar(std::uint32_t i, std::uint32_t j) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (orient3d(corner(i, 0), corner(i, 1), corner(i, 2), corner(j, k)) != 0) return false;
    return true;
  }

  void add(const std::array<std::uint32_t, 3>& triangle, std::uint32_t parent) {
    result_.triangles.push_back(triangle);
    result_.parent.push_back(parent);
  }

  ExactKernel::Triangle_3 exact_triangle(std::uint32_t t) const {
    return {exact_point(triangles_[t][0]), exact_point(triangles_[t][1]), exact_point(triangles_[t][2])};
  }

  void intersect(std::uint32_t i, std::uint32_t j, std::vector<Piece>& of_i, std::vector<Piece>& of_j) const {
    const auto common = CGAL::intersection(exact_triangle(i), exact_triangle(j));
    if (!common) return;
    Piece piece;
    if (const auto* point = boost::get<Point3>(&*common)) {
      piece = {*point, *point, true};
    } else if (const auto* segment = boost::get<ExactKernel::Segment_3>(&*common)) {
      piece = {segment->source(), segment->target(), false};
    } else {
      return;  // the intersection is a region only for coplanar triangles, which are in one group and not intersected
    }
    for (const Point3* p : {&piece.a, &piece.b}) CGAL::exact(*p);
    of_i.push_back(piece);
    of_j.push_back(piece);
  }

  std::uint32_t vertex_of(const Point3& p) {
    const auto [found, is_new] = vertex_.try_emplace(p, static_cast<std::uint32_t>(result_.points.size()));
    if (is_new) {
      const auto& exact = CGAL::exact(p);
      result_.points.push_back({CGAL::to_double(exact.x()), CGAL::to_double(exact.y()), CGAL::to_double(exact.z())});
    }
    return found->second;
  }

  void triangulate(const Group& group) {
    const std::uint32_t first = group.triangles.front();
    const ExactKernel::Plane_3 plane = exact_triangle(first).supporting_plane();
    const std::array<Number, 3> normal{plane.a(), plane.b(), plane.c()};
    std::size_t c = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
      if (CGAL::abs(normal[axis]) > CGAL::abs(normal[c])) c = axis;
    const int a = static_cast<int>((c + 1) % 3), b = static_cast<int>((c + 2) % 3), third = static_cast<int>(c);
    const auto flat = [&](const Point3& p) { return Point2(p[a], p[b]); };

    Planar planar;
    for (const std::uint32_t t : group.triangles)
      for (std::size_t k = 0; k < 3; ++k) planar.insert_constraint(flat(exact_point(triangles_[t][k])), flat(exact_point(triangles_[t][(k + 1) % 3])));
    for (const Piece& piece : group.pieces) {
      if (piece.is_point) planar.insert(flat(piece.a));
      else planar.insert_constraint(flat(piece.a), flat(piece.b));
    }
    for (const auto v : planar.finite_vertex_handles()) {
      std::array<Number, 3> x;
      x[static_cast<std::size_t>(a)] = v->point().x();
      x[static_cast<std::size_t>(b)] = v->point().y();
      x[static_cast<std::size_t>(third)] =
          -(plane.d() + normal[static_cast<std::size_t>(a)] * v->point().x() + normal[static_cast<std::size_t>(b)] * v->point().y()) / normal[c];
      const Point3 p(x[0], x[1], x[2]);
      CGAL::exact(p);
      v->info() = vertex_of(p);
    }
    struct Outline {
      std::uint32_t triangle = 0;
      bool is_turned = false;
      std::array<Point2, 3> corners;
      CGAL::Bbox_2 box;
    };
    std::vector<Outline> outlines;
    for (const std::uint32_t t : group.triangles) {
      Outline& outline = outlines.emplace_back();
      outline.triangle = t;
      for (std::size_t k = 0; k < 3; ++k) outline.corners[k] = flat(exact_point(triangles_[t][k]));
      outline.is_turned = CGAL::orientation(outline.corners[0], outline.corners[1], outline.corners[2]) == CGAL::RIGHT_TURN;
      outline.box = outline.corners[0].bbox() + outline.corners[1].bbox() + outline.corners[2].bbox();
    }
    for (const auto f : planar.finite_face_handles()) {
      const std::array<std::uint32_t, 3> triangle{f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()};
      const Point2 center = outlines.size() > 1 ? CGAL::centroid(f->vertex(0)->point(), f->vertex(1)->point(), f->vertex(2)->point()) : Point2();
      for (const Outline& outline : outlines) {
        if (outlines.size() > 1 && !covers(outline.corners, outline.box, center)) continue;
        add(outline.is_turned ? std::array{triangle[0], triangle[2], triangle[1]} : triangle, outline.triangle);
      }
    }
  }

  static bool covers(const std::array<Point2, 3>& corners, const CGAL::Bbox_2& box, const Point2& p) {
    if (!CGAL::do_overlap(box, p.bbox())) return false;
    const auto turn = CGAL::orientation(corners[0], corners[1], corners[2]);
    for (std::size_t k = 0; k < 3; ++k)
      if (CGAL::orientation(corners[k], corners[(k + 1) % 3], p) != turn) return false;
    return true;
  }

  std::span<const Vec3> points_;
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  Arrangement result_;
  std::map<Point3, std::uint32_t, PointOrder> vertex_;
};

}  // namespace

Arrangement arrange_triangles(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                              std::span<const std::array<std::uint32_t, 2>> pairs, const RunContext& context) {
  try {
    return Arranger(points, triangles).run(pairs, context);
  } catch (const CGAL::Failure_exception& failure) {
    ErrorInfo info;
    info.code = ErrorCode::geometry_failed;
    info.attempted = "cutting crossing triangles along their intersections";
    info.problem = "CGAL failed (" + failure.expression() + ")";
    throw Error(std::move(info));
  }
}

}  // namespace sterna
