#include "volmesh/envelope/validity.h"

#include <algorithm>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "volmesh/envelope/corner_shape.h"
#include "volmesh/envelope/keep_inside.h"

namespace sterna::volmesh {
namespace {

/// g_1,min of eq. (6): the envelope triangle keeps at least this fraction of the wall triangle's area in projection on the wall.
constexpr double k_min_area_share = 0.01;
/// Smallest cosine between envelope normal and growth edge (warp, docs/method/validity.md, "Margins"), unless the cosine at the wall triangle itself is
/// smaller.
constexpr double k_min_warp_cosine = 0.05;
constexpr double k_warp_share_of_wall = 0.2;
/// If at most one in this number of vertices is marked, listing the triangles at these vertices is cheaper than testing all triangles.
constexpr std::size_t k_list_share = 16;
/// If the cosine between neighbouring normals is above this value, the edge is not folded: the angle between the triangles is then above 60 degrees.
constexpr double k_open_fold_cosine = -0.5;
/// Number of elements per task; a task takes about 50 us.
constexpr std::size_t k_validity_chunk = 512;

bool is_prism_valid_with_margin(const MacroElement& e) {
  std::array<Vec3, 3> top;
  for (std::size_t k = 0; k < 3; ++k) top[k] = e.wall[k] + e.height[k] * e.direction[k];
  const Vec3 n_wall = cross(e.wall[1] - e.wall[0], e.wall[2] - e.wall[0]);
  const Vec3 n_top = cross(top[1] - top[0], top[2] - top[0]);
  const double wall2 = norm2(n_wall);
  if (dot(n_wall, n_top) < k_min_area_share * wall2) return false;
  const double wall_length = std::sqrt(wall2);
  const double top_length = norm(n_top);
  const std::array<double, 3> wall_sines = corner_sines(e.wall[1] - e.wall[0], e.wall[2] - e.wall[0], wall_length);
  const std::array<double, 3> top_sines = corner_sines(top[1] - top[0], top[2] - top[0], top_length);
  for (std::size_t k = 0; k < 3; ++k)
    if (top_sines[k] < least_corner_sine(wall_sines[k])) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const double seen_from_wall = dot(n_wall, e.direction[k]) / wall_length;
    if (seen_from_wall <= 0.0) return false;
    const double needed = std::min(k_min_warp_cosine, k_warp_share_of_wall * seen_from_wall);
    if (dot(n_top, e.direction[k]) < needed * top_length) return false;
  }
  return is_wedge_valid({e.wall[0], e.wall[1], e.wall[2], top[0], top[1], top[2]});
}

}  // namespace

MacroElement macro_element(const LayerBase& base, const EnvelopeShape& envelope, TriangleId t) {
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

EdgeDiamond edge_diamond(const LayerBase& base, HalfedgeId h) {
  const Topology& topology = base.topology;
  return {topology.from(h), topology.to(h), topology.to(next(h)), topology.to(next(topology.twin(h)))};
}

FoldPoints wall_points(const LayerBase& base, const EdgeDiamond& diamond) {
  FoldPoints points;
  for (std::size_t k = 0; k < 4; ++k) points[k] = base.wall.points[diamond[k]];
  return points;
}

FoldPoints envelope_points(const LayerBase& base, const EnvelopeShape& shape, const EdgeDiamond& diamond) {
  FoldPoints points;
  for (std::size_t k = 0; k < 4; ++k) points[k] = shape.point(base.wall, diamond[k]);
  return points;
}

bool is_fold_open(const LayerBase& base, const EnvelopeShape& shape, HalfedgeId h) {
  if (base.topology.is_boundary(h)) return true;
  const EdgeDiamond diamond = edge_diamond(base, h);
  const Fold fold = fold_of(envelope_points(base, shape, diamond));
  if (!(fold.cosine < k_open_fold_cosine)) return true;  // also returned for a triangle without area, which another test covers
  return fold_slack(fold, fold_limit(wall_points(base, diamond))) > 0.0;
}

bool is_prism(const MacroElement& e) { return e.height[0] > 0.0 && e.height[1] > 0.0 && e.height[2] > 0.0; }

double scaled_jacobian(const MacroElement& e) {
  WedgePoints p;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = e.wall[k];
    p[k + 3] = e.wall[k] + e.height[k] * e.direction[k];
  }
  return wedge_quality(p);
}

namespace {

bool has_open_folds(const LayerBase& base, const EnvelopeShape& shape, TriangleId t) {
  return is_fold_open(base, shape, halfedge(t, 0)) && is_fold_open(base, shape, halfedge(t, 1)) && is_fold_open(base, shape, halfedge(t, 2));
}

}  // namespace

