#include "volmesh/layer/first_node.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"

namespace sterna::volmesh {
namespace {

constexpr double k_tolerance = k_first_cell_slack;

struct Tally {
  std::int64_t n_full = 0, n_good = 0, n_compressed = 0, n_collapsed = 0;
  CompensatedSum area, smooth, good, mean_good, ridge;
  double worst = 0.0;
  Point location;

  void note(double deviation, const Point& p) {
    if (!(deviation > worst)) return;
    worst = deviation;
    location = p;
  }
};

Tally combined(Tally a, const Tally& b) {
  a.n_full += b.n_full;
  a.n_good += b.n_good;
  a.n_compressed += b.n_compressed;
  a.n_collapsed += b.n_collapsed;
  a.area.add(b.area);
  a.smooth.add(b.smooth);
  a.good.add(b.good);
  a.mean_good.add(b.mean_good);
  a.ridge.add(b.ridge);
  a.note(b.worst, b.location);
  return a;
}

double share(double part, double whole) { return whole > 0.0 ? part / whole : 1.0; }

}  // namespace

FirstNodeReport first_node_report(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, const Envelope& envelope,
                                  const Extrusion& extrusion, const RunContext& context) {
  const EnvelopeScale scale = scale_of(base, options);
  const auto is_full = [&](VertexId v) { return normal_height(base, envelope, v) >= scale.room_for_first_cell(v, extrusion.layers.layers_of_line(v.value())); };
  const auto first_step = [&](VertexId v) { return extrusion.points[extrusion.layers.node(v.value(), 1).index()] - base.wall.points[v]; };
  const Tally vertices = parallel_reduce(
      context, base.wall.n_vertices(), Tally{},
      [&](std::size_t begin, std::size_t end) {
        Tally part;
        for (std::size_t i = begin; i < end; ++i) {
          const VertexId v(i);
          part.n_collapsed += envelope.is_collapsed(v);
          if (!is_full(v)) {
            part.n_compressed += !envelope.is_collapsed(v);
            continue;
          }
          const double deviation = std::abs(dot(first_step(v), base.vertex_normal[v]) / scale.first_step(v) - 1.0);
          ++part.n_full;
          part.n_good += deviation <= k_tolerance;
          part.note(deviation, base.wall.points[v]);
        }
        return part;
      },
      combined);
  const Tally facets = parallel_reduce(
      context, base.wall.n_triangles(), Tally{},
      [&](std::size_t begin, std::size_t end) {
        Tally part;
        for (std::size_t i = begin; i < end; ++i) {
          const TriangleId t(i);
          const TriangleVertices& corners = base.wall.triangles[t];
          part.area.add(base.area[t]);
          const auto is_sharp = [&](VertexId v) { return classes.vertex[v].is_ridge || classes.vertex[v].is_corner; };
          if (std::any_of(corners.begin(), corners.end(), is_sharp)) {
            part.ridge.add(base.area[t]);
            continue;
          }
          if (!std::all_of(corners.begin(), corners.end(), is_full)) continue;
          double deviation = 0.0, mean = 0.0;
          for (const VertexId v : corners) {
            const double relative = dot(first_step(v), base.unit_normal[t]) / scale.h0(v) - 1.0;
            deviation = std::max(deviation, std::abs(relative));
            mean += relative / 3.0;
          }
          part.smooth.add(base.area[t]);
          if (deviation <= k_tolerance) part.good.add(base.area[t]);
          if (std::abs(mean) <= k_tolerance) part.mean_good.add(base.area[t]);
          part.note(deviation, base.wall.points[corners[0]]);
        }
        return part;
      },
      combined);
  FirstNodeReport report;
  report.n_lines = static_cast<std::int64_t>(base.wall.n_vertices());
  report.n_compressed = vertices.n_compressed;
  report.n_collapsed = vertices.n_collapsed;
  report.vertex_share = share(static_cast<double>(vertices.n_good), static_cast<double>(vertices.n_full));
  report.facet_share = share(facets.good.value(), facets.smooth.value());
  report.facet_mean_share = share(facets.mean_good.value(), facets.smooth.value());
  report.ridge_area = share(facets.ridge.value(), facets.area.value());
  report.worst_vertex = vertices.worst;
  report.worst_vertex_location = vertices.location;
  report.worst_facet = facets.worst;
  report.worst_facet_location = facets.location;
  return report;
}

}  // namespace sterna::volmesh
