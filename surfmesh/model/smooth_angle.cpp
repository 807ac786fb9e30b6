// Each face measures its inner edges, and lists its border edges with the exact normals at their ends. The lists of all faces are sorted together. An edge of
// two triangles is measured as well if the normals of both faces agree there. Edges with a large turn are joined to groups, and spots are separated from the
// other groups.
#include "surfmesh/model/smooth_angle.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "geom/base/disjoint_sets.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

/// Faces that join at less than this angle have no crease. CAD systems treat faces as tangent within about one degree; fitted surfaces deviate by a few
/// degrees.
constexpr double k_tangent = 5.0 * std::numbers::pi / 180.0;

/// Edges that turn by more than this are grouped with their neighbours. From about this angle on, layers treat a smooth region as a ridge.
constexpr double k_sharp = 45.0 * std::numbers::pi / 180.0;
/// Relative to the longest edge of a group: groups that do not extend farther than this are spots. A cone of half angle a is thinner than its edges are long
/// over 1 / tan(a) edges from its point. Where the round tip of a wing of 4 % thickness ends at its trailing edge, this happens over 21 edges.
constexpr double k_spot = 25.0;
/// A triangle follows the surface if its normal is within this angle of the exact normals at two of its vertices. (The third vertex may be the point of a cone,
/// which has no normal.) Two triangles around a half circle deviate by 45 degrees, folds by 90 degrees and more.
constexpr double k_follows = 75.0 * std::numbers::pi / 180.0;

struct LocalEdge {
  std::uint32_t low, high;
  std::uint32_t triangle;  ///< number of the triangle within the face
  auto operator<=>(const LocalEdge&) const = default;
};

/// An edge with only one triangle of its face. Its vertices have their numbers across all faces.
struct BorderEdge {
  std::uint32_t low = 0, high = 0;
  FaceId face;
  std::uint32_t triangle = 0;
  std::array<Vec3, 2> exact;  ///< outward normals of the surface at low and high; zero where the surface has none
  Vec3 normal;                ///< normal of the triangle
  std::array<Point, 2> ends;  ///< points at low and high
  bool follows = true;        ///< the triangle follows the surface
  Point middle() const { return 0.5 * (ends[0] + ends[1]); }
  bool before(const BorderEdge& other) const {
    return std::array{low, high, face.value(), triangle} < std::array{other.low, other.high, other.face.value(), other.triangle};
  }
};

/// Identifies a vertex across all faces: a border vertex by its number there, an inner vertex by its number and face.
struct VertexKey {
  FaceId face;  ///< invalid for vertices on borders
  std::uint32_t vertex = 0;
  bool operator==(const VertexKey&) const = default;
  bool operator<(const VertexKey& other) const { return std::pair(face.value(), vertex) < std::pair(other.face.value(), other.vertex); }
};

/// An edge that turns by more than k_sharp.
struct SharpEdge {
  double angle = 0.0;
  std::array<VertexKey, 2> keys;
  std::array<Point, 2> ends;
  bool follow = true;  ///< both triangles follow the surface
  FaceId face;         ///< one of the adjacent faces
};

struct FaceAngles {
  SmoothAngle inner;
  std::vector<SharpEdge> sharp;
  std::vector<BorderEdge> border;
};

void keep_larger(SmoothAngle& best, double angle, const Point& location) {
  if (angle <= best.angle) return;
  best.angle = angle;
  best.location = location;
}

void keep_larger_outside_spots(SmoothAngle& best, double angle, const Point& location) {
  if (angle <= best.angle_outside_spots) return;
  best.angle_outside_spots = angle;
  best.place_outside_spots = location;
}

FaceAngles measure_face(const ModelFace& model_face, FaceId f, const MeshedFace& face) {
  const FaceMesh& mesh = face.mesh;
  FaceAngles result;
  std::vector<LocalEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k].value(), b = mesh.triangles[t][(k + 1) % 3].value();
      edges.push_back({std::min(a, b), std::max(a, b), t});
    }
  std::sort(edges.begin(), edges.end());
  const double side = model_face.is_reversed ? -1.0 : 1.0;
  const auto normal = [&](std::uint32_t t) {
    const TriangleVertices& v = mesh.triangles[t];
    const Point& a = mesh.points[v[0].index()];
    return side * cross(mesh.points[v[1].index()] - a, mesh.points[v[2].index()] - a);
  };
  const auto exact_normal = [&](std::uint32_t v) {
    const SurfaceDerivatives d = model_face.surface->derivatives(mesh.uv[v]);
    return side * cross(d.du, d.dv);
  };
  const auto follows = [&](std::uint32_t t) {
    int n = 0;
    for (const auto v : mesh.triangles[t]) n += angle_between(normal(t), exact_normal(v.value())) <= k_follows ? 1 : 0;
    return n >= 2;
  };
  const auto key = [&](std::uint32_t v) { return v < mesh.n_border ? VertexKey{{}, face.border_ids[v].value()} : VertexKey{f, v}; };
  for (std::size_t i = 0; i < edges.size();) {
    const LocalEdge& e = edges[i];
    if (i + 1 < edges.size() && edges[i + 1].low == e.low && edges[i + 1].high == e.high) {
      const std::uint32_t other = edges[i + 1].triangle;
      const double angle = angle_between(normal(e.triangle), normal(other));
      const Point &a = mesh.points[e.low], &b = mesh.points[e.high];
      keep_larger(result.inner, angle, 0.5 * (a + b));
      if (angle > k_sharp) result.sharp.push_back({angle, {key(e.low), key(e.high)}, {a, b}, follows(e.triangle) && follows(other), f});
      else keep_larger_outside_spots(result.inner, angle, 0.5 * (a + b));
      i += 2;
      continue;
    }
    ++i;
    if (e.high >= mesh.n_border) continue;  // the edge belongs to a triangle at a pole
    BorderEdge edge{.face = f,
                    .triangle = e.triangle,
                    .exact = {exact_normal(e.low), exact_normal(e.high)},
                    .normal = normal(e.triangle),
                    .ends = {mesh.points[e.low], mesh.points[e.high]},
                    .follows = follows(e.triangle)};
    edge.low = face.border_ids[e.low].value();
    edge.high = face.border_ids[e.high].value();
    if (edge.low > edge.high) {
      std::swap(edge.low, edge.high);
      std::swap(edge.exact[0], edge.exact[1]);
      std::swap(edge.ends[0], edge.ends[1]);
    }
    result.border.push_back(edge);
  }
  return result;
}

