#include "surfmesh/model/model_facets.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/delaunay/planar.h"
#include "surfmesh/model/face_outline.h"

namespace sterna::surfmesh {
namespace {

/// Largest number of halvings of an edge, which gives 512 pieces.
constexpr int k_most_halvings = 9;
/// Every edge is tested in at least this many pieces, because a wave may pass through the middle of its chord.
constexpr int k_first_pieces = 4;
/// Largest number of rows of a face's grid in one direction. Also the largest number of lines along which the curvature of the face is sampled.
constexpr std::size_t k_most_rows = 256;
constexpr int k_curvature_lines = 5;
/// Number of pieces of the degenerate edge at a pole.
constexpr int k_pole_pieces = 16;
/// Small entities are drawn with a tolerance of this fraction of their own size, not of the size of the model.
constexpr double k_own_tolerance = 4e-3;
constexpr double k_least_share = 1e-2;  ///< relative to the model's tolerance: smaller deviations are not visible

/// Returns the distance of a point from the chord's line.
double off_chord(const Point& a, const Point& between, const Point& b) {
  const Vec3 chord = b - a;
  const double length = norm(chord);
  return length > 0.0 ? norm(cross(between - a, chord)) / length : distance(between, a);
}

/// Cut points of an edge, both ends included.
struct EdgePoints {
  std::vector<double> t;
  std::vector<Point> points;
};

void halve_piece(const Curve& curve, double from, const Point& at_from, double to, const Point& at_to, double tolerance, int halvings, EdgePoints& edge) {
  const double middle = 0.5 * (from + to);
  const Point at_middle = curve.point(middle);
  if (halvings < k_most_halvings && off_chord(at_from, at_middle, at_to) > tolerance) {
    halve_piece(curve, from, at_from, middle, at_middle, tolerance, halvings + 1, edge);
    halve_piece(curve, middle, at_middle, to, at_to, tolerance, halvings + 1, edge);
    return;
  }
  edge.t.push_back(to);
  edge.points.push_back(at_to);
}

EdgePoints cut_edge(const ModelEdge& edge, double tolerance) {
  EdgePoints result;
  if (edge.is_degenerate()) return result;
  std::vector<Point> points;
  double length = 0.0;
  const auto at = [&](int k) { return edge.range.from + edge.range.length() * k / k_first_pieces; };
  for (int k = 0; k <= k_first_pieces; ++k) {
    points.push_back(edge.curve->point(at(k)));
    if (k > 0) length += distance(points[static_cast<std::size_t>(k - 1)], points.back());
  }
  const double allowed = std::clamp(k_own_tolerance * length, k_least_share * tolerance, tolerance);
  bool is_straight = true;
  for (int k = 1; k < k_first_pieces; ++k)
    is_straight = is_straight && off_chord(points.front(), points[static_cast<std::size_t>(k)], points.back()) <= allowed;
  result.t = {edge.range.from};
  result.points = {points.front()};
  if (is_straight && distance(points.front(), points.back()) > 0.5 * length) {
    result.t.push_back(edge.range.to);
    result.points.push_back(points.back());
    return result;
  }
  for (int k = 0; k < k_first_pieces; ++k)
    halve_piece(*edge.curve, at(k), points[static_cast<std::size_t>(k)], at(k + 1), points[static_cast<std::size_t>(k + 1)], allowed, 2, result);
  return result;
}

/// Triangles of one face, with its own points.
struct FaceFacets {
  std::vector<Point> points;
  std::vector<Uv> uv;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint8_t> edges;
  std::vector<double> curvature;
  bool is_untrimmed = false;
};

struct FacetLoop {
  std::vector<Uv> uv;
  std::vector<Point> points;
};

/// Returns the polygons of the outline if a border runs around a period, else polygons of the edge points.
std::vector<FacetLoop> loops_of(const Model& model, FaceId f, const FaceOutline& outline, const Column<EdgeId, EdgePoints>& edges) {
  const Surface& surface = *model.faces[f].surface;
  std::vector<FacetLoop> loops;
  if (!outline.winding.empty()) {
    for (const std::vector<Uv>& polygon : outline.polygons) {
      FacetLoop loop{polygon, std::vector<Point>(polygon.size())};
      surface.points(loop.uv, loop.points);
      if (polygon.size() > 2) loops.push_back(std::move(loop));
    }
    return loops;
  }
  for (const auto& uses : outline.borders) {
    FacetLoop loop;
    for (const OutlineUse& entry : uses) {
      const EdgeUse& use = model.faces[f].borders[entry.location.border][entry.location.location];
      const ModelEdge& edge = model.edges[use.edge];
      if (edge.is_degenerate()) {
        const Point pole = model.corners[edge.start].point;
        for (int k = 0; k < k_pole_pieces; ++k) {
          const double share = static_cast<double>(k) / k_pole_pieces;
          loop.uv.push_back(parameters_at(model, entry, edge.range.from + (use.is_reversed ? 1.0 - share : share) * edge.range.length()));
          loop.points.push_back(pole);
        }
        continue;
      }
      const EdgePoints& cut = edges[use.edge];
      for (std::size_t k = 0; k + 1 < cut.t.size(); ++k) {  // the end point is not added, because it is the start of the next edge
        const std::size_t i = use.is_reversed ? cut.t.size() - 1 - k : k;
        loop.uv.push_back(parameters_at(model, entry, cut.t[i]));
        loop.points.push_back(cut.points[i]);
      }
    }
    if (loop.uv.size() > 2) loops.push_back(std::move(loop));
  }
  return loops;
}

ParameterBox box_around(const std::vector<FacetLoop>& loops) {
  constexpr double k_far = 1e300;
  ParameterBox box{{k_far, -k_far}, {k_far, -k_far}};
  for (const FacetLoop& loop : loops)
    for (const Uv& at : loop.uv) {
      box.u = {std::min(box.u.from, at.u), std::max(box.u.to, at.u)};
      box.v = {std::min(box.v.from, at.v), std::max(box.v.to, at.v)};
    }
  return box;
}

/// Returns the number of pieces of equal parameter length along u (or v). It is a power of two, large enough that the chords of a line of the surface are
/// within the tolerance.
std::size_t rows_along(const Surface& surface, const ParameterBox& box, bool is_u, double tolerance) {
  const auto location = [&](double along, double across) {
    const Uv at{is_u ? along : across, is_u ? across : along};
    return Uv{box.u.from + at.u * box.u.length(), box.v.from + at.v * box.v.length()};
  };
  std::size_t n = 1;
  std::vector<Uv> at;
  std::vector<Point> points;
  for (; n < k_most_rows; n *= 2) {
    double worst = 0.0;
    for (int line = 0; line < k_curvature_lines; ++line) {
      at.clear();
      for (std::size_t k = 0; k <= 4 * n; ++k) at.push_back(location(static_cast<double>(k) / static_cast<double>(4 * n), (line + 0.5) / k_curvature_lines));
      points.resize(at.size());
      surface.points(at, points);
      for (std::size_t k = 0; k + 4 < at.size(); k += 4)
        for (std::size_t q = 1; q < 4; ++q) worst = std::max(worst, off_chord(points[k], points[k + q], points[k + 4]));
    }
    if (worst <= tolerance) break;
  }
  return n;
}

/// Returns the magnitude of the larger principal curvature, 1/m; nothing if the surface has no normal.
double curvature_at(const Surface& surface, Uv at) {
  const SurfaceDerivatives d = surface.derivatives(at);
  const double e = dot(d.du, d.du), f = dot(d.du, d.dv), g = dot(d.dv, d.dv), area2 = e * g - f * f;
  const Vec3 normal = cross(d.du, d.dv);
  const double length = norm(normal);
  if (!(area2 > 1e-24 * e * g) || !(length > 0.0)) return std::nan("");
  const double l = dot(d.duu, normal) / length, m = dot(d.duv, normal) / length, n = dot(d.dvv, normal) / length;
  const double mean = (e * n - 2.0 * f * m + g * l) / (2.0 * area2), gauss = (l * n - m * m) / area2;
  return std::abs(mean) + std::sqrt(std::max(mean * mean - gauss, 0.0));
}

bool is_in_loops(const std::vector<FacetLoop>& loops, Uv at) {
  bool inside = false;
  for (const FacetLoop& loop : loops)
    for (std::size_t i = 0; i < loop.uv.size(); ++i) {
      const Uv &a = loop.uv[i], &b = loop.uv[(i + 1) % loop.uv.size()];
      if ((a.u <= at.u) != (b.u <= at.u) && a.v + (at.u - a.u) / (b.u - a.u) * (b.v - a.v) > at.v) inside = !inside;
    }
  return inside;
}

/// Triangulates the borders and the grid in a plane in which the grid cells are squares.
void triangulate(const std::vector<FacetLoop>& loops, const ParameterBox& box, std::size_t n_u, std::size_t n_v, FaceFacets& facets,
                 const RunContext& context) {
  std::vector<delaunay::Segment> segments;
  for (const FacetLoop& loop : loops) {
    const auto first = static_cast<std::uint32_t>(facets.uv.size());
    const auto n = static_cast<std::uint32_t>(loop.uv.size());
    for (std::uint32_t k = 0; k < n; ++k) segments.push_back({first + k, first + (k + 1) % n});
    facets.uv.insert(facets.uv.end(), loop.uv.begin(), loop.uv.end());
    facets.points.insert(facets.points.end(), loop.points.begin(), loop.points.end());
  }
  for (std::size_t i = 1; i < n_u; ++i)
    for (std::size_t j = 1; j < n_v; ++j)
      facets.uv.push_back({box.u.from + box.u.length() * static_cast<double>(i) / static_cast<double>(n_u),
                           box.v.from + box.v.length() * static_cast<double>(j) / static_cast<double>(n_v)});
  // Long cells are as acceptable as square ones here. The plane is scaled so that cells are squares.
  const auto scale = [](std::size_t n, double length) { return length > 0.0 ? static_cast<double>(n) / length : 1.0; };
  const Vec2 by{scale(n_u, box.u.length()), scale(n_v, box.v.length())};
  std::vector<Vec2> plane;
  for (const Uv& at : facets.uv) plane.push_back({at.u * by.x, at.v * by.y});
  delaunay::PlanarTriangulation made;
  try {
    made = delaunay::triangulate_plane(plane, segments, delaunay::Extent::inside, context);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::self_intersection) throw;
    facets.is_untrimmed = true;
    made = delaunay::triangulate_plane(plane, {}, delaunay::Extent::hull, context);
  }
  const delaunay::Triangulation& mesh = made.mesh;
  for (const TriangleId t : mesh.cells.ids()) {
    if (mesh.cells[t].is_dead || mesh.is_ghost(t)) continue;
    const auto& v = mesh.cells[t].vertex;
    const std::array<std::uint32_t, 3> corners{v[0].value(), v[1].value(), v[2].value()};
    if (facets.is_untrimmed) {
      const Uv middle = (1.0 / 3.0) * (facets.uv[corners[0]] + facets.uv[corners[1]] + facets.uv[corners[2]]);
      if (!is_in_loops(loops, middle)) continue;
    }
    std::uint8_t edges = 0;
    for (std::uint32_t k = 0; k < 3; ++k)
      if (mesh.is_constrained(halfedge(t, k))) edges = static_cast<std::uint8_t>(edges | (1u << k));
    facets.triangles.push_back(corners);
    facets.edges.push_back(edges);
  }
  facets.points.resize(facets.uv.size());
}

FaceFacets facets_of_face(const Model& model, FaceId f, const Column<EdgeId, EdgePoints>& edges, double tolerance, const FacetOptions& options,
                          const RunContext& context) {
  FaceFacets facets;
  const ModelFace& face = model.faces[f];
  const std::vector<FacetLoop> loops = loops_of(model, f, outline_of(model, f), edges);
  if (loops.empty()) return facets;
  const ParameterBox box = box_around(loops);
  Box around;
  std::size_t n_border = 0;
  for (const FacetLoop& loop : loops) {
    n_border += loop.uv.size();
    for (const Point& p : loop.points) around.add(p);
  }
  const double allowed = std::clamp(k_own_tolerance * around.longest_side(), k_least_share * tolerance, tolerance);
  const std::size_t n_u = rows_along(*face.surface, box, true, allowed), n_v = rows_along(*face.surface, box, false, allowed);
  triangulate(loops, box, n_u, n_v, facets, context);
  face.surface->points(std::span(facets.uv).subspan(n_border), std::span(facets.points).subspan(n_border));
  std::size_t n = 0;
  for (std::size_t t = 0; t < facets.triangles.size(); ++t) {
    auto c = facets.triangles[t];
    if (facets.points[c[0]] == facets.points[c[1]] || facets.points[c[1]] == facets.points[c[2]] || facets.points[c[2]] == facets.points[c[0]]) continue;
    std::uint8_t bits = facets.edges[t];
    if (options.with_curvature) facets.curvature.push_back(curvature_at(*face.surface, (1.0 / 3.0) * (facets.uv[c[0]] + facets.uv[c[1]] + facets.uv[c[2]])));
    if (face.is_reversed) {
      std::swap(c[1], c[2]);  // edges 0-1, 1-2, 2-0 now join the vertices 2, 1, 0
      bits = static_cast<std::uint8_t>(((bits & 1) << 2) | (bits & 2) | ((bits & 4) >> 2));
    }
    facets.triangles[n] = c;
    facets.edges[n++] = bits;
  }
  facets.triangles.resize(n);
  facets.edges.resize(n);
  return facets;
}

}  // namespace

