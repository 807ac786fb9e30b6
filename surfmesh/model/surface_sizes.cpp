// 1. A lower bound: all sources, with distances through space. It sets the resolution of stations and cells that small sizes require.
// 2. Stations along edges, the borders of faces through these stations, and the cells of the faces.
// 3. One graph of corners, stations and nodes of cells, each with its own required size. Sizes are carried along the graph.
// 4. Values at the corners of cells, and the edges that run through each cell.
#include "surfmesh/model/surface_sizes.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "surfmesh/model/size_graph.h"

namespace sterna::surfmesh {
namespace {

/// Largest distance between stations, relative to the lower bound.
constexpr double k_station_sizes = 1.0;
constexpr int k_max_size_halvings = 24;
/// Number of intermediate points between two stations. They are used to find the cells that an edge runs through.
constexpr int k_between = 4;

double distance_along(const Point& p, const Point& a, const Point& b, double& share) {
  const Vec3 along = b - a;
  const double length2 = norm2(along);
  share = length2 > 0.0 ? std::clamp(dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return distance(p, a + share * along);
}

/// A station while the graph is constructed.
struct Stop {
  double t = 0.0;
  Point point;
  double requested = 0.0;
  std::uint32_t node = 0;
  std::array<Vec3, 2> normals{};  ///< normals of the two faces of its edge; zero if there are more than two faces, or none
};

}  // namespace

struct SurfaceSizes::Builder {
  SurfaceSizes& field;
  const Model& model;
  const Column<EdgeId, EdgeSamples>& edges;
  const ModelTopology& topology;
  const ModelSizes& sizes;
  const RunContext& context;
  bool keeps_grids;
  BackgroundSizes in_space;
  Column<EdgeId, std::vector<Stop>> stops;
  SizeGraph graph;

  /// Runs the loop in parallel if user functions may be called from any thread.
  template <class Body>
  void for_each(std::size_t n, std::size_t chunk, const Body& body) const {
    if (!sizes.local.is_serial()) return parallel_for(context, n, body, chunk);
    for (std::size_t i = 0; i < n; ++i) {
      context.check_stop();
      body(i);
    }
  }

  void run() {
    const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
    stops.resize(model.edges.size());
    for_each(model.edges.size(), 4, [&](std::size_t i) {
      const EdgeId e(static_cast<std::uint64_t>(i));
      if (topology.is_point[e] != 0 || uses[e].empty()) return;
      place_stops(e, uses[e]);
      for (Stop& stop : stops[e]) stop.normals = normals_at(uses[e], stop.t);
    });
    field.faces_.resize(model.faces.size());
    for_each(model.faces.size(), 1, [&](std::size_t i) { divide_face(FaceId(static_cast<std::uint64_t>(i))); });
    add_edges_to_graph();
    Column<FaceId, std::uint32_t> first_node(model.faces.size(), 0);
    for (const FaceId f : model.faces.ids()) first_node[f] = add_face_to_graph(f);
    context.check_stop();
    carry_sizes(graph, field.growth_);
    field.edges_.resize(model.edges.size());
    for (const EdgeId e : model.edges.ids())
      for (const Stop& s : stops[e]) field.edges_[e].push_back({s.t, graph.sizes[s.node]});
    parallel_for(
        context, model.faces.size(),
        [&](std::size_t i) { keep_face(FaceId(static_cast<std::uint64_t>(i)), first_node[FaceId(static_cast<std::uint64_t>(i))]); }, 1);
  }