bool is_tangent(const BorderEdge& a, const BorderEdge& b) {
  for (std::size_t k = 0; k < 2; ++k)
    if (norm(a.exact[k]) > 0.0 && norm(b.exact[k]) > 0.0 && angle_between(a.exact[k], b.exact[k]) > k_tangent) return false;
  return true;
}

/// Adds groups of sharp edges that share vertices. Groups that are not spots count. If a face has more spots than one at each of its two ends, all its groups
/// count.
void add_groups(const std::vector<SharpEdge>& edges, std::size_t n_faces, SmoothAngle& best) {
  std::vector<VertexKey> keys;
  for (const SharpEdge& e : edges) keys.insert(keys.end(), e.keys.begin(), e.keys.end());
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const auto index = [&](const VertexKey& key) { return static_cast<std::uint32_t>(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin()); };
  DisjointSets connected(keys.size());
  for (const SharpEdge& e : edges) connected.join(index(e.keys[0]), index(e.keys[1]));
  struct Group {
    Box box;
    double longest = 0.0;
    bool follow = true;
    FaceId face;
    double extent() const { return norm(box.max - box.min) / longest; }  ///< extent of the group in edge lengths
  };
  std::vector<Group> groups(keys.size());
  for (const SharpEdge& e : edges) {
    Group& group = groups[connected.root(index(e.keys[0]))];
    for (const Point& p : e.ends) group.box.add(p);
    group.longest = std::max(group.longest, distance(e.ends[0], e.ends[1]));
    group.follow = group.follow && e.follow;
    group.face = e.face;
  }
  Column<FaceId, double> extents(n_faces, 0.0);
  for (const Group& group : groups)
    if (group.longest > 0.0) extents[group.face] += group.extent();
  for (const SharpEdge& e : edges) {
    const Group& group = groups[connected.root(index(e.keys[0]))];
    if (group.follow && group.extent() <= k_spot && extents[group.face] <= 2.0 * k_spot) continue;
    keep_larger_outside_spots(best, e.angle, 0.5 * (e.ends[0] + e.ends[1]));
  }
}

}  // namespace

SmoothAngle measure_smooth_angle(const Model& model, const Column<FaceId, MeshedFace>& faces, const RunContext& context) {
  Column<FaceId, FaceAngles> angles(faces.size());
  parallel_for(
      context, faces.size(),
      [&](std::size_t i) {
        const FaceId f(static_cast<std::uint64_t>(i));
        if (!faces[f].failure) angles[f] = measure_face(model.faces[f], f, faces[f]);
      },
      1);
  SmoothAngle best;
  std::vector<BorderEdge> border;
  std::vector<SharpEdge> sharp;
  for (const FaceAngles& face : angles) {
    keep_larger(best, face.inner.angle, face.inner.location);
    keep_larger_outside_spots(best, face.inner.angle_outside_spots, face.inner.place_outside_spots);
    sharp.insert(sharp.end(), face.sharp.begin(), face.sharp.end());
    border.insert(border.end(), face.border.begin(), face.border.end());
  }
  std::sort(border.begin(), border.end(), [](const BorderEdge& a, const BorderEdge& b) { return a.before(b); });
  for (std::size_t i = 0; i + 1 < border.size(); ++i) {
    const BorderEdge &a = border[i], &b = border[i + 1];
    if (a.low != b.low || a.high != b.high || !is_tangent(a, b)) continue;
    const double angle = angle_between(a.normal, b.normal);
    keep_larger(best, angle, a.middle());
    if (angle > k_sharp) sharp.push_back({angle, {VertexKey{{}, a.low}, VertexKey{{}, a.high}}, a.ends, a.follows && b.follows, a.face});
    else keep_larger_outside_spots(best, angle, a.middle());
  }
  add_groups(sharp, faces.size(), best);
  return best;
}

}  // namespace sterna::surfmesh
