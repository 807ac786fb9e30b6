// Each face gets its triangles back with (u, v) at their corners. On seams and at poles a vertex has several (u, v); the triangle takes those nearest to each
// other.
#include "surfmesh/model/carry_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/model/projection.h"
#include "surfmesh/model/crossings.h"
#include "surfmesh/model/mesh_report.h"
#include "surfmesh/model/smooth_angle.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_carried_sine2 = 1e-16;  ///< sine squared; below this limit du and dv are parallel within double precision, and the surface has no normal
constexpr double k_least_angle = 20.0 * k_degree, k_largest_angle = 130.0 * k_degree;  ///< range of FaceMeshReport::n_outside_20_130

// ---- Locations of vertices in a face ---------------------------------------------------------------------------------------------------------

/// A location of a vertex in one face.
struct Candidate {
  Uv at;
  EdgeId edge;  ///< edge on which the location lies; invalid inside the face
};

/// The vertices on the borders of the faces of a model, sorted by face.
class BorderLocations {
 public:
  BorderLocations(const SurfaceMesh& mesh, const Model& model) : mesh_(mesh), model_(model), of_corner_(mesh.mesh.n_vertices()) {
    for (const CornerId c : mesh.corner_vertices.ids())
      if (const VertexId v = mesh.corner_vertices[c]; v.is_valid()) of_corner_[v].push_back(c);
  }

  /// Returns all locations of the vertex in the face, in the order of its borders. Locations of inner vertices come from `locations`. The result is never empty
  /// for a vertex of a triangle of the face, unless the edge of the face there was absorbed.
  std::vector<Candidate> in_face(VertexId v, FaceId f) const {
    const EdgeLocation& on_edge = mesh_.edge_locations[v];
    if (!on_edge.edge.is_valid() && of_corner_[v].empty()) return {{mesh_.locations[v].at, {}}};
    std::vector<Candidate> found;
    for (const Border& border : model_.faces[f].borders)
      for (const EdgeUse& use : border) {
        const ModelEdge& edge = model_.edges[use.edge];
        if (on_edge.edge == use.edge) found.push_back({use.parameter->point(on_edge.t), use.edge});
        if (on_edge.edge.is_valid()) continue;
        if (is_at(v, edge.start)) found.push_back({use.parameter->point(edge.range.from), use.edge});
        if (is_at(v, edge.end)) found.push_back({use.parameter->point(edge.range.to), use.edge});
      }
    if (found.empty() && mesh_.locations[v].face == f) found.push_back({mesh_.locations[v].at, {}});
    return found;
  }

  /// Returns true if the face has an edge without length there: du or dv consists of rounding errors only.
  bool is_pole(VertexId v, FaceId f) const {
    for (const Border& border : model_.faces[f].borders)
      for (const EdgeUse& use : border)
        if (const ModelEdge& edge = model_.edges[use.edge]; edge.is_degenerate() && (is_at(v, edge.start) || is_at(v, edge.end))) return true;
    return false;
  }

 private:
  bool is_at(VertexId v, CornerId c) const { return std::find(of_corner_[v].begin(), of_corner_[v].end(), c) != of_corner_[v].end(); }

  const SurfaceMesh& mesh_;
  const Model& model_;
  Column<VertexId, std::vector<CornerId>> of_corner_;
};

/// Measures distances in (u, v) as fractions of the face's extent, with periods taken into account.
class Nearness {
 public:
  Nearness(const Surface& surface, const ParameterBox& box) {
    const ParameterBox domain = surface.domain();
    u_ = {box.u.length(), surface.is_periodic_u() ? domain.u.length() : 0.0};
    v_ = {box.v.length(), surface.is_periodic_v() ? domain.v.length() : 0.0};
  }
  double distance(Uv a, Uv b) const { return along(a.u - b.u, u_) + along(a.v - b.v, v_); }

 private:
  struct Axis {
    double extent = 1.0, period = 0.0;
  };
  static double along(double step, const Axis& axis) {
    if (axis.period > 0.0) step -= std::round(step / axis.period) * axis.period;
    return axis.extent > 0.0 ? std::abs(step) / axis.extent : std::abs(step);
  }
  Axis u_, v_;
};

/// Returns the three locations, one per corner, that are nearest to each other, the first ones if several are equally near. \pre candidates[k] is not empty
std::array<std::size_t, 3> nearest_together(const std::array<std::vector<Candidate>, 3>& candidates, const Nearness& nearness) {
  std::array<std::size_t, 3> best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates[0].size(); ++i)
    for (std::size_t j = 0; j < candidates[1].size(); ++j)
      for (std::size_t k = 0; k < candidates[2].size(); ++k) {
        const Uv a = candidates[0][i].at, b = candidates[1][j].at, c = candidates[2][k].at;
        const double sum = nearness.distance(a, b) + nearness.distance(b, c) + nearness.distance(c, a);
        if (sum >= least) continue;
        least = sum;
        best = {i, j, k};
      }
  return best;
}

