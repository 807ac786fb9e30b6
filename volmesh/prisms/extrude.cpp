#include "volmesh/prisms/extrude.h"

#include <algorithm>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/math/sub_volumes.h"
#include "volmesh/envelope/growth_law.h"
#include "volmesh/envelope/keep_inside.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_repair_rounds = 200;
constexpr int k_straighten_rounds = 3;     ///< rounds that reduce c_t before heights are touched
constexpr double k_neighbour_share = 0.5;  ///< of c_t that stays beside a straightened line
constexpr double k_equalise_factor = 1.05; ///< corners of an invalid cell keep heights within this ratio of the lowest
constexpr double k_shrink_factor = 0.7;    ///< of the heights of a cell that stays invalid with equal heights and straight lines
/// Below this c_t the exponential underflows and the line is straight to the last bit anyway.
constexpr double k_straight = 1e-3;

/// Normalised s(t) of eq. (12): 1 at the wall, exactly 0 at the top.
double normal_share(double t, double c) {
  if (c < k_straight) return 0.0;
  const double end = std::exp(-1.0 / c);
  return (std::exp(-t / c) - end) / (1.0 - end);
}

/// Valid in itself (G3) and with a positive dual mesh (G4); a tet has both at once.
bool is_prism_certain(const WedgePoints& p) { return is_wedge_valid(p) && are_sub_volumes_positive(p); }
bool is_pyramid_certain(const std::array<Vec3, 5>& p) { return is_pyramid_valid(p) && are_sub_volumes_positive(p); }

/// The lines' nodes, their curvature and what is needed to rebuild single ones.
class LineSet {
 public:
  LineSet(const LayerBase& base, const EnvelopeScale& scale, double c_t, const RunContext& context)
      : base_(base), scale_(scale), context_(context), curvature_(base.wall.n_vertices(), c_t) {}

  /// Numbers the nodes (collapsed lines have one) and places them all.
  void build(const Envelope& envelope) {
    const std::size_t n = base_.wall.n_vertices();
    layers_.n_layers = scale_.n;
    layers_.first_node.resize(n);
    layers_.is_collapsed.resize(n);
    std::uint64_t next = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const bool is_down = envelope.is_collapsed(VertexId(i));
      layers_.first_node[i] = NodeId(next).value();
      layers_.is_collapsed[i] = is_down ? 1 : 0;
      next += is_down ? 1u : static_cast<std::uint64_t>(scale_.n) + 1;
    }
    layers_.base.resize(base_.wall.n_triangles());
    parallel_for(context_, layers_.base.size(), [&](std::size_t i) {
      const TriangleVertices& v = base_.wall.triangles[TriangleId(i)];
      layers_.base[i] = {v[0].value(), v[1].value(), v[2].value()};
    });
    points_.resize(next);
    parallel_for(context_, n, [&](std::size_t i) { place(envelope, VertexId(i)); });
  }

  /// Columns with an invalid cell among those that touch a marked line (all if `dirty` is null), ascending.
  std::vector<std::size_t> invalid_columns(const Column<VertexId, std::uint8_t>* dirty) const {
    using List = std::vector<std::size_t>;
    return parallel_reduce(
        context_, layers_.n_columns(), List{},
        [&](std::size_t begin, std::size_t end) {
          List bad;
          for (std::size_t c = begin; c < end; ++c) {
            const auto& lines = layers_.base[c];
            if (dirty && !(*dirty)[VertexId(lines[0])] && !(*dirty)[VertexId(lines[1])] && !(*dirty)[VertexId(lines[2])]) continue;
            if (!is_column_valid(c)) bad.push_back(c);
          }
          return bad;
        },
        [](List a, List b) {
          a.insert(a.end(), b.begin(), b.end());
          return a;
        });
  }

  /// Replaces the nodes of one line. \pre its collapse state is the one of the last build().
  void place(const Envelope& envelope, VertexId v) {
    Point* p = points_.data() + layers_.first_node[v.index()];
    const Point wall = base_.wall.points[v];
    p[0] = wall;
    if (envelope.is_collapsed(v)) return;
    std::vector<double> t;
    t.resize(static_cast<std::size_t>(scale_.n) + 1);
    const double h = envelope.height[v];
    layer_parameters(scale_.h0, h, scale_.n, t.data());
    const Vec3 along = h * envelope.direction[v];
    const Vec3 aside = h * base_.vertex_normal[v] - along;
    const VertexConstraint& constraint = base_.constraint[v];
    const ConstraintSurface* surface =
        constraint.freedom == Freedom::surface ? base_.surfaces[static_cast<std::size_t>(constraint.on[0])].get() : nullptr;
    for (int j = 1; j < scale_.n; ++j) {
      const double s = normal_share(t[static_cast<std::size_t>(j)], curvature_[v]);
      p[j] = wall + t[static_cast<std::size_t>(j)] * (along + s * aside);
      if (surface) p[j] = surface->closest(p[j]);
    }
    p[scale_.n] = envelope.point(base_.wall, v);
  }

  double& curvature(VertexId v) { return curvature_[v]; }
  Extrusion take() { return {std::move(layers_), std::move(points_), 0}; }

 private:
  bool is_column_valid(std::size_t c) const {
    const int n_down = layers_.n_collapsed(c);
    if (n_down == 3) return true;
    if (n_down == 0) {
      const auto& lines = layers_.base[c];
      const std::array<const Point*, 3> p = {&points_[layers_.first_node[lines[0]]], &points_[layers_.first_node[lines[1]]], &points_[layers_.first_node[lines[2]]]};
      for (int j = 0; j < scale_.n; ++j)
        if (!is_prism_certain({p[0][j], p[1][j], p[2][j], p[0][j + 1], p[1][j + 1], p[2][j + 1]})) return false;
      return true;
    }
    for (int j = 0; j < scale_.n; ++j) {
      const Cell cell = layers_.cell(c, j);
      const auto at = [&](std::size_t i) { return points_[cell.nodes[i].index()]; };
      const bool is_valid = n_down == 1 ? is_pyramid_certain({at(0), at(1), at(2), at(3), at(4)}) : is_tet_valid({at(0), at(1), at(2), at(3)});
      if (!is_valid) return false;
    }
    return true;
  }

  const LayerBase& base_;
  EnvelopeScale scale_;
  const RunContext& context_;
  Column<VertexId, double> curvature_;
  LayerBlock layers_;
  std::vector<Point> points_;
};

