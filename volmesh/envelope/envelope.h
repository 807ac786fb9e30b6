// The outer surface of the layer. It has the connectivity of the wall, and one growth direction and one height per vertex.
#pragma once

#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "geom/base/borrowed.h"
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

/// Geometry of the envelope. The optimiser uses the same type for proposals.
struct EnvelopeShape {
  Column<VertexId, Vec3> direction;  ///< unit growth direction
  Column<VertexId, double> height;   ///< m, height along the direction; 0: the vertex is collapsed

  bool is_collapsed(VertexId v) const { return height[v] == 0.0; }
  Point point(const TriMesh& wall, VertexId v) const { return wall.points[v] + height[v] * direction[v]; }
};

struct Envelope : EnvelopeShape {
  Column<VertexId, double> target;  ///< m, h_target of docs/method/envelope.md, "Heights"
  Column<VertexId, double> eq1;     ///< m, height by eq. (1) without upper limits
  Column<VertexId, double> cap;     ///< m, largest height that the stages so far allow (starts as target)
  Column<VertexId, HeightLimit> limit;
};

/// Returns the columns of an envelope; this is the only list of them (for_each_column).
template <class AnyEnvelope>
requires std::is_same_v<std::remove_const_t<AnyEnvelope>, Envelope>
auto columns_of(AnyEnvelope& envelope) {
  const auto columns = std::tie(envelope.direction, envelope.height, envelope.target, envelope.eq1, envelope.cap, envelope.limit);
  static_assert(sizeof(Envelope) == std::tuple_size_v<decltype(columns)> * sizeof(envelope.height), "every column of the envelope has its place in this list");
  return columns;
}

/// Largest thickness as a fraction of the body length, if max_thickness is automatic.
inline constexpr double k_default_thickness_share = 0.1;
/// Returns the largest thickness in metres: the requested one, or the automatic fraction of the body length. The result is never below a requested total
/// height.
inline double thickness_limit(double max_thickness, double total_height, double body_length) {
  if (!is_automatic(max_thickness)) return max_thickness;
  const double usual = k_default_thickness_share * body_length;
  return total_height > usual ? total_height : usual;
}

/// A first height counts as met if its relative deviation is not larger than this (G11 of docs/method/quality.md, "Gates").
inline constexpr double k_first_cell_slack = 0.02;
/// Largest ratio of the first step along a vertex's normal to the first height above the facets at the vertex.
inline constexpr double k_most_lean = 2.0;

/// Layer targets at each vertex, and derived values that every step needs. They come from the demand of the base or, if the demand is empty, from the options.
class EnvelopeScale {
 public:
  EnvelopeScale(Borrowed<const LayerBase> base, const EnvelopeOptions& options);

  double h0(VertexId v) const { return demand_->is_empty() ? first_height_ : demand_->first_height[v]; }  ///< m, first height
  int n(VertexId v) const { return demand_->is_empty() ? layers_ : demand_->layers[v]; }                  ///< number of layers
  double max_growth(VertexId v) const { return demand_->is_empty() ? max_growth_ : demand_->max_growth[v]; }
  double max_thickness(VertexId v) const { return demand_->is_empty() ? max_thickness_ : demand_->max_thickness[v]; }  ///< m
  /// Returns the target total height of all layers in metres; automatic: eq. (1) of docs/method/envelope.md, "Heights".
  double total_height(VertexId v) const { return demand_->is_empty() ? total_height_ : demand_->total_height.empty() ? k_automatic : demand_->total_height[v]; }
  /// Returns the target height of the first cell at v along the vertex normal in metres. If all growth lines have the same growth (growth = "uniform"), first
  /// heights are measured above the facets, as their mean. The result is then h0 divided by the mean cosine between the vertex normal and the facet normals,
  /// but at most k_most_lean h0.
  double first_step(VertexId v) const { return has_common_growth_ ? h0(v) / std::max(base_->facet_cosine[v], 1.0 / k_most_lean) : h0(v); }
  /// Returns the growth of the cells along the growth line at v.
  LineGrowth growth(VertexId v) const {
    if (!has_common_growth_) return {.h0 = h0(v)};
    return {.h0 = first_step(v), .common = max_growth(v), .edge = base_->longest_edge[v], .target = requested_height(v)};
  }
  /// Returns the given total height, or the height of eq. (1), in metres.
  double unlimited_height(VertexId v) const;
  /// Returns the target total height in metres: unlimited_height(), but at most max_thickness().
  double requested_height(VertexId v) const;
  bool has_common_growth() const { return has_common_growth_; }
  /// Returns the smallest height in metres along the normal at which the first of n cells has its target height, minus the tolerance of 2 % of gate G11.
  double room_for_first_cell(VertexId v, int n) const {
    return has_common_growth_ ? (1.0 - k_first_cell_slack) * height_for_first_cell(growth(v), n) : n * h0(v);
  }
  double compressed(VertexId v) const { return n(v) * h0(v); }  ///< m, n h0: a layer lower than this cannot have its first height
  double h_min(VertexId v) const;                               ///< m, 0.2 n h0: vertices with a lower height collapse (docs/method/envelope.md, "Warp")
  int most_layers() const { return most_layers_; }
  /// Returns the smallest max(h0, h_min) of all vertices in metres. It is the lower bound of heights in the optimiser.
  double least_height() const { return least_height_; }

 private:
  const LayerBase* base_;
  const LayerDemand* demand_;
  bool has_common_growth_;
  double first_height_, max_growth_, total_height_, max_thickness_, least_height_;
  int layers_, most_layers_;
};
EnvelopeScale scale_of(Borrowed<const LayerBase> base, const EnvelopeOptions& options);

/// Returns the height in metres of the layer at a vertex along its wall normal: h (d . n). The growth law divides this height, so that the first node is at the
/// distance h0 from the wall for any curvature and inclination of the growth line. If this height is below n h0, the layer is compressed (h0 not met). The
/// result is at least 0.1 h, because the nodes of steeper growth lines could not be distinguished. For a growth line of a multi-normal fan, the result is its
/// length. The nodes of a fan are then at equal distances from their ridge base vertex, however little the fan is open.
double normal_height(const LayerBase& base, const Envelope& envelope, VertexId v);

/// Returns the mean length in metres of the envelope's edges at a vertex.
double envelope_edge(const LayerBase& base, const EnvelopeShape& envelope, VertexId v);

/// Lowers a height (never raises it) and stores the reason. Collapses the vertex if the height is below h_min. If all growth lines have the same growth, the
/// vertex also collapses below a hundredth of the target height.
void lower(Envelope& envelope, VertexId v, double height, HeightLimit reason, const EnvelopeScale& scale);

}  // namespace sterna::volmesh
