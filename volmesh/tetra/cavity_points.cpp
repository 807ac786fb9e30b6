// One point in each solid region of a wall.
//
// TetGen removes a cavity if it gets a point inside it. There may be several bodies, and bodies may be hollow, nested or extremely thin. Steps: Find shells,
// which are components connected across edges. For each shell, find a point behind one of its largest triangles (`point_behind`). For this, all crossings of a
// line along a coordinate axis through the triangle with the wall are computed; the point is the middle of the segment from the triangle to the next crossing.
// Count the winding number of the point about every shell on that line, with exact predicates (`windings`). The sum must be 1, otherwise the region is not
// solid. Centre the point along the axes in turn. Of the points of all triangles, use the one with the largest clearance. Points inside the same shells are in
// the same region (because shells do not intersect), so one point is kept for each set of shells.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/math/predicates.h"
#include "geom/mesh/bvh.h"
#include "geom/mesh/topology.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {
namespace {

constexpr std::size_t k_triangles_tried = 8;  ///< number of triangles that are tried for each shell, largest first
/// Weights of the point at which a triangle is pierced. They are uneven, so that lines do not hit the edges and vertices of regular meshes. If a line hits an
/// edge, the next set is used.
constexpr std::array<std::array<double, 3>, 5> k_weights = {
    {{0.43, 0.31, 0.26}, {0.2713, 0.4127, 0.316}, {0.361, 0.2117, 0.4273}, {0.5519, 0.1709, 0.2772}, {0.1373, 0.2939, 0.5688}}};

struct Crossing {
  TriangleId triangle;
  double at = 0.0;  ///< rounded coordinate along the axis; it is used only to find segments
  int sense = 0;    ///< +1 if the triangle's normal points along the axis, else -1
};

/// The shells around a point with the winding number about each, ascending. Shells with the winding number 0 are left out.
using Windings = std::vector<std::pair<std::uint32_t, int>>;

class Wall {
 public:
  Wall(const TriMesh& mesh, const Components& shells, const RunContext& context) : mesh_(mesh), shells_(shells), tree_(boxes_of(mesh, context), context) {}

  /// Returns the crossings with the line through p along an axis, sorted along the line; nothing if the line touches an edge or a vertex.
  std::optional<std::vector<Crossing>> crossings(const Vec3& p, std::size_t axis) const {
    Box line;
    line.min = line.max = p;
    const Box& all = tree_.nodes()[0].box;
    line.min[axis] = all.min[axis];
    line.max[axis] = all.max[axis];
    std::vector<Crossing> found;
    bool is_degenerate = false;
    tree_.visit_overlaps(line, [&](std::uint32_t item) {
      const TriangleId t(item);
      const int sense = sense_of_crossing(t, p, axis, is_degenerate);
      if (sense != 0) found.push_back({t, position(t, p, axis), sense});
      return !is_degenerate;
    });
    if (is_degenerate) return std::nullopt;
    std::ranges::sort(found, [](const Crossing& a, const Crossing& b) { return a.at != b.at ? a.at < b.at : a.triangle < b.triangle; });
    return found;
  }

  /// Returns the exact winding numbers from the crossings with the line through p; nothing if p lies on a triangle.
  std::optional<Windings> windings(const Vec3& p, const std::vector<Crossing>& crossings) const {
    std::map<std::uint32_t, int> sum;
    for (const Crossing& crossing : crossings) {
      const auto [a, b, c] = corners(mesh_, crossing.triangle);
      const int side = orient3d(a, b, c, p);
      if (side == 0) return std::nullopt;
      if (side == -crossing.sense) sum[shells_.component[crossing.triangle]] += crossing.sense;  // the crossing lies ahead of p
    }
    Windings result;
    for (const auto& [shell, winding] : sum) {
      if (winding != 0) result.emplace_back(shell, winding);
    }
    return result;
  }

