// Finds vertices that nearly touch an unconnected wall across the fluid. Each vertex searches for triangles within a small fraction of its edges. Triangles at
// the vertex and at its neighbours are excluded.
#include "geom/base/number_text.h"
#include "geom/math/nearest.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

/// Largest cosine between the normals of vertex and triangle. Triangles with a larger cosine do not face the vertex across the fluid; they are behind the wall.
constexpr double k_facing_cosine = 0.0;

struct Contact {
  VertexId vertex;
  TriangleId opposite;
  double share = 0.0;  ///< distance as a fraction of the mean edge at the vertex
  friend bool operator<(const Contact& a, const Contact& b) { return a.share != b.share ? a.share < b.share : a.vertex < b.vertex; }
};

class ContactFinder {
 public:
  ContactFinder(const LayerBase& base, const Collider& collider) : base_(base), collider_(collider) {}

  /// Finds the contact of a vertex. `buffer` is scratch memory.
  void find(VertexId v, double limit, std::vector<std::uint32_t>& buffer, std::vector<Contact>& contacts) const {
    const auto outgoing = base_.topology.outgoing(v);
    if (outgoing.empty()) return;
    const Point p = base_.wall.points[v];
    Contact nearest{.vertex = v, .opposite = {}, .share = limit};
    buffer.clear();
    collider_.find_walls(box_around(p, limit * base_.mean_edge[v]), buffer);
    for (const std::uint32_t item : buffer) {
      const TriangleId t(item);
      if (is_own(v, t) || dot(base_.unit_normal[t], base_.vertex_normal[v]) > k_facing_cosine) continue;
      const Point q = nearest_on_triangle(p, corners(base_.wall, t));
      const double share = distance(p, q) / base_.mean_edge[v];
      if (share >= nearest.share && !(share == nearest.share && t < nearest.opposite)) continue;
      // The fluid must lie between vertex and triangle: the triangle ahead of the vertex, and the vertex in front of the triangle.
      if (dot(q - p, base_.vertex_normal[v]) <= 0.0 || dot(p - q, base_.unit_normal[t]) <= 0.0) continue;
      nearest.share = share;
      nearest.opposite = t;
    }
    if (nearest.opposite.is_valid()) contacts.push_back(nearest);
  }

 private:
  static Box box_around(const Point& p, double reach) {
    Box box;
    box.add(p - Vec3{reach, reach, reach});
    box.add(p + Vec3{reach, reach, reach});
    return box;
  }
  /// Returns true for a triangle at the vertex or at one of its neighbours. Such a triangle is no contact.
  bool is_own(VertexId v, TriangleId t) const {
    for (const VertexId corner : base_.wall.triangles[t]) {
      if (corner == v) return true;
      const auto around = base_.topology.neighbours(v);
      if (std::binary_search(around.begin(), around.end(), corner)) return true;
    }
    return false;
  }

  const LayerBase& base_;
  const Collider& collider_;
};

}  // namespace

void survey_contacts(const Survey& survey, const LayerBase& base, const Collider& collider, const WallMap& map) {
  const double limit = survey.request.limits.contact;
  if (limit <= 0.0) return;
  const ContactFinder finder(base, collider);
  std::vector<Contact> contacts = parallel_reduce(
      survey.context, base.wall.n_vertices(), std::vector<Contact>{},
      [&](std::size_t begin, std::size_t end) {
        std::vector<Contact> list;
        std::vector<std::uint32_t> buffer;
        for (std::size_t i = begin; i < end; ++i) finder.find(VertexId(static_cast<std::uint64_t>(i)), limit, buffer, list);
        return list;
      },
      joined_lists<Contact>);
  if (contacts.empty()) return;
  std::sort(contacts.begin(), contacts.end());
  Finding finding{.kind = FindingKind::contact,
                  .severity = Severity::warn,
                  .count = static_cast<std::int64_t>(contacts.size()),
                  .value = contacts.front().share,
                  .limit = limit};
  std::vector<TriangleId> where;
  for (const Contact& contact : contacts) {
    const TriangleId opposite = map.triangle(contact.opposite);
    where.push_back(opposite);
    for (const HalfedgeId h : base.topology.outgoing(contact.vertex)) where.push_back(map.triangle(triangle_of(h)));
    if (finding.locations.size() >= survey.n_locations()) continue;
    const double gap = contact.share * base.mean_edge[contact.vertex];
    finding.locations.push_back({base.wall.points[contact.vertex], survey.patch_of(where.back()), contact.share,
                                 "vertex " + std::to_string(contact.vertex.value()) + ", " + in_metres(gap, k_text_digits) + " from triangle " +
                                     std::to_string(opposite.value()) + " (" + survey.patch_of(opposite) + ")"});
  }
  finding.text = count_of(finding.count, "vertex nearly touches", "vertices nearly touch") + " the opposite wall, closer than " +
                 number_text(limit, k_text_digits) + " edge lengths (" + number_text(finding.value, k_text_digits) +
                 " at the closest): the layer collapses there, and tetrahedra engines fail";
  finding.advice = "move the bodies apart by at least one edge length, or make them overlap and unite them with `sterna union`";
  add_finding(survey.report, std::move(finding), where);
}

}  // namespace sterna::volmesh
