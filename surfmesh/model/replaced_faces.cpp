#include "surfmesh/model/replaced_faces.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/mesh/bvh.h"
#include "surfmesh/model/deviation.h"

namespace sterna::surfmesh {
namespace {

constexpr int k_digits = 3;                 ///< digits of distances in messages
constexpr std::size_t k_sample_chunk = 32;  ///< triangles per chunk; a sample takes 5 to 50 us
/// Distances are measured at no fewer than this number of triangles. If there are more, every second, third etc. triangle is measured.
constexpr std::size_t k_sampled = 20'000;

using Corners = std::array<std::uint32_t, 3>;

Corners sorted_corners(const TriangleVertices& v) {
  Corners c{v[0].value(), v[1].value(), v[2].value()};
  std::sort(c.begin(), c.end());
  return c;
}

/// Returns for each point of `to` the lowest point of `from` with the same coordinates; invalid if there is none.
Column<VertexId, VertexId> same_points(const TriMesh& to, const TriMesh& from, const RunContext& context) {
  const auto less = [](const Point& a, const Point& b) { return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z); };
  std::vector<VertexId> order;
  order.reserve(from.n_vertices());
  for (const VertexId v : from.points.ids()) order.push_back(v);
  parallel_sort(context, order, [&](VertexId a, VertexId b) {
    const Point &p = from.points[a], &q = from.points[b];
    return less(p, q) || (!less(q, p) && a < b);
  });
  Column<VertexId, VertexId> same(to.n_vertices());
  parallel_for(context, to.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    const auto at = std::lower_bound(order.begin(), order.end(), to.points[v], [&](VertexId a, const Point& p) { return less(from.points[a], p); });
    if (at != order.end() && from.points[*at] == to.points[v]) same[v] = *at;
  });
  return same;
}

}  // namespace

ReplacedFaces find_replaced_faces(const ModelWall& model, const TriMesh& made, const TriMesh& repaired, const RunContext& context) {
  const Column<TriangleId, FaceId>& face_of = model.locations().triangle_face;
  const Column<VertexId, VertexId> same = same_points(repaired, made, context), own = same_points(made, made, context);
  std::vector<std::pair<Corners, TriangleId>> triangles;
  triangles.reserve(made.n_triangles());
  for (const TriangleId t : made.triangles.ids()) {
    const TriangleVertices& v = made.triangles[t];
    triangles.emplace_back(sorted_corners({own[v[0]], own[v[1]], own[v[2]]}), t);
  }
  parallel_sort(context, triangles, std::less<>());

  ReplacedFaces result;
  std::vector<std::uint8_t> is_left(made.n_triangles(), 0);
  std::vector<TriangleId> fresh;
  for (const TriangleId t : repaired.triangles.ids()) {
    const TriangleVertices& v = repaired.triangles[t];
    bool is_known = same[v[0]].is_valid() && same[v[1]].is_valid() && same[v[2]].is_valid();
    if (is_known) {
      const Corners key = sorted_corners({same[v[0]], same[v[1]], same[v[2]]});
      const auto at = std::lower_bound(triangles.begin(), triangles.end(), std::pair(key, TriangleId(0u)));
      is_known = at != triangles.end() && at->first == key;
      if (is_known) is_left[at->second.index()] = 1;
    }
    if (is_known) ++result.n_exact;
    else fresh.push_back(t);
  }

  const ModelDistance from_model(made, model, context);
  const std::size_t step = std::max<std::size_t>(1, fresh.size() / k_sampled);
  struct Finding {
    FaceId face;
    double distance = -1.0;
    Point location{};
  };
  std::vector<Finding> findings(fresh.size());
  parallel_for(
      context, fresh.size(),
      [&](std::size_t i) {
        const auto [a, b, c] = corners(repaired, fresh[i]);
        const Point middle = (a + b + c) / 3.0;
        findings[i].face = face_of[from_model.nearest_triangle(middle)];
        if (i % step != 0) return;
        const auto look = [&](const Point& p) {
          const double d = from_model(p);
          if (d <= findings[i].distance) return;
          findings[i].distance = d;
          findings[i].location = p;
        };
        look(middle);
        for (const VertexId v : repaired.triangles[fresh[i]])
          if (!same[v].is_valid()) look(repaired.points[v]);  // points that are the same in both are points of the model and need no test
      },
      k_sample_chunk);

  std::map<FaceId, ReplacedFace> faces;
  for (const Finding& finding : findings) {
    ReplacedFace& face = faces[finding.face];
    ++face.n_new;
    if (finding.distance <= face.distance) continue;
    face.distance = finding.distance;
    face.location = finding.location;
  }
  std::map<FaceId, std::int64_t> n_before;
  for (const TriangleId t : made.triangles.ids()) {
    ++n_before[face_of[t]];
    if (is_left[t.index()] == 0) ++faces[face_of[t]].n_gone;
  }
  for (auto& [f, face] : faces) {
    face.face = f;
    face.name = model.name_of(f);
    face.n_before = n_before[f];
    result.faces.push_back(face);
  }
  std::stable_sort(result.faces.begin(), result.faces.end(), [](const ReplacedFace& a, const ReplacedFace& b) { return a.distance > b.distance; });
  return result;
}

std::vector<std::string> to_lines(const std::vector<ReplacedFace>& faces, std::size_t most) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < std::min(most, faces.size()); ++i) {
    const ReplacedFace& face = faces[i];
    std::string line = "face " + std::to_string(face.face.value()) + " \"" + face.name + "\": ";
    line += face.n_before == 0 ? "" : std::to_string(face.n_gone) + " of " + std::to_string(face.n_before) + " triangles ";
    if (face.n_new == 0) line += "removed";
    else
      line += (face.n_before == 0 ? "" : "replaced by ") + std::to_string(face.n_new) + (face.n_before == 0 ? " triangles" : "") + ", at most " +
              number_text(face.distance, k_digits) + " m from the model, at " + format_point(face.location);
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace sterna::surfmesh
