// Integral over a trimmed face: by Green's theorem that of g(u, v) over the face is the border integral of G dv, G(u, v) = integral of g from a fixed u
// to u. Each border piece between knots of v, and each inner integral between knots of u, has a Gauss rule of its own.
#include "geom/model/model_measures.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sterna {
namespace {

/// Gauss-Legendre on [0, 1], exact to degree 9.
constexpr std::array<double, 5> k_nodes = {0.046910077030668004, 0.23076534494715845, 0.5, 0.7692346550528415, 0.95308992296933200};
constexpr std::array<double, 5> k_weights = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454};
/// Pieces of a direction without knots: surfaces of sines and cosines are integrated to 1e-12 by so many.
constexpr int k_plain_pieces = 12;
/// Pieces of a border piece that is not a parameter line.
constexpr int k_curved_pieces = 4;

struct Sums {
  double area = 0.0, volume = 0.0, projected = 0.0;
  Vec3 normal;
  void add(double w, const Sums& s) {
    area += w * s.area;
    volume += w * s.volume;
    projected += w * s.projected;
    normal += w * s.normal;
  }
};

std::vector<double> pieces(const Interval& domain, std::vector<double> inner) {
  if (inner.empty())
    for (int i = 1; i < k_plain_pieces; ++i) inner.push_back(domain.from + domain.length() * i / k_plain_pieces);
  inner.push_back(domain.from);
  inner.push_back(domain.to);
  std::sort(inner.begin(), inner.end());
  inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
  return inner;
}

/// Knots with more between them: rational pieces are no polynomials, a rule of degree 9 needs a few for each.
std::vector<double> refined(const std::vector<double>& knots) {
  constexpr int k_pieces = 4;
  std::vector<double> fine;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    for (int k = 0; k < k_pieces; ++k) fine.push_back(knots[i] + (knots[i + 1] - knots[i]) * k / k_pieces);
  return fine;
}

/// Integral of the integrand along u from `from` to `to` at one v.
Sums along_u(const Surface& surface, const std::vector<double>& breaks, double from, double to, double v) {
  Sums total;
  const double sign = to >= from ? 1.0 : -1.0;
  const double low = std::min(from, to), high = std::max(from, to);
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double a = i == 0 ? low : std::max(low, breaks[i]);                           // beyond the outermost knots the end pieces go on
    const double b = i + 2 == breaks.size() ? high : std::min(high, breaks[i + 1]);
    if (!(b > a)) continue;
    for (std::size_t k = 0; k < k_nodes.size(); ++k) {
      const SurfaceDerivatives d = surface.derivatives({a + k_nodes[k] * (b - a), v});
      const Vec3 n = cross(d.du, d.dv);
      total.add(sign * k_weights[k] * (b - a), {norm(n), dot(d.point, n) / 3.0, 0.5 * std::abs(n.z), n});
    }
  }
  return total;
}

}  // namespace

FaceMeasures face_measures(const Model& model, FaceId id) {
  const ModelFace& face = model.faces[id];
  const Surface& surface = *face.surface;
  const ParameterBox domain = surface.domain();
  std::vector<double> knots_u = surface.breaks_u(), knots_v = surface.breaks_v();
  if (const std::optional<NurbsSurfaceForm> form = surface.exact_nurbs()) {
    const bool is_rational = !form->weights.empty();
    knots_u = is_rational ? refined(form->knots_u) : form->knots_u;
    knots_v = is_rational ? refined(form->knots_v) : form->knots_v;
  }
  const std::vector<double> breaks_u = pieces(domain.u, knots_u), breaks_v = pieces(domain.v, knots_v);
  Sums total;
  for (const Border& border : face.borders)
    for (const EdgeUse& use : border) {
      const Interval range = use.parameter->domain();
      const Uv start = use.parameter->point(range.from), end = use.parameter->point(range.to);
      const auto* line = use.parameter.get();
      const std::optional<NurbsCurveForm<Uv>> form = line->exact_nurbs();
      const bool is_straight = form && form->poles.size() == 2;
      if (is_straight && start.v == end.v) continue;  // dv = 0
      std::vector<double> inner;
      if (is_straight) {
        for (const double v : breaks_v)
          if (const double part = (v - start.v) / (end.v - start.v); part > 0.0 && part < 1.0) inner.push_back(range.from + part * range.length());
        inner.push_back(range.from + 0.5 * range.length());  // never taken for a direction without knots
      } else {
        std::vector<double> knots = form ? form->knots : std::vector<double>{};
        knots = pieces(range, knots);
        for (std::size_t i = 0; i + 1 < knots.size(); ++i)
          for (int k = 0; k < k_curved_pieces; ++k) inner.push_back(knots[i] + (knots[i + 1] - knots[i]) * k / k_curved_pieces);
      }
      const std::vector<double> steps = pieces(range, inner);
      for (std::size_t i = 0; i + 1 < steps.size(); ++i)
        for (std::size_t k = 0; k < k_nodes.size(); ++k) {
          const double h = steps[i + 1] - steps[i];
          const ParameterCurveDerivatives p = use.parameter->derivatives(steps[i] + k_nodes[k] * h);
          const double weight = k_weights[k] * h * p.first.v * (use.is_reversed ? -1.0 : 1.0);
          if (weight != 0.0) total.add(weight, along_u(surface, breaks_u, domain.u.from, p.point.u, p.point.v));
        }
    }
  const double sign = face.is_reversed ? -1.0 : 1.0;
  return {total.area, sign * total.volume, sign * total.normal, total.projected};
}

SolidMeasures solid_measures(const Model& model, SolidId solid) {
  SolidMeasures sum;
  Vec3 vector;
  for (const FaceId f : model.solids[solid].faces) {
    const FaceMeasures m = face_measures(model, f);
    sum.area += m.area;
    sum.volume += m.volume;
    vector += m.vector_area;
  }
  sum.open = sum.area > 0.0 ? norm(vector) / sum.area : 0.0;
  return sum;
}

}  // namespace sterna
