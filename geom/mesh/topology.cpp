// Finds twins without a global sort. The half-edges that touch a vertex are its outgoing half-edges and their predecessors. Each edge is therefore processed at
// its lower vertex, from the vertex's own short list, sorted by (neighbour, sense, id).
#include "geom/mesh/topology.h"

#include <string>

#include "geom/base/error.h"
#include "geom/base/parallel.h"

namespace sterna {
namespace {

constexpr std::size_t k_max_trouble_edges = 10000;

/// A half-edge relative to one of its vertices.
struct Spoke {
  VertexId neighbour;
  bool is_incoming = false;
  HalfedgeId halfedge;
  friend auto operator<=>(const Spoke&, const Spoke&) = default;
};

/// An edge with more than two triangles or two of the same sense.
struct BadEdge {
  VertexId from, to;
  std::uint32_t n_forward = 0, n_backward = 0;
};

/// Sorts half-edges by starting vertex, then by id. This counting sort with two streaming passes is faster than any parallel sort here.
void sort_by_origin(std::size_t n_vertices, const Column<HalfedgeId, VertexId>& from, std::vector<std::uint64_t>& first, std::vector<HalfedgeId>& sorted) {
  first.assign(n_vertices + 1, 0);
  for (const VertexId v : from) ++first[v.index() + 1];
  for (std::size_t v = 0; v < n_vertices; ++v) first[v + 1] += first[v];
  sorted.resize(from.size());
  std::vector<std::uint64_t> cursor(first.begin(), first.end() - 1);
  for (const HalfedgeId h : from.ids()) sorted[cursor[from[h].index()]++] = h;
}

std::string describe(const TriMesh& mesh, const BadEdge& edge, PatchId patch) {
  std::string text = "edge of vertices " + std::to_string(edge.from.value()) + " and " + std::to_string(edge.to.value()) + ", ";
  const std::uint32_t n = edge.n_forward + edge.n_backward;
  text += n > 2 ? std::to_string(n) + " triangles where 2 are allowed" : std::string("two triangles of opposite orientation");
  if (patch.is_valid() && patch.index() < mesh.patches.size()) text += ", patch " + mesh.patches[patch].name;
  return text;
}

[[noreturn]] void throw_non_manifold(const TriMesh& mesh, const Topology& topology, const std::vector<BadEdge>& bad) {
  ErrorInfo info;
  info.code = ErrorCode::non_manifold_surface;
  info.attempted = "connecting " + std::to_string(mesh.n_triangles()) + " triangles";
  info.problem = std::to_string(bad.size()) + (bad.size() == 1 ? " edge does" : " edges do") + " not join one or two triangles of the same orientation";
  info.n_locations = static_cast<std::int64_t>(bad.size());
  info.hint = "remove duplicate or internal facets and make the orientation consistent";
  for (std::size_t i = 0; i < bad.size() && i < k_max_trouble_edges; ++i) {
    const Point& a = mesh.points[bad[i].from];
    const Point& b = mesh.points[bad[i].to];
    if (i < k_max_locations) {
      PatchId patch;
      for (const HalfedgeId h : topology.outgoing(bad[i].from))
        if (!patch.is_valid() && topology.to(h) == bad[i].to && mesh.triangle_patch.size() == mesh.n_triangles()) patch = mesh.triangle_patch[triangle_of(h)];
      info.locations.push_back({0.5 * (a + b), describe(mesh, bad[i], patch)});
    }
    const auto n = static_cast<std::uint32_t>(info.geometry.points.size());
    info.geometry.points.insert(info.geometry.points.end(), {a, b});
    info.geometry.edges.push_back({n, n + 1});
  }
  throw Error(std::move(info));
}

}  // namespace

Topology::Topology(const TriMesh& mesh, const RunContext& context) {
  const std::size_t n_vertices = mesh.n_vertices();
  const std::size_t n_halfedges = 3 * mesh.n_triangles();
  if (n_halfedges >= HalfedgeId::k_invalid) throw_id_overflow(n_halfedges);
  from_.resize(n_halfedges);
  parallel_for(context, mesh.n_triangles(), [&](std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) from_.raw()[3 * t + k] = mesh.triangles.raw()[t][k];
  });
  sort_by_origin(n_vertices, from_, first_outgoing_, outgoing_);