/// c_t = 0 on the lines of the columns, half on the neighbouring lines. Marks what changed; false when all those lines were straight already.
bool straighten(const LayerBase& base, const std::vector<std::size_t>& columns, LineSet& lines, Column<VertexId, std::uint8_t>& changed) {
  bool has_changed = false;
  for (const std::size_t c : columns) {
    for (const VertexId v : base.wall.triangles[TriangleId(c)]) {
      if (lines.curvature(v) == 0.0) continue;
      lines.curvature(v) = 0.0;
      changed[v] = 1;
      has_changed = true;
      for (const VertexId other : base.topology.neighbours(v)) {
        if (lines.curvature(other) == 0.0) continue;
        lines.curvature(other) *= k_neighbour_share;
        changed[other] = 1;
      }
    }
  }
  return has_changed;
}

/// Equal heights over the corners of invalid columns; where they were equal already, lower ones.
void lower_columns(const LayerBase& base, const std::vector<std::size_t>& columns, const EnvelopeScale& scale, Envelope& envelope) {
  for (const std::size_t c : columns) {
    const TriangleVertices& v = base.wall.triangles[TriangleId(c)];
    double lowest = 0.0, tallest = 0.0;
    for (const VertexId vertex : v) {
      const double h = envelope.height[vertex];
      if (h > 0.0 && (lowest == 0.0 || h < lowest)) lowest = h;
      tallest = std::max(tallest, h);
    }
    const double bound = tallest > k_equalise_factor * lowest ? k_equalise_factor * lowest : k_shrink_factor * lowest;
    for (const VertexId vertex : v) lower(envelope, vertex, bound, HeightLimit::prism, scale);
  }
}

}  // namespace

Extrusion extrude_prisms(const LayerBase& base, const EnvelopeOptions& envelope_options, const PrismOptions& options, Envelope& envelope,
                         const RunContext& context) {
  const EnvelopeScale scale = scale_of(envelope_options);
  LineSet lines(base, scale, options.wall_perpendicularity, context);
  lines.build(envelope);
  const std::size_t n_vertices = base.wall.n_vertices();
  Column<VertexId, std::uint8_t> changed(n_vertices, 1);
  std::vector<std::size_t> bad = lines.invalid_columns(nullptr);
  for (int round = 0; !bad.empty(); ++round) {
    if (round == k_max_repair_rounds) {
      const auto place = base.wall.points[base.wall.triangles[TriangleId(bad.front())][0]];
      throw Error({.code = ErrorCode::envelope_failed,
                   .attempted = "extruding prisms",
                   .problem = std::to_string(bad.size()) + " columns stay invalid after " + std::to_string(round) + " repairs",
                   .places = {{place, "column " + std::to_string(bad.front())}},
                   .n_places = static_cast<std::int64_t>(bad.size()),
                   .hint = "report this surface"});
    }
    context.debug("extrusion: " + std::to_string(bad.size()) + " invalid columns in round " + std::to_string(round));
    changed.assign(n_vertices, 0);
    if (round < k_straighten_rounds && straighten(base, bad, lines, changed)) {
      parallel_for(context, n_vertices, [&](std::size_t i) {
        if (changed[VertexId(i)]) lines.place(envelope, VertexId(i));
      });
    } else {
      straighten(base, bad, lines, changed);
      const Column<VertexId, double> before = envelope.height;
      lower_columns(base, bad, scale, envelope);
      unwarp(base, envelope_options, HeightLimit::prism, envelope, context);
      seat_on_surfaces(base, envelope_options, nullptr, envelope, context);
      bool has_collapsed = false;
      for (const VertexId v : before.ids()) {
        if (before[v] == envelope.height[v]) continue;
        changed[v] = 1;
        has_collapsed = has_collapsed || envelope.is_collapsed(v);
      }
      if (has_collapsed) lines.build(envelope);
      else
        parallel_for(context, n_vertices, [&](std::size_t i) {
          if (changed[VertexId(i)]) lines.place(envelope, VertexId(i));
        });
    }
    for (const std::size_t c : bad)  // also where nothing was left to change in this round
      for (const VertexId v : base.wall.triangles[TriangleId(c)]) changed[v] = 1;
    bad = lines.invalid_columns(&changed);
  }
  std::int64_t n_straightened = 0;
  for (std::size_t i = 0; i < n_vertices; ++i) n_straightened += lines.curvature(VertexId(i)) < options.wall_perpendicularity ? 1 : 0;
  Extrusion result = lines.take();
  result.n_straightened = n_straightened;
  return result;
}

}  // namespace sterna::volmesh
