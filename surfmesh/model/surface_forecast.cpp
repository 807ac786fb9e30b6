// 1. The sizes of mesh_model, computed in the same order: sizes of faces, of locations and of edges, then carried over the surface.
// 2. of_face: areas of grid cells are divided by the area of an equilateral triangle of the local size. A face has at least as many triangles as border edges,
// minus two.
// 3. explain: finds the rule that causes at least half of a face's triangles.
#include "surfmesh/model/surface_forecast.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "surfmesh/model/estimate.h"
#include "surfmesh/model/sized_model.h"
#include "surfmesh/model/surface_sizes.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_rough = 2e7;  ///< number of triangles; above it, the cells that store sizes would take gigabytes
/// Ratio of the number of triangles made to the number that follows from the sizes. It was 1.05 to 1.16 on ten CAD models, because edges are cut into whole
/// numbers of segments.
constexpr double k_made = 1.1;
constexpr double k_cause = 0.5;  ///< fraction of a face's triangles from which a rule counts as the cause
constexpr double k_same_size = 1.05;
constexpr int k_cell_samples = 2;    ///< samples in each direction of a cell inside a face
constexpr int k_border_samples = 6;  ///< samples in each direction of a cell crossed by the border
constexpr int k_most_pieces = 64;    ///< largest number of pieces for an edge between two samples

/// Sums for one face.
struct FaceSum {
  double n = 0.0, area = 0.0;
};

bool is_in_outline(const FaceOutline& outline, const Uv& at) {
  bool inside = false;
  for (const std::vector<Uv>& loop : outline.polygons)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Uv &a = loop[i], &b = loop[(i + 1) % loop.size()];
      if ((a.u <= at.u) != (b.u <= at.u) && a.v + (at.u - a.u) / (b.u - a.u) * (b.v - a.v) > at.v) inside = !inside;
    }
  return inside;
}

FaceSum sum_of_cells(const SizedModel& all, const SurfaceSizes& field, FaceId f) {
  const FaceGrid& grid = field.grid(f);
  FaceSum sum;
  for (const FaceGridCell& cell : grid.cells()) {
    if (!cell.is_used) continue;
    std::array<const FaceGridNode*, 4> node{};
    bool is_whole = true;
    for (std::size_t k = 0; k < 4; ++k) {
      node[k] = &grid.nodes()[cell.nodes[k]];
      is_whole = is_whole && node[k]->is_inside;
    }
    const double area = triangle_area(node[0]->point, node[1]->point, node[3]->point) + triangle_area(node[0]->point, node[3]->point, node[2]->point);
    const int n = is_whole ? k_cell_samples : k_border_samples;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double s = (i + 0.5) / n, t = (j + 0.5) / n;
        const std::array weight = {(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t};
        Uv uv;
        Point point;
        for (std::size_t k = 0; k < 4; ++k) {
          uv.u += weight[k] * node[k]->uv.u;
          uv.v += weight[k] * node[k]->uv.v;
          point += weight[k] * node[k]->point;
        }
        if (!is_whole && !is_in_outline(all.sizes.outlines[f], uv)) continue;
        const double size = field.on_face(f, uv, point), share = area / (n * n);
        sum.area += share;
        sum.n += share / (k_equilateral_area * size * size);
      }
  }
  return sum;
}

/// Returns the expected number of segments of an edge.
double cuts_of(const SizedModel& all, const SurfaceSizes& field, EdgeId e) {
  const std::vector<EdgeSample>& samples = all.edges[e].samples;
  if (samples.empty() || all.topology.is_point[e] != 0) return 0.0;
  double n = 0.0;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const double length = distance(samples[i].point, samples[i + 1].point);
    const double size = std::min(field.on_edge(e, samples[i].t), field.on_edge(e, samples[i + 1].t));
    const int pieces = static_cast<int>(std::clamp(std::ceil(length / size), 1.0, static_cast<double>(k_most_pieces)));
    for (int k = 0; k < pieces; ++k) n += length / pieces / field.on_edge(e, samples[i].t + (k + 0.5) / pieces * (samples[i + 1].t - samples[i].t));
  }
  return std::max(n, 1.0);
}

struct LeastEdge {
  EdgeId edge;
  double size = 1e300, curvature = 0.0, t = 0.0;
  Point location;
};

LeastEdge least_edge_of(const SizedModel& all, FaceId f) {
  LeastEdge least;
  for (const Border& border : all.model.faces[f].borders)
    for (const EdgeUse& use : border) {
      if (all.sizes.edge_sizes.empty()) break;
      const std::vector<double>& sizes = all.sizes.edge_sizes[use.edge];
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        const EdgeSample& sample = all.edges[use.edge].samples[i];
        if (sizes[i] < least.size) least = {use.edge, sizes[i], sample.curvature, sample.t, sample.point};
      }
    }
  return least;
}