 private:
  static std::vector<Box> boxes_of(const TriMesh& mesh, const RunContext& context) {
    std::vector<Box> boxes(mesh.n_triangles());
    parallel_for(context, boxes.size(), [&](std::size_t i) {
      for (const Point& p : corners(mesh, TriangleId(std::uint64_t{i}))) boxes[i].add(p);
    });
    return boxes;
  }
  /// Returns the orientation of a crossing; 0: there is no crossing. Exact, in the projection along the axis.
  int sense_of_crossing(TriangleId t, const Vec3& p, std::size_t axis, bool& is_degenerate) const {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto flat = [&](const Vec3& q) { return Vec2{q[u], q[v]}; };
    const std::array<Point, 3> corner = corners(mesh_, t);
    int n_left = 0, n_right = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int turn = orient2d(flat(corner[k]), flat(corner[(k + 1) % 3]), flat(p));
      n_left += turn > 0;
      n_right += turn < 0;
    }
    if (n_left > 0 && n_right > 0) return 0;
    if (n_left + n_right < 3) is_degenerate = true;
    return n_left == 3 ? 1 : n_right == 3 ? -1 : 0;
  }
  double position(TriangleId t, const Vec3& p, std::size_t axis) const {
    const auto [a, b, c] = corners(mesh_, t);
    const Vec3 n = cross(b - a, c - a);
    Vec3 to_line = p - a;
    to_line[axis] = 0.0;
    const double at = a[axis] - dot(n, to_line) / n[axis];
    return std::clamp(at, std::min({a[axis], b[axis], c[axis]}), std::max({a[axis], b[axis], c[axis]}));
  }

  const TriMesh& mesh_;
  const Components& shells_;
  BoxTree tree_;
};

/// Returns the largest triangles of each shell, in descending order of area.
std::vector<std::vector<TriangleId>> largest_triangles(const TriMesh& wall, const Components& shells) {
  std::vector<std::vector<std::pair<double, TriangleId>>> best(shells.count);
  const auto is_before = [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; };
  for (const TriangleId t : wall.triangles.ids()) {
    const auto [a, b, c] = corners(wall, t);
    auto& list = best[shells.component[t]];
    const std::pair entry{norm2(area_vector(a, b, c)), t};
    if (list.size() == k_triangles_tried && !is_before(entry, list.back())) continue;
    list.insert(std::ranges::upper_bound(list, entry, is_before), entry);
    if (list.size() > k_triangles_tried) list.pop_back();
  }
  std::vector<std::vector<TriangleId>> result(shells.count);
  for (std::size_t shell = 0; shell < best.size(); ++shell) {
    for (const auto& entry : best[shell]) result[shell].push_back(entry.second);
  }
  return result;
}

