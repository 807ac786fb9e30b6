#include "volmesh/layer/layer_report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/base/print_text.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/layer_room.h"

namespace sterna::volmesh {
namespace {

constexpr int k_report_digits = 4;  ///< number of digits of lengths in texts
/// Fraction of the area; if a larger fraction is compressed, a mistake in the settings is more probable than a difficult shape.
constexpr double k_suspicious_share = 0.5;

/// Reasons for less than the full height: those of HeightLimit, and as the last one growth lines that are long enough but inclined.
constexpr std::size_t k_lean = k_height_limits;
using LostArea = std::array<double, k_height_limits + 1>;

std::string_view reason_text(std::size_t reason) {
  return reason == k_lean ? "growth lines lean away from the wall normal" : to_string(static_cast<HeightLimit>(reason));
}

/// Areas by state of the layer, m^2.
struct Areas {
  double all = 0.0, full = 0.0, compressed = 0.0, thin = 0.0, collapsed = 0.0, attainable = 0.0, attained = 0.0, truncated = 0.0;
  int least_layers = std::numeric_limits<int>::max();  ///< smallest number of layers on growth lines that are not collapsed
  LostArea lost{};
};

/// Returns the height of the layer along the wall's normal in metres. Unlike normal_height() it has no lower limit.
double height_along_normal(const LayerBase& base, const Envelope& envelope, VertexId v) {
  return envelope.height[v] * dot(envelope.direction[v], base.vertex_normal[v]);
}

bool has_full_height(const LayerBase& base, const Envelope& envelope, VertexId v) {
  return !envelope.is_collapsed(v) && height_along_normal(base, envelope, v) >= k_full_height_share * envelope.target[v];
}

std::size_t reason_of(const LayerBase& base, const Envelope& envelope, VertexId v) {
  const bool is_long = !envelope.is_collapsed(v) && envelope.height[v] >= k_full_height_share * envelope.target[v];
  return is_long && !has_full_height(base, envelope, v) ? k_lean : static_cast<std::size_t>(envelope.limit[v]);
}

double mean_top_edge(const LayerBase& base, const Envelope& envelope, TriangleId t) {
  const TriangleVertices& v = base.wall.triangles[t];
  const auto top = [&](std::size_t k) { return envelope.point(base.wall, v[k]); };
  return (distance(top(0), top(1)) + distance(top(1), top(2)) + distance(top(2), top(0))) / 3.0;
}

/// Returns the room around the wall with its layer targets and the outer boundary.
LayerRoom room_around(const LayerBase& base, const Envelope& envelope, const TriMesh* outer, const RunContext& context) {
  std::vector<FacingTriangle> facing(base.wall.n_triangles());
  parallel_for(context, facing.size(), [&](std::size_t i) {
    const TriangleId t(i);
    const TriangleVertices& v = base.wall.triangles[t];
    facing[i] = {.corners = corners(base.wall, t),
                 .base_lines = {v[0].value(), v[1].value(), v[2].value()},
                 .requested = std::max({envelope.target[v[0]], envelope.target[v[1]], envelope.target[v[2]]}),
                 .edge = mean_top_edge(base, envelope, t)};
  });
  constexpr std::uint32_t k_none = FacingTriangle::k_no_line;
  if (outer != nullptr)
    for (const TriangleId t : outer->triangles.ids()) facing.push_back({.corners = corners(*outer, t), .base_lines = {k_none, k_none, k_none}});
  return LayerRoom(std::move(facing), context);
}

/// Returns the height along the normal in metres that the geometry permits at each vertex. Where the vertex has its full height, it is the target.
Column<VertexId, double> permitted_heights(const LayerBase& base, const Envelope& envelope, const TriMesh* outer, const RunContext& context) {
  Column<VertexId, double> permitted = envelope.target;
  const auto is_full = [&](VertexId v) { return has_full_height(base, envelope, v) || base.topology.outgoing(v).empty(); };
  std::size_t n_low = 0;
  for (const VertexId v : envelope.height.ids()) n_low += is_full(v) ? 0 : 1;
  if (n_low == 0) return permitted;
  const LayerRoom room = room_around(base, envelope, outer, context);
  parallel_for(context, permitted.size(), [&](std::size_t i) {
    const VertexId v(i);
    if (is_full(v)) return;
    const auto around = base.topology.outgoing(v);
    double edge = 0.0;
    for (const HalfedgeId h : around) edge += mean_top_edge(base, envelope, triangle_of(h)) / static_cast<double>(around.size());
    permitted[v] = room.permitted({v.value(), base.wall.points[v], base.vertex_normal[v], envelope.target[v], edge, base.visibility[v]});
  });
  return permitted;
}

class Classifier {
 public:
  Classifier(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope, const LayerBlock& layers, const TriMesh* outer,
             const RunContext& context)
      : base_(base), envelope_(envelope), layers_(layers), scale_(scale_of(base, options)), permitted_(permitted_heights(base, envelope, outer, context)) {}
  bool is_full(VertexId v) const { return has_full_height(base_, envelope_, v); }
  int layers(VertexId v) const { return layers_.layers_of_line(v.value()); }
  bool is_compressed(VertexId v) const { return !envelope_.is_collapsed(v) && normal_height(base_, envelope_, v) < scale_.room_for_first_cell(v, layers(v)); }
  /// Returns true if the layer is lower than the sum of the first heights of its layers.
  bool is_thin(VertexId v) const { return is_compressed(v) && normal_height(base_, envelope_, v) < layers(v) * scale_.h0(v); }
  bool is_truncated(VertexId v) const { return !envelope_.is_collapsed(v) && layers(v) < scale_.n(v); }
  void add(VertexId v, double area, Areas& areas) const {
    areas.all += area;
    if (is_full(v)) areas.full += area;
    else areas.lost[reason_of(base_, envelope_, v)] += area;
    if (is_compressed(v)) areas.compressed += area;
    if (is_thin(v)) areas.thin += area;
    if (envelope_.is_collapsed(v)) areas.collapsed += area;
    else areas.least_layers = std::min(areas.least_layers, layers(v));
    if (is_truncated(v)) areas.truncated += area;
    if (permitted_[v] >= k_full_height_share * envelope_.target[v]) areas.attainable += area;
    if (is_full(v) || height_along_normal(base_, envelope_, v) >= k_full_height_share * permitted_[v]) areas.attained += area;
  }
  const EnvelopeScale& scale() const { return scale_; }

