// The second surface that bounds the layer: same connectivity as the wall, one growth direction and one height per vertex.
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

/// Why a vertex has less than its target height; the reason of the strongest limit.
enum class HeightLimit : std::uint8_t { none, untangle, warp, gap, collision, prism, invisible, fixed };
inline constexpr std::size_t k_height_limits = 8;
std::string_view to_string(HeightLimit limit);

/// Where the envelope is; what a proposal consists of.
struct EnvelopeShape {
  Column<VertexId, Vec3> direction;  ///< unit growth direction
  Column<VertexId, double> height;   ///< m along the direction; 0 = collapsed

  bool is_collapsed(VertexId v) const { return height[v] == 0.0; }
  Point point(const TriMesh& wall, VertexId v) const { return wall.points[v] + height[v] * direction[v]; }
};

struct Envelope : EnvelopeShape {
  Column<VertexId, double> target;  ///< m, h_target of docs/method/envelope.md, "Heights"
  Column<VertexId, double> eq1;     ///< m, height by eq. (1) without caps
  Column<VertexId, double> cap;     ///< m, largest height that the stages so far allow (starts as target)
  Column<VertexId, HeightLimit> limit;
};

/// The one list of an envelope's columns (for_each_column).
template <class AnyEnvelope>
requires std::is_same_v<std::remove_const_t<AnyEnvelope>, Envelope>
auto columns_of(AnyEnvelope& envelope) {
  const auto columns = std::tie(envelope.direction, envelope.height, envelope.target, envelope.eq1, envelope.cap, envelope.limit);
  static_assert(sizeof(Envelope) == std::tuple_size_v<decltype(columns)> * sizeof(envelope.height), "every column of the envelope has its place in this list");
  return columns;
}

/// Share of the body length, when max_thickness is automatic.
inline constexpr double k_default_thickness_share = 0.1;
/// Largest thickness, m: what is asked, or the share of the body length, but never below a total height that is asked.
inline double thickness_limit(double max_thickness, double total_height, double body_length) {
  if (!is_automatic(max_thickness)) return max_thickness;
  const double usual = k_default_thickness_share * body_length;
  return total_height > usual ? total_height : usual;
}

/// Of a first height that counts as met (G11 of docs/method/quality.md, "Gates").
inline constexpr double k_first_cell_slack = 0.02;
/// Largest first step along a vertex's normal over the first height above its facets.
inline constexpr double k_most_lean = 2.0;

/// What is asked of the layer at each vertex, and derived numbers that every step needs: the base's demand, or where it is empty the options.
class EnvelopeScale {
 public:
  /// `base` must outlive this.
  EnvelopeScale(const LayerBase& base, const EnvelopeOptions& options);

  double h0(VertexId v) const { return demand_->is_empty() ? first_height_ : demand_->first_height[v]; }  ///< m, first height
  int n(VertexId v) const { return demand_->is_empty() ? layers_ : demand_->layers[v]; }                  ///< layers
  double max_growth(VertexId v) const { return demand_->is_empty() ? max_growth_ : demand_->max_growth[v]; }
  double max_thickness(VertexId v) const { return demand_->is_empty() ? max_thickness_ : demand_->max_thickness[v]; }  ///< m
  /// m, what all layers together are to have; automatic: eq. (1) of docs/method/envelope.md, "Heights".
  double total_height(VertexId v) const { return demand_->is_empty() ? total_height_ : demand_->total_height.empty() ? k_automatic : demand_->total_height[v]; }
  /// m, what the first cell of the line at v is to have along the vertex's normal. Where lines grow alike (growth = "uniform"), first heights are those above
  /// the facets, in their mean: h0 over the mean cosine between the vertex's normal and theirs, at most k_most_lean h0.
  double first_step(VertexId v) const { return has_common_growth_ ? h0(v) / std::max(base_->facet_cosine[v], 1.0 / k_most_lean) : h0(v); }
  /// How the cells of the line at v grow.
  LineGrowth growth(VertexId v) const {
    if (!has_common_growth_) return {.h0 = h0(v)};
    return {.h0 = first_step(v), .common = max_growth(v), .edge = base_->longest_edge[v], .target = asked_height(v)};
  }
  /// m, the total height that is given, or that of eq. (1).
  double unlimited_height(VertexId v) const;
  /// m, the total height that is asked for: unlimited_height(), at most max_thickness().
  double asked_height(VertexId v) const;
  bool has_common_growth() const { return has_common_growth_; }
  /// m, the least height along the normal with which the first cell of n is as high as is asked for, less the 2 % that gate G11 leaves it.
  double room_for_first_cell(VertexId v, int n) const {
    return has_common_growth_ ? (1.0 - k_first_cell_slack) * height_for_first_cell(growth(v), n) : n * h0(v);
  }
  double compressed(VertexId v) const { return n(v) * h0(v); }  ///< m, n h0: a layer that is lower cannot have its first height
  double h_min(VertexId v) const;                               ///< m, 0.2 n h0: below it a vertex collapses (docs/method/envelope.md, "Warp")
  int most_layers() const { return most_layers_; }
  /// The smallest max(h0, h_min) of all vertices, m: what an optimiser may lower heights to.
  double least_height() const { return least_height_; }

 private:
  const LayerBase* base_;
  const LayerDemand* demand_;
  bool has_common_growth_;
  double first_height_, max_growth_, total_height_, max_thickness_, least_height_;
  int layers_, most_layers_;
};
EnvelopeScale scale_of(const LayerBase& base, const EnvelopeOptions& options);

/// Height of the layer at a vertex along its wall normal, m: h (d . n). It is what the layer law divides, so that the first node is h0 off the wall whatever
/// the line's curve and slant; the layer is compressed (h0 not met) where it is below n h0. At least 0.1 h: steeper lines would not be told
/// apart. Of a line of a fan: its length, so that nodes of one fan are equally far from their foot, however little it is open.
double normal_height(const LayerBase& base, const Envelope& envelope, VertexId v);

/// Mean length of the envelope's edges at a vertex, m.
double envelope_edge(const LayerBase& base, const EnvelopeShape& envelope, VertexId v);

/// Lowers a height (never raises), remembers why, and collapses below h_min, where all lines grow alike also below a hundredth of the target height.
void lower(Envelope& envelope, VertexId v, double height, HeightLimit reason, const EnvelopeScale& scale);

}  // namespace sterna::volmesh
