#include "surfmesh/model/edge_cuts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geom/base/parallel.h"

namespace sterna::surfmesh {
namespace {

/// A segment turns by this at most, however short an edge is: a hole stays a hexagon.
constexpr double k_largest_turn = std::numbers::pi / 3.0;
/// Halvings of a sampling interval at most, while its length is above the size there.
constexpr int k_max_halvings = 24;
constexpr std::size_t k_closed_segments = 3;

struct Station {
  double t = 0.0;
  double metric = 0.0;  ///< length in sizes from the start
};

/// Sum of length / size along the edge, at stations near enough for the trapezoid rule.
std::vector<Station> measure(EdgeId e, const ModelEdge& edge, const EdgeSamples& samples, const SurfaceSizes& field) {
  std::vector<Station> stations{{samples.samples.front().t, 0.0}};
  struct End {
    double t;
    Point point;
    double size;
  };
  const auto end_at = [&](double t, const Point& p) { return End{t, p, field.on_edge(e, t)}; };
  struct Piece {
    End a, b;
    int depth;
  };
  std::vector<Piece> stack;
  End before = end_at(samples.samples.front().t, samples.samples.front().point);
  for (std::size_t i = 1; i < samples.samples.size(); ++i) {
    const End after = end_at(samples.samples[i].t, samples.samples[i].point);
    stack.push_back({before, after, 0});
    while (!stack.empty()) {
      const Piece piece = stack.back();
      stack.pop_back();
      const double length = distance(piece.a.point, piece.b.point);
      if (length > std::min(piece.a.size, piece.b.size) && piece.depth < k_max_halvings) {
        const double t = 0.5 * (piece.a.t + piece.b.t);
        const End middle = end_at(t, edge.curve->point(t));
        stack.push_back({middle, piece.b, piece.depth + 1});
        stack.push_back({piece.a, middle, piece.depth + 1});
        continue;
      }
      stations.push_back({piece.b.t, stations.back().metric + 0.5 * length * (1.0 / piece.a.size + 1.0 / piece.b.size)});
    }
    before = after;
  }
  return stations;
}

EdgeCut cut_at(const ModelEdge& edge, const std::vector<Station>& stations, std::size_t n_segments) {
  EdgeCut cut;
  std::size_t i = 0;
  const double total = stations.back().metric;
  for (std::size_t k = 1; k < n_segments; ++k) {
    const double wanted = total * static_cast<double>(k) / static_cast<double>(n_segments);
    while (i + 2 < stations.size() && stations[i + 1].metric < wanted) ++i;
    const double step = stations[i + 1].metric - stations[i].metric;
    const double share = step > 0.0 ? (wanted - stations[i].metric) / step : 0.5;
    cut.t.push_back(stations[i].t + share * (stations[i + 1].t - stations[i].t));
    cut.points.push_back(edge.curve->point(cut.t.back()));
  }
  return cut;
}

/// Place of a share of the length along the samples.
double t_at_share(const EdgeSamples& samples, double share) {
  const double wanted = share * samples.length;
  double along = 0.0;
  for (std::size_t i = 0; i + 1 < samples.samples.size(); ++i) {
    const double step = distance(samples.samples[i].point, samples.samples[i + 1].point);
    if (along + step >= wanted && step > 0.0) return samples.samples[i].t + (wanted - along) / step * (samples.samples[i + 1].t - samples.samples[i].t);
    along += step;
  }
  return samples.samples.back().t;
}

/// Share of the length up to t.
double share_at(const EdgeSamples& samples, double t) {
  double along = 0.0;
  for (std::size_t i = 0; i + 1 < samples.samples.size(); ++i) {
    const EdgeSample &a = samples.samples[i], &b = samples.samples[i + 1];
    const double step = distance(a.point, b.point);
    if (t <= b.t) return (along + step * (b.t > a.t ? (t - a.t) / (b.t - a.t) : 0.0)) / samples.length;
    along += step;
  }
  return 1.0;
}

/// The cut of the edge that stands for this one, at the same shares of the length.
EdgeCut cut_like(const EdgeSamples& own, const EdgeSamples& other, const EdgeCut& cut, bool is_reversed) {
  EdgeCut result;
  for (std::size_t k = 0; k < cut.t.size(); ++k) {
    const std::size_t i = is_reversed ? cut.t.size() - 1 - k : k;
    const double share = share_at(other, cut.t[i]);
    result.t.push_back(t_at_share(own, is_reversed ? 1.0 - share : share));
    result.points.push_back(cut.points[i]);
  }
  return result;
}

}  // namespace

Column<EdgeId, EdgeCut> cut_edges(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const SurfaceSizes& field, const RunContext& context) {
  const Column<EdgeId, std::vector<EdgeUsePlace>> uses = uses_of_edges(model);
  Column<EdgeId, std::vector<Station>> stations(model.edges.size());
  Column<EdgeId, std::size_t> n_segments(model.edges.size(), 1);
  parallel_for(context, model.edges.size(), [&](std::size_t i) {
    const EdgeId e(static_cast<std::uint64_t>(i));
    if (topology.is_point[e] != 0 || uses[e].empty() || topology.same_as[e].edge != e) return;
    stations[e] = measure(e, model.edges[e], edges[e], field);
    const auto by_size = static_cast<std::size_t>(std::max(1.0, std::round(stations[e].back().metric)));
    const auto by_turning = static_cast<std::size_t>(std::max(1.0, std::ceil(edges[e].turning / k_largest_turn - 0.01)));
    const bool is_closed = topology.corner[model.edges[e].start] == topology.corner[model.edges[e].end];
    n_segments[e] = std::max({by_size, by_turning, is_closed ? k_closed_segments : 1});
  }, 4);
  // Of several edges of one segment between the same corners all but the shortest are divided.
  struct Pair {
    CornerId a, b;
    double length;
    EdgeId edge;
    auto operator<=>(const Pair&) const = default;
  };
  std::vector<Pair> single;
  for (const EdgeId e : model.edges.ids()) {
    if (stations[e].empty() || n_segments[e] > 1) continue;
    const CornerId a = topology.corner[model.edges[e].start], b = topology.corner[model.edges[e].end];
    single.push_back({std::min(a, b), std::max(a, b), edges[e].length, e});
  }
  std::sort(single.begin(), single.end());
  for (std::size_t i = 1; i < single.size(); ++i)
    if (single[i].a == single[i - 1].a && single[i].b == single[i - 1].b) n_segments[single[i].edge] = 2;
  Column<EdgeId, EdgeCut> cuts(model.edges.size());
  parallel_for(context, model.edges.size(), [&](std::size_t i) {
    const EdgeId e(static_cast<std::uint64_t>(i));
    if (!stations[e].empty() && n_segments[e] > 1) cuts[e] = cut_at(model.edges[e], stations[e], n_segments[e]);
  }, 4);
  for (const EdgeId e : model.edges.ids())
    if (const SameEdge& same = topology.same_as[e]; same.edge != e && topology.is_point[e] == 0) cuts[e] = cut_like(edges[e], edges[same.edge], cuts[same.edge], same.is_reversed);
  return cuts;
}

}  // namespace sterna::surfmesh