Vec3 normal_at(const Surface& surface, Uv at) {
  const SurfaceDerivatives d = surface.derivatives(at);
  const Vec3 normal = cross(d.du, d.dv);
  const double length2 = norm2(normal);
  return length2 > k_carried_sine2 * norm2(d.du) * norm2(d.dv) ? normal / std::sqrt(length2) : Vec3{};
}

/// The face's own triangulation before the faces were joined; its border vertices are ordered by first use in the triangles.
struct OwnFace {
  MeshedFace face;
  std::vector<EdgeId> border_edges;   ///< per border vertex: edge on which it lies; invalid if not known
  std::vector<TriangleId> triangles;  ///< numbers of the triangles in the joined mesh
};

OwnFace own_face(const SurfaceMesh& mesh, const Model& model, const BorderLocations& locations, const ParameterBox& box, FaceId f,
                 std::vector<TriangleId> triangles) {
  const ModelFace& of_model = model.faces[f];
  const Nearness nearness(*of_model.surface, box);
  OwnFace own;
  own.triangles = std::move(triangles);
  struct Local {
    VertexId vertex;
    Candidate at;
  };
  std::vector<Local> border, inner;
  std::map<std::pair<VertexId, std::size_t>, std::uint32_t> number;  // number by vertex and candidate; inner vertices are numbered after those of the border
  std::vector<std::array<std::pair<bool, std::uint32_t>, 3>> corners;
  for (const TriangleId t : own.triangles) {
    const TriangleVertices& v = mesh.mesh.triangles[t];
    std::array<std::vector<Candidate>, 3> candidates;
    for (std::size_t k = 0; k < 3; ++k) {
      candidates[k] = locations.in_face(v[k], f);
      if (candidates[k].empty()) candidates[k].push_back({SurfaceProjector(of_model.surface).nearest(mesh.mesh.points[v[k]]).at, EdgeId()});
    }
    const std::array<std::size_t, 3> chosen = nearest_together(candidates, nearness);
    std::array<std::pair<bool, std::uint32_t>, 3>& corner = corners.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_inner =
          !mesh.edge_locations[v[k]].edge.is_valid() && mesh.locations[v[k]].face == f && candidates[k].size() == 1 && !candidates[k].front().edge.is_valid();
      std::vector<Local>& list = is_inner ? inner : border;
      const auto [at, is_new] = number.try_emplace({v[k], chosen[k]}, static_cast<std::uint32_t>(list.size()));
      if (is_new) list.push_back({v[k], candidates[k][chosen[k]]});
      corner[k] = {is_inner, at->second};
    }
  }
  FaceMesh& face = own.face.mesh;
  face.n_border = static_cast<std::uint32_t>(border.size());
  for (const std::vector<Local>* list : {&border, &inner})
    for (const Local& local : *list) {
      face.points.push_back(mesh.mesh.points[local.vertex]);
      face.uv.push_back(local.at.at);
      face.normals.push_back(list == &border && locations.is_pole(local.vertex, f) ? Vec3{} : normal_at(*of_model.surface, local.at.at));
    }
  for (const Local& local : border) {
    own.face.border_ids.push_back(local.vertex);
    own.border_edges.push_back(local.at.edge);
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    TriangleVertices v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = VertexId(corners[i][k].second + (corners[i][k].first ? face.n_border : 0u));
    if (of_model.is_reversed) std::swap(v[1], v[2]);
    face.triangles.push_back(v);
    face.n_band += mesh.is_band[own.triangles[i]] != 0 ? 1 : 0;
  }
  return own;
}

// ---- Checks ----------------------------------------------------------------------------------------------------------------------------------

struct Shape {
  double least = 0.0, largest = 0.0;  ///< rad, smallest and largest angle
};
Shape shape_of(const std::array<Point, 3>& p) {
  const std::array<double, 3> angles{corner_angle(p[0], p[1], p[2]), corner_angle(p[1], p[2], p[0]), corner_angle(p[2], p[0], p[1])};
  return {*std::min_element(angles.begin(), angles.end()), *std::max_element(angles.begin(), angles.end())};
}

/// Triangles with the same fault, and the worst value.
struct Fault {
  std::int64_t n = 0;
  double worst = 0.0;  ///< worst value; larger is worse
  double value = 0.0, limit = 0.0;
  Point location{};
  void add(double badness, double of_value, double of_limit, const Point& at) {
    if (n++ > 0 && badness <= worst) return;
    worst = badness;
    value = of_value;
    limit = of_limit;
    location = at;
  }
  void add(const Fault& other) {
    if (other.n == 0) return;
    const std::int64_t sum = n + other.n;
    if (n == 0 || other.worst > worst) *this = other;
    n = sum;
  }
};

