#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {
namespace {

/// Share of n h0 below which a layer is no longer worth its cells (method.md §4).
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

EnvelopeScale scale_of(const EnvelopeOptions& options) {
  return {options.first_height, options.layers, k_min_height_share * options.layers * options.first_height};
}

void lower(Envelope& envelope, VertexId v, double height, HeightLimit reason, const EnvelopeScale& scale) {
  if (height >= envelope.height[v]) return;
  envelope.height[v] = height < scale.h_min ? 0.0 : height;
  envelope.limit[v] = reason;
}

}  // namespace sterna::volmesh
