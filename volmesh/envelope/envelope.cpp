#include "volmesh/envelope/envelope.h"

#include <algorithm>
#include <limits>

namespace sterna::volmesh {
namespace {

/// Smallest fraction of the target height. With the same growth on all growth lines, a lower growth line would have first cells that are lower in proportion,
/// beside cells of a hundred times their height.
constexpr double k_least_of_target = 0.01;
/// Lower limit of the normal height used in the growth law, as a fraction of h (a growth line at 84 degrees to the wall normal).
constexpr double k_min_normal_share = 0.1;
/// Fraction of n h0 below which a layer does not justify the cost of its cells (docs/method/envelope.md, "Warp").
constexpr double k_min_height_share = 0.2;

}  // namespace

std::string_view to_string(HeightLimit limit) {
  switch (limit) {
    case HeightLimit::none: return "none";
    case HeightLimit::untangle: return "neighbouring growth lines converge";
    case HeightLimit::warp: return "the wedge on a triangle would be warped";
    case HeightLimit::gap: return "gap to an opposing wall";
    case HeightLimit::collision: return "layers collide";
    case HeightLimit::prism: return "a prism of the layer would be invalid";
    case HeightLimit::invisible: return "no direction sees all faces";
    case HeightLimit::fixed: return "fixed on the wall";
  }
  return "";
}

EnvelopeScale::EnvelopeScale(Borrowed<const LayerBase> base, const EnvelopeOptions& options)
    : base_(&base.get()),
      demand_(&base->demand),
      has_common_growth_(sterna::volmesh::has_common_growth(options)),
      first_height_(options.first_height),
      max_growth_(options.max_growth),
      total_height_(options.total_height),
      max_thickness_(thickness_limit(options.max_thickness, options.total_height, base->body_length)),
      layers_(options.layers) {
  const auto least = [](int n, double h0) { return std::max(h0, k_min_height_share * n * h0); };
  most_layers_ = layers_;
  least_height_ = least(layers_, first_height_);
  if (demand_->is_empty()) return;
  most_layers_ = *std::max_element(demand_->layers.begin(), demand_->layers.end());
  least_height_ = std::numeric_limits<double>::infinity();
  for (const VertexId v : demand_->layers.ids()) least_height_ = std::min(least_height_, least(n(v), h0(v)));
}

double EnvelopeScale::unlimited_height(VertexId v) const {
  const double given = total_height(v);
  return is_automatic(given) ? height_by_edge(first_step(v), base_->layer_edge[v], max_growth(v), n(v), has_common_growth_) : given;
}

double EnvelopeScale::requested_height(VertexId v) const { return std::min(unlimited_height(v), max_thickness(v)); }

double EnvelopeScale::h_min(VertexId v) const { return k_min_height_share * n(v) * h0(v); }

EnvelopeScale scale_of(Borrowed<const LayerBase> base, const EnvelopeOptions& options) { return {base, options}; }

double normal_height(const LayerBase& base, const Envelope& envelope, VertexId v) {
  if (base.multi_normal_of(v) != nullptr) return envelope.height[v];
  return envelope.height[v] * std::max(dot(envelope.direction[v], base.vertex_normal[v]), k_min_normal_share);
}

double envelope_edge(const LayerBase& base, const EnvelopeShape& envelope, VertexId v) {
  const auto around = base.topology.neighbours(v);
  const Point own = envelope.point(base.wall, v);
  double sum = 0.0;
  for (const VertexId other : around) sum += distance(own, envelope.point(base.wall, other));
  return around.empty() ? 0.0 : sum / static_cast<double>(around.size());
}

void lower(Envelope& envelope, VertexId v, double height, HeightLimit reason, const EnvelopeScale& scale) {
  if (height >= envelope.height[v]) return;
  const double least = std::max(scale.h_min(v), scale.has_common_growth() ? k_least_of_target * envelope.target[v] : 0.0);
  envelope.height[v] = height < least ? 0.0 : height;
  envelope.limit[v] = reason;
}

}  // namespace sterna::volmesh