std::vector<TriangleId> low_quality_elements(const LayerBase& base, const EnvelopeShape& shape, double least_quality,
                                             const Column<VertexId, std::uint8_t>& marked, const RunContext& context) {
  using List = std::vector<TriangleId>;
  return parallel_reduce(
      context, base.wall.n_triangles(), List{},
      [&](std::size_t begin, std::size_t end) {
        List list;
        for (std::size_t i = begin; i < end; ++i) {
          const TriangleId t(i);
          const TriangleVertices& v = base.wall.triangles[t];
          if (!marked[v[0]] && !marked[v[1]] && !marked[v[2]]) continue;
          const MacroElement e = macro_element(base, shape, t);
          if (!is_macro_valid(e) || !has_open_folds(base, shape, t) || (is_prism(e) && !base.is_virtual(t) && scaled_jacobian(e) < least_quality))
            list.push_back(t);
        }
        return list;
      },
      [](List a, const List& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
}

std::vector<TriangleId> invalid_macros(const LayerBase& base, const EnvelopeShape& shape, const RunContext& context, const std::vector<VertexId>* around) {
  using List = std::vector<TriangleId>;
  const bool is_list = around && around->size() < base.wall.n_vertices() / k_list_share;
  List candidates;
  Column<VertexId, std::uint8_t> is_marked;
  if (is_list) {
    for (const VertexId v : *around)
      for (const HalfedgeId h : base.topology.outgoing(v)) candidates.push_back(triangle_of(h));
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  } else if (around) {
    is_marked.resize(base.wall.n_vertices());
    for (const VertexId v : *around) is_marked[v] = 1;
  }
  return parallel_reduce(
      context, is_list ? candidates.size() : base.wall.n_triangles(), List{},
      [&](std::size_t begin, std::size_t end) {
        List bad;
        for (std::size_t i = begin; i < end; ++i) {
          const TriangleId t = is_list ? candidates[i] : TriangleId(i);
          const TriangleVertices& v = base.wall.triangles[t];
          if (!is_marked.empty() && !is_marked[v[0]] && !is_marked[v[1]] && !is_marked[v[2]]) continue;
          if (!is_macro_valid(macro_element(base, shape, t)) || !has_open_folds(base, shape, t)) bad.push_back(t);
        }
        return bad;
      },
      [](List a, List b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      },
      k_validity_chunk);
}

ShapeChange difference(const EnvelopeShape& from, const EnvelopeShape& to, const RunContext& context) {
  using List = std::vector<VertexId>;
  ShapeChange change;
  change.vertices = parallel_reduce(
      context, from.height.size(), List{},
      [&](std::size_t begin, std::size_t end) {
        List moved;
        for (std::size_t i = begin; i < end; ++i) {
          const VertexId v(i);
          if (to.height[v] != from.height[v] || !(to.direction[v] == from.direction[v])) moved.push_back(v);
        }
        return moved;
      },
      [](List a, List b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
  change.direction.resize(change.vertices.size());
  change.height.resize(change.vertices.size());
  parallel_for(context, change.vertices.size(), [&](std::size_t i) {
    change.direction[i] = to.direction[change.vertices[i]];
    change.height[i] = to.height[change.vertices[i]];
  });
  return change;
}

TrialChange::TrialChange(Borrowed<const LayerBase> base, Borrowed<EnvelopeShape> shape, ShapeChange change, const RunContext& context)
    : base_(base), shape_(shape), context_(context), change_(std::move(change)), is_in_force_(base->wall.n_vertices(), 0), location_(base->wall.n_vertices()) {
  parallel_for(context, change_.vertices.size(), [&](std::size_t i) {
    const VertexId v = change_.vertices[i];
    if (!is_inside(base, v, change_.height[i] * change_.direction[i])) return;
    location_[v] = static_cast<std::uint32_t>(i);
    is_in_force_[v] = 1;
    exchange(i);
  });
}

void TrialChange::exchange(std::size_t i) {
  const VertexId v = change_.vertices[i];
  std::swap(change_.height[i], shape_.height[v]);
  std::swap(change_.direction[i], shape_.direction[v]);
}

std::vector<VertexId> TrialChange::vertices_in_force() const {
  std::vector<VertexId> result;
  for (const VertexId v : change_.vertices)
    if (is_in_force_[v]) result.push_back(v);
  return result;
}

bool TrialChange::take_back(VertexId v) {
  if (!is_in_force_[v]) return false;
  is_in_force_[v] = 0;
  exchange(location_[v]);
  return true;
}

std::vector<VertexId> TrialChange::take_back_invalid(std::vector<VertexId> around) {
  std::vector<VertexId> all;
  while (!around.empty()) {
    const std::vector<TriangleId> bad = invalid_macros(base_, shape_, context_, &around);
    around.clear();
    for (const TriangleId t : bad)
      for (const VertexId v : base_.wall.triangles[t])
        if (take_back(v)) around.push_back(v);
    all.insert(all.end(), around.begin(), around.end());
  }
  return all;
}

void apply_where_valid(const LayerBase& base, EnvelopeShape& envelope, const EnvelopeShape& proposal, const RunContext& context) {
  ShapeChange change = difference(envelope, proposal, context);
  std::vector<VertexId> vertices = change.vertices;
  TrialChange(base, envelope, std::move(change), context).take_back_invalid(std::move(vertices));
}

}  // namespace sterna::volmesh
