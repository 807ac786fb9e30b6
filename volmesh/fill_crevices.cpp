// Steps: tetrahedra between the points of the boundary (fluid_of), those between walls that face each other (Filler::find_between), which of them become solid
// (Filler::fill), the new wall (Filler::result).
#include "volmesh/fill_crevices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/base/sort_unique.h"
#include "geom/mesh/bvh.h"
#include "geom/tets/recover.h"
#include "geom/tets/tet_mesh.h"
#include "volmesh/domain/complete_boundary.h"

namespace sterna::volmesh {
namespace {

using Face = std::array<std::uint32_t, 3>;

constexpr double k_divided = 0.7;          ///< share of the progress
constexpr double k_flat = 0.02;            ///< thickness over the width of tetrahedra that are very flat
constexpr double k_rounding = 1.0 + 1e-9;  ///< a gap as wide as the width is filled
constexpr double k_on_edge = 1e-6;         ///< rounding of the areas by which a sample is inside a triangle, over the area of the triangle
constexpr double k_most_filled = 0.5;      ///< fraction of a region of the fluid that may become solid
constexpr int k_careful_rounds = 30;       ///< rounds in which one tetrahedron at each location becomes fluid again; later all there
constexpr int k_most_rounds = 10000;       ///< rounds of repairs; each but the last changes a tetrahedron for good
constexpr double k_same_location = 1e-6;   ///< over the body length: open boundaries were moved at most this far into their plane
constexpr std::uint32_t k_none = tets::k_none;

Face sorted(Face f) {
  std::sort(f.begin(), f.end());
  return f;
}

/// A triangle of the wall as it is at present. Normal into the fluid.
struct WallFace {
  Face nodes;
  std::uint32_t given = k_none;  ///< the triangle of the given wall; none for faces between solid and fluid
  std::uint32_t solid = k_none;  ///< the solid tetrahedron behind a face that is not of the given wall
  Vec3 normal;                   ///< unit
  Vec3 middle;
};

double thickness_of(const std::array<Vec3, 4>& x) {
  const double volume = std::abs(dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0]))) / 6.0;
  double area = 0.0;
  for (const auto& f : tets::k_face) area = std::max(area, 0.5 * norm(cross(x[f[1]] - x[f[0]], x[f[2]] - x[f[0]])));
  double thickness = area > 0.0 ? 3.0 * volume / area : 0.0;
  constexpr std::array<std::array<int, 4>, 3> k_opposite = {{{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}}};
  for (const auto& [a, b, c, d] : k_opposite) {
    const Vec3 n = cross(x[static_cast<std::size_t>(b)] - x[static_cast<std::size_t>(a)], x[static_cast<std::size_t>(d)] - x[static_cast<std::size_t>(c)]);
    const double length = norm(n);
    if (length > 0.0) thickness = std::min(thickness, std::abs(dot(n, x[static_cast<std::size_t>(c)] - x[static_cast<std::size_t>(a)])) / length);
  }
  return thickness;
}

class Filler {
 public:
  Filler(const TriMesh& wall, const TriangleTree& given, tets::TetMesh fluid, const CreviceOptions& options, const RunContext& context)
      : wall_(wall), given_(given), options_(options), context_(context), fluid_(std::move(fluid)), is_wall_node_(fluid_.points.size(), 0) {
    find_wall();
    require_same_wall();
    find_between();
  }

  /// Makes all tetrahedra between facing walls solid. Then repairs the wall until it is manifold, encloses no fluid, and is near the given wall.
  void fill() {
    for (std::uint32_t t = 0; t < state_.size(); ++t)
      if (opening_[t] <= k_rounding * options_.width) state_[t] = State::solid;
    require_fluid();
    for (int round = 0; round < k_most_rounds; ++round) {
      context_.check_stop();
      reopen_inner_nodes();
      make_surface();
      if (!join_enclosed() && !repair_topology(round < k_careful_rounds) && !reopen_far()) return;
    }
    throw Error({.code = ErrorCode::geometry_failed,
                 .attempted = "filling crevices",
                 .problem = "the wall is not manifold after " + std::to_string(k_most_rounds) + " rounds of repairs",
                 .hint = "use another width, or remesh the wall"});
  }

