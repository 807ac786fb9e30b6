// Why the filled cavity is a valid mesh: every face of the cavity is strictly visible from the point, from inside (exact). A ray from the point therefore
// leaves the cavity once and never returns, so the cavity is star-shaped around the point, whatever the mesh was before.

#include "geom/tets/insert.h"

#include <algorithm>
#include <atomic>

#include "geom/tets/signs.h"

namespace sterna::tets {
namespace {

constexpr std::uint8_t k_inside = 1, k_outside = 2, k_dropped = 3;
/// A cavity has fallen apart if the tetrahedra that it loses because they are not visible from the point are more than this number and more than this fraction.
constexpr std::size_t k_least_loss = 30;
constexpr double k_lost_share = 0.5;
/// Limit of tetrahedra that are added to a cavity to keep it connected.
constexpr int k_most_grown = 200;

/// Returns true if a point is over a triangle and less than `height` above it.
bool is_low(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, double height) {
  const Vec3 normal = cross(b - a, c - a);
  if (dot(p - a, normal) >= height * norm(normal)) return false;
  return dot(cross(normal, b - a), p - a) >= 0.0 && dot(cross(normal, c - b), p - b) >= 0.0 && dot(cross(normal, a - c), p - c) >= 0.0;
}

}  // namespace

int perturbed_sphere_side(const TetMesh& mesh, const Corners& tet, std::uint32_t point) {
  const std::vector<Vec3>& p = mesh.points;
  if (const int side = sphere_side(p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]], p[point]); side != 0) return side;
  // A lifted corner moves the sphere upwards on that corner's side of the opposite face. A point below the sphere is then inside.
  std::array<std::uint32_t, 5> order = {tet[0], tet[1], tet[2], tet[3], point};
  std::ranges::sort(order, std::greater());
  for (const std::uint32_t highest : order) {
    if (highest == point) return -1;
    Corners moved = tet;
    *std::ranges::find(moved, highest) = point;
    if (const int side = orientation(p[moved[0]], p[moved[1]], p[moved[2]], p[moved[3]]); side != 0) return side;
  }
  return -1;  // the point coincides with a corner
}

Insertion Inserter::insert(std::uint32_t point, std::uint32_t start, const Room& room) {
  if (start == k_none || !mesh_.is_alive(start)) start = last_;
  if (start == k_none) return Insertion::foreign;
  Insertion why = Insertion::done;
  const Vec3 p = mesh_.points[point];
  const std::uint32_t base = locate(p, start, why);
  if (why != Insertion::done) return why;
  for (const std::uint32_t v : mesh_.nodes[base])
    if (why = nearness(v, p, room); why != Insertion::done) return why;
  why = gather(point, base, room);
  const std::size_t n_gathered = cavity_.size();
  if (why == Insertion::done) why = make_visible(p, base, room, 0);
  if (const auto n_left = static_cast<double>(cavity_.size());
      n_gathered > cavity_.size() + k_least_loss && n_left < (1.0 - k_lost_share) * static_cast<double>(n_gathered)) {
    unmark();
    why = gather(point, base, room);
    if (why == Insertion::done) why = make_visible(p, base, room, k_most_grown);
  }
  if (why == Insertion::done && faces_.size() > cavity_.size() + free_.size() + (end_ - next_)) why = Insertion::foreign;
  if (why == Insertion::done) fill(point);
  unmark();
  return why;
}