ModelFacets facets_of(const Model& model, const FacetOptions& options, const RunContext& context) {
  Box box;
  for (const ModelCorner& corner : model.corners) box.add(corner.point);
  for (const ModelEdge& edge : model.edges)
    if (!edge.is_degenerate()) box.add(edge.curve->point(0.5 * (edge.range.from + edge.range.to)));
  const double tolerance = options.tolerance * (box.empty() ? 1.0 : box.longest_side());
  Column<EdgeId, EdgePoints> edges(model.edges.size());
  parallel_for(
      context, edges.size(),
      [&](std::size_t i) {
        const ModelEdge& edge = model.edges[EdgeId(i)];
        EdgePoints& cut = edges[EdgeId(i)] = cut_edge(edge, tolerance);
        if (cut.points.empty()) return;
        // Edges that meet have bitwise the same point where they meet.
        cut.points.front() = model.corners[edge.start].point;
        cut.points.back() = model.corners[edge.end].point;
      },
      16);
  std::vector<FaceFacets> faces(model.faces.size());
  parallel_for(
      context, faces.size(), [&](std::size_t i) { faces[i] = facets_of_face(model, FaceId(i), edges, tolerance, options, context); }, 1);
  ModelFacets all;
  for (const FaceId f : model.faces.ids()) {
    const FaceFacets& face = faces[f.index()];
    const auto first = static_cast<std::uint32_t>(all.points.size());
    all.points.insert(all.points.end(), face.points.begin(), face.points.end());
    for (const auto& c : face.triangles) all.triangles.push_back({first + c[0], first + c[1], first + c[2]});
    all.face.insert(all.face.end(), face.triangles.size(), f);
    all.edges.insert(all.edges.end(), face.edges.begin(), face.edges.end());
    all.curvature.insert(all.curvature.end(), face.curvature.begin(), face.curvature.end());
    if (face.is_untrimmed) all.untrimmed.push_back(f);
  }
  return all;
}

}  // namespace sterna::surfmesh
