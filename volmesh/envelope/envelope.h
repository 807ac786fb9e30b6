// The outer surface of the layer: same connectivity as the wall, one growth direction and one height per vertex.
#pragma once

#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "geom/base/columns.h"
#include "geom/base/ids.h"
#include "geom/base/vec3.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Reason of the strongest limit that keeps a vertex below its target height.
enum class HeightLimit : std::uint8_t { none, untangle, warp, gap, collision, prism, invisible, fixed };
inline constexpr std::size_t k_height_limits = 8;
std::string_view to_string(HeightLimit limit);

/// Geometry of the envelope; also the content of a proposal.
struct EnvelopeShape {
  Column<VertexId, Vec3> direction;  ///< unit growth direction
  Column<VertexId, double> height;   ///< m along the direction; 0 = collapsed

  bool is_collapsed(VertexId v) const { return height[v] == 0.0; }
  Point point(const TriMesh& wall, VertexId v) const { return wall.points[v] + height[v] * direction[v]; }
};

struct Envelope : EnvelopeShape {
  Column<VertexId, double> target;  ///< m, h_target of docs/method/envelope.md, "Heights"
  Column<VertexId, double> eq1;     ///< m, height by eq. (1) without caps
  Column<VertexId, double> cap;     ///< m, largest height allowed by the stages so far (starts as target)
  Column<VertexId, HeightLimit> limit;
};

/// Returns the only list of an envelope's columns (for_each_column).
template <class AnyEnvelope>
requires std::is_same_v<std::remove_const_t<AnyEnvelope>, Envelope>
auto columns_of(AnyEnvelope& envelope) {
  const auto columns = std::tie(envelope.direction, envelope.height, envelope.target, envelope.eq1, envelope.cap, envelope.limit);
  static_assert(sizeof(Envelope) == std::tuple_size_v<decltype(columns)> * sizeof(envelope.height), "every column of the envelope has its place in this list");
  return columns;
}

/// Largest thickness as a share of the body length, if max_thickness is automatic.
inline constexpr double k_default_thickness_share = 0.1;
/// Returns the largest thickness, m: the requested one, or the share of the body length, but never below a requested total height.
inline double thickness_limit(double max_thickness, double total_height, double body_length) {
  if (!is_automatic(max_thickness)) return max_thickness;
  const double usual = k_default_thickness_share * body_length;
  return total_height > usual ? total_height : usual;
}

/// Relative deviation up to which a first height counts as met (G11 of docs/method/quality.md, "Gates").
inline constexpr double k_first_cell_slack = 0.02;
/// Largest ratio of the first step along a vertex's normal to the first height above its facets.
inline constexpr double k_most_lean = 2.0;

/// Layer targets at each vertex, and derived values that every step needs: from the demand of the base or, if the demand is empty, from the options.
class EnvelopeScale {
 public:
  /// `base` must outlive this.
  EnvelopeScale(const LayerBase& base, const EnvelopeOptions& options);

  double h0(VertexId v) const { return demand_->is_empty() ? first_height_ : demand_->first_height[v]; }  ///< m, first height
  int n(VertexId v) const { return demand_->is_empty() ? layers_ : demand_->layers[v]; }                  ///< layers
  double max_growth(VertexId v) const { return demand_->is_empty() ? max_growth_ : demand_->max_growth[v]; }
  double max_thickness(VertexId v) const { return demand_->is_empty() ? max_thickness_ : demand_->max_thickness[v]; }  ///< m
  /// m, target total height of all layers; automatic: eq. (1) of docs/method/envelope.md, "Heights".
  double total_height(VertexId v) const { return demand_->is_empty() ? total_height_ : demand_->total_height.empty() ? k_automatic : demand_->total_height[v]; }
  /// Returns the target height of the first cell at v along the vertex normal, m. If all growth lines have the same growth (growth = "uniform"), first
  /// heights are measured above the facets, in their mean: h0 over the mean cosine between the vertex normal and the facet normals, at most k_most_lean h0.
  double first_step(VertexId v) const { return has_common_growth_ ? h0(v) / std::max(base_->facet_cosine[v], 1.0 / k_most_lean) : h0(v); }
  /// Returns the growth of the cells along the growth line at v.
  LineGrowth growth(VertexId v) const {
    if (!has_common_growth_) return {.h0 = h0(v)};
    return {.h0 = first_step(v), .common = max_growth(v), .edge = base_->longest_edge[v], .target = asked_height(v)};
  }
  /// Returns the given total height, or the height of eq. (1), m.
  double unlimited_height(VertexId v) const;
  /// Returns the target total height, m: unlimited_height(), at most max_thickness().
  double asked_height(VertexId v) const;
  bool has_common_growth() const { return has_common_growth_; }
  /// Returns the least height along the normal at which the first of n cells has its target height, less the tolerance of 2 % of gate G11, m.
  double room_for_first_cell(VertexId v, int n) const {
    return has_common_growth_ ? (1.0 - k_first_cell_slack) * height_for_first_cell(growth(v), n) : n * h0(v);
  }
  double compressed(VertexId v) const { return n(v) * h0(v); }  ///< m, n h0: a lower layer cannot meet its first height
  double h_min(VertexId v) const;                               ///< m, 0.2 n h0: lower vertices collapse (docs/method/envelope.md, "Warp")
  int most_layers() const { return most_layers_; }
  /// Returns the smallest max(h0, h_min) of all vertices, m: the lower bound of heights in the optimiser.
  double least_height() const { return least_height_; }

 private:
  const LayerBase* base_;
  const LayerDemand* demand_;
  bool has_common_growth_;
  double first_height_, max_growth_, total_height_, max_thickness_, least_height_;
  int layers_, most_layers_;
};
EnvelopeScale scale_of(const LayerBase& base, const EnvelopeOptions& options);

/// Returns the height of the layer at a vertex along its wall normal, m: h (d . n). The growth law divides this height, so that the first node is at distance
/// h0 from the wall for any curvature and inclination of the growth line; the layer is compressed (h0 not met) where this height is below n h0. At least 0.1
/// h: steeper growth lines would have indistinguishable nodes. For a growth line of a multi-normal fan: its length, so that nodes of one fan are at equal
/// distances from their ridge base vertex, however little the fan is open.
double normal_height(const LayerBase& base, const Envelope& envelope, VertexId v);

/// Returns the mean length of the envelope's edges at a vertex, m.
double envelope_edge(const LayerBase& base, const EnvelopeShape& envelope, VertexId v);

/// Lowers a height (never raises), stores the reason, and collapses the vertex below h_min; if all growth lines have the same growth, also below a hundredth
/// of the target height.
void lower(Envelope& envelope, VertexId v, double height, HeightLimit reason, const EnvelopeScale& scale);

}  // namespace sterna::volmesh
