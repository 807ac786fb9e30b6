// Builds bodies in four steps: make rows of points through the frames; spline one surface through them, periodic around the body; split it into halves with
// shared edges at bottom and top; close the ends.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/model/components.h"
#include "geom/model/model_builder.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/nurbs_tools.h"
#include "geom/model/section_rows.h"
#include "geom/model/spline.h"

namespace sterna {
namespace {

/// Number of points of half a frame: approximates a superellipse of exponent 4.5 to 1e-4 of its size.
constexpr std::size_t k_half_points = 32;
/// Smallest ratio of the crown of a dome to its base; a smaller crown would pinch it.
constexpr double k_min_crown = 0.25;

/// A ring of the body's surface at which an end begins.
struct Ring {
  std::vector<Point> poles;         ///< poles of the ring's curve along u
  std::vector<Vec3> outwards;       ///< from each pole along the body, outwards; not unit vectors
  std::array<EdgeId, 2> halves;     ///< right, left
  std::array<CornerId, 2> corners;  ///< bottom, top
};

class BodyBuilder {
 public:
  BodyBuilder(const Body& body, ComponentKind kind, const BodyEnds& ends, const Transform& map)
      : body_(body), ends_(ends), map_(map * transform_of(body.placement)), builder_({body.name, kind}) {}
  Model build();

 private:
  void check_frames() const;
  void skin();
  Ring ring(const NurbsSurfaceForm& form, bool is_start, const std::array<EdgeId, 2>& halves, const std::array<CornerId, 2>& corners) const;
  void halves(const NurbsSurfaceForm& form, const std::array<EdgeId, 2>& from, const std::array<EdgeId, 2>& to, const std::array<CornerId, 2>& from_corners,
              const std::array<CornerId, 2>& to_corners, FaceRole role, const std::string& name);
  std::array<EdgeId, 2> ring_edges(const NurbsSurfaceForm& form, double v, const std::array<CornerId, 2>& corners);
  void end(const Ring& ring, const EndCap& cap, FaceRole role, const std::string& name);
  void strip(const Ring& ring, double height, FaceRole role, const std::string& name);
  void dome(const Ring& ring, double height, FaceRole role, const std::string& name);
  void lip(const Ring& ring);