 private:
  const LayerBase& base_;
  const Envelope& envelope_;
  const LayerBlock& layers_;
  EnvelopeScale scale_;
  Column<VertexId, double> permitted_;  ///< m
};

std::vector<std::pair<std::string, double>> shares_of(const Areas& areas) {
  std::vector<std::pair<std::string, double>> shares;
  for (std::size_t i = 0; i < areas.lost.size(); ++i)
    if (areas.lost[i] > 0.0) shares.emplace_back(reason_text(i), areas.lost[i] / areas.all);
  std::stable_sort(shares.begin(), shares.end(), [](const auto& x, const auto& y) { return x.second > y.second; });
  return shares;
}

std::vector<PatchLayerReport> cover_patches(const LayerBase& base, const Classifier& classifier) {
  std::vector<Areas> areas(base.wall.patches.size());
  for (const TriangleId t : base.wall.triangles.ids())
    for (const VertexId v : base.wall.triangles[t]) classifier.add(v, base.area[t] / 3.0, areas[base.wall.triangle_patch[t].index()]);
  std::vector<PatchLayerReport> patches;
  for (const PatchId p : base.wall.patches.ids()) {
    const Areas& own = areas[p.index()];
    const auto share = [&own](double part) { return own.all > 0.0 ? part / own.all : 0.0; };
    patches.push_back({base.wall.patches[p].name, own.all, share(own.full), share(own.compressed), share(own.collapsed), share(own.attainable),
                       share(own.attained), share(own.truncated), own.collapsed < own.all ? own.least_layers : 0, shares_of(own)});
  }
  return patches;
}

std::string vertex_text(const LayerBase& base, const Envelope& envelope, VertexId v) {
  const Patch& patch = base.wall.patches[base.wall.triangle_patch[triangle_of(base.topology.outgoing(v).front())]];
  return "vertex " + std::to_string(v.value()) + " of patch " + patch.name + ": " + std::string(to_string(envelope.limit[v]));
}

void list_locations(const LayerBase& base, const Envelope& envelope, const Classifier& classifier, LayerReport& report) {
  std::vector<VertexId> compressed;
  for (const VertexId v : envelope.height.ids()) {
    if (base.topology.outgoing(v).empty()) continue;  // the vertex belongs to no triangle
    if (classifier.is_compressed(v)) compressed.push_back(v);
    if (envelope.is_collapsed(v)) report.collapsed.push_back({base.wall.points[v], vertex_text(base, envelope, v)});
  }
  report.n_compressed = static_cast<std::int64_t>(compressed.size());
  std::stable_sort(compressed.begin(), compressed.end(), [&](VertexId a, VertexId b) { return envelope.height[a] < envelope.height[b]; });
  compressed.resize(std::min(compressed.size(), k_listed_compressed));
  for (const VertexId v : compressed)
    report.compressed.push_back({base.wall.points[v], in_metres(envelope.height[v], k_report_digits) + ", " + vertex_text(base, envelope, v)});
}

/// Warns of layers that are thinner than the sum of their first heights. A wrong unit is a more frequent cause than a difficult shape.
/// \param thin_area fraction of the wall area with such layers
void warn(const Envelope& envelope, const Classifier& classifier, double thin_area, LayerReport& report) {
  // Finds the vertex with the largest ratio of the target to the sum of the first heights.
  const EnvelopeScale& scale = classifier.scale();
  VertexId v(0);
  for (const VertexId other : envelope.target.ids())
    if (envelope.target[other] * scale.compressed(v) > envelope.target[v] * scale.compressed(other)) v = other;
  const double tallest = envelope.target[v];
  const bool is_target_low = tallest < scale.compressed(v) && tallest < scale.room_for_first_cell(v, scale.n(v));
  if (!is_target_low && thin_area <= k_suspicious_share) {
    if (report.compressed_area > k_suspicious_share)
      report.warnings.push_back(
          print_text("first cells are lower than first_height on %.0f %% of the wall: the layer is lower there than layers of uniform growth require; give "
                     "fewer layers, or growth = \"local\"",
                     100.0 * report.compressed_area));
    return;
  }
  char share[32];
  std::snprintf(share, sizeof share, "%.0f %%", 100.0 * thin_area);
  report.warnings.push_back("the layer is compressed on " + std::string(share) + " of the wall: " + std::to_string(scale.n(v)) + " layers of first_height " +
                            in_metres(scale.h0(v), k_report_digits) + " are " + in_metres(scale.compressed(v), k_report_digits) + " tall" +
                            (is_target_low ? ", more than the largest target height of " + in_metres(tallest, k_report_digits) : "") + " (body length " +
                            in_metres(report.body_length, k_report_digits) + "); are first_height and the surface in the same unit?");
}

constexpr double k_interface_ratio = 3.0;

InterfaceReport report_interface(const LayerBase& base, const Classifier& classifier, const Extrusion& extrusion, const RunContext& context) {
  struct Sums {
    double within = 0.0, below = 0.0, above = 0.0, full = 0.0, full_within = 0.0;
  };
  const LayerBlock& layers = extrusion.layers;
  const auto node = [&](VertexId v, int layer) { return extrusion.points[layers.node(v.value(), layer).index()]; };
  const Sums sums = parallel_reduce(
      context, base.wall.n_triangles(), Sums{},
      [&](std::size_t begin, std::size_t end) {
        Sums part;
        for (std::size_t t = begin; t < end; ++t) {
          const TriangleVertices& v = base.wall.triangles[TriangleId(t)];
          std::array<Point, 3> top;
          double height = 0.0;
          for (std::size_t k = 0; k < 3; ++k) {
            const int n_layers = layers.layers_of_line(v[k].value());
            top[k] = node(v[k], n_layers);
            height += distance(top[k], node(v[k], n_layers - 1)) / 3.0;
          }
          const double edge = (distance(top[0], top[1]) + distance(top[1], top[2]) + distance(top[2], top[0])) / 3.0;
          const double ratio = height / (k_regular_height * edge);
          double& sum = ratio > k_interface_ratio ? part.above : ratio * k_interface_ratio < 1.0 ? part.below : part.within;
          const double area = triangle_area(top[0], top[1], top[2]);
          sum += area;
          if (!std::ranges::all_of(v, [&](VertexId corner) { return classifier.is_full(corner); })) continue;
          part.full += area;
          if (&sum == &part.within) part.full_within += area;
        }
        return part;
      },
      [](const Sums& a, const Sums& b) {
        return Sums{a.within + b.within, a.below + b.below, a.above + b.above, a.full + b.full, a.full_within + b.full_within};
      });
  const double all = sums.within + sums.below + sums.above;
  if (!(all > 0.0)) return {};
  return {sums.within / all, sums.below / all, sums.above / all, sums.full > 0.0 ? sums.full_within / sums.full : 0.0};
}

}  // namespace

LayerReport report_layer(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope, const Extrusion& extrusion, const TriMesh* outer,
                         const RunContext& context) {
  LayerReport report;
  report.body_length = base.body_length;
  report.feature_angle = options.feature_angle;
  report.visibility = report_visibility(base);
  report.n_vertices = static_cast<std::int64_t>(base.wall.n_vertices());
  if (base.wall.n_triangles() == 0) return report;
  const Classifier classifier(base, options, envelope, extrusion.layers, outer, context);
  Areas areas;
  double heights = 0.0, targets = 0.0, ratios = 0.0;
  for (const VertexId v : envelope.height.ids()) {
    const double a = base.vertex_area[v];
    classifier.add(v, a, areas);
    heights += a * height_along_normal(base, envelope, v);
    targets += a * envelope.target[v];
    ratios += a * envelope.target[v] / envelope.eq1[v];
  }
  report.coverage = areas.full / areas.all;
  report.attainable = areas.attainable / areas.all;
  report.attained = areas.attained / areas.all;
  report.compressed_area = areas.compressed / areas.all;
  report.collapsed_area = areas.collapsed / areas.all;
  report.truncated_area = areas.truncated / areas.all;
  report.lost_area = shares_of(areas);
  report.target_over_eq1 = ratios / areas.all;
  report.mean_height_share = heights / targets;
  report.mean_height = heights / areas.all;
  report.patches = cover_patches(base, classifier);
  list_locations(base, envelope, classifier, report);
  report.first_node = first_node_report(base, classify_vertices(base, options, context), options, envelope, extrusion, context);
  report.interface = report_interface(base, classifier, extrusion, context);
  report.reduced_curving = extrusion.curving_shares;
  warn(envelope, classifier, areas.thin / areas.all, report);
  return report;
}

LayerRequest layer_request(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope, const LayerBlock& layers) {
  LayerRequest request;
  request.first_height = options.first_height;
  request.max_growth = options.max_growth;
  if (const LayerDemand& demand = base.demand; !demand.is_empty()) {
    request.line_first_height = demand.first_height.raw();
    request.line_max_growth = demand.max_growth.raw();
    request.first_height = *std::min_element(demand.first_height.begin(), demand.first_height.end());
    request.max_growth = *std::max_element(demand.max_growth.begin(), demand.max_growth.end());
  }
  const EnvelopeScale scale = scale_of(base, options);
  if (scale.has_common_growth()) {
    request.line_first_height.clear();
    for (const VertexId v : envelope.height.ids()) {
      request.line_first_height.push_back(scale.first_step(v));
      request.line_first_room.push_back(scale.room_for_first_cell(v, layers.layers_of_line(v.value())));
    }
  }
  const auto requested = [&](VertexId v) { return static_cast<std::uint16_t>(scale.n(v)); };
  bool is_truncated = false;
  for (const VertexId v : envelope.height.ids()) {
    request.line_layers.push_back(requested(v));
    is_truncated = is_truncated || layers.layers_of_line(v.value()) < requested(v);
  }
  if (!is_truncated) request.line_layers.clear();
  for (const VertexId v : envelope.height.ids()) {
    const double total = scale.total_height(v);
    const bool is_of_patch = !is_automatic(total) && is_automatic(options.total_height);
    const double thickness = is_of_patch || is_automatic(options.boundary_layer) ? total : options.boundary_layer;
    request.line_boundary_layer.push_back(is_automatic(thickness) ? 0.0 : thickness);
  }
  if (std::ranges::all_of(request.line_boundary_layer, [](double thickness) { return thickness == 0.0; })) request.line_boundary_layer.clear();
  request.target_height = envelope.target.raw();
  for (std::size_t i = 0; i <= k_lean; ++i) request.reasons.emplace_back(reason_text(i));
  request.reason.reserve(envelope.limit.size());
  for (const VertexId v : envelope.limit.ids()) request.reason.push_back(static_cast<std::uint8_t>(reason_of(base, envelope, v)));
  return request;
}

}  // namespace sterna::volmesh