  /// Places stops at the samples of the edge. Samples nearer to each other than the sizes require are left out; between samples farther apart, intermediate
  /// stops are added.
  void place_stops(EdgeId e, const std::vector<EdgeUseLocation>& uses) {
    const ModelEdge& edge = model.edges[e];
    const std::vector<EdgeSample>& samples = edges[e].samples;
    const std::vector<double> nothing(samples.size(), sizes.largest);
    const std::vector<double>& requested = sizes.edge_sizes[e].empty() ? nothing : sizes.edge_sizes[e];
    double cap = sizes.largest;
    for (const EdgeUseLocation& use : uses) cap = std::min(cap, sizes.faces[use.face].max_edge);
    struct End {
      double t;
      Point point;
      double requested;
      double spacing;
    };
    const auto end_at = [&](double t, const Point& p, double by_edge) {
      double requested_here = std::min(cap, by_edge);
      for (const EdgeUseLocation& use : uses) requested_here = std::min(requested_here, sizes.local(use.face, p));
      requested_here = in_space(p, requested_here);
      return End{t, p, requested_here, k_station_sizes * std::min(requested_here, field.bound_(p, cap))};
    };
    struct Piece {
      End a, b;
      int depth;
    };
    std::vector<Piece> pieces;
    std::vector<Stop>& list = stops[e];
    End before = end_at(samples.front().t, samples.front().point, requested.front());
    list.push_back({before.t, before.point, before.requested, 0});
    double along = 0.0;  // length since the last stop
    for (std::size_t i = 1; i < samples.size(); ++i) {
      const End after = end_at(samples[i].t, samples[i].point, requested[i]);
      pieces.push_back({before, after, 0});
      while (!pieces.empty()) {
        const Piece piece = pieces.back();
        pieces.pop_back();
        const double length = distance(piece.a.point, piece.b.point), least = std::min(piece.a.spacing, piece.b.spacing);
        if (length > least && piece.depth < k_max_size_halvings) {
          const double t = 0.5 * (piece.a.t + piece.b.t), share = (t - samples[i - 1].t) / (samples[i].t - samples[i - 1].t);
          const End middle = end_at(t, edge.curve->point(t), requested[i - 1] + share * (requested[i] - requested[i - 1]));
          pieces.push_back({middle, piece.b, piece.depth + 1});
          pieces.push_back({piece.a, middle, piece.depth + 1});
          continue;
        }
        along += length;
        const bool is_last = i + 1 == samples.size() && pieces.empty();
        if (is_last || along + 0.5 * length >= least) {
          list.push_back({piece.b.t, piece.b.point, piece.b.requested, 0});
          along = 0.0;
        } else {
          // If a sample between two stops requires a size, the last stop gets that requirement.
          list.back().requested = std::min(list.back().requested, piece.b.requested + field.growth_ * along);
        }
      }
      before = after;
    }
  }

  std::array<Vec3, 2> normals_at(const std::vector<EdgeUseLocation>& uses, double t) const {
    std::array<Vec3, 2> normals{};
    if (uses.size() > 2) return normals;
    for (std::size_t k = 0; k < uses.size(); ++k) {
      const ModelFace& face = model.faces[uses[k].face];
      const SurfaceDerivatives d = face.surface->derivatives(face.borders[uses[k].border][uses[k].location].parameter->point(t));
      const Vec3 normal = cross(d.du, d.dv);
      const double length = norm(normal);
      if (length > 0.0 && std::isfinite(length)) normals[k] = normal / length;
    }
    if (uses.size() == 1) normals[1] = normals[0];
    return normals;
  }

  /// Visits (u, v) of the stops of one edge use, in the direction of its border.
  template <class Visit>
  void for_stops(const OutlineUse& entry, const Visit& visit) const {
    const EdgeUse& use = model.faces[entry.location.face].borders[entry.location.border][entry.location.location];
    const std::vector<Stop>& list = stops[use.edge];
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Stop& stop = list[use.is_reversed ? list.size() - 1 - k : k];
      visit(stop, use.parameter->point(stop.t) + entry.shift);
    }
  }

  void divide_face(FaceId f) {
    if (topology.is_absorbed[f] != 0) return;
    const FaceOutline& outline = sizes.outlines[f];
    std::vector<std::vector<Uv>> loops;
    ParameterBox box{{1e300, -1e300}, {1e300, -1e300}};
    for (const auto& border : outline.borders) {
      std::vector<Uv>& loop = loops.emplace_back();
      for (const OutlineUse& entry : border) {
        const EdgeUse& use = model.faces[f].borders[entry.location.border][entry.location.location];
        if (stops[use.edge].empty()) {
          const Interval range = model.edges[use.edge].range;
          for (const double t : {range.from, range.to}) loop.push_back(use.parameter->point(use.is_reversed ? range.from + range.to - t : t) + entry.shift);
        }
        for_stops(entry, [&](const Stop&, Uv at) { loop.push_back(at); });
      }
      for (const Uv at : loop) {
        box.u = {std::min(box.u.from, at.u), std::max(box.u.to, at.u)};
        box.v = {std::min(box.v.from, at.v), std::max(box.v.to, at.v)};
      }
    }
    // Borders that run around a period are closed by a seam. The seam is not an edge of the model.
    if (!outline.winding.empty()) {
      loops = outline.polygons;
      for (const auto& loop : loops)
        for (const Uv at : loop) {
          box.u = {std::min(box.u.from, at.u), std::max(box.u.to, at.u)};
          box.v = {std::min(box.v.from, at.v), std::max(box.v.to, at.v)};
        }
    }
    const double cap = sizes.faces[f].max_edge;
    const FaceGrid::Bounds bounds{
        .at = [&, f](const Point& p) { return field.bound_(p, sizes.local(f, p)); },
        .is_level_within = [&, f, cap](const Point& p,
                                       double reach) { return !keeps_grids && sizes.local.is_level_within(f, p, reach) && field.bound_(p, cap, reach) >= cap; },
        .largest = cap};
    field.faces_[f].grid = FaceGrid(*model.faces[f].surface, box, loops, bounds);
  }

