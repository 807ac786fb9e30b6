#include "surfmesh/model/mesh_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geom/math/measures.h"
#include "surfmesh/model/band_runs.h"
#include "surfmesh/model/own_seam.h"

namespace sterna::surfmesh {
namespace {

/// Each use contributes its start and its cuts; its end is the start of the next use. Absorbed edges contribute nothing. A pole contributes its corner at its
/// start and, as the start of the next use, at its end.
LabelledBorder border_of(const Model& model, FaceId f, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                         const FaceOutline& outline) {
  LabelledBorder result;
  for (const auto& uses : outline.borders) {
    std::vector<BorderPoint> loop;
    Uv end;
    for (const OutlineUse& entry : uses) {
      const EdgeUse& use = model.faces[f].borders[entry.location.border][entry.location.location];
      const ModelEdge& edge = model.edges[use.edge];
      const Interval range = edge.range;
      end = use.parameter->point(use.is_reversed ? range.from : range.to) + entry.shift;  // also set for absorbed edges, because the last one may close a ring
      if (topology.is_point[use.edge] != 0 && !edge.is_degenerate()) continue;
      const CornerId corner = topology.corner[use.is_reversed ? edge.end : edge.start];
      loop.push_back({use.parameter->point(use.is_reversed ? range.to : range.from) + entry.shift, model.corners[corner].point});
      result.ids.push_back(numbers.of_corner[corner]);
      result.edges.push_back(use.edge);
      const EdgeCut& cut = cuts[use.edge];
      const SameEdge& same = topology.same_as[use.edge];
      for (std::size_t k = 0; k < cut.t.size(); ++k) {
        const std::size_t i = use.is_reversed ? cut.t.size() - 1 - k : k;
        loop.push_back({use.parameter->point(cut.t[i]) + entry.shift, cut.points[i]});
        result.ids.push_back(VertexId(numbers.first_of_edge[same.edge] + static_cast<std::uint32_t>(same.is_reversed ? cut.t.size() - 1 - i : i)));
        result.edges.push_back(use.edge);
      }
    }
    if (loop.empty()) continue;
    result.border.loops.push_back(std::move(loop));
    result.loop_ends.push_back(end);
  }
  return result;
}

/// Returns the model's tolerance for the distance between an edge's vertices and its faces.
double tolerance_of(const Model& model, FaceId f, EdgeId e) {
  const ModelEdge& edge = model.edges[e];
  // Some files have tolerances of zero. Deviations within double precision at that size are not reported.
  constexpr double k_rounding = 1e-12;
  double extent = 0.0;
  for (const Point& p : {model.corners[edge.start].point, model.corners[edge.end].point,
                         edge.is_degenerate() ? Point{} : edge.curve->point(0.5 * (edge.range.from + edge.range.to))})
    extent = std::max(extent, norm(p - Point{}));
  return std::max({edge.tolerance, model.corners[edge.start].tolerance, model.corners[edge.end].tolerance, model.faces[f].tolerance, k_rounding * extent});
}

/// Merges border points where a border passes a corner twice (a hole that touches the border), so that both points have the same (u, v). In files they differ
/// by rounding, and the mesher would mesh a gap of that width. If such points are consecutive, only the first one is kept. Points at poles and on seams are not
/// merged, because they are far apart in (u, v).
LabelledBorder merge_touching(const Model& model, FaceId f, const LabelledBorder& given) {
  constexpr double k_near = 1e-5;  // fraction of the border's extent in (u, v)
  const Surface& surface = *model.faces[f].surface;
  ParameterBox box{{1e300, -1e300}, {1e300, -1e300}};
  for (const auto& loop : given.border.loops)
    for (const BorderPoint& p : loop) {
      box.u = {std::min(box.u.from, p.uv.u), std::max(box.u.to, p.uv.u)};
      box.v = {std::min(box.v.from, p.uv.v), std::max(box.v.to, p.uv.v)};
    }
  LabelledBorder result;
  result.loop_ends = given.loop_ends;
  std::map<VertexId, std::vector<Uv>> met;
  std::size_t i = 0;
  for (const auto& loop : given.border.loops) {
    std::vector<BorderPoint> kept;
    for (BorderPoint p : loop) {
      const EdgeId e = given.edges[i];
      const VertexId id = given.ids[i++];
      std::vector<Uv>& locations = met[id];
      const auto is_same = [&](const Uv& q) {
        const Uv step = p.uv - q;
        if (std::abs(step.u) > k_near * box.u.length() || std::abs(step.v) > k_near * box.v.length()) return false;
        return distance(surface.point(p.uv), surface.point(q)) <= tolerance_of(model, f, e);
      };
      if (const auto near = std::find_if(locations.begin(), locations.end(), is_same); near != locations.end()) p.uv = *near;
      else locations.push_back(p.uv);
      if (!kept.empty() && kept.back().uv == p.uv && result.ids.back() == id) continue;
      kept.push_back(p);
      result.ids.push_back(id);
      result.edges.push_back(e);
    }
    while (kept.size() > 1 && kept.back().uv == kept.front().uv && result.ids.back() == result.ids[result.ids.size() - kept.size()]) {
      kept.pop_back();
      result.ids.pop_back();
      result.edges.pop_back();
    }
    result.border.loops.push_back(std::move(kept));
  }
  return result;
}

/// Returns the face's border, ready for meshing.
LabelledBorder labelled_border(const Model& model, FaceId f, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                               const ModelSizes& sizes, const SurfaceSizes& field) {
  LabelledBorder labelled = merge_touching(model, f, border_of(model, f, topology, cuts, numbers, sizes.outlines[f]));
  add_own_seam(
      *model.faces[f].surface, [&](Uv at, const Point& p) { return field.on_face(f, at, p); }, labelled);
  return labelled;
}

void note_dropped_rows(const BandedFace& banded, MeshedFace& face) {
  if (banded.dropped.empty()) return;
  face.notes.push_back("rows on \"" + face.summary.name + "\" are left out beside " + std::to_string(banded.dropped.size()) + " points, the first " +
                       format_point(banded.dropped.front()) + ": the rest of the face could not be meshed around these points");
}

}  // namespace

void measure_face(MeshedFace& face) {
  const FaceMesh& mesh = face.mesh;
  FaceMeshSummary& summary = face.summary;
  summary.area = summary.area_above = 0.0;
  summary.n_triangles = static_cast<std::int64_t>(mesh.triangles.size());
  summary.n_band = static_cast<std::int64_t>(mesh.n_band);
  summary.min_angle = mesh.report.min_angle;
  summary.max_angle = mesh.report.max_angle;
  summary.worst_location = mesh.report.worst_location;
  summary.n_outside_20_130 = mesh.report.n_outside_20_130;
  // Cosines are compared instead of angles, because only the largest angle is needed.
  const double allowed = std::cos(summary.curvature_angle);
  double least = 1.0;
  for (const TriangleVertices& v : mesh.triangles) {
    const Point &a = mesh.points[v[0].index()], &b = mesh.points[v[1].index()], &c = mesh.points[v[2].index()];
    const Vec3 normal = cross(b - a, c - a);
    const double length = norm(normal);
    summary.area += 0.5 * length;
    bool is_above = false;
    for (const VertexId w : v) {
      const Vec3& n = mesh.normals[w.index()];
      if (norm2(n) == 0.0 || length == 0.0) continue;
      const double cosine = dot(normal, n) / length;
      is_above = is_above || cosine < allowed;
      if (cosine >= least) continue;
      least = cosine;
      summary.normal_location = mesh.points[w.index()];
    }
    if (is_above) summary.area_above += 0.5 * length;
  }
  summary.max_normal_angle = std::acos(std::max(-1.0, least));
}

void measure_border(const Model& model, const std::vector<EdgeId>& edges, MeshedFace& face) {
  const FaceMesh& mesh = face.mesh;
  const Surface& surface = *model.faces[face.summary.face].surface;
  std::map<EdgeId, LooseEdge> loose;
  for (std::uint32_t i = 0; i < mesh.n_border; ++i) {
    const double off = distance(surface.point(mesh.uv[i]), mesh.points[i]);
    if (off > face.edge_distance) {
      face.edge_distance = off;
      face.edge_distance_location = mesh.points[i];
    }
    if (!edges[i].is_valid()) continue;
    const double tolerance = tolerance_of(model, face.summary.face, edges[i]);
    if (off <= tolerance) continue;
    LooseEdge& entry = loose[edges[i]];
    if (off > entry.distance) entry = {edges[i], face.summary.face, off, tolerance, mesh.points[i]};
  }
  for (const auto& [edge, entry] : loose) face.loose_edges.push_back(entry);
}

BorderVertices number_border(const Model& model, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts) {
  BorderVertices numbers{Column<CornerId, VertexId>(model.corners.size()), Column<EdgeId, std::uint32_t>(model.edges.size(), 0), 0, 0};
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
  Column<CornerId, std::uint8_t> is_used(model.corners.size(), 0);
  for (const EdgeId e : model.edges.ids())
    if (!uses[e].empty()) is_used[topology.corner[model.edges[e].start]] = is_used[topology.corner[model.edges[e].end]] = 1;
  for (const CornerId c : model.corners.ids())
    if (is_used[c] != 0) numbers.of_corner[c] = VertexId(numbers.n++);
  numbers.n_corners = numbers.n;
  for (const EdgeId e : model.edges.ids()) {
    numbers.first_of_edge[e] = numbers.n;
    if (topology.same_as[e].edge == e) numbers.n += static_cast<std::uint32_t>(cuts[e].t.size());
  }
  return numbers;
}

std::vector<VertexId> border_ids(const Model& model, FaceId f, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts,
                                 const BorderVertices& numbers, const FaceOutline& outline) {
  return merge_touching(model, f, border_of(model, f, topology, cuts, numbers, outline)).ids;
}

MeshedFace mesh_one_face(const Model& model, FaceId f, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                         const ModelSizes& sizes, const WingBands& bands, const SurfaceSizes& field, int max_triangles, const RunContext& context) {
  const ModelFace& face = model.faces[f];
  MeshedFace result;
  result.summary.face = f;
  result.summary.name = face.name;
  const auto fail = [&](ErrorInfo info) {
    info.attempted = "meshing face " + std::to_string(f.value()) + ", \"" + face.name + "\"";
    result.failure = std::move(info);
    return result;
  };
  if (topology.is_absorbed[f] != 0) return result;
  LabelledBorder labelled;
  FaceMeshOptions options;
  options.min_edge = 0.0;
  options.size_growth = sizes.growth;
  options.max_triangles = max_triangles;
  const Vec2 speed{sizes.faces[f].curvature->mean_speed_u(), sizes.faces[f].curvature->mean_speed_v()};
  const auto size = [&](Uv at, const Point& p) { return field.on_face(f, at, p); };
  try {
    labelled = labelled_border(model, f, topology, cuts, numbers, sizes, field);
    const BorderSegments segments = segments_of(model, topology, cuts, numbers, labelled);
    if (std::optional<BandedFace> strip = bands.strips[f] ? mesh_base(*face.surface, labelled, segments, *bands.strips[f]) : std::nullopt) {
      result.mesh = std::move(strip->mesh);
      result.bands = strip->bands;
    } else if (const std::vector<BandRun> runs = band_runs(f, labelled, segments, bands, sizes.faces[f].limits); !runs.empty()) {
      BandedFace banded = mesh_banded_face(*face.surface, labelled.border, runs, size, speed, options, context);
      result.mesh = std::move(banded.mesh);
      result.bands = banded.bands;
      note_dropped_rows(banded, result);
    } else {
      result.mesh = mesh_face(*face.surface, labelled.border, size, speed, options, context);
    }
    if (bands.strips[f] && result.mesh.n_band == 0)
      result.notes.push_back("the base of \"" + face.name + "\" near " + format_point(labelled.border.loops.front().front().point) +
                             " could not be divided into a strip of cells and is meshed like other faces");
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    return fail(error.info());
  }
  free_own_seam(labelled, result.mesh);
  result.border_ids = std::move(labelled.ids);
  result.summary.curvature_angle = sizes.faces[f].limits.angle;
  measure_border(model, labelled.edges, result);
  measure_face(result);
  return result;
}

}  // namespace sterna::surfmesh
