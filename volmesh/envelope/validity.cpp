#include "volmesh/envelope/validity.h"

#include <algorithm>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::volmesh {
namespace {

/// g_1,min of eq. (6): the envelope triangle keeps this share of the wall triangle's area, projected on the wall.
constexpr double k_min_area_share = 0.01;
/// Smallest cosine between envelope normal and growth edge (warp, method.md §4), unless the wall triangle is itself seen more flatly.
constexpr double k_min_warp_cosine = 0.05;
constexpr double k_warp_share_of_wall = 0.2;

bool is_prism_valid_with_margin(const MacroElement& e) {
  std::array<Vec3, 3> top;
  for (std::size_t k = 0; k < 3; ++k) top[k] = e.wall[k] + e.height[k] * e.direction[k];
  const Vec3 n_wall = cross(e.wall[1] - e.wall[0], e.wall[2] - e.wall[0]);
  const Vec3 n_top = cross(top[1] - top[0], top[2] - top[0]);
  const double wall2 = norm2(n_wall);
  if (dot(n_wall, n_top) < k_min_area_share * wall2) return false;
  const double wall_length = std::sqrt(wall2);
  const double top_length = norm(n_top);
  for (std::size_t k = 0; k < 3; ++k) {
    const double seen_from_wall = dot(n_wall, e.direction[k]) / wall_length;
    if (seen_from_wall <= 0.0) return false;
    const double needed = std::min(k_min_warp_cosine, k_warp_share_of_wall * seen_from_wall);
    if (dot(n_top, e.direction[k]) < needed * top_length) return false;
  }
  return is_wedge_valid({e.wall[0], e.wall[1], e.wall[2], top[0], top[1], top[2]});
}

}  // namespace

MacroElement macro_element(const LayerBase& base, const Envelope& envelope, TriangleId t) {
  MacroElement element;
  const TriangleVertices& v = base.wall.triangles[t];
  for (std::size_t k = 0; k < 3; ++k) {
    element.wall[k] = base.wall.points[v[k]];
    element.direction[k] = envelope.direction[v[k]];
    element.height[k] = envelope.height[v[k]];
  }
  return element;
}

bool is_macro_valid(const MacroElement& e) {
  const auto top = [&](std::size_t k) { return e.wall[k % 3] + e.height[k % 3] * e.direction[k % 3]; };
  const auto is_down = [&](std::size_t k) { return e.height[k % 3] == 0.0; };
  const int n_down = is_down(0) + is_down(1) + is_down(2);
  if (n_down == 0) return is_prism_valid_with_margin(e);
  if (n_down == 3) return true;
  std::size_t a = 0;
  while (is_down(a) != (n_down == 1)) ++a;
  const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
  if (n_down == 1) return is_pyramid_valid({e.wall[b], top(b), top(c), e.wall[c], e.wall[a]});
  return is_tet_valid({e.wall[a], e.wall[b], e.wall[c], top(a)});
}

std::vector<TriangleId> invalid_macros(const LayerBase& base, const Envelope& envelope, const RunContext& context,
                                       const Column<VertexId, std::uint8_t>* dirty) {
  using List = std::vector<TriangleId>;
  return parallel_reduce(
      context, base.wall.n_triangles(), List{},
      [&](std::size_t begin, std::size_t end) {
        List bad;
        for (std::size_t i = begin; i < end; ++i) {
          const TriangleId t(i);
          if (dirty) {
            const TriangleVertices& v = base.wall.triangles[t];
            if (!(*dirty)[v[0]] && !(*dirty)[v[1]] && !(*dirty)[v[2]]) continue;
          }
          if (!is_macro_valid(macro_element(base, envelope, t))) bad.push_back(t);
        }
        return bad;
      },
      [](List a, List b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
}

void apply_where_valid(const LayerBase& base, Envelope& envelope, const Envelope& proposal, const RunContext& context,
                       const Column<VertexId, std::uint8_t>* first_dirty) {
  const std::size_t n = base.wall.n_vertices();
  Column<VertexId, std::uint8_t> moved(n, 0);
  Envelope mixed = envelope;
  parallel_for(context, n, [&](std::size_t i) {
    const VertexId v(i);
    if (proposal.height[v] == envelope.height[v] && proposal.direction[v] == envelope.direction[v]) return;
    moved[v] = 1;
    mixed.height[v] = proposal.height[v];
    mixed.direction[v] = proposal.direction[v];
  });
  Column<VertexId, std::uint8_t> dirty = first_dirty ? *first_dirty : moved;
  while (true) {
    bool has_reverted = false;
    const std::vector<TriangleId> bad = invalid_macros(base, mixed, context, &dirty);
    dirty.assign(n, 0);
    for (const TriangleId t : bad) {
      for (const VertexId v : base.wall.triangles[t]) {
        if (!moved[v]) continue;
        moved[v] = 0;
        dirty[v] = 1;
        mixed.height[v] = envelope.height[v];
        mixed.direction[v] = envelope.direction[v];
        has_reverted = true;
      }
    }
    if (!has_reverted) break;
  }
  envelope.height = std::move(mixed.height);
  envelope.direction = std::move(mixed.direction);
}

}  // namespace sterna::volmesh