std::size_t dominant_axis(const Vec3& n) {
  const Vec3 m{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
  return m.x >= m.y && m.x >= m.z ? 0 : m.y >= m.z ? 1 : 2;
}

struct Candidate {
  Point point;
  double room = 0.0;  ///< smallest distance to the wall along the axes
  Windings windings;
};

struct Failure {
  Point position;
  std::string what;
};

bool is_solid(const Windings& windings) {
  int sum = 0;
  for (const auto& entry : windings) sum += entry.second;
  return sum == 1;
}

/// Moves the point to the middle of its segment along one axis if exact signs prove that it stays in its region. Stores the clearance along the axis.
void center(const Wall& surface, std::size_t axis, Candidate& candidate) {
  const auto crossings = surface.crossings(candidate.point, axis);
  if (!crossings) return;
  const auto next = std::ranges::upper_bound(*crossings, candidate.point[axis], {}, &Crossing::at);
  if (next == crossings->begin() || next == crossings->end()) return;
  Point moved = candidate.point;
  moved[axis] = (next - 1)->at + 0.5 * (next->at - (next - 1)->at);
  if (surface.windings(moved, *crossings) != candidate.windings) return;
  candidate.point = moved;
  candidate.room = std::min(candidate.room, 0.5 * (next->at - (next - 1)->at));
}

/// Returns the centred point in the segment behind a triangle. Returns nothing if every line that was tried hits an edge, or if there is no solid (then
/// `failure` is set).
std::optional<Candidate> point_behind(const Wall& surface, const TriMesh& wall, TriangleId t, std::optional<Failure>& failure) {
  const auto [a, b, c] = corners(wall, t);
  const std::size_t axis = dominant_axis(cross(b - a, c - a));
  for (const auto& weight : k_weights) {
    Vec3 p = weight[0] * a + weight[1] * b + weight[2] * c;
    const auto crossings = surface.crossings(p, axis);
    if (!crossings) continue;
    const auto here = std::ranges::find(*crossings, t, &Crossing::triangle);
    if (here == crossings->end()) continue;  // this is a sliver triangle, and rounding moved the line out of it
    const bool is_last = here->sense > 0 ? here == crossings->begin() : here + 1 == crossings->end();
    if (is_last) {
      failure = {p, "no surface behind this triangle"};
      return std::nullopt;
    }
    const Crossing& next = here->sense > 0 ? *(here - 1) : *(here + 1);
    p[axis] = here->at + 0.5 * (next.at - here->at);
    auto windings = surface.windings(p, *crossings);
    if (!windings) continue;
    if (!is_solid(*windings)) {
      failure = {p, "a point behind the triangle is not inside exactly one solid"};
      return std::nullopt;
    }
    Candidate candidate{p, 0.5 * std::abs(next.at - here->at), std::move(*windings)};
    for (const std::size_t step : {1, 2, 3}) center(surface, (axis + step) % 3, candidate);
    return candidate;
  }
  return std::nullopt;
}

/// Returns the point with the largest clearance. \throws Error(not_orientable) if there is no solid behind any of the triangles
Candidate roomiest_point(const Wall& surface, const TriMesh& wall, const std::vector<TriangleId>& triangles) {
  Candidate best;
  std::optional<Failure> failure;
  for (const TriangleId t : triangles) {
    auto candidate = point_behind(surface, wall, t, failure);
    if (candidate && candidate->room > best.room) best = std::move(*candidate);
  }
  if (best.room > 0.0) return best;
  const PatchId patch = wall.triangle_patch[triangles.front()];
  ErrorInfo error{
      .code = ErrorCode::not_orientable,
      .attempted = "finding a point inside each body",
      .problem = "the region behind a shell of patch \"" + wall.patches[patch].name + "\" is not a bounded solid",
      .hint = "normals must point out of the body; on shells inside a body they must point into its holes; a body must not lie inside another body"};
  const auto [a, b, c] = corners(wall, triangles.front());
  if (failure) error.locations.push_back({failure->position, failure->what});
  else error.locations.push_back({(a + b + c) / 3.0, "largest triangle of the shell"});
  throw Error(std::move(error));
}

}  // namespace

std::vector<Point> find_cavity_points(const TriMesh& wall, const RunContext& context) {
  if (wall.triangles.empty()) return {};
  const Components shells = connected_components(wall, Topology(wall, context));
  const Wall surface(wall, shells, context);
  const std::vector<std::vector<TriangleId>> triangles = largest_triangles(wall, shells);
  std::vector<Candidate> candidates(shells.count);
  parallel_for(
      context, candidates.size(), [&](std::size_t shell) { candidates[shell] = roomiest_point(surface, wall, triangles[shell]); }, 1);

  // For each region only the point with the largest clearance is kept, at the position of the region's first shell.
  std::vector<Candidate> kept;
  std::map<Windings, std::size_t> region_of;
  for (Candidate& candidate : candidates) {
    const auto [it, is_new] = region_of.try_emplace(candidate.windings, kept.size());
    if (is_new) kept.push_back(std::move(candidate));
    else if (candidate.room > kept[it->second].room) kept[it->second] = std::move(candidate);
  }
  std::vector<Point> points;
  for (const Candidate& candidate : kept) points.push_back(candidate.point);
  return points;
}

}  // namespace sterna::volmesh
