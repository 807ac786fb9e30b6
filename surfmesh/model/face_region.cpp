#include "surfmesh/model/face_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace sterna::surfmesh {
namespace {

/// Number of pieces of a use. It equals that of the polygon in the outline, which is used for the test away from the border.
constexpr int k_pieces = 24;
/// Points nearer to a chord than this many times its sag are tested with the curve itself, because the sag is estimated at the middle of the chord only.
constexpr double k_near = 3.0;
/// Number of Newton steps. They start from the fraction of the chord, because the curve is nearly straight there.
constexpr int k_steps = 6;

double cross_of(Uv a, Uv b) { return a.u * b.v - a.v * b.u; }
double dot_of(Uv a, Uv b) { return a.u * b.u + a.v * b.v; }

bool crosses(Uv a, Uv b, Uv at) { return (a.u <= at.u) != (b.u <= at.u) && a.v + (at.u - a.u) / (b.u - a.u) * (b.v - a.v) > at.v; }

}  // namespace

FaceRegion::FaceRegion(Borrowed<const Model> of, FaceId face) : model_(&of.get()), outline_(outline_of(of, face)) {
  const Model& model = of;
  const Surface& surface = *model.faces[face].surface;
  const ParameterBox domain = surface.domain();
  period_ = {surface.is_periodic_u() ? domain.u.length() : 0.0, surface.is_periodic_v() ? domain.v.length() : 0.0};
  for (std::uint32_t b = 0; b < outline_.borders.size(); ++b)
    for (std::uint32_t i = 0; i < outline_.borders[b].size(); ++i) {
      const OutlineUse& use = outline_.borders[b][i];
      const EdgeUse& edge_use = model.faces[face].borders[use.location.border][use.location.location];
      const Interval range = model.edges[edge_use.edge].range;
      const auto parameter = [&](int k) {
        const double share = static_cast<double>(k) / k_pieces;
        return edge_use.is_reversed ? range.to - share * range.length() : range.from + share * range.length();
      };
      for (int k = 0; k < k_pieces; ++k) {
        Piece piece{.t_from = parameter(k), .t_to = parameter(k + 1), .border = b, .use = i};
        piece.from = parameters_at(model, use, piece.t_from);
        piece.to = parameters_at(model, use, piece.t_to);
        const Uv chord = piece.to - piece.from;
        const double length = std::sqrt(dot_of(chord, chord));
        if (length == 0.0) continue;
        const Uv middle = parameters_at(model, use, 0.5 * (piece.t_from + piece.t_to));
        piece.sag = std::abs(cross_of(chord, middle - piece.from)) / length;
        pieces_.push_back(piece);
      }
    }
}

bool FaceRegion::is_left_of(const Piece& piece, Uv at) const {
  const OutlineUse& use = outline_.borders[piece.border][piece.use];
  const EdgeUse& edge_use = model_->faces[use.location.face].borders[use.location.border][use.location.location];
  const Uv chord = piece.to - piece.from;
  double t = piece.t_from + dot_of(at - piece.from, chord) / dot_of(chord, chord) * (piece.t_to - piece.t_from);
  const auto [least, most] = std::minmax(piece.t_from, piece.t_to);
  ParameterCurveDerivatives d{};
  for (int step = 0; step < k_steps; ++step) {
    t = std::clamp(t, least, most);
    d = edge_use.parameter->derivatives(t);
    const double speed = dot_of(d.first, d.first);
    if (speed == 0.0) break;
    t += dot_of(at - (d.point + use.shift), d.first) / speed;
  }
  const Uv along = piece.t_to > piece.t_from ? d.first : -1.0 * d.first;
  return cross_of(along, at - (d.point + use.shift)) >= 0.0;
}

bool FaceRegion::contains_here(Uv at) const {
  const Piece* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces_) {
    const Uv chord = piece.to - piece.from, away = at - piece.from;
    const double length2 = dot_of(chord, chord), share = dot_of(away, chord) / length2;
    if (share < 0.0 || share > 1.0) continue;
    const double distance = std::abs(cross_of(chord, away)) / std::sqrt(length2);
    if (distance > k_near * piece.sag || distance >= least) continue;
    least = distance;
    nearest = &piece;
  }
  if (nearest) return is_left_of(*nearest, at);
  bool inside = false;
  for (const std::vector<Uv>& polygon : outline_.polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i)
      if (crosses(polygon[i], polygon[(i + 1) % polygon.size()], at)) inside = !inside;
  return inside;
}

bool FaceRegion::contains(Uv at) const {
  const int n_u = period_.u > 0.0 ? 1 : 0, n_v = period_.v > 0.0 ? 1 : 0;
  for (int i = -n_u; i <= n_u; ++i)
    for (int j = -n_v; j <= n_v; ++j)
      if (contains_here(at + Uv{i * period_.u, j * period_.v})) return true;
  return false;
}

}  // namespace sterna::surfmesh