  const Body& body_;
  const BodyEnds& ends_;
  Transform map_;
  ModelBuilder builder_;
  std::vector<std::vector<Point>> rows_;
};

SplineTangents spline_tangents(BodyTangents tangents) {
  switch (tangents) {
    case BodyTangents::bessel: return SplineTangents::bessel;
    case BodyTangents::akima: return SplineTangents::akima;
    case BodyTangents::monotone: return SplineTangents::monotone;
    case BodyTangents::linear: return SplineTangents::linear;
  }
  return SplineTangents::linear;
}

Point middle_of(const std::vector<Point>& points) {
  Point sum;
  for (const Point& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

double mean_radius(const std::vector<Point>& points, const Point& middle) {
  double sum = 0.0;
  for (const Point& p : points) sum += distance(p, middle);
  return sum / static_cast<double>(points.size());
}

Vec3 unit_normal(const std::vector<Point>& ring) {
  Vec3 sum;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) sum += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return normalized(sum);
}

bool is_point(const std::vector<Point>& row) {
  return std::all_of(row.begin(), row.end(), [&](const Point& p) { return p == row.front(); });
}

void BodyBuilder::check_frames() const {
  const auto refuse = [&](const std::string& problem, const Point& location) {
    throw Error(
        {.code = ErrorCode::bad_argument, .attempted = "making body '" + body_.name + "'", .problem = problem, .locations = {{map_.point(location), "frame"}}});
  };
  if (body_.frames.size() < 2) refuse("the body has " + std::to_string(body_.frames.size()) + " frames; at least 2 are needed", {});
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    const Point a = middle_of(rows_[i - 1]), b = middle_of(rows_[i]);
    const bool is_planar = body_.frames[i].shape != FrameShape::loop && body_.frames[i - 1].shape != FrameShape::loop;
    if (is_planar ? !(body_.frames[i].center.x > body_.frames[i - 1].center.x) : distance(a, b) == 0.0)
      refuse("frames '" + body_.frames[i - 1].name + "' and '" + body_.frames[i].name + "' are not in ascending order along x", body_.frames[i].center);
    if (i + 1 < rows_.size() && is_point(rows_[i])) refuse("frame '" + body_.frames[i].name + "' within the body is a point", body_.frames[i].center);
  }
}

std::array<EdgeId, 2> BodyBuilder::ring_edges(const NurbsSurfaceForm& form, double v, const std::array<CornerId, 2>& corners) {
  if (corners[0] == corners[1]) return {builder_.pole(corners[0]), builder_.pole(corners[0])};
  const CurvePtr curve = line_of_constant_v(form, v);
  return {builder_.edge(curve, {0.0, 0.5}, corners[0], corners[1]), builder_.edge(curve, {0.5, 1.0}, corners[1], corners[0])};
}

/// Adds the right and left half of a surface that is closed along u.
void BodyBuilder::halves(const NurbsSurfaceForm& form, const std::array<EdgeId, 2>& from, const std::array<EdgeId, 2>& to,
                         const std::array<CornerId, 2>& from_corners, const std::array<CornerId, 2>& to_corners, FaceRole role, const std::string& name) {
  const auto surface = std::make_shared<NurbsSurface>(form, true, false, "bicubic spline");
  const Interval v = surface->domain().v;
  const EdgeId bottom = builder_.edge(line_of_constant_u(form, 0.0), v, from_corners[0], to_corners[0], "bottom");
  const EdgeId top = builder_.edge(line_of_constant_u(form, 0.5), v, from_corners[1], to_corners[1], "top");
  builder_.patch(surface, {{0.0, 0.5}, v}, {from[0], top, to[0], bottom}, role, name);
  builder_.patch(surface, {{0.5, 1.0}, v}, {from[1], bottom, to[1], top}, role, name);
}

Ring BodyBuilder::ring(const NurbsSurfaceForm& form, bool is_start, const std::array<EdgeId, 2>& edges, const std::array<CornerId, 2>& corners) const {
  Ring ring{{}, {}, edges, corners};
  for (std::size_t i = 0; i < form.n_u; ++i) {
    const Point& p = form.poles[i * form.n_v + (is_start ? 0 : form.n_v - 1)];
    ring.poles.push_back(p);
    ring.outwards.push_back(p - form.poles[i * form.n_v + (is_start ? 1 : form.n_v - 2)]);
  }
  return ring;
}

SplineOptions around_body() {
  SplineOptions u{.tangents = SplineTangents::periodic, .at = {}};
  for (std::size_t i = 0; i <= 2 * k_half_points; ++i) u.at.push_back(static_cast<double>(i) / static_cast<double>(2 * k_half_points));
  return u;
}

void BodyBuilder::skin() {
  const std::size_t n = rows_.size();
  const std::size_t step = body_.tangents == BodyTangents::linear ? 1 : n - 1;  // frame intervals per surface
  std::array<EdgeId, 2> edges{};
  std::array<CornerId, 2> corners{};
  NurbsSurfaceForm first, last;
  Ring front, back;
  for (std::size_t from = 0; from + 1 < n; from += step) {
    PointGrid grid{2 * k_half_points + 1, step + 1, {}};
    for (std::size_t i = 0; i < grid.n_u; ++i)
      for (std::size_t j = from; j <= from + step; ++j) grid.points.push_back(rows_[j][i]);
    const SplineTangents along = step == 1 ? SplineTangents::linear : spline_tangents(body_.tangents);
    const NurbsSurfaceForm form = spline_surface_form(grid, around_body(), {.tangents = along});
    const auto corners_of = [&](std::size_t row) {
      const CornerId bottom = builder_.corner(rows_[row].front());
      return std::array<CornerId, 2>{bottom, is_point(rows_[row]) ? bottom : builder_.corner(rows_[row][k_half_points])};
    };
    if (from == 0) {
      corners = corners_of(0);
      edges = ring_edges(form, form.knots_v.front(), corners);
      front = ring(form, true, edges, corners);
    }
    const std::array<CornerId, 2> next_corners = corners_of(from + step);
    const std::array<EdgeId, 2> next = ring_edges(form, form.knots_v.back(), next_corners);
    halves(form, edges, next, corners, next_corners, FaceRole::skin, body_.name);
    edges = next;
    corners = next_corners;
    back = ring(form, false, edges, corners);
  }
  if (!is_point(rows_.front())) {
    if (body_.lip) lip(front);
    else end(front, body_.nose, FaceRole::nose, ends_.nose);
  }
  if (!is_point(rows_.back())) end(back, body_.tail, ends_.tail.empty() ? FaceRole::tail : FaceRole::nozzle, ends_.tail);
}

void BodyBuilder::end(const Ring& ring, const EndCap& cap, FaceRole role, const std::string& name) {
  const std::string& patch = name.empty() ? body_.name : name;
  if (cap.height > 0.0 && cap.shape == CapShape::strip) strip(ring, cap.height, role, patch);
  else if (cap.height > 0.0) dome(ring, cap.height, role, patch);
  else builder_.plane({ring.halves[0], ring.halves[1]}, role, patch);
}

/// Closes a ring by half ellipses from the right to the left half, at every height of the ring. They are rational quadratics with the poles side, side + bulge,
/// crest, side + bulge, side. The bulge points straight ahead; it is half the distance of both sides times the height. Bottom and top are poles of the surface.
void BodyBuilder::strip(const Ring& ring, double height, FaceRole role, const std::string& name) {
  const NurbsCurveForm<Point> around_body = *builder_.model().edges[ring.halves[0]].curve->exact_nurbs();
  const NurbsCurveForm<Point> right = restricted(around_body, {0.0, 0.5}), left = reversed(restricted(around_body, {0.5, 1.0}));
  Vec3 ahead = unit_normal(ring.poles), mean;
  for (const Vec3& v : ring.outwards) mean += v;
  if (dot(ahead, mean) < 0.0) ahead = -ahead;
  NurbsSurfaceForm form{3, 2, right.knots, {0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0}, right.poles.size(), 5, {}, {}};
  for (std::size_t i = 0; i < form.n_u; ++i) {
    const Point &a = right.poles[i], &b = left.poles[i];
    const Vec3 bulge = 0.5 * height * distance(a, b) * ahead;
    form.poles.insert(form.poles.end(), {a, a + bulge, 0.5 * (a + b) + bulge, b + bulge, b});
    form.weights.insert(form.weights.end(), {1.0, std::numbers::sqrt2 / 2.0, 1.0, std::numbers::sqrt2 / 2.0, 1.0});
  }
  const EdgeId bottom = builder_.pole(ring.corners[0]), top = builder_.pole(ring.corners[1]);
  builder_.patch(std::make_shared<NurbsSurface>(form), {{0.0, 0.5}, {0.0, 1.0}}, {ring.halves[0], top, ring.halves[1], bottom}, role, name);
}

/// Closes a ring by quarter ellipses from the ring to a crown point. They are rational quadratics with the poles base, base + slope of the body, crown. All
/// middle poles lie in the plane of the crown, so the crown is smooth. They lie along the body's own slope, so the base is also smooth. If that would pinch the
/// dome, they are straight ahead instead.
void BodyBuilder::dome(const Ring& ring, double height, FaceRole role, const std::string& name) {
  const Point middle = middle_of(ring.poles);
  Vec3 ahead = unit_normal(ring.poles);
  Vec3 mean;
  for (const Vec3& v : ring.outwards) mean += v;
  if (dot(ahead, mean) < 0.0) ahead = -ahead;
  const double radius = mean_radius(ring.poles, middle), depth = height * radius;
  std::vector<Point> shoulder;
  for (std::size_t i = 0; i < ring.poles.size(); ++i) {
    const double rise = dot(ring.outwards[i], ahead);
    const Vec3 slope = rise > 0.0 ? ring.outwards[i] / rise : Vec3{};
    shoulder.push_back(ring.poles[i] + depth * (rise > 0.0 ? slope : ahead));
  }
  const auto is_pinched = [&] {
    const Point crown = middle_of(shoulder);
    for (std::size_t i = 0; i < shoulder.size(); ++i)
      if (dot(shoulder[i] - crown, ring.poles[i] - middle) < k_min_crown * norm2(ring.poles[i] - middle)) return true;
    return false;
  };
  if (is_pinched())
    for (std::size_t i = 0; i < shoulder.size(); ++i) shoulder[i] = ring.poles[i] + depth * ahead;
  const Point crown = middle_of(shoulder);
  NurbsSurfaceForm form;
  form.degree_u = 3;
  form.degree_v = 2;
  form.n_u = ring.poles.size();
  form.n_v = 3;
  form.knots_u = builder_.model().edges[ring.halves[0]].curve->exact_nurbs()->knots;
  form.knots_v = {0.0, 0.0, 0.0, 1.0, 1.0, 1.0};
  for (std::size_t i = 0; i < form.n_u; ++i) {
    form.poles.insert(form.poles.end(), {ring.poles[i], shoulder[i], crown});
    form.weights.insert(form.weights.end(), {1.0, std::numbers::sqrt2 / 2.0, 1.0});
  }
  const CornerId top = builder_.corner(crown);
  halves(form, ring.halves, {builder_.pole(top), builder_.pole(top)}, ring.corners, {top, top}, role, name);
}

/// Builds the surface from the front frame around the lip and back to a flat fan face. The surface leaves the frame along the body's own slope, so the lip is
/// round.
void BodyBuilder::lip(const Ring& ring) {
  const InletLip& lip = *body_.lip;
  const Point middle = middle_of(ring.poles);
  const double radius = mean_radius(ring.poles, middle);
  const Vec3 inwards = map_.vector({1.0, 0.0, 0.0});
  const double depth = lip.axial_offset * radius, narrowing = lip.radial_offset * radius;
  if (!(lip.axial_offset > 0.0 && lip.radial_offset < 1.0))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "making body '" + body_.name + "'",
                 .problem = "an inlet lip needs a positive axial offset (given: " + std::to_string(lip.axial_offset) + ") and a radial offset below 1 (" +
                            std::to_string(lip.radial_offset) + ")"});
  double slope = 0.0;
  for (const Vec3& v : ring.outwards) slope += norm(v) / static_cast<double>(ring.outwards.size());
  constexpr double k_round = 0.5522847498307936;  // a cubic with this tangent length is a quarter circle
  NurbsSurfaceForm form;
  form.degree_u = form.degree_v = 3;
  form.n_u = ring.poles.size();
  form.n_v = 4;
  form.knots_u = builder_.model().edges[ring.halves[0]].curve->exact_nurbs()->knots;
  form.knots_v = {0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
  std::vector<Point> fan;
  for (std::size_t i = 0; i < form.n_u; ++i) {
    const Point& p = ring.poles[i];
    fan.push_back(middle + (1.0 - lip.radial_offset) * (p - middle) + depth * inwards);
    form.poles.insert(form.poles.end(),
                      {p, p + k_round * lip.shape * narrowing / slope * ring.outwards[i], fan.back() - k_round * lip.shape * depth * inwards, fan.back()});
  }
  const Point bottom = line_of_constant_v(form, 1.0)->point(0.0), top = line_of_constant_v(form, 1.0)->point(0.5);
  const std::array<CornerId, 2> corners{builder_.corner(bottom), builder_.corner(top)};
  const std::array<EdgeId, 2> edges = ring_edges(form, 1.0, corners);
  halves(form, ring.halves, edges, ring.corners, corners, FaceRole::inlet_lip, body_.name);
  builder_.plane({edges[0], edges[1]}, FaceRole::fan_face, ends_.nose.empty() ? body_.name : ends_.nose);
}

Model BodyBuilder::build() {
  for (const BodyFrame& frame : body_.frames) rows_.push_back(frame_row(frame, k_half_points));
  check_frames();
  for (std::vector<Point>& row : rows_)
    for (Point& p : row) p = map_.point(p);
  skin();
  return builder_.closed_solid(body_.name);
}

}  // namespace

Model make_body(const Body& body, ComponentKind kind, const BodyEnds& ends, const Transform& map) { return BodyBuilder(body, kind, ends, map).build(); }

}  // namespace sterna
