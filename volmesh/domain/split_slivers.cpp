// Steps: find sliver triangles (if there are none, nothing is done); flip edges around them; bisect edges, each time with the flips that the new vertex makes
// possible; verify that nothing intersects.
#include "volmesh/domain/split_slivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"

namespace sterna::volmesh {
namespace {

/// A flip reduces the larger cotangent of its two triangles at least to this fraction, which prevents flipping back and forth.
constexpr double k_flip_gain = 0.95;
constexpr double k_flip_drift = 0.3;  ///< largest movement of the surface in a flip, as a fraction of flip_angle (rad) times the shorter diagonal; a square
                                      ///< folded by the angle moves by a quarter
/// Fraction of the diagonal: normals of thinner triangles consist of rounding errors, so only the distance of the diagonals is tested.
constexpr double k_hairline = 1e-6;
/// Largest number of pieces of a long edge; slivers that would need more pieces are left, because the triangles in between would be slivers too.
constexpr double k_sliver_reach = 32.0;
constexpr double k_least_piece = 0.45;  ///< shortest edge that bisection may make, as a fraction of the piece length at which the parts of the given triangle
                                        ///< are no slivers; below one half, so that a half may be shorter than such a piece once
/// Fraction of a triangle's longest edge: creases at least this long are bisected first, because only creases need bisection.
constexpr double k_crease_share = 2.0 / 3.0;
constexpr double k_path_ratio = 1.6;  ///< ratio of edges: if the neighbour's longest edge is longer than this, it is bisected first. The ratio is above 1 /
                                      ///< k_crease_share, so that paths end
constexpr double k_spoilt = 1.01;     ///< limit for the cotangent sum of the sliver parts of a triangle, relative to its own cotangent
constexpr int k_sliver_passes = 6;    ///< the first pass only flips edges; each further pass leaves out the triangles that became worse in the previous pass
constexpr double k_sharper = 1.1;     ///< largest factor by which a bisection may increase a sliver's cotangent
constexpr double k_endless_cotangent = 1e300;

using FaceId = std::uint32_t;
/// Number of a side, 3 face + corner: the side from that corner to the next one.
using SideId = std::uint32_t;

FaceId face_of(SideId s) { return s / 3; }
SideId side_after(SideId s) { return s % 3 == 2 ? s - 2 : s + 1; }
SideId side_before(SideId s) { return s % 3 == 0 ? s + 2 : s - 1; }
SideId side_at(FaceId f, std::uint32_t k) { return 3 * f + k; }

struct WallFace {
  std::array<VertexId, 3> corners;
  std::array<SideId, 3> twins;
  PatchId patch;
  TriangleId source;
  bool has_layer = false;
  double least_edge = 0.0;  ///< m; bisection makes no edge shorter than this
  double drift = 0.0;       ///< m, largest distance from the given surface
  CornerWeights weights{};
};

std::array<double, 3> middle_weights(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

/// Returns the distance between the lines through ab and cd. The surface moves by this distance if one diagonal replaces the other.
double diagonal_distance(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Vec3 n = cross(b - a, d - c);
  const double length = norm(n);
  return length > 0.0 ? std::abs(dot(n, c - a)) / length : 0.0;
}

/// Returns the cotangent of the smallest angle.
double cotangent_of(const Point& a, const Point& b, const Point& c) {
  const double ab = norm2(b - a), bc = norm2(c - b), ca = norm2(a - c), doubled = norm(cross(b - a, c - a));
  const double scalar = 0.5 * (ab + bc + ca) - std::min({ab, bc, ca});
  return doubled > 0.0 ? scalar / doubled : k_endless_cotangent;
}

class SliverSplitter {
 public:
  SliverSplitter(const TriMesh& mesh, const Topology& topology, const Column<PatchId, std::uint8_t>& has_layer,
                 const Column<TriangleId, std::uint8_t>& is_locked, const SliverOptions& options, const RunContext& context)
      : options_(options),
        context_(context),
        limit_(1.0 / std::tan(options.split_needles)),
        flat_cosine_(std::cos(options.flip_angle)),
        points_(mesh.points),
        is_locked_(is_locked) {
    faces_.resize(mesh.n_triangles());
    parallel_for(context, faces_.size(), [&](std::size_t f) {
      const TriangleId t(f);
      WallFace& face = faces_[f];
      face = {.corners = mesh.triangles[t],
              .twins = {},
              .patch = mesh.triangle_patch[t],
              .source = t,
              .has_layer = has_layer[mesh.triangle_patch[t]] != 0,
              .weights = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
      double longest = 0.0;
      for (std::uint32_t k = 0; k < 3; ++k) {
        face.twins[k] = static_cast<SideId>(topology.twin(HalfedgeId(3 * f + k)).index());
        longest = std::max(longest, distance(points_[face.corners[k]], points_[face.corners[(k + 1) % 3]]));
      }
      const auto [a, b, c] = sterna::corners(mesh, t);
      face.least_edge = k_least_piece * longest * std::min(1.0, limit_ / std::max(limit_ / k_sliver_reach, cotangent_of(a, b, c)));
    });
    for (const WallFace& face : faces_) n_given_ += face.has_layer ? 1 : 0;
  }

  void run() {
    for (FaceId f = 0; f < faces_.size(); ++f)
      if (is_sliver(f)) flip_around({f});
    const auto budget = static_cast<std::int64_t>(std::min(options_.needle_budget * static_cast<double>(n_given_), 2e9));
    for (FaceId f = 0; f < faces_.size(); ++f) enqueue(f);
    while (!queue_.empty()) {
      const Candidate candidate = queue_.top();
      queue_.pop();
      if (candidate.cotangent != cotangent(candidate.face)) continue;  // the entry belongs to a triangle that no longer exists
      const SideId chosen = side_to_bisect(candidate.face);
      if (chosen == k_none) continue;
      if (n_new_ + 2 > budget) {
        is_over_budget_ = true;
        break;
      }
      const std::array<FaceId, 4> made = bisect(end_of_path(chosen));
      for (const FaceId f : flip_around({made.begin(), made.end()})) {
        enqueue(f);
        for (const SideId twin : faces_[f].twins) enqueue(face_of(twin));
      }
      enqueue(candidate.face);
      if (++n_bisections_ % 4096 == 0) context_.check_stop();
    }
  }

  /// Returns the sum of the cotangents of sliver triangles, a measure of their number and sharpness.
  double sharpness() const {
    double sum = 0.0;
    for (FaceId f = 0; f < faces_.size(); ++f) sum += is_sliver(f) ? cotangent(f) : 0.0;
    return sum;
  }

  /// Marks the given triangles whose sliver parts are more or sharper than before. Returns false if no further triangle is marked.
  bool lock_spoilt(const TriMesh& given, Column<TriangleId, std::uint8_t>& is_locked) const {
    Column<TriangleId, double> sum(is_locked.size(), 0.0);
    for (FaceId f = 0; f < faces_.size(); ++f)
      if (is_sliver(f)) sum[faces_[f].source] += cotangent(f);
    bool has_new = false;
    for (const TriangleId t : given.triangles.ids()) {
      const auto [a, b, c] = sterna::corners(given, t);
      if (is_locked[t] || sum[t] <= k_spoilt * std::max(limit_, cotangent_of(a, b, c))) continue;
      is_locked[t] = has_new = true;
    }
    return has_new;
  }

  SliverSplits put_into(TriMesh& mesh) const {
    SliverSplits result;
    std::vector<FaceId> order(faces_.size());
    for (FaceId f = 0; f < order.size(); ++f) order[f] = f;
    std::stable_sort(order.begin(), order.end(), [&](FaceId a, FaceId b) { return faces_[a].source < faces_[b].source; });
    mesh.points = points_;
    mesh.triangles.clear();
    mesh.triangle_patch.clear();
    for (const FaceId f : order) {
      mesh.triangles.push_back(faces_[f].corners);
      mesh.triangle_patch.push_back(faces_[f].patch);
      result.sources.push_back(faces_[f].source);
      result.weights.push_back(faces_[f].weights);
    }
    result.report = {.n_given = n_given_, .n_triangles = n_given_ + n_new_, .n_flips = n_flips_, .is_over_budget = is_over_budget_};
    return result;
  }

 private:
  static constexpr SideId k_none = static_cast<SideId>(-1);

  struct Candidate {
    double cotangent;
    FaceId face;
    /// The top of a priority_queue is its largest element. This order makes it the mildest sliver, and among equal ones the first face.
    bool operator<(const Candidate& b) const { return cotangent != b.cotangent ? cotangent > b.cotangent : face > b.face; }
  };

  const Point& from(SideId s) const { return points_[faces_[face_of(s)].corners[s % 3]]; }
  const Point& to(SideId s) const { return from(side_after(s)); }
  const Point& opposite(SideId s) const { return from(side_before(s)); }
  VertexId vertex(SideId s) const { return faces_[face_of(s)].corners[s % 3]; }
  SideId twin(SideId s) const { return faces_[face_of(s)].twins[s % 3]; }
  double length2(SideId s) const { return norm2(to(s) - from(s)); }
  double cotangent(FaceId f) const { return cotangent_of(from(side_at(f, 0)), from(side_at(f, 1)), from(side_at(f, 2))); }
  bool is_sliver(FaceId f) const { return faces_[f].has_layer && cotangent(f) > limit_; }
  Vec3 area(FaceId f) const { return area_vector(from(side_at(f, 0)), from(side_at(f, 1)), from(side_at(f, 2))); }
  bool is_inner(SideId s) const { return faces_[face_of(s)].has_layer && faces_[face_of(twin(s))].has_layer; }

  void enqueue(FaceId f) {
    if (is_sliver(f)) queue_.push({cotangent(f), f});
  }

  /// Returns true if a vertex is a neighbour of the start of a side.
  bool has_neighbour(SideId s, VertexId other) const {
    const SideId first = s;
    do {
      if (vertex(side_after(s)) == other) return true;
      s = side_after(twin(s));
    } while (s != first);
    return false;
  }

  bool is_straight(const Vec3& a, const Vec3& b) const { return dot(a, b) >= flat_cosine_ * norm(a) * norm(b); }

  /// Returns true if an edge is inside a patch and the wall is flat along it.
  bool is_flat(SideId s) const {
    const SideId t = twin(s);
    if (options_.flip_angle == 0.0 || !is_inner(s) || faces_[face_of(s)].patch != faces_[face_of(t)].patch) return false;
    const Vec3 a = area(face_of(s)), b = area(face_of(t));
    if (is_straight(a, b)) return true;
    return diagonal_distance(from(s), to(s), opposite(s), opposite(t)) <= k_hairline * distance(opposite(s), opposite(t));
  }

  /// Returns the larger cotangent after a flip; infinite if the flip is not allowed.
  double cotangent_behind_flip(SideId s) const {
    if (!is_flat(s)) return k_endless_cotangent;
    const Point &a = from(s), &b = to(s), &c = opposite(s), &d = opposite(twin(s));
    const double worst = std::max(cotangent_of(a, d, c), cotangent_of(d, b, c));
    if (worst == k_endless_cotangent) return worst;
    const Vec3 sum = area(face_of(s)) + area(face_of(twin(s)));
    const Vec3 first = area_vector(a, d, c), second = area_vector(d, b, c);
    if (!is_straight(first, sum) || !is_straight(second, sum)) return k_endless_cotangent;
    if (drift_behind_flip(s) > k_flip_drift * options_.flip_angle * std::sqrt(std::min(length2(s), norm2(d - c)))) return k_endless_cotangent;
    if (has_neighbour(side_before(s), vertex(side_before(twin(s))))) return k_endless_cotangent;
    return worst;
  }

  double drift_behind_flip(SideId s) const {
    return std::max(faces_[face_of(s)].drift, faces_[face_of(twin(s))].drift) + diagonal_distance(from(s), to(s), opposite(s), opposite(twin(s)));
  }

  void join(SideId a, SideId b) {
    faces_[face_of(a)].twins[a % 3] = b;
    faces_[face_of(b)].twins[b % 3] = a;
  }

  void flip(SideId s) {
    const double drift = drift_behind_flip(s);
    const SideId t = twin(s);
    const FaceId f = face_of(s), g = face_of(t);
    const VertexId a = vertex(s), b = vertex(t), c = vertex(side_before(s)), d = vertex(side_before(t));
    const SideId bc = twin(side_after(s)), ca = twin(side_before(s)), ad = twin(side_after(t)), db = twin(side_before(t));
    const double least_edge = std::min(faces_[f].least_edge, faces_[g].least_edge);
    faces_[f].corners = {a, d, c};
    faces_[g].corners = {d, b, c};
    join(side_at(f, 0), ad);
    join(side_at(f, 1), side_at(g, 2));
    join(side_at(f, 2), ca);
    join(side_at(g, 0), db);
    join(side_at(g, 1), bc);
    for (const FaceId i : {f, g}) {
      faces_[i].weights = {};
      faces_[i].drift = drift;
      faces_[i].least_edge = least_edge;
    }
    ++n_flips_;
  }

  /// Flips edges of sliver triangles among these faces, and of faces that change in the process, as long as flips improve angles. Returns all these faces,
  /// ascending.
  std::vector<FaceId> flip_around(std::vector<FaceId> faces) {
    std::vector<FaceId> waiting(faces.rbegin(), faces.rend());
    while (!waiting.empty()) {
      const FaceId f = waiting.back();
      waiting.pop_back();
      if (!is_sliver(f)) continue;
      SideId best = k_none;
      double least = k_endless_cotangent;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const double behind = cotangent_behind_flip(side_at(f, k));
        const double before = std::max(cotangent(f), cotangent(face_of(twin(side_at(f, k)))));
        if (behind > k_flip_gain * before || behind >= least) continue;
        least = behind;
        best = side_at(f, k);
      }
      if (best == k_none) continue;
      const FaceId g = face_of(twin(best));
      flip(best);
      for (const FaceId changed : {g, f}) {
        waiting.push_back(changed);
        faces.push_back(changed);
      }
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

  /// Returns true if the angle between the creases at a corner is large enough for better angles.
  bool has_room(SideId at_corner) const {
    double angle = corner_angle(from(at_corner), to(at_corner), opposite(at_corner));
    const auto add = [&](SideId s) { return angle += corner_angle(from(s), to(s), opposite(s)); };
    SideId s = at_corner;
    while (angle < options_.split_needles && is_flat(s)) {
      s = side_after(twin(s));
      if (s == at_corner) return true;
      add(s);
    }
    s = at_corner;
    while (angle < options_.split_needles && is_flat(side_before(s))) {
      s = twin(side_before(s));
      if (s == at_corner) return true;
      add(s);
    }
    return angle >= options_.split_needles;
  }

  /// Returns the longest edge of a triangle, or a crease of the triangle that is nearly as long.
  SideId long_side(FaceId f) const {
    SideId longest = side_at(f, 0);
    for (std::uint32_t k = 1; k < 3; ++k)
      if (length2(side_at(f, k)) > length2(longest)) longest = side_at(f, k);
    SideId crease = k_none;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const SideId s = side_at(f, k);
      if (!is_inner(s) || is_flat(s) || length2(s) < k_crease_share * k_crease_share * length2(longest)) continue;
      if (crease == k_none || length2(s) > length2(crease)) crease = s;
    }
    return crease != k_none ? crease : longest;
  }

  /// Returns true if a triangle is a sliver that stays a sliver, whatever the number of pieces.
  bool is_hopeless(FaceId f) const {
    const double sharp = cotangent(f);
    if (!faces_[f].has_layer || sharp <= limit_) return false;
    if (sharp > k_sliver_reach * limit_ || is_locked_[faces_[f].source]) return true;
    SideId shortest = side_at(f, 0);
    for (std::uint32_t k = 1; k < 3; ++k)
      if (length2(side_at(f, k)) < length2(shortest)) shortest = side_at(f, k);
    return !has_room(side_before(shortest));  // tests the room at the smallest angle
  }

  /// Returns true if a triangle's halves would be sharper slivers than the triangle itself.
  bool spoils(SideId s) const {
    if (!faces_[face_of(s)].has_layer) return false;
    const Point m = 0.5 * (from(s) + to(s));
    const double worst = std::max(cotangent_of(from(s), m, opposite(s)), cotangent_of(m, to(s), opposite(s)));
    return worst > std::max(limit_, k_sharper * cotangent(face_of(s)));
  }

  /// Returns the edge to bisect to improve a sliver; none if bisection would not improve it.
  SideId side_to_bisect(FaceId f) const {
    const SideId s = long_side(f);
    if (!is_inner(s) || length2(s) < 4.0 * faces_[f].least_edge * faces_[f].least_edge) return k_none;
    return is_hopeless(f) || is_hopeless(face_of(twin(s))) || spoils(s) || spoils(twin(s)) ? k_none : s;
  }

  SideId end_of_path(SideId s) const {
    for (;;) {
      const SideId beyond = long_side(face_of(twin(s)));
      if (!is_inner(beyond) || length2(beyond) <= length2(s)) return s;
      double longest = 0.0;
      for (std::uint32_t k = 0; k < 3; ++k) longest = std::max(longest, length2(side_at(face_of(beyond), k)));
      if (longest <= k_path_ratio * k_path_ratio * length2(s) || is_hopeless(face_of(twin(beyond)))) return s;
      s = beyond;
    }
  }

  /// Bisects an edge and returns the four triangles adjacent to the new vertex.
  std::array<FaceId, 4> bisect(SideId s) {
    const SideId t = twin(s);
    const VertexId m = points_.push_back(0.5 * (from(s) + to(s)));
    const std::array<FaceId, 4> made = {face_of(s), static_cast<FaceId>(faces_.size()), face_of(t), static_cast<FaceId>(faces_.size() + 1)};
    halve(s, m);
    halve(t, m);
    join(side_at(made[0], 0), side_at(made[3], 0));
    join(side_at(made[1], 0), side_at(made[2], 0));
    n_new_ += 2;
    return made;
  }

  /// Changes (a, b, c) to (a, m, c), and appends (m, b, c) as the last face.
  void halve(SideId s, VertexId m) {
    const FaceId f = face_of(s), last = static_cast<FaceId>(faces_.size());
    const std::uint32_t k = s % 3, l = (k + 1) % 3, n = (k + 2) % 3;
    const SideId bc = twin(side_at(f, l)), ca = twin(side_at(f, n));
    WallFace &first = faces_[f], second = first;
    const WallFace whole = first;
    const std::array<double, 3> middle = middle_weights(whole.weights[k], whole.weights[l]);
    first.corners = {whole.corners[k], m, whole.corners[n]};
    first.weights = {whole.weights[k], middle, whole.weights[n]};
    second.corners = {m, whole.corners[l], whole.corners[n]};
    second.weights = {middle, whole.weights[l], whole.weights[n]};
    faces_.push_back(second);
    join(side_at(f, 2), ca);
    join(side_at(last, 1), bc);
    join(side_at(f, 1), side_at(last, 2));
  }

  const SliverOptions& options_;
  const RunContext& context_;
  double limit_;  ///< limit of the cotangent
  double flat_cosine_;
  Column<VertexId, Point> points_;
  const Column<TriangleId, std::uint8_t>& is_locked_;  ///< flags of the given triangles
  std::vector<WallFace> faces_;                        ///< all faces of the boundary
  std::priority_queue<Candidate> queue_;
  std::int64_t n_given_ = 0, n_new_ = 0, n_flips_ = 0, n_bisections_ = 0;
  bool is_over_budget_ = false;
};

struct SliverCount {
  std::int64_t n = 0;
  Point first{};
};

SliverCount count_slivers(const TriMesh& mesh, const Column<PatchId, std::uint8_t>& has_layer, double angle) {
  const double limit = 1.0 / std::tan(angle);
  SliverCount count;
  for (const TriangleId t : mesh.triangles.ids()) {
    if (has_layer[mesh.triangle_patch[t]] == 0) continue;
    const auto [a, b, c] = corners(mesh, t);
    if (cotangent_of(a, b, c) <= limit) continue;
    if (count.n++ == 0) count.first = (a + b + c) / 3.0;
  }
  return count;
}

bool crosses_itself(const TriMesh& mesh, const RunContext& context) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(mesh.n_triangles());
  for (const TriangleVertices& v : mesh.triangles) triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
  return find_crossings(mesh.points.raw(), triangles, context, 1).total > 0;
}

}  // namespace

std::string describe(const SliverReport& report) {
  return std::to_string(report.n_slivers) + " sliver triangles, " + std::to_string(report.n_flips) + " edges flipped: " + std::to_string(report.n_given) +
         " -> " + std::to_string(report.n_triangles) + " triangles; " + std::to_string(report.n_left) + " sliver triangles left";
}

SliverSplits split_slivers(TriMesh& boundary, const Column<PatchId, std::uint8_t>& has_layer, const SliverOptions& options, const RunContext& context) {
  SliverSplits unchanged;
  if (options.split_needles == 0.0) return unchanged;
  const SliverCount before = count_slivers(boundary, has_layer, options.split_needles);
  for (const TriangleId t : boundary.triangles.ids()) unchanged.report.n_given += has_layer[boundary.triangle_patch[t]] != 0 ? 1 : 0;
  unchanged.report.n_triangles = unchanged.report.n_given;
  unchanged.report.n_slivers = unchanged.report.n_left = before.n;
  unchanged.report.first_left = before.first;
  if (before.n == 0) return unchanged;

  const StageTimer timer(context, "needles");
  const Topology topology(boundary, context);
  if (topology.n_boundary_halfedges() > 0) return unchanged;  // split_domain rejects such a boundary later
  TriMesh split = boundary;
  SliverSplits result;
  Column<TriangleId, std::uint8_t> is_locked(boundary.n_triangles(), 0);
  double least = std::numeric_limits<double>::infinity();
  SliverOptions of_pass = options;
  of_pass.needle_budget = 0.0;
  for (int pass = 0; pass < k_sliver_passes; ++pass) {
    SliverSplitter splitter(boundary, topology, has_layer, is_locked, of_pass, context);
    splitter.run();
    if (const double sharpness = splitter.sharpness(); sharpness < least) {
      least = sharpness;
      result = splitter.put_into(split);
      result.report.is_over_budget &= pass > 0;
    }
    if (options.needle_budget == 0.0 || (pass > 0 && !splitter.lock_spoilt(boundary, is_locked))) break;
    of_pass.needle_budget = options.needle_budget;
  }
  if (!result.report.has_changed()) return unchanged;
  if (crosses_itself(split, context)) {
    context.info("sliver triangles: left unchanged, because flipped edges would cross the wall");
    return unchanged;
  }
  const SliverCount after = count_slivers(split, has_layer, options.split_needles);
  result.report.n_slivers = before.n;
  result.report.n_left = after.n;
  result.report.first_left = after.first;
  boundary = std::move(split);
  return result;
}

}  // namespace sterna::volmesh