struct Faults {
  Fault folded, thin, stretched;
  void add(const Faults& other) {
    folded.add(other.folded);
    thin.add(other.thin);
    stretched.add(other.stretched);
  }
};

Faults faults_of(const OwnFace& own, const SurfaceMesh& before, const SurfaceMesh& now, const FaceMeshSummary& was, bool is_reversed) {
  Faults faults;
  const double of_reference = std::max(was.max_normal_angle, was.curvature_angle);
  const double normal_limit = std::max(was.max_normal_angle, std::min(of_reference + k_normal_slack, 0.5 * std::numbers::pi));
  const double allowed = std::cos(normal_limit);
  for (std::size_t i = 0; i < own.triangles.size(); ++i) {
    const TriangleId t = own.triangles[i];
    const auto p = corners(now.mesh, t), q = corners(before.mesh, t);
    const Point middle = (p[0] + p[1] + p[2]) / 3.0;
    const Vec3 normal = (is_reversed ? -1.0 : 1.0) * cross(p[1] - p[0], p[2] - p[0]);
    const double length = norm(normal);
    double cosine = length > 0.0 ? 1.0 : -1.0;
    for (const VertexId v : own.face.mesh.triangles[i])
      if (const Vec3& n = own.face.mesh.normals[v.index()]; length > 0.0 && norm2(n) > 0.0) cosine = std::min(cosine, dot(normal, n) / length);
    if (!(cosine >= allowed)) faults.folded.add(-cosine, std::acos(std::clamp(cosine, -1.0, 1.0)), normal_limit, middle);
    const double limit = k_kept_angle * std::min(shape_of(q).least, k_good_angle), least = shape_of(p).least;
    if (!(least >= limit)) faults.thin.add(limit - least, least, limit, middle);
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = distance(q[k], q[(k + 1) % 3]), b = distance(p[k], p[(k + 1) % 3]);
      const double stretch = a > 0.0 && b > 0.0 ? std::max(a / b, b / a) : std::numeric_limits<double>::infinity();
      if (!(stretch <= k_edge_stretch)) faults.stretched.add(stretch, b / a, k_edge_stretch, 0.5 * (p[k] + p[(k + 1) % 3]));
    }
  }
  return faults;
}

std::string counted(std::int64_t n, std::string_view what) { return std::to_string(n) + " " + std::string(what) + (n == 1 ? "" : "s"); }

/// Returns an empty string if there is no fault.
std::string text_of(const Faults& faults, Point& location) {
  const auto number = [](double value) { return number_text(value, 3); };
  if (const Fault& f = faults.folded; f.n > 0) {
    location = f.location;
    return counted(f.n, "triangle") + " would deviate from the surface normals by up to " + number(f.value / k_degree) + " degrees; the limit is " +
           number(f.limit / k_degree) + " degrees";
  }
  if (const Fault& f = faults.thin; f.n > 0) {
    location = f.location;
    return counted(f.n, "triangle") + " would be too thin, the worst with an angle of " + number(f.value / k_degree) + " degrees; the limit is " +
           number(f.limit / k_degree) + " degrees";
  }
  if (const Fault& f = faults.stretched; f.n > 0) {
    location = f.location;
    return counted(f.n, "edge") + " of triangles would be too long or too short, the worst " + number(f.value) +
           " times as long as in the reference; allowed are " + number(1.0 / f.limit) + " to " + number(f.limit) + " times";
  }
  return {};
}

// ---- Report ----------------------------------------------------------------------------------------------------------------------------------

void measure_angles(const OwnFace& own, const SurfaceMesh& now, FaceMesh& face) {
  FaceMeshReport& report = face.report;
  report.min_angle = std::numbers::pi;
  for (const TriangleId t : own.triangles) {
    if (now.is_band[t] != 0) continue;
    const auto p = corners(now.mesh, t);
    const Shape shape = shape_of(p);
    if (shape.least < report.min_angle) {
      report.min_angle = shape.least;
      report.worst_location = (p[0] + p[1] + p[2]) / 3.0;
    }
    report.max_angle = std::max(report.max_angle, shape.largest);
    if (shape.least < k_least_angle || shape.largest > k_largest_angle) ++report.n_outside_20_130;
  }
}

/// Returns the new location of an absorbed part. The part moves like the nearest vertex.
Point moved_location(const Point& location, const SurfaceMesh& before, const Column<VertexId, Point>& points) {
  double nearest = std::numeric_limits<double>::infinity();
  VertexId of_nearest;
  for (const VertexId v : points.ids())
    if (const double off = distance(before.mesh.points[v], location); off < nearest) {
      nearest = off;
      of_nearest = v;
    }
  return of_nearest.is_valid() ? location + (points[of_nearest] - before.mesh.points[of_nearest]) : location;
}

}  // namespace