  CreviceResult result() {
    make_surface();
    CreviceResult made;
    CreviceReport& report = made.report;
    report.n_triangles_before = static_cast<std::int64_t>(wall_.n_triangles());
    find_left(report);
    if (!has_solid()) {
      made.wall = wall_;
      report.n_triangles = report.n_triangles_before;
      return made;
    }
    const std::vector<PatchId> patch_of_solid = patches_of_solid();
    made.wall = new_wall(patch_of_solid);
    report.n_triangles = static_cast<std::int64_t>(made.wall.n_triangles());
    report_crevices(report);
    return made;
  }

 private:
  std::array<Vec3, 4> corners_of(std::uint32_t t) const {
    const tets::Corners& n = fluid_.nodes[t];
    return {fluid_.points[n[0]], fluid_.points[n[1]], fluid_.points[n[2]], fluid_.points[n[3]]};
  }
  Vec3 middle_of(std::uint32_t t) const {
    const auto x = corners_of(t);
    return 0.25 * (x[0] + x[1] + x[2] + x[3]);
  }
  double volume_of(std::uint32_t t) const {
    const auto x = corners_of(t);
    return std::abs(dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0]))) / 6.0;
  }
  /// Corners of the face opposite to corner i, normal into the tetrahedron.
  Face face_of(std::uint32_t t, int i) const {
    const auto& f = tets::k_face[static_cast<std::size_t>(i)];
    const tets::Corners& n = fluid_.nodes[t];
    return {n[f[0]], n[f[1]], n[f[2]]};
  }
  bool is_solid(std::uint32_t t) const { return state_[t] == State::solid; }
  bool has_solid() const { return std::ranges::find(state_, State::solid) != state_.end(); }

  /// Nodes of the wall have the numbers of its vertices: without layers the boundary's points come first.
  void find_wall() {
    for (const TriangleId t : wall_.triangles.ids()) {
      if (wall_.patches[wall_.triangle_patch[t]].kind != PatchKind::wall) continue;
      const TriangleVertices& v = wall_.triangles[t];
      triangle_of_.emplace(sorted({v[0].value(), v[1].value(), v[2].value()}), t.value());
      for (const VertexId corner : v) is_wall_node_[corner.index()] = 1;
    }
  }

  void require_same_wall() const {
    const double length = body_length(wall_);
    for (const VertexId v : wall_.points.ids())
      if (is_wall_node_[v.index()] && norm(fluid_.points[v.index()] - wall_.points[v]) > k_same_location * length)
        throw Error({.code = ErrorCode::internal,
                     .attempted = "filling crevices",
                     .problem = "vertex " + std::to_string(v.value()) + " of the wall is not at its place in the mesh of the fluid",
                     .hint = "report this surface"});
  }

  void find_between() {
    state_.assign(fluid_.nodes.size(), State::other);
    thickness_.assign(fluid_.nodes.size(), 0.0);
    opening_.assign(fluid_.nodes.size(), std::numeric_limits<double>::infinity());
    at_node_.resize(wall_.n_vertices());
    for (std::uint32_t t = 0; t < fluid_.nodes.size(); ++t)
      for (const std::uint32_t node : fluid_.nodes[t])
        if (node < at_node_.size() && is_wall_node_[node]) at_node_[node].push_back(t);
    make_surface();
    require_all_faces();
    parallel_for(context_, fluid_.nodes.size(), [&](std::size_t i) {
      const auto t = static_cast<std::uint32_t>(i);
      if (!std::ranges::all_of(fluid_.nodes[t], [&](std::uint32_t node) { return is_wall_node_[node] != 0; })) return;
      state_[t] = State::between;
      thickness_[t] = thickness_of(corners_of(t));
      if (thickness_[t] <= k_rounding * options_.width) opening_[t] = opening_of(t);
    });
  }

  /// A wall triangle without fluid beside it would be lost in the new wall.
  void require_all_faces() const {
    if (faces_.size() == triangle_of_.size()) return;
    throw Error({.code = ErrorCode::internal,
                 .attempted = "filling crevices",
                 .problem = std::to_string(triangle_of_.size() - faces_.size()) + " triangles of the wall have no tetrahedron beside them",
                 .hint = "report this surface"});
  }

  void make_surface() {
    faces_.clear();
    faces_at_.assign(wall_.n_vertices(), {});
    const auto add = [&](WallFace face) {
      const auto& [a, b, c] = face.nodes;
      const Vec3 n = cross(fluid_.points[b] - fluid_.points[a], fluid_.points[c] - fluid_.points[a]);
      const double length = norm(n);
      face.normal = length > 0.0 ? n / length : Vec3{};
      face.middle = (fluid_.points[a] + fluid_.points[b] + fluid_.points[c]) / 3.0;
      for (const std::uint32_t node : face.nodes) faces_at_[node].push_back(static_cast<std::uint32_t>(faces_.size()));
      faces_.push_back(face);
    };
    for (std::uint32_t t = 0; t < fluid_.nodes.size(); ++t) {
      if (is_solid(t)) continue;
      for (int i = 0; i < 4; ++i) {
        const std::uint32_t across = fluid_.neighbours[t][static_cast<std::size_t>(i)];
        const Face face = face_of(t, i);
        if (across == k_none) {
          const auto found = triangle_of_.find(sorted(face));
          if (found != triangle_of_.end()) add({.nodes = face, .given = found->second, .normal = {}, .middle = {}});
        } else if (is_solid(across / 4)) {
          add({.nodes = face, .solid = across / 4, .normal = {}, .middle = {}});
        }
      }
    }
  }

  /// Returns true if the normal of `face` meets a sample of `other` in front of the face, at a distance of at most the width.
  bool is_over(const WallFace& face, const WallFace& other) const {
    const auto& [a, b, c] = face.nodes;
    const Vec3 &p = fluid_.points[a], &q = fluid_.points[b], &r = fluid_.points[c];
    const double least = -k_on_edge * dot(face.normal, cross(q - p, r - p));  // samples of equal grids lie on edges
    const auto is_inside = [&](const Vec3& x) {
      return dot(face.normal, cross(q - p, x - p)) >= least && dot(face.normal, cross(r - q, x - q)) >= least && dot(face.normal, cross(p - r, x - r)) >= least;
    };
    const std::array<Vec3, 3> corners = {fluid_.points[other.nodes[0]], fluid_.points[other.nodes[1]], fluid_.points[other.nodes[2]]};
    for (std::size_t i = 0; i < 3; ++i)
      for (const Vec3& sample : {corners[i], 0.5 * (corners[i] + corners[(i + 1) % 3]), other.middle}) {
        const double height = dot(face.normal, sample - face.middle);
        if (height > 1e-9 * options_.width && height <= k_rounding * options_.width && is_inside(sample)) return true;
      }
    return false;
  }

  /// Returns true if two faces face each other across the fluid: one is over the other. Behind a convex edge each face is behind the plane of the other one.
  bool are_facing(const WallFace& a, const WallFace& b) const {
    return dot(a.normal, b.normal) < -std::cos(options_.angle) && (is_over(a, b) || is_over(b, a));
  }

  /// Largest distance of a node of the tetrahedron in front of the face, m.
  double height_over(const WallFace& face, std::uint32_t t) const {
    double height = 0.0;
    for (const Vec3& corner : corners_of(t)) height = std::max(height, dot(face.normal, corner - face.middle));
    return height;
  }

  /// Smallest distance between two facing walls that have the tetrahedron between them, in m: largest distance of its nodes in front of either. Infinite if
  /// there are none. The walls are triangles of the given wall at the nodes.
  double opening_of(std::uint32_t t) const {
    const Vec3 middle = middle_of(t);
    std::vector<std::uint32_t> around;
    for (const std::uint32_t node : fluid_.nodes[t])
      for (const std::uint32_t f : faces_at_[node])
        if (dot(faces_[f].normal, middle - faces_[f].middle) > 0.0 && height_over(faces_[f], t) <= k_rounding * options_.width) around.push_back(f);
    sort_unique(around);
    double opening = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < around.size(); ++i)
      for (std::size_t j = i + 1; j < around.size(); ++j) {
        const WallFace &a = faces_[around[i]], &b = faces_[around[j]];
        const double here = std::max(height_over(a, t), height_over(b, t));
        if (here < opening && are_facing(a, b)) opening = here;
      }
    return opening;
  }

  /// Returns true if a tetrahedron is so flat that it may become solid to make the wall manifold.
  bool is_repair(std::uint32_t t) const { return state_[t] == State::between && thickness_[t] <= k_flat * options_.width; }

  /// Number of faces of a tetrahedron that have fluid on the other side.
  std::ptrdiff_t n_open(std::uint32_t t) const {
    return std::ranges::count_if(fluid_.neighbours[t], [&](std::uint32_t across) { return across != k_none && !is_solid(across / 4); });
  }

  /// Where the wall is not manifold, the flattest tetrahedron becomes solid. If none is flat, a solid one becomes fluid for good: the one with the most faces
  /// at the fluid, and of these the one with the widest opening.
  bool repair_topology(bool is_careful) {
    bool is_changed = false;
    for (const std::vector<std::uint32_t>& tets_there : broken_locations()) {
      std::uint32_t flattest = k_none, outermost = k_none;
      for (const std::uint32_t t : tets_there) {
        if (is_repair(t) && (flattest == k_none || thickness_[t] < thickness_[flattest])) flattest = t;
        if (is_solid(t) && (outermost == k_none || std::pair(n_open(t), opening_[t]) > std::pair(n_open(outermost), opening_[outermost]))) outermost = t;
      }
      if (flattest != k_none) state_[flattest] = State::solid;
      else if (outermost != k_none && is_careful) reopen(outermost);
      else if (outermost != k_none)
        for (const std::uint32_t t : tets_there) reopen(t);
      is_changed = is_changed || flattest != k_none || outermost != k_none;
    }
    return is_changed;
  }

  /// Nodes that are not on the wall must not be on the new one: solid tetrahedra that have one become fluid where fluid is beside it.
  void reopen_inner_nodes() {
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      for (std::uint32_t t = 0; t < state_.size(); ++t) {
        if (!is_solid(t) || std::ranges::all_of(fluid_.nodes[t], [&](std::uint32_t node) { return is_wall_node_[node] != 0; })) continue;
        for (int i = 0; i < 4; ++i) {
          const std::uint32_t across = fluid_.neighbours[t][static_cast<std::size_t>(i)];
          if (across == k_none || is_solid(across / 4)) continue;
          const Face face = face_of(t, i);
          if (std::ranges::all_of(face, [&](std::uint32_t node) { return is_wall_node_[node] != 0; })) continue;
          is_changed = reopen(t) || is_changed;
          break;
        }
      }
    }
  }

  /// New wall triangles that are farther from the given wall than half of the width (the middle of a gap): their solid tetrahedra become fluid for good.
  bool reopen_far() {
    bool is_changed = false;
    for (const WallFace& face : faces_)
      if (face.solid != k_none && distance_of(face) > 0.5 * k_rounding * options_.width) is_changed = reopen(face.solid) || is_changed;
    return is_changed;
  }

  /// Largest distance of a face from the given wall, m: at points that divide its edges in eight.
  double distance_of(const WallFace& face) const {
    constexpr int k_parts = 8;
    const auto& [a, b, c] = face.nodes;
    const Vec3 &p = fluid_.points[a], u = fluid_.points[b] - p, v = fluid_.points[c] - p;
    double distance = 0.0;
    for (int i = 0; i <= k_parts; ++i)
      for (int j = 0; i + j <= k_parts; ++j)
        distance = std::max(distance, given_.nearest(p + (i / static_cast<double>(k_parts)) * u + (j / static_cast<double>(k_parts)) * v).distance);
    return distance;
  }

  bool reopen(std::uint32_t t) {
    if (!is_solid(t)) return false;
    state_[t] = State::left;
    return true;
  }

  /// Tetrahedra around each edge with more than two faces, then around each vertex whose faces are no single fan.
  std::vector<std::vector<std::uint32_t>> broken_locations() {
    std::vector<std::vector<std::uint32_t>> broken;
    for (std::uint32_t v = 0; v < faces_at_.size(); ++v) {
      const std::vector<std::uint32_t>& faces = faces_at_[v];
      if (std::ranges::none_of(faces, [&](std::uint32_t f) { return faces_[f].solid != k_none; })) continue;
      std::map<std::uint32_t, std::vector<std::uint32_t>> by_other;  // faces at the edge to this node, by index in `faces`
      for (std::uint32_t i = 0; i < faces.size(); ++i)
        for (const std::uint32_t node : faces_[faces[i]].nodes)
          if (node != v) by_other[node].push_back(i);
      DisjointSets fans(faces.size());
      bool is_edge_broken = false;
      for (const auto& [node, beside] : by_other) {
        for (const std::uint32_t i : beside) fans.join(beside.front(), i);
        if (beside.size() <= 2) continue;
        is_edge_broken = true;
        if (v > node) continue;  // found from the other end
        std::vector<std::uint32_t> around;
        for (const std::uint32_t t : at_node_[v])
          if (std::ranges::find(fluid_.nodes[t], node) != fluid_.nodes[t].end()) around.push_back(t);
        broken.push_back(std::move(around));
      }
      if (is_edge_broken) continue;
      for (std::uint32_t i = 1; i < faces.size(); ++i)
        if (fans.root(i) != 0) {
          broken.push_back(at_node_[v]);
          break;
        }
    }
    return broken;
  }

  /// Finds fluid that solid tetrahedra separate from the rest. Fluid that is thin everywhere becomes solid as well. Other fluid stays connected: the solid
  /// tetrahedra around it become fluid for good.
  bool join_enclosed() {
    const auto n = static_cast<std::uint32_t>(state_.size());
    DisjointSets before(n), now(n);
    for (std::uint32_t t = 0; t < n; ++t)
      for (const std::uint32_t across : fluid_.neighbours[t]) {
        if (across == k_none || across / 4 < t) continue;
        before.join(t, across / 4);
        if (!is_solid(t) && !is_solid(across / 4)) now.join(t, across / 4);
      }
    std::map<std::uint32_t, std::map<std::uint32_t, double>> volumes;  // of the parts of each region
    for (std::uint32_t t = 0; t < n; ++t)
      if (!is_solid(t)) volumes[before.root(t)][now.root(t)] += volume_of(t);
    std::set<std::uint32_t> small;
    for (const auto& [region, parts] : volumes) {
      const auto largest = std::ranges::max_element(parts, {}, [](const auto& part) { return part.second; });
      for (const auto& [part, volume] : parts)
        if (part != largest->first) small.insert(part);
    }
    std::set<std::uint32_t> open;  // parts that are no gap
    for (std::uint32_t t = 0; t < n; ++t)
      if (!is_solid(t) && small.contains(now.root(t)) && !is_in_gap(t)) open.insert(now.root(t));
    bool is_changed = false;
    for (std::uint32_t t = 0; t < n; ++t) {
      if (is_solid(t) || !small.contains(now.root(t))) continue;
      if (!open.contains(now.root(t))) {
        state_[t] = State::solid;
        is_changed = true;
        continue;
      }
      for (const std::uint32_t across : fluid_.neighbours[t])
        if (across != k_none) is_changed = reopen(across / 4) || is_changed;
    }
    return is_changed;
  }

  /// Returns true if a tetrahedron may be inside a gap: it is thin, and its nodes are not farther from the wall than the middle of a gap is.
  bool is_in_gap(std::uint32_t t) const {
    return state_[t] != State::left && thickness_of(corners_of(t)) <= k_rounding * options_.width &&
           std::ranges::all_of(fluid_.nodes[t], [&](std::uint32_t node) {
             return is_wall_node_[node] != 0 || given_.nearest(fluid_.points[node], options_.width).distance <= 0.5 * k_rounding * options_.width;
           });
  }

  /// A duct as narrow as a gap is no gap.
  /// \throws Error(bad_argument) if most of the volume of a connected region of the fluid is solid
  void require_fluid() const {
    DisjointSets regions(state_.size());
    for (std::uint32_t t = 0; t < state_.size(); ++t)
      for (const std::uint32_t across : fluid_.neighbours[t])
        if (across != k_none) regions.join(t, across / 4);
    std::map<std::uint32_t, std::array<double, 2>> volumes;  // of the region, and of its solid tetrahedra
    for (std::uint32_t t = 0; t < state_.size(); ++t) {
      std::array<double, 2>& sums = volumes[regions.root(t)];
      sums[0] += volume_of(t);
      if (is_solid(t)) sums[1] += volume_of(t);
    }
    for (const auto& [region, sums] : volumes)
      if (sums[1] > k_most_filled * sums[0])
        throw Error({.code = ErrorCode::bad_argument,
                     .attempted = "filling crevices",
                     .problem = number_text(100.0 * sums[1] / sums[0], 3) + " % of a region of the fluid is narrower than the width " +
                                in_metres(options_.width) + " and would become solid; the limit is " + number_text(100.0 * k_most_filled, 3) + " %",
                     .locations = {{middle_of(region), "fluid of this region"}},
                     .hint = "use a smaller width"});
  }

  void find_left(CreviceReport& report) const {
    for (std::uint32_t t = 0; t < state_.size(); ++t) {
      if (state_[t] != State::left) continue;
      if (report.left.size() < k_max_locations) report.left.push_back(middle_of(t));
      ++report.n_left;
    }
  }

  /// Patch of the largest wall triangle of each solid tetrahedron, else that of the neighbour that has one first.
  std::vector<PatchId> patches_of_solid() const {
    std::vector<PatchId> patch(state_.size());
    std::vector<std::uint32_t> reached;
    for (std::uint32_t t = 0; t < state_.size(); ++t) {
      if (!is_solid(t)) continue;
      double largest = -1.0;
      for (int i = 0; i < 4; ++i) {
        if (fluid_.neighbours[t][static_cast<std::size_t>(i)] != k_none) continue;
        const Face face = face_of(t, i);
        const auto found = triangle_of_.find(sorted(face));
        if (found == triangle_of_.end()) continue;
        const double area = norm(cross(fluid_.points[face[1]] - fluid_.points[face[0]], fluid_.points[face[2]] - fluid_.points[face[0]]));
        if (area <= largest) continue;
        largest = area;
        patch[t] = wall_.triangle_patch[TriangleId(found->second)];
      }
      if (patch[t].is_valid()) reached.push_back(t);
    }
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const std::uint32_t across : fluid_.neighbours[reached[i]]) {
        if (across == k_none || !is_solid(across / 4) || patch[across / 4].is_valid()) continue;
        patch[across / 4] = patch[reached[i]];
        reached.push_back(across / 4);
      }
    // Tetrahedra that reach no wall triangle through faces: the patch of a wall triangle at one of their nodes.
    for (std::uint32_t t = 0; t < state_.size(); ++t) {
      if (!is_solid(t) || patch[t].is_valid()) continue;
      for (const TriangleId given : wall_.triangles.ids())
        if (std::ranges::any_of(wall_.triangles[given], [&](VertexId v) { return std::ranges::find(fluid_.nodes[t], v.value()) != fluid_.nodes[t].end(); })) {
          patch[t] = wall_.triangle_patch[given];
          break;
        }
    }
    return patch;
  }

  TriMesh new_wall(const std::vector<PatchId>& patch_of_solid) const {
    std::vector<std::uint8_t> stays(wall_.n_triangles(), 1);
    for (const auto& [nodes, given] : triangle_of_) stays[given] = 0;
    for (const WallFace& face : faces_)
      if (face.given != k_none) stays[face.given] = 1;
    std::vector<std::pair<Face, PatchId>> triangles;
    for (const TriangleId t : wall_.triangles.ids()) {
      const TriangleVertices& v = wall_.triangles[t];
      if (stays[t.index()]) triangles.push_back({{v[0].value(), v[1].value(), v[2].value()}, wall_.triangle_patch[t]});
    }
    for (const WallFace& face : faces_)
      if (face.solid != k_none) triangles.push_back({face.nodes, patch_of_solid[face.solid]});
    TriMesh made;
    made.patches = wall_.patches;
    std::vector<std::uint8_t> is_used(wall_.n_vertices(), 0);
    for (const auto& [nodes, patch] : triangles)
      for (const std::uint32_t node : nodes) is_used[node] = 1;
    std::vector<VertexId> number(wall_.n_vertices());
    for (const VertexId v : wall_.points.ids())
      if (is_used[v.index()]) number[v.index()] = made.points.push_back(wall_.points[v]);
    for (const auto& [nodes, patch] : triangles) {
      made.triangles.push_back({number[nodes[0]], number[nodes[1]], number[nodes[2]]});
      made.triangle_patch.push_back(patch);
    }
    return made;
  }

  void report_crevices(CreviceReport& report) const {
    DisjointSets regions(state_.size() + fluid_.points.size());
    for (std::uint32_t t = 0; t < state_.size(); ++t)
      if (is_solid(t))
        for (const std::uint32_t node : fluid_.nodes[t]) regions.join(t, static_cast<std::uint32_t>(state_.size()) + node);
    struct Region {
      FilledCrevice crevice;
      double largest = 0.0;
    };
    std::map<std::uint32_t, Region> by_root;
    for (std::uint32_t t = 0; t < state_.size(); ++t) {
      if (!is_solid(t)) continue;
      auto& [crevice, largest] = by_root[regions.root(t)];
      const double volume = volume_of(t);
      if (volume > largest || crevice.n_tetrahedra == 0) {
        largest = volume;
        crevice.location = middle_of(t);
      }
      crevice.volume += volume;
      if (opening_[t] <= k_rounding * options_.width) crevice.width = std::max(crevice.width, opening_[t]);
      ++crevice.n_tetrahedra;
      for (const Vec3& corner : corners_of(t)) crevice.box.add(corner);
    }
    for (const TriangleId t : wall_.triangles.ids())
      for (const VertexId v : wall_.triangles[t]) {
        const auto found = by_root.find(regions.root(static_cast<std::uint32_t>(state_.size()) + v.value()));
        if (found != by_root.end()) found->second.crevice.patches.push_back(wall_.patches[wall_.triangle_patch[t]].name);
      }
    for (const WallFace& face : faces_) {
      if (face.solid == k_none) continue;
      double& distance = by_root[regions.root(face.solid)].crevice.distance;
      distance = std::max(distance, distance_of(face));
    }
    for (auto& [root, region] : by_root) {
      sort_unique(region.crevice.patches);
      report.volume += region.crevice.volume;
      report.distance = std::max(report.distance, region.crevice.distance);
      report.crevices.push_back(std::move(region.crevice));
    }
    std::ranges::stable_sort(report.crevices, [](const FilledCrevice& a, const FilledCrevice& b) { return a.volume > b.volume; });
  }

  enum class State : std::uint8_t {
    other,    ///< with a node that is not on a wall
    between,  ///< all nodes on walls
    solid,
    left,  ///< has to stay fluid
  };

  const TriMesh& wall_;
  const TriangleTree& given_;  ///< tree of `wall`
  const CreviceOptions& options_;
  const RunContext& context_;
  tets::TetMesh fluid_;
  std::vector<std::uint8_t> is_wall_node_;
  std::map<Face, std::uint32_t> triangle_of_;  ///< wall triangle of its sorted nodes
  std::vector<State> state_;                   ///< state per tetrahedron
  std::vector<double> thickness_;              ///< thickness in m, for tetrahedra whose nodes are all on walls
  std::vector<double> opening_;                ///< opening_of()
  std::vector<std::vector<std::uint32_t>> at_node_;
  std::vector<WallFace> faces_;  ///< the wall at present
  std::vector<std::vector<std::uint32_t>> faces_at_;
};