  twin_.resize(n_halfedges);
  // A vertex has at most two neighbours per triangle. The list of v is compacted and starts at slot 2 * first_outgoing_[v].
  std::vector<VertexId> slots(2 * n_halfedges);
  first_neighbour_.assign(n_vertices + 1, 0);
  const std::vector<BadEdge> bad = parallel_reduce(
      context, n_vertices, std::vector<BadEdge>{},
      [&](std::size_t begin, std::size_t end) {
        std::vector<BadEdge> found;
        std::vector<Spoke> spokes;
        for (std::size_t i = begin; i < end; ++i) {
          const VertexId v(static_cast<std::uint64_t>(i));
          spokes.clear();
          for (const HalfedgeId h : outgoing(v)) {
            spokes.push_back({to(h), false, h});
            spokes.push_back({from(previous(h)), true, previous(h)});
          }
          std::sort(spokes.begin(), spokes.end());
          VertexId* slot = slots.data() + 2 * first_outgoing_[i];
          for (std::size_t s = 0, e = 0; s < spokes.size(); s = e) {
            std::uint32_t n_incoming = 0;
            for (e = s; e < spokes.size() && spokes[e].neighbour == spokes[s].neighbour; ++e) n_incoming += spokes[e].is_incoming;
            const auto n_outgoing = static_cast<std::uint32_t>(e - s) - n_incoming;
            *slot++ = spokes[s].neighbour;
            if (spokes[s].neighbour < v) continue;
            if (n_outgoing > 1 || n_incoming > 1) {
              found.push_back({v, spokes[s].neighbour, n_outgoing, n_incoming});
            } else if (e - s == 2) {
              twin_[spokes[s].halfedge] = spokes[s + 1].halfedge;
              twin_[spokes[s + 1].halfedge] = spokes[s].halfedge;
            }
          }
          first_neighbour_[i + 1] = static_cast<std::uint64_t>(slot - (slots.data() + 2 * first_outgoing_[i]));
        }
        return found;
      },
      [](std::vector<BadEdge> all, std::vector<BadEdge> more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
      });
  if (!bad.empty()) throw_non_manifold(mesh, *this, bad);

  for (std::size_t v = 0; v < n_vertices; ++v) first_neighbour_[v + 1] += first_neighbour_[v];
  neighbours_.resize(first_neighbour_.back());
  parallel_for(context, n_vertices, [&](std::size_t v) {
    std::copy_n(slots.data() + 2 * first_outgoing_[v], first_neighbour_[v + 1] - first_neighbour_[v], neighbours_.data() + first_neighbour_[v]);
  });
  n_boundary_ = static_cast<std::size_t>(std::count(twin_.begin(), twin_.end(), HalfedgeId{}));
}

Components connected_components(const TriMesh& mesh, const Topology& topology) {
  constexpr std::uint32_t k_unseen = 0xffffffffu;
  Components result;
  result.component.resize(mesh.n_triangles(), k_unseen);
  std::vector<TriangleId> front;
  for (const TriangleId seed : mesh.triangles.ids()) {
    if (result.component[seed] != k_unseen) continue;
    result.component[seed] = result.count;
    front.assign(1, seed);
    while (!front.empty()) {
      const TriangleId t = front.back();
      front.pop_back();
      for (int corner = 0; corner < 3; ++corner) {
        const HalfedgeId twin = topology.twin(halfedge(t, corner));
        if (!twin.is_valid() || result.component[triangle_of(twin)] != k_unseen) continue;
        result.component[triangle_of(twin)] = result.count;
        front.push_back(triangle_of(twin));
      }
    }
    ++result.count;
  }
  return result;
}

}  // namespace sterna