/// Walks from tetrahedron to tetrahedron through a face that has the point on its other side.
std::uint32_t Inserter::locate(const Vec3& p, std::uint32_t start, Insertion& why) {
  std::uint32_t t = start, from = k_none;
  for (std::size_t step = 0; step < target_.most_effort; ++step) {  // in meshes that are not Delaunay the walk may cycle
    const Corners& v = mesh_.nodes[t];
    const Corners& n = mesh_.neighbours[t];
    std::uint32_t next = t;
    bool is_barred = false;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t i = (k + static_cast<std::uint32_t>(step)) % 4;  // start with a different face in each step, which prevents short cycles
      if (n[i] != k_none && n[i] / 4 == from) continue;
      if (orientation(mesh_.points[v[k_face[i][0]]], mesh_.points[v[k_face[i][1]]], mesh_.points[v[k_face[i][2]]], p) >= 0) continue;
      if (n[i] == k_none) {
        is_barred = true;
        continue;
      }
      next = n[i] / 4;
      break;
    }
    if (next == t) {
      if (is_barred) why = Insertion::outside;
      return t;
    }
    if (is_foreign(next)) {
      why = Insertion::foreign;
      return t;
    }
    from = t;
    t = next;
  }
  why = Insertion::no_cavity;
  return t;
}

/// Collects the tetrahedra whose spheres contain the point, connected through faces that are not boundary faces.
Insertion Inserter::gather(std::uint32_t point, std::uint32_t base, const Room& room) {
  const Vec3 p = mesh_.points[point];
  cavity_.assign(1, base);
  touched_.assign(1, base);
  target_.mark[base] = k_inside;
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    for (const std::uint32_t n : mesh_.neighbours[cavity_[i]]) {
      if (n == k_none) continue;
      const std::uint32_t other = n / 4;
      if (is_foreign(other)) return Insertion::foreign;
      if (target_.mark[other] != 0) continue;
      touched_.push_back(other);
      if (perturbed_sphere_side(mesh_, mesh_.nodes[other], point) < 0) {
        target_.mark[other] = k_outside;
        continue;
      }
      target_.mark[other] = k_inside;
      cavity_.push_back(other);
      if (const Insertion near = nearness(mesh_.nodes[other][n % 4], p, room); near != Insertion::done) return near;
      if (cavity_.size() > target_.most_effort) return Insertion::no_cavity;
    }
  }
  return Insertion::done;
}

void Inserter::collect_faces() {
  faces_.clear();
  for (const std::uint32_t t : cavity_) {
    const Corners &v = mesh_.nodes[t], &n = mesh_.neighbours[t];
    for (std::size_t i = 0; i < 4; ++i)
      if (n[i] == k_none || target_.mark[n[i] / 4] != k_inside) faces_.push_back({{v[k_face[i][0]], v[k_face[i][1]], v[k_face[i][2]]}, n[i], t});
  }
}

/// Keeps the tetrahedra that are still connected with the base.
void Inserter::reach(std::uint32_t base) {
  constexpr std::uint8_t k_reached = 4;
  std::vector<std::uint32_t> reached = {base};
  target_.mark[base] = k_reached;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const std::uint32_t n : mesh_.neighbours[reached[i]]) {
      if (n == k_none || target_.mark[n / 4] != k_inside) continue;
      target_.mark[n / 4] = k_reached;
      reached.push_back(n / 4);
    }
  }
  for (const std::uint32_t t : cavity_)
    if (target_.mark[t] == k_inside) target_.mark[t] = k_outside;
  for (const std::uint32_t t : reached) target_.mark[t] = k_inside;
  cavity_ = std::move(reached);
}