Column<VertexId, Point> carried_points(const StructuredMesh& from, const Model& model, const ModelStructure& now, const RunContext& context) {
  const SurfaceMesh& mesh = from.mesh;
  Column<VertexId, Point> points(mesh.mesh.n_vertices());
  Column<VertexId, CornerId> corner(mesh.mesh.n_vertices());
  for (const CornerId c : mesh.corner_vertices.ids())  // if absorbed edges merged several corners, the first represents all
    if (const VertexId v = mesh.corner_vertices[c]; v.is_valid() && !corner[v].is_valid()) corner[v] = c;
  parallel_for(context, points.size(), [&](std::size_t i) {
    const VertexId v(static_cast<std::uint64_t>(i));
    if (corner[v].is_valid()) points[v] = model.corners[corner[v]].point;
    else if (const EdgeLocation& location = mesh.edge_locations[v]; location.edge.is_valid())
      points[v] = model.edges[location.edge].curve->point(carried(location.t, from.structure.edges[location.edge].range, now.edges[location.edge].range));
    else if (const VertexLocation& at = mesh.locations[v]; true)
      points[v] = model.faces[at.face].surface->point(carried(at.at, from.structure.faces[at.face].box, now.faces[at.face].box));
  });
  return points;
}

CarriedMesh carry_mesh(const StructuredMesh& from, const Model& model, const ModelStructure& now, Column<VertexId, Point> points,
                       const SurfaceMeshOptions& options, const RunContext& context) {
  const SurfaceMesh& before = from.mesh;
  const auto refuse = [](std::string objection, const Point& location) { return CarriedMesh{{}, std::move(objection), location}; };
  SurfaceMesh mesh = before;
  mesh.report = {};
  mesh.report.n_free_edges = before.report.n_free_edges;
  mesh.report.bands = before.report.bands;
  mesh.report.absorbed = before.report.absorbed;
  for (AbsorbedPart& part : mesh.report.absorbed) part.location = moved_location(part.location, before, points);
  mesh.mesh.points = std::move(points);
  for (const VertexId v : mesh.locations.ids()) {
    if (VertexLocation& location = mesh.locations[v]; location.face.is_valid())
      location.at = carried(location.at, from.structure.faces[location.face].box, now.faces[location.face].box);
    if (EdgeLocation& location = mesh.edge_locations[v]; location.edge.is_valid())
      location.t = carried(location.t, from.structure.edges[location.edge].range, now.edges[location.edge].range);
  }

  Column<FaceId, std::vector<TriangleId>> triangles(model.faces.size());
  for (const TriangleId t : mesh.triangle_face.ids()) triangles[mesh.triangle_face[t]].push_back(t);
  const BorderLocations locations(mesh, model);
  Column<FaceId, MeshedFace> faces(model.faces.size());
  Column<FaceId, Faults> of_face(model.faces.size());
  parallel_for(
      context, faces.size(),
      [&](std::size_t i) {
        const FaceId f(static_cast<std::uint64_t>(i));
        const FaceMeshSummary& was = before.report.faces[i];
        OwnFace own = own_face(mesh, model, locations, now.faces[f].box, f, std::move(triangles[f]));
        of_face[f] = faults_of(own, before, mesh, was, model.faces[f].is_reversed);
        if (!own.triangles.empty()) measure_angles(own, mesh, own.face.mesh);
        own.face.summary.face = f;
        own.face.summary.name = was.name;
        own.face.summary.curvature_angle = was.curvature_angle;
        measure_border(model, own.border_edges, own.face);
        measure_face(own.face);
        faces[f] = std::move(own.face);
      },
      1);
  Faults faults;
  for (const Faults& of_one : of_face) faults.add(of_one);
  Point location;
  if (std::string problem = text_of(faults, location); !problem.empty()) return refuse(std::move(problem), location);
  if (options.crossings != "ignore")
    if (const MeshCrossings crossings = find_mesh_crossings(model, mesh, context); crossings.total > 0) {
      const auto p = corners(mesh.mesh, crossings.pairs.front()[0]);
      return refuse(counted(crossings.total, "pair") + " of triangles would cross", (p[0] + p[1] + p[2]) / 3.0);
    }
  summarise_faces(faces, mesh.report);
  measure_triangles(mesh);
  const SmoothAngle smooth = measure_smooth_angle(model, faces, context);
  mesh.report.max_smooth_angle = smooth.angle;
  mesh.report.smooth_angle_location = smooth.location;
  return {std::move(mesh), {}, {}};
}

}  // namespace sterna::surfmesh
