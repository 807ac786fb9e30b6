#include "surfmesh/model/edge_cuts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "geom/base/parallel.h"

namespace sterna::surfmesh {
namespace {

/// Largest turn of a segment, however short the edge is. A hole is therefore at least a hexagon.
constexpr double k_largest_turn = std::numbers::pi / 3.0;
/// Largest number of halvings of a sampling interval. Intervals are halved while they are longer than the size there.
constexpr int k_max_halvings = 24;
constexpr std::size_t k_closed_segments = 3;

struct Station {
  double t = 0.0;
  double metric = 0.0;  ///< length from the start, in multiples of the local size
};

/// Integrates length / size along the edge. The stations are close enough for the trapezoidal rule. `size_at` returns the size in metres for a parameter.
template <class SizeAt>
std::vector<Station> measure(const ModelEdge& edge, const EdgeSamples& samples, const SizeAt& size_at) {
  std::vector<Station> stations{{samples.samples.front().t, 0.0}};
  struct End {
    double t;
    Point point;
    double size;
  };
  const auto end_at = [&](double t, const Point& p) { return End{t, p, size_at(t)}; };
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

/// Returns the samples between two parameters, including samples at both parameters.
EdgeSamples part_of(const ModelEdge& edge, const EdgeSamples& whole, double from, double to) {
  EdgeSamples part;
  part.samples.push_back({from, edge.curve->point(from), 0.0});
  for (const EdgeSample& s : whole.samples)
    if (s.t > from && s.t < to) part.samples.push_back(s);
  part.samples.push_back({to, edge.curve->point(to), 0.0});
  return part;
}

/// Returns that part with its own length and turning angle.
EdgeSamples measured_part_of(const ModelEdge& edge, const EdgeSamples& whole, double from, double to) {
  if (from == whole.samples.front().t && to == whole.samples.back().t) return whole;
  EdgeSamples part = part_of(edge, whole, from, to);
  measure_polyline(part);
  return part;
}

/// Returns the parameter between `from` and `end` whose point is `step` metres from the point at `from`; returns `end` if there is none.
double t_at_step(const Curve& curve, double from, double end, double step) {
  const Point start = curve.point(from);
  constexpr int k_halvings = 60, k_widenings = 40;
  double near = from, far = end;
  // The first bracket is near the start, so that a curve that turns back is not intersected behind its bend.
  double ahead = end - from;
  for (int i = 0; i < k_widenings && distance(curve.point(from + 0.5 * ahead), start) >= step; ++i) ahead *= 0.5;
  far = from + ahead;
  if (distance(curve.point(far), start) < step) return end;
  for (int i = 0; i < k_halvings; ++i) {
    const double middle = 0.5 * (near + far);
    (distance(curve.point(middle), start) < step ? near : far) = middle;
  }
  return 0.5 * (near + far);
}

/// Returns the locations where the rows of a band meet an edge that leaves the band, starting at the corner.
std::vector<double> row_locations(EdgeId e, const ModelEdge& edge, const EdgeSamples& samples, std::size_t end, const CrossingEnd& crossing,
                                  const SurfaceSizes& field) {
  constexpr double k_share_of_edge = 0.45;  // less than half, because the other end may have rows, too
  constexpr int k_step_iterations = 4;      // few steps suffice: the edge turns little within a step, so each iteration gains a digit or two
  const double start = end == 0 ? edge.range.from : edge.range.to, stop = end == 0 ? edge.range.to : edge.range.from;
  const double spacing = std::min(crossing.longest, field.on_edge(e, start));
  std::vector<double> locations;
  double t = start, height = 0.0, along = 0.0;
  while (locations.size() < k_max_rows) {
    const CurveDerivatives d = edge.curve->derivatives(t);
    const double speed2 = norm2(d.first), curvature = speed2 > 0.0 ? norm(cross(d.first, d.second)) / (speed2 * std::sqrt(speed2)) : 0.0;
    height = crossing.law.next_height(height, std::isfinite(curvature) ? curvature : 0.0);
    // Heights are measured across the rows, which run parallel to the edges of the band. Steps along this edge are longer than the height, depending on the
    // direction of their chord.
    Vec3 chord = normalized(d.first);
    double step = height, next = t;
    for (int i = 0; i < k_step_iterations; ++i) {
      step = height / std::max(k_steep_sine, std::min(norm(cross(chord, crossing.along[0])), norm(cross(chord, crossing.along[1]))));
      next = t_at_step(*edge.curve, t, stop, step);
      chord = normalized(edge.curve->point(next) - edge.curve->point(t));
    }
    along += step;
    if (height > k_isotropic_height * spacing || along > k_share_of_edge * samples.length) break;
    t = next;
    if (t == stop) break;
    locations.push_back(t);
  }
  return locations;
}

EdgeCut cut_at(const ModelEdge& edge, const std::vector<Station>& stations, std::size_t n_segments) {
  EdgeCut cut;
  std::size_t i = 0;
  const double total = stations.back().metric;
  for (std::size_t k = 1; k < n_segments; ++k) {
    const double target = total * static_cast<double>(k) / static_cast<double>(n_segments);
    while (i + 2 < stations.size() && stations[i + 1].metric < target) ++i;
    const double step = stations[i + 1].metric - stations[i].metric;
    const double share = step > 0.0 ? (target - stations[i].metric) / step : 0.5;
    cut.t.push_back(stations[i].t + share * (stations[i + 1].t - stations[i].t));
    cut.points.push_back(edge.curve->point(cut.t.back()));
  }
  return cut;
}

/// Returns the parameter at a fraction of the length along the samples.
double t_at_share(const EdgeSamples& samples, double share) {
  const double target = share * samples.length;
  double along = 0.0;
  for (std::size_t i = 0; i + 1 < samples.samples.size(); ++i) {
    const double step = distance(samples.samples[i].point, samples.samples[i + 1].point);
    if (along + step >= target && step > 0.0) return samples.samples[i].t + (target - along) / step * (samples.samples[i + 1].t - samples.samples[i].t);
    along += step;
  }
  return samples.samples.back().t;
}

/// Returns the fraction of the length up to t.
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

EdgeCut cut_evenly(const ModelEdge& edge, const EdgeSamples& samples, std::size_t n_segments) {
  EdgeCut cut;
  for (std::size_t k = 1; k < n_segments; ++k) {
    cut.t.push_back(t_at_share(samples, static_cast<double>(k) / static_cast<double>(n_segments)));
    cut.points.push_back(edge.curve->point(cut.t.back()));
  }
  return cut;
}

/// Adds the rows at both ends of a cut. The cut between them begins at the last row of each end.
void add_rows(const ModelEdge& edge, const std::array<std::vector<double>, 2>& rows, EdgeCut& cut) {
  std::vector<double> t = rows[0];
  t.insert(t.end(), cut.t.begin(), cut.t.end());
  t.insert(t.end(), rows[1].rbegin(), rows[1].rend());
  cut = {std::move(t), {}, {rows[0].size(), rows[1].size()}};
  for (const double at : cut.t) cut.points.push_back(edge.curve->point(at));
}

/// Cuts the other long side of a strip at the same length fractions.
EdgeCut cut_by_shares(const ModelEdge& edge, const EdgeSamples& own, const EdgeSamples& other, const EdgeCut& cut, bool is_against) {
  EdgeCut result;
  for (std::size_t k = 0; k < cut.t.size(); ++k) {
    const double share = share_at(other, cut.t[is_against ? cut.t.size() - 1 - k : k]);
    result.t.push_back(t_at_share(own, is_against ? 1.0 - share : share));
    result.points.push_back(edge.curve->point(result.t.back()));
  }
  return result;
}

/// Cuts an edge like the edge that represents it, at the same length fractions.
EdgeCut cut_like(const EdgeSamples& own, const EdgeSamples& other, const EdgeCut& cut, bool is_reversed) {
  EdgeCut result;
  for (std::size_t k = 0; k < cut.t.size(); ++k) {
    const std::size_t i = is_reversed ? cut.t.size() - 1 - k : k;
    const double share = share_at(other, cut.t[i]);
    result.t.push_back(t_at_share(own, is_reversed ? 1.0 - share : share));
    result.points.push_back(cut.points[i]);
  }
  result.n_rows = {cut.n_rows[is_reversed ? 1 : 0], cut.n_rows[is_reversed ? 0 : 1]};
  return result;
}

/// Returns the number of segments for a length measured in sizes. The number is rounded up for band edges, so that their segments are never too long.
std::size_t segments_by_size(double metric, bool is_band) {
  constexpr double k_whole = 0.02;  // fraction of a segment by which a length may exceed a whole number before it is rounded up
  return static_cast<std::size_t>(std::max(1.0, is_band ? std::ceil(metric - k_whole) : std::round(metric)));
}

std::size_t segments_by_turning(double turning) { return static_cast<std::size_t>(std::max(1.0, std::ceil(turning / k_largest_turn - 0.01))); }

/// Cuts pieces that are images of each other. One piece of each kind is cut, with the smallest of all sizes on the pieces of that kind. Its cuts are moved to
/// the others.
class PeriodicCutter {
 public:
  PeriodicCutter(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const WingBands& bands,
                 const PeriodicBorders& borders, const SurfaceSizes& field)
      : model_(model),
        edges_(edges),
        topology_(topology),
        bands_(bands),
        borders_(borders),
        field_(field),
        samples_(borders.pieces.size()),
        stations_(borders.pieces.size()),
        n_(borders.pieces.size(), 1),
        n_even_(borders.pieces.size(), 0) {
    of_kind_.resize(borders.pieces.size());
    for (std::size_t i = 0; i < borders.pieces.size(); ++i) of_kind_[borders.pieces[i].like].push_back(i);
  }

  bool has(EdgeId e) const { return !borders_.empty() && borders_.of_edge[e][1] > 0; }

  void measure_all(const RunContext& context) {
    parallel_for(
        context, borders_.pieces.size(), [&](std::size_t i) { measure_kind(i); }, 1);
  }

  std::size_t n_segments(EdgeId e) const {
    const auto [first, n] = borders_.of_edge[e];
    std::size_t sum = 0;
    for (std::size_t i = first; i < first + n; ++i) sum += n_[borders_.pieces[i].like];
    return sum;
  }
  /// Sets the minimum number of segments to two, for the edge and each of its images.
  void divide(EdgeId e) {
    for (std::size_t i = borders_.of_edge[e][0]; i < borders_.of_edge[e][0] + borders_.of_edge[e][1]; ++i)
      n_[borders_.pieces[i].like] = std::max<std::size_t>(n_[borders_.pieces[i].like], 2);
  }

  EdgeCut cut(EdgeId e) const {
    const auto [first, n] = borders_.of_edge[e];
    EdgeCut whole;
    for (std::size_t i = first; i < first + n; ++i) {
      const EdgeCut part = cut_piece(i);
      whole.t.insert(whole.t.end(), part.t.begin(), part.t.end());
      whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
      if (i + 1 == first + n) break;
      const BorderStop& stop = borders_.stops[e][i - first];
      whole.t.push_back(stop.t);
      whole.points.push_back(stop.point);
    }
    return whole;
  }

 private:
  void measure_kind(std::size_t first) {
    const PeriodicPiece& piece = borders_.pieces[first];
    if (piece.like != first) return;
    const std::vector<std::size_t>& kind = of_kind_[first];
    samples_[first] = measured_part_of(model_.edges[piece.edge], edges_[piece.edge], piece.range.from, piece.range.to);
    stations_[first] = measure(model_.edges[piece.edge], samples_[first], [&](double t) {
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t i : kind) least = std::min(least, field_.on_edge(borders_.pieces[i].edge, image_parameter(borders_, i, t, model_, edges_)));
      return least;
    });
    bool is_band = false;
    for (const std::size_t i : kind) {
      const EdgeId e = borders_.pieces[i].edge;
      is_band = is_band || bands_.edges[e].has_value();
      const std::size_t n_pieces = borders_.of_edge[e][1];
      if (n_pieces == 1) n_even_[first] = std::max(n_even_[first], bands_.n_short[e]);
      if (topology_.corner[model_.edges[e].start] == topology_.corner[model_.edges[e].end])
        n_[first] = std::max(n_[first], (k_closed_segments + n_pieces - 1) / n_pieces);
    }
    n_[first] = std::max({n_[first], segments_by_size(stations_[first].back().metric, is_band), segments_by_turning(samples_[first].turning)});
    if (n_even_[first] > 0) n_[first] = n_even_[first];
  }

  EdgeCut cut_piece(std::size_t i) const {
    const PeriodicPiece& piece = borders_.pieces[i];
    const PeriodicPiece& first = borders_.pieces[piece.like];
    const ModelEdge& edge = model_.edges[first.edge];
    EdgeCut cut = n_even_[piece.like] > 0 ? cut_evenly(edge, samples_[piece.like], n_[piece.like]) : cut_at(edge, stations_[piece.like], n_[piece.like]);
    if (piece.like == i) return cut;
    for (std::size_t k = 0; k < cut.t.size(); ++k) {
      cut.points[k] += piece.translation;
      cut.t[k] = nearest_parameter(model_.edges[piece.edge], edges_[piece.edge], piece.range, cut.points[k]);
    }
    if (piece.is_reversed) {
      std::ranges::reverse(cut.t);
      std::ranges::reverse(cut.points);
    }
    return cut;
  }

  const Model& model_;
  const Column<EdgeId, EdgeSamples>& edges_;
  const ModelTopology& topology_;
  const WingBands& bands_;
  const PeriodicBorders& borders_;
  const SurfaceSizes& field_;
  std::vector<std::vector<std::size_t>> of_kind_;
  std::vector<EdgeSamples> samples_;
  std::vector<std::vector<Station>> stations_;
  std::vector<std::size_t> n_;
  std::vector<std::size_t> n_even_;  ///< given number of equal segments, such as at the end of a strip; 0: sizes determine the number
};

}  // namespace

Column<EdgeId, EdgeCut> cut_edges(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const WingBands& bands,
                                  const PeriodicBorders& borders, const SurfaceSizes& field, const RunContext& context) {
  PeriodicCutter alike(model, edges, topology, bands, borders, field);
  alike.measure_all(context);
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
  Column<EdgeId, std::vector<Station>> stations(model.edges.size());
  Column<EdgeId, std::size_t> n_segments(model.edges.size(), 1);
  Column<EdgeId, std::array<std::vector<double>, 2>> rows(model.edges.size());
  parallel_for(
      context, model.edges.size(),
      [&](std::size_t i) {
        const EdgeId e(static_cast<std::uint64_t>(i));
        if (topology.is_point[e] != 0 || uses[e].empty() || topology.same_as[e].edge != e || alike.has(e)) return;
        Interval between = model.edges[e].range;
        for (const std::size_t end : {0u, 1u})
          if (bands.crossings[e][end].is_any && !bands.edges[e]) {
            rows[e][end] = row_locations(e, model.edges[e], edges[e], end, bands.crossings[e][end], field);
            if (!rows[e][end].empty()) (end == 0 ? between.from : between.to) = rows[e][end].back();
          }
        const bool has_rows = !rows[e][0].empty() || !rows[e][1].empty();
        stations[e] = measure(model.edges[e], has_rows ? part_of(model.edges[e], edges[e], between.from, between.to) : edges[e],
                              [&](double t) { return field.on_edge(e, t); });
        const std::size_t by_size = segments_by_size(stations[e].back().metric, bands.edges[e].has_value());
        if (bands.n_short[e] > 0) {
          n_segments[e] = bands.n_short[e];
          return;
        }
        const std::size_t by_turning = segments_by_turning(edges[e].turning);
        const bool is_closed = topology.corner[model.edges[e].start] == topology.corner[model.edges[e].end];
        n_segments[e] = std::max({by_size, by_turning, is_closed ? k_closed_segments : 1});
      },
      4);
  // If several edges with a single segment join the same corners, all except the shortest are divided.
  struct Pair {
    CornerId a, b;
    double length;
    EdgeId edge;
    auto operator<=>(const Pair&) const = default;
  };
  std::vector<Pair> single;
  for (const EdgeId e : model.edges.ids()) {
    if (alike.has(e)) n_segments[e] = alike.n_segments(e);
    if ((stations[e].empty() && !alike.has(e)) || n_segments[e] > 1 || bands.n_short[e] > 0 || !rows[e][0].empty() || !rows[e][1].empty()) continue;
    const CornerId a = topology.corner[model.edges[e].start], b = topology.corner[model.edges[e].end];
    single.push_back({std::min(a, b), std::max(a, b), edges[e].length, e});
  }
  std::sort(single.begin(), single.end());
  for (std::size_t i = 1; i < single.size(); ++i)
    if (single[i].a == single[i - 1].a && single[i].b == single[i - 1].b) {
      n_segments[single[i].edge] = 2;
      if (alike.has(single[i].edge)) alike.divide(single[i].edge);
    }
  for (const std::optional<BaseStrip>& strip : bands.strips)
    if (strip) n_segments[strip->long_edge[0]] = std::max(n_segments[strip->long_edge[0]], n_segments[strip->long_edge[1]]);
  Column<EdgeId, EdgeCut> cuts(model.edges.size());
  parallel_for(
      context, model.edges.size(),
      [&](std::size_t i) {
        const EdgeId e(static_cast<std::uint64_t>(i));
        if (alike.has(e)) {
          cuts[e] = alike.cut(e);
          return;
        }
        if (bands.n_short[e] > 0) {
          cuts[e] = cut_evenly(model.edges[e], edges[e], bands.n_short[e]);
          return;
        }
        if (!stations[e].empty() && n_segments[e] > 1) cuts[e] = cut_at(model.edges[e], stations[e], n_segments[e]);
        if (!rows[e][0].empty() || !rows[e][1].empty()) add_rows(model.edges[e], rows[e], cuts[e]);
      },
      4);
  for (const std::optional<BaseStrip>& strip : bands.strips)
    if (strip)
      cuts[strip->long_edge[1]] =
          cut_by_shares(model.edges[strip->long_edge[1]], edges[strip->long_edge[1]], edges[strip->long_edge[0]], cuts[strip->long_edge[0]], strip->is_against);
  for (const EdgeId e : model.edges.ids())
    if (const SameEdge& same = topology.same_as[e]; same.edge != e && topology.is_point[e] == 0)
      cuts[e] = cut_like(edges[e], edges[same.edge], cuts[same.edge], same.is_reversed);
  return cuts;
}

}  // namespace sterna::surfmesh