/// Makes every face of the cavity visible from the point. If a face is not visible, the tetrahedron behind it is added, up to a limit; otherwise the
/// tetrahedron in front of it is removed. In a mesh that is far from Delaunay, such as after flips of the recovery, each removed tetrahedron obstructs others.
/// A single one can cost a cavity of a thousand tetrahedra, and the remaining ones are flat and long and obstruct the next point.
Insertion Inserter::make_visible(const Vec3& p, std::uint32_t base, const Room& room, int most_grown) {
  int n_grown = 0;
  for (;;) {
    bool has_changed = false;
    collect_faces();
    for (const CavityFace& face : faces_) {
      const Vec3 &a = mesh_.points[face.nodes[0]], &b = mesh_.points[face.nodes[1]], &c = mesh_.points[face.nodes[2]];
      if (orientation(a, b, c, p) > 0) {
        if (face.outer == k_none && is_low(a, b, c, p, room.to_boundary)) return Insertion::encroaches;
        continue;
      }
      if (face.outer != k_none && n_grown < most_grown) {
        const std::uint32_t other = face.outer / 4;
        if (target_.mark[other] == k_inside) continue;  // added since the faces were collected
        if (is_foreign(other)) return Insertion::foreign;
        if (target_.mark[other] != k_dropped && nearness(mesh_.nodes[other][face.outer % 4], p, room) == Insertion::done) {
          if (target_.mark[other] == 0) touched_.push_back(other);
          target_.mark[other] = k_inside;
          cavity_.push_back(other);
          ++n_grown;
          has_changed = true;
          continue;
        }
      }
      if (face.tet == base) return Insertion::no_cavity;
      if (target_.mark[face.tet] != k_inside) continue;
      target_.mark[face.tet] = k_dropped;
      has_changed = true;
    }
    if (!has_changed) return Insertion::done;
    reach(base);
  }
}

void Inserter::link(std::uint32_t a, std::uint32_t b, std::uint32_t face) {
  const std::uint64_t edge = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  const std::size_t last = edges_.size() - 1;
  for (std::size_t i = (edge * 0x9e3779b97f4a7c15ull >> 32) & last;; i = (i + 1) & last) {
    EdgeEntry& entry = edges_[i];
    if (entry.epoch != epoch_) {
      entry = {edge, epoch_, face};
      return;
    }
    if (entry.edge != edge) continue;
    mesh_.neighbours[face / 4][face % 4] = entry.face;
    mesh_.neighbours[entry.face / 4][entry.face % 4] = face;
    return;
  }
}

/// Creates one tetrahedron on each face of the cavity.
void Inserter::fill(std::uint32_t point) {
  if (2 * faces_.size() > edges_.size() / 2) edges_.assign(8 * faces_.size() | 1023, {});  // the following lines round this size up to a power of two
  if ((edges_.size() & (edges_.size() - 1)) != 0) {
    std::size_t size = 1024;
    while (size < edges_.size()) size *= 2;
    edges_.assign(size, {});
    epoch_ = 0;
  }
  if (++epoch_ == 0) {
    std::ranges::fill(edges_, EdgeEntry{});
    epoch_ = 1;
  }
  for (const std::uint32_t t : cavity_) {
    mesh_.nodes[t][0] = k_none;
    target_.mark[t] = 0;
  }
  std::size_t n_reused = 0;
  for (const CavityFace& face : faces_) {
    std::uint32_t t = 0;
    if (n_reused < cavity_.size()) t = cavity_[n_reused++];
    else if (!free_.empty()) {
      t = free_.back();
      free_.pop_back();
    } else t = next_++;
    mesh_.nodes[t] = {face.nodes[0], face.nodes[1], face.nodes[2], point};
    mesh_.neighbours[t] = {k_none, k_none, k_none, face.outer};
    target_.mark[t] = 0;
    target_.state[t] = 0;
    std::atomic_ref(target_.is_changed[t / k_chunk]).store(1, std::memory_order_relaxed);  // several blocks may share a chunk
    if (face.outer != k_none) mesh_.neighbours[face.outer / 4][face.outer % 4] = 4 * t + 3;
    link(face.nodes[1], face.nodes[2], 4 * t);
    link(face.nodes[0], face.nodes[2], 4 * t + 1);
    link(face.nodes[0], face.nodes[1], 4 * t + 2);
    last_ = t;
  }
  for (; n_reused < cavity_.size(); ++n_reused) free_.push_back(cavity_[n_reused]);
}

void Inserter::unmark() {
  for (const std::uint32_t t : touched_) target_.mark[t] = 0;
}

std::vector<std::uint32_t> Inserter::take_free() {
  for (; next_ < end_; ++next_) free_.push_back(next_);
  return std::move(free_);
}

}  // namespace sterna::tets