  /// Adds the corners first, then the stations between them; each station is a neighbour of the next.
  void add_edges_to_graph() {
    for (const CornerId c : model.corners.ids()) graph.add_node(model.corners[c].point, {}, sizes.largest, true);
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
      graph.cell_nodes.insert(graph.cell_nodes.end(), {a, b});
      graph.close_cell();
    };
    for (const EdgeId e : model.edges.ids()) {
      std::vector<Stop>& list = stops[e];
      for (std::size_t k = 0; k < list.size(); ++k) {
        const bool is_end = k == 0 || k + 1 == list.size();
        list[k].node = is_end ? topology.corner[k == 0 ? model.edges[e].start : model.edges[e].end].value()
                              : graph.add_node(list[k].point, list[k].normals, list[k].requested, true);
        graph.sizes[list[k].node] = std::min(graph.sizes[list[k].node], list[k].requested);
        if (k > 0) join(list[k - 1].node, list[k].node);
      }
    }
    // Both sides of an absorbed strip are the same line, so their stations become neighbours.
    for (const EdgeId e : model.edges.ids()) {
      const SameEdge& same = topology.same_as[e];
      if (same.edge == e || stops[e].empty() || stops[same.edge].empty()) continue;
      for (const Stop& s : stops[e]) {
        const auto nearest = std::min_element(stops[same.edge].begin(), stops[same.edge].end(),
                                              [&](const Stop& a, const Stop& b) { return norm2(a.point - s.point) < norm2(b.point - s.point); });
        join(s.node, nearest->node);
      }
    }
  }

  std::uint32_t add_face_to_graph(FaceId f) {
    const auto first = static_cast<std::uint32_t>(graph.points.size());
    FaceField& face = field.faces_[f];
    if (face.grid.empty()) return first;
    const std::vector<FaceGridNode>& nodes = face.grid.nodes();
    std::vector<Vec3> normals(nodes.size());
    for (const FaceGridCell& cell : face.grid.cells()) {
      const Vec3 normal = cross(nodes[cell.nodes[3]].point - nodes[cell.nodes[0]].point, nodes[cell.nodes[2]].point - nodes[cell.nodes[1]].point);
      for (const std::uint32_t n : cell.nodes) normals[n] += normal;
    }
    const CurvatureSizes& curvature = *sizes.faces[f].curvature;
    const double cap = sizes.faces[f].max_edge;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const double length = norm(normals[n]);
      double requested = cap;
      if (nodes[n].is_inside) {
        requested = sizes.local(f, nodes[n].point);
        if (!sizes.is_covered || !sizes.is_covered(f, nodes[n].point)) requested = std::min(requested, curvature(nodes[n].uv));
        requested = in_space(nodes[n].point, requested);
      }
      const Vec3 normal = length > 0.0 ? normals[n] / length : Vec3{};
      graph.add_node(nodes[n].point, {normal, normal}, requested, nodes[n].is_inside);
    }
    std::vector<std::vector<std::uint32_t>> stops_in(face.grid.cells().size());
    for (const auto& border : sizes.outlines[f].borders)
      for (const OutlineUse& entry : border) {
        const EdgeUse& use = model.faces[f].borders[entry.location.border][entry.location.location];
        if (stops[use.edge].empty()) {
          const Uv at = use.parameter->point(model.edges[use.edge].range.from) + entry.shift;
          stops_in[face.grid.find(at).cell].push_back(topology.corner[model.edges[use.edge].start].value());
        }
        for_stops(entry, [&](const Stop& stop, Uv at) { stops_in[face.grid.find(at).cell].push_back(stop.node); });
      }
    std::size_t hanging = 0;
    for (std::size_t c = 0; c < face.grid.cells().size(); ++c) {
      std::vector<std::uint32_t>& list = stops_in[c];
      for (; hanging < face.grid.hanging().size() && face.grid.hanging()[hanging].cell == c; ++hanging)
        list.push_back(first + face.grid.hanging()[hanging].node);
      if (face.grid.cells()[c].is_level || (!face.grid.cells()[c].is_used && list.empty())) continue;
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
      for (const std::uint32_t n : face.grid.cells()[c].nodes) graph.cell_nodes.push_back(first + n);
      graph.cell_nodes.insert(graph.cell_nodes.end(), list.begin(), list.end());
      graph.close_cell();
    }
    return first;
  }

  void keep_face(FaceId f, std::uint32_t first) {
    FaceField& face = field.faces_[f];
    if (face.grid.empty()) return;
    face.cells.resize(face.grid.cells().size());
    for (std::size_t c = 0; c < face.cells.size(); ++c)
      for (std::size_t k = 0; k < 4; ++k) face.cells[c].sizes[k] = static_cast<float>(graph.sizes[first + face.grid.cells()[c].nodes[k]]);
    struct Crossing {
      std::uint32_t cell;
      Segment segment;
    };
    std::vector<Crossing> crossings;
    for (const auto& border : sizes.outlines[f].borders)
      for (const OutlineUse& entry : border) {
        const Stop* before = nullptr;
        Uv uv_before;
        for_stops(entry, [&](const Stop& stop, Uv at) {
          if (before != nullptr) {
            const Segment segment{before->point, stop.point, static_cast<float>(graph.sizes[before->node]), static_cast<float>(graph.sizes[stop.node])};
            std::array<std::uint32_t, k_between + 1> met{};
            std::size_t n_met = 0;
            for (int k = 0; k <= k_between; ++k) {
              const std::uint32_t cell = face.grid.find(uv_before + (static_cast<double>(k) / k_between) * (at - uv_before)).cell;
              if (std::find(met.begin(), met.begin() + static_cast<std::ptrdiff_t>(n_met), cell) != met.begin() + static_cast<std::ptrdiff_t>(n_met)) continue;
              met[n_met++] = cell;
              crossings.push_back({cell, segment});
            }
          }
          before = &stop;
          uv_before = at;
        });
      }
    std::stable_sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.cell < b.cell; });
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      Cell& cell = face.cells[crossings[i].cell];
      if (cell.n_segments == 0) cell.first = static_cast<std::uint32_t>(i);
      ++cell.n_segments;
      face.segments.push_back(crossings[i].segment);
    }
    if (!keeps_grids) face.grid.forget_nodes();
  }
};

