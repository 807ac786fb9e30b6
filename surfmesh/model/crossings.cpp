#include "surfmesh/model/crossings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"

namespace sterna::surfmesh {
namespace {

/// Largest number of triangles in the drawing of an error.
constexpr std::size_t k_drawn_triangles = 50'000;
/// Crossings less deep than this fraction of a triangle's longest edge can come from coarse facets: facets that span 12 to 30 degrees deviate from their
/// surface by a fiftieth to a fifteenth of their edge.
constexpr double k_shallow = 0.1;
/// Parts nearer than this fraction of the longest edge touch. Refinement does not change that.
constexpr double k_touching = 1e-9;

/// Rad: triangles that deviate by more than this from the normals of their surface lie on a surface that turns over between their corners.
constexpr double k_folded = 0.5 * std::numbers::pi;

using Triangle = std::array<Point, 3>;

/// Groups of faces: the faces of a solid, or faces without a solid that share edges.
struct Parts {
  Column<FaceId, std::uint32_t> of_face;
  std::vector<bool> is_closed;
};

Parts parts_of(const Model& model) {
  Column<FaceId, FaceId> stands_for(model.faces.size());
  for (const FaceId f : model.faces.ids()) stands_for[f] = f;
  const auto find = [&](FaceId f) {
    while (stands_for[f] != f) f = stands_for[f] = stands_for[stands_for[f]];
    return f;
  };
  const auto join = [&](FaceId a, FaceId b) {
    const FaceId one = find(a), two = find(b);
    stands_for[std::max(one, two)] = std::min(one, two);
  };
  for (const ModelSolid& solid : model.solids)
    for (const FaceId f : solid.faces) join(solid.faces.front(), f);
  Column<FaceId, std::uint8_t> is_in_solid(model.faces.size(), 0);
  for (const ModelSolid& solid : model.solids)
    for (const FaceId f : solid.faces) is_in_solid[f] = 1;
  for (const auto& uses : uses_of_edges(model))
    for (const EdgeUseLocation& use : uses)
      if (is_in_solid[use.face] == 0 && is_in_solid[uses.front().face] == 0) join(uses.front().face, use.face);
  Parts parts{Column<FaceId, std::uint32_t>(model.faces.size(), 0), {}};
  for (const FaceId f : model.faces.ids()) {
    if (find(f) == f) {
      parts.of_face[f] = static_cast<std::uint32_t>(parts.is_closed.size());
      parts.is_closed.push_back(true);
    }
    parts.of_face[f] = parts.of_face[find(f)];
  }
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
  for (const EdgeId e : free_edges(model)) parts.is_closed[parts.of_face[uses[e].front().face]] = false;
  return parts;
}

double longest_edge(const Triangle& p) { return std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])}); }

/// Returns the distance by which `a` passes through the plane of `b`: the smaller of its distances on the two sides.
double depth_through(const Triangle& a, const Triangle& b) {
  const Vec3 area = cross(b[1] - b[0], b[2] - b[0]);
  if (norm2(area) == 0.0) return 0.0;
  const Vec3 normal = normalized(area);
  double above = 0.0, below = 0.0;
  for (const Point& p : a) {
    const double off = dot(p - b[0], normal);
    above = std::max(above, off);
    below = std::max(below, -off);
  }
  return std::min(above, below);
}

bool is_shallow(const Triangle& a, const Triangle& b) {
  const double length = std::max(longest_edge(a), longest_edge(b)), depth = std::min(depth_through(a, b), depth_through(b, a));
  return depth > k_touching * length && depth < k_shallow * length;
}

/// Returns a location on a surface near `target`, starting from an initial guess. Uses Newton's method in the tangent plane; the trimming of the face is
/// ignored.
Point nearest_on(const Surface& surface, const Point& target, Uv& at) {
  constexpr int k_steps = 6;
  constexpr double k_least_sine2 = 1e-16;
  SurfaceDerivatives d = surface.derivatives(at);
  for (int step = 0; step < k_steps; ++step) {
    const Vec3 off = target - d.point;
    const double e = norm2(d.du), f = dot(d.du, d.dv), g = norm2(d.dv), area2 = e * g - f * f;
    if (!(area2 > k_least_sine2 * e * g)) break;
    const double along_u = dot(d.du, off), along_v = dot(d.dv, off);
    const Uv moved = at + Uv{(g * along_u - f * along_v) / area2, (e * along_v - f * along_u) / area2};
    const SurfaceDerivatives there = surface.derivatives(moved);
    if (!(distance(there.point, target) < distance(d.point, target))) break;
    at = moved;
    d = there;
  }
  return d.point;
}