std::string metres(double value) { return number_text(value, 3) + " m"; }

void explain(const SizedModel& all, const FaceSum& sum, FaceForecast& forecast) {
  const FaceSizes& target = all.sizes.faces[forecast.face];
  const auto blame = [&](std::string rule, std::string advice) {
    forecast.rule = std::move(rule);
    forecast.advice = std::move(advice);
  };
  const double by_longest = sum.area / (k_equilateral_area * target.max_edge * target.max_edge), goal = k_cause * forecast.n_triangles;
  forecast.least_edge = target.max_edge;
  target.curvature->for_each_inside([&](const Point& p, double size) {
    if (size >= forecast.least_edge && forecast.least_edge < target.max_edge) return;
    if (size < forecast.least_edge) forecast.least_edge = size;
    forecast.location = p;
  });
  const std::string curvature = "curvature: the surface turns along an edge by at most " + number_text(target.limits.angle * k_degrees, 3) + " degrees";
  const std::string less_curvature = "a larger curvature_angle or min_edge";
  if (by_longest >= goal) return blame("max_edge = " + metres(target.max_edge), "a larger max_edge");
  if (estimated_triangles(all.sizes, forecast.face) >= goal) return blame(curvature, less_curvature);
  const LeastEdge least = least_edge_of(all, forecast.face);
  if (!(least.size < target.max_edge / k_same_size))
    return blame("short edges beside the face or sources, from which edge lengths grow by at most a factor of " + number_text(1.0 + all.sizes.growth, 3),
                 "a larger growth");
  forecast.location = least.location;
  forecast.least_edge = std::min(forecast.least_edge, least.size);
  if (all.edges[least.edge].length < target.max_edge && least.size * k_same_size >= all.edges[least.edge].length)
    return blame("an edge of the face that is " + metres(all.edges[least.edge].length) + " long", "a larger min_edge");
  double by_curvature = target.limits.size_of(least.curvature);
  for (const Border& border : all.model.faces[forecast.face].borders)
    for (const EdgeUse& use : border)
      if (use.edge == least.edge)
        by_curvature = std::min(by_curvature,
                                target.limits.size_of(largest_curvature(all.model.faces[forecast.face].surface->derivatives(use.parameter->point(least.t)))));
  if (by_curvature <= k_same_size * least.size) return blame(curvature, less_curvature);
  return blame(
      "narrow region: the face or its neighbour is about " + metres(least.size * all.options.sizes.refinement / all.options.sizes.narrow) + " wide there",
      "a larger min_edge or narrow");
}

}  // namespace

SurfaceForecast forecast_surface(const Model& model, const SurfaceMeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                                 const RunContext& context) {
  SizedModel all = sized_model(model, options, patches, requested, context);
  std::vector<FaceSum> sums(model.faces.size());
  double rough = 0.0;
  for (const FaceId f : model.faces.ids()) {
    sums[f.index()] = {estimated_triangles(all.sizes, f), all.sizes.faces[f].curvature->area()};
    rough += sums[f.index()].n;
  }
  if (rough < k_rough) {
    std::vector<AbsorbedPart> absorbed;
    all.topology = absorb_small_parts(model, all.edges, all.sizes, absorbed);
    add_narrow_locations(all, nullptr, context);
    const SurfaceSizes field(model, all.edges, all.topology, all.sizes, {}, context, true);
    const auto of_face = [&](std::size_t i) {
      const FaceId f(static_cast<std::uint64_t>(i));
      if (all.topology.is_absorbed[f] != 0) {
        sums[i] = {};
        return;
      }
      sums[i] = sum_of_cells(all, field, f);
      double cuts = -2.0;
      for (const Border& border : model.faces[f].borders)
        for (const EdgeUse& use : border) cuts += cuts_of(all, field, use.edge);
      sums[i].n = std::max(k_made * sums[i].n, cuts);
    };
    parallel_for(context, sums.size(), of_face, 1);
  }
  SurfaceForecast forecast;
  std::vector<FaceId> order;
  for (const FaceId f : model.faces.ids()) {
    forecast.n_triangles += sums[f.index()].n;
    order.push_back(f);
  }
  std::ranges::stable_sort(order, [&](FaceId a, FaceId b) { return sums[a.index()].n > sums[b.index()].n; });
  for (std::size_t i = 0; i < std::min(k_forecast_faces, order.size()); ++i) {
    FaceForecast of_face{.face = order[i], .name = model.faces[order[i]].name, .n_triangles = sums[order[i].index()].n};
    explain(all, sums[order[i].index()], of_face);
    forecast.largest.push_back(std::move(of_face));
  }
  return forecast;
}

}  // namespace sterna::surfmesh