SurfaceSizes::SurfaceSizes(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const ModelSizes& sizes,
                           std::vector<SizePoint> in_space, const RunContext& context, bool keeps_grids)
    : bound_({}, sizes.growth, sizes.largest, context), growth_(sizes.growth), largest_(sizes.largest) {
  in_space.insert(in_space.end(), sizes.in_space.begin(), sizes.in_space.end());
  std::vector<SizePoint> all = sizes.sources;
  all.insert(all.end(), in_space.begin(), in_space.end());
  bound_ = BackgroundSizes(all, sizes.growth, sizes.largest, context);
  Builder builder{*this, model, edges, topology, sizes, context, keeps_grids, BackgroundSizes(in_space, sizes.growth, sizes.largest, context), {}, {}};
  builder.run();
}

double SurfaceSizes::on_face(FaceId face, Uv at, const Point& point) const {
  const FaceField& field = faces_[face];
  const FaceGrid::Location location = field.grid.find(at);
  const Cell& cell = field.cells[location.cell];
  const double s = location.s, t = location.t;
  double size = (1.0 - t) * ((1.0 - s) * static_cast<double>(cell.sizes[0]) + s * static_cast<double>(cell.sizes[1])) +
                t * ((1.0 - s) * static_cast<double>(cell.sizes[2]) + s * static_cast<double>(cell.sizes[3]));
  for (std::uint32_t i = cell.first; i < cell.first + cell.n_segments; ++i) {
    const Segment& segment = field.segments[i];
    const auto size_a = static_cast<double>(segment.size_a), size_b = static_cast<double>(segment.size_b);
    if (std::min(size_a, size_b) >= size) continue;
    double share = 0.0;
    const double away = distance_along(point, segment.a, segment.b, share);
    size = std::min(size, size_a + share * (size_b - size_a) + growth_ * away);
  }
  return size;
}

double SurfaceSizes::on_edge(EdgeId edge, double t) const {
  const std::vector<Station>& stations = edges_[edge];
  const auto above = std::upper_bound(stations.begin() + 1, stations.end() - 1, t, [](double value, const Station& s) { return value < s.t; });
  const Station &a = *(above - 1), &b = *above;
  const double share = b.t > a.t ? std::clamp((t - a.t) / (b.t - a.t), 0.0, 1.0) : 0.0;
  return a.size + share * (b.size - a.size);
}

std::size_t SurfaceSizes::n_cells() const {
  std::size_t n = 0;
  for (const FaceField& face : faces_) n += face.cells.size();
  return n;
}

}  // namespace sterna::surfmesh