/// Returns the gap between the surfaces of two triangles near these triangles; zero if the surfaces meet. Computed by alternating projection.
double gap_between(const Model& model, const SurfaceMesh& mesh, TriangleId a, TriangleId b, double depth) {
  constexpr int k_turns = 40;
  // Relative to the depth of the crossing: smaller gaps count as zero, because the alternating projection has not converged after k_turns.
  constexpr double k_apart = 0.01;
  const auto guess = [&](TriangleId t) -> std::optional<Uv> {
    for (const VertexId v : mesh.mesh.triangles[t])
      if (mesh.locations[v].face == mesh.triangle_face[t]) return mesh.locations[v].at;
    return std::nullopt;
  };
  std::optional<Uv> at_a = guess(a), at_b = guess(b);
  if (!at_a || !at_b) return 0.0;
  const Triangle p = corners(mesh.mesh, a);
  Point on_b = (p[0] + p[1] + p[2]) / 3.0;
  double gap = 0.0;
  for (int turn = 0; turn < k_turns; ++turn) {
    const Point on_a = nearest_on(*model.faces[mesh.triangle_face[a]].surface, on_b, *at_a);
    on_b = nearest_on(*model.faces[mesh.triangle_face[b]].surface, on_a, *at_b);
    gap = distance(on_a, on_b);
    if (gap <= k_apart * depth) return 0.0;
  }
  return gap;
}

/// Returns the factor by which the edges of two crossing triangles should be shortened. 1: smaller triangles would cross as well. The distance of facets from
/// their surface falls with the square of their length.
double refining_factor(const Model& model, const SurfaceMesh& mesh, TriangleId a, TriangleId b, bool is_one_part) {
  constexpr double k_most = 0.5, k_least = 0.05;
  constexpr double k_safety = 0.7;
  const Triangle p = corners(mesh.mesh, a), q = corners(mesh.mesh, b);
  if (is_shallow(p, q)) {
    const double depth = std::min(depth_through(p, q), depth_through(q, p));
    if (const double gap = gap_between(model, mesh, a, b, depth); gap > 0.0) return std::clamp(k_safety * std::sqrt(gap / (gap + depth)), k_least, k_most);
  }
  return is_one_part ? k_most : 1.0;
}