/// Returns tetrahedra in the fluid whose nodes are the points of its boundary, up to a few points that keep the boundary. The wall's vertices come first.
tets::TetMesh fluid_of(const TriMesh& wall, const RunContext& context) {
  const TriMesh boundary = complete_boundary(wall, {}, context);
  std::vector<tets::Facet> facets;
  facets.reserve(boundary.n_triangles());
  for (const TriangleVertices& v : boundary.triangles) facets.push_back({v[0].value(), v[1].value(), v[2].value()});
  tets::Recovery recovery = tets::recover(boundary.points.raw(), facets, {}, context);
  if (!recovery.mesh.nodes.empty()) return std::move(recovery.mesh);
  ErrorInfo error{.code = ErrorCode::geometry_failed,
                  .attempted = "filling crevices",
                  .problem = "the fluid beside the wall has no tetrahedra with all triangles of the wall as faces: " + recovery.failure.problem,
                  .hint = "remesh the wall first"};
  for (const Vec3& location : recovery.failure.locations) error.locations.push_back({location, "triangle or edge that is missing"});
  throw Error(std::move(error));
}

}  // namespace

CreviceResult fill_crevices(const TriMesh& wall, const CreviceOptions& options, const RunContext& context) {
  if (!(options.width > 0.0))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "filling crevices",
                 .problem = is_automatic(options.width) ? std::string("no width is given") : "the width " + in_metres(options.width) + " is not positive",
                 .hint = "give the largest distance between facing walls that is filled, for example width = 0.02"});
  const TriangleTree given(wall, context);
  Filler filler(wall, given, fluid_of(wall, context.part("fluid", 0.0, k_divided)), options, context);
  filler.fill();
  return filler.result();
}

std::vector<std::string> to_lines(const CreviceReport& report, std::size_t n) {
  std::vector<std::string> lines;
  for (const FilledCrevice& crevice : report.crevices) {
    if (lines.size() == n) break;
    std::string names;
    for (const std::string& name : crevice.patches) names += (names.empty() ? "" : ", ") + name;
    constexpr int k_digits = 3;
    lines.push_back(format_point(crevice.location) + ": " + std::to_string(crevice.n_tetrahedra) +
                    (crevice.n_tetrahedra == 1 ? " tetrahedron, " : " tetrahedra, ") + number_text(crevice.volume, k_digits) + " m^3, up to " +
                    in_metres(crevice.width, k_digits) + " wide, new triangles at most " + in_metres(crevice.distance, k_digits) +
                    " from the given wall, between " + names);
  }
  return lines;
}

}  // namespace sterna::volmesh