/// Returns a point on both triangles within double precision, at the intersection of an edge of one triangle with the other triangle.
Point crossing_location(const Triangle& a, const Triangle& b) {
  Vec3 sum;
  double n = 0.0;
  const auto add = [&](const Triangle& edges, const Triangle& plane) {
    const Vec3 normal = cross(plane[1] - plane[0], plane[2] - plane[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &p = edges[k], &q = edges[(k + 1) % 3];
      const double at_p = dot(p - plane[0], normal), at_q = dot(q - plane[0], normal);
      if (at_p == at_q || (at_p < 0.0) == (at_q < 0.0)) continue;
      const Point x = p + at_p / (at_p - at_q) * (q - p);
      bool is_inside = true;
      for (std::size_t i = 0; i < 3 && is_inside; ++i) is_inside = dot(cross(plane[(i + 1) % 3] - plane[i], x - plane[i]), normal) >= 0.0;
      if (!is_inside) continue;
      sum += x;
      n += 1.0;
    }
  };
  add(a, b);
  add(b, a);
  if (n > 0.0) return sum / n;
  const Triangle& smaller = longest_edge(a) < longest_edge(b) ? a : b;
  return (smaller[0] + smaller[1] + smaller[2]) / 3.0;
}

std::string name_of(const Model& model, FaceId f) {
  std::string text = "\"" + model.faces[f].name + "\" (face " + std::to_string(f.value()) + ")";
  for (const ModelSolid& solid : model.solids)
    if (std::find(solid.faces.begin(), solid.faces.end(), f) != solid.faces.end() && solid.name != model.faces[f].name) text += " of \"" + solid.name + "\"";
  return text;
}

TroubleGeometry draw(const SurfaceMesh& mesh, const MeshCrossings& crossings) {
  std::vector<TriangleId> triangles;
  for (const auto& pair : crossings.pairs) {
    triangles.insert(triangles.end(), pair.begin(), pair.end());
    if (triangles.size() >= 2 * k_drawn_triangles) break;
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  if (triangles.size() > k_drawn_triangles) triangles.resize(k_drawn_triangles);
  TroubleGeometry drawn;
  for (const TriangleId t : triangles) {
    const auto n = static_cast<std::uint32_t>(drawn.points.size());
    for (const Point& p : corners(mesh.mesh, t)) drawn.points.push_back(p);
    drawn.triangles.push_back({n, n + 1, n + 2});
  }
  return drawn;
}

}  // namespace

MeshCrossings find_mesh_crossings(const Model& model, const SurfaceMesh& mesh, const RunContext& context) {
  const CrossingPairs found = find_crossings(mesh.mesh, context, k_most_pairs);
  MeshCrossings result{{}, found.total, {}};
  if (found.pairs.empty()) return result;
  const Parts parts = parts_of(model);
  for (const auto& pair : found.pairs) {
    const TriangleId a(pair[0]), b(pair[1]);
    result.pairs.push_back({a, b});
    const bool is_same_part = parts.of_face[mesh.triangle_face[a]] == parts.of_face[mesh.triangle_face[b]];
    const double factor = refining_factor(model, mesh, a, b, is_same_part);
    if (factor == 1.0) continue;
    result.refinable.push_back({a, factor});
    result.refinable.push_back({b, factor});
  }
  // Only the smallest factor of each triangle is kept.
  std::sort(result.refinable.begin(), result.refinable.end(),
            [](const RefinableTriangle& a, const RefinableTriangle& b) { return std::pair(a.triangle, a.factor) < std::pair(b.triangle, b.factor); });
  result.refinable.erase(std::unique(result.refinable.begin(), result.refinable.end(),
                                     [](const RefinableTriangle& a, const RefinableTriangle& b) { return a.triangle == b.triangle; }),
                         result.refinable.end());
  return result;
}

std::vector<CrossingFaces> crossing_faces(const Model& model, const SurfaceMesh& mesh, const MeshCrossings& crossings) {
  const Parts parts = parts_of(model);
  std::map<std::pair<FaceId, FaceId>, CrossingFaces> found;
  for (const auto& pair : crossings.pairs) {
    const auto [first, second] = std::minmax(mesh.triangle_face[pair[0]], mesh.triangle_face[pair[1]]);
    const auto [at, is_new] = found.try_emplace({first, second});
    ++at->second.n_pairs;
    if (!is_new) continue;
    at->second.first = first;
    at->second.second = second;
    at->second.is_one_part = parts.of_face[first] == parts.of_face[second];
    at->second.is_closed = parts.is_closed[parts.of_face[first]] && parts.is_closed[parts.of_face[second]];
    at->second.location = crossing_location(corners(mesh.mesh, pair[0]), corners(mesh.mesh, pair[1]));
  }
  std::vector<CrossingFaces> result;
  for (const auto& [key, entry] : found) result.push_back(entry);
  std::stable_sort(result.begin(), result.end(), [](const CrossingFaces& a, const CrossingFaces& b) { return a.n_pairs > b.n_pairs; });
  return result;
}

ErrorInfo crossing_error(const Model& model, const SurfaceMesh& mesh, const MeshCrossings& crossings, const std::vector<CrossingFaces>& faces) {
  ErrorInfo info{.code = ErrorCode::self_intersection, .attempted = "meshing the model's surface"};
  const auto count = [&](auto&& predicate) { return std::count_if(faces.begin(), faces.end(), predicate); };
  const auto n_own = count([](const CrossingFaces& c) { return c.is_one_part; });
  const auto n_closed = count([](const CrossingFaces& c) { return !c.is_one_part && c.is_closed; });
  const auto n_open = static_cast<std::ptrdiff_t>(faces.size()) - n_own - n_closed;
  info.problem = std::to_string(crossings.total) + " pairs of triangles cross or touch, on " + std::to_string(faces.size()) + " pairs of faces (" +
                 std::to_string(n_own) + " within one part, " + std::to_string(n_closed + n_open) + " between parts that overlap or touch)";
  info.n_locations = static_cast<std::int64_t>(faces.size());
  for (std::size_t i = 0; i < std::min(k_max_locations, faces.size()); ++i) {
    const CrossingFaces& c = faces[i];
    const auto folds = [&](FaceId f) { return mesh.report.faces.empty() ? false : mesh.report.faces[f.index()].max_normal_angle > k_folded; };
    std::string what = c.first == c.second ? name_of(model, c.first) + " and itself" : name_of(model, c.first) + " and " + name_of(model, c.second);
    what += ": " + std::to_string(c.n_pairs) + " pairs";
    for (const FaceId f : {c.first, c.second}) {
      if (!c.is_one_part || !folds(f) || (f == c.second && c.first == c.second)) continue;
      what += "; face " + std::to_string(f.value()) + " folds or has no normal at " + format_point(mesh.report.faces[f.index()].normal_location);
    }
    info.locations.push_back({c.location, what});
  }
  const auto advise = [&](const std::string& text) { info.hint += (info.hint.empty() ? "" : "; ") + text; };
  if (n_closed > 0) advise("unite the parts first: union{ ... } or sterna union model.step -o united.step");
  if (n_open > 0) advise("an open part cannot be united: close the part (cap = true on reading), or leave it out");
  if (n_own > 0)
    advise(
        "repair the faces that cross within a part in CAD (a folded surface cannot be meshed reliably), or, where faces are only close to each other, give "
        "them "
        "a smaller max_edge by name (patches)");
  info.geometry = draw(mesh, crossings);
  return info;
}

}  // namespace sterna::surfmesh
