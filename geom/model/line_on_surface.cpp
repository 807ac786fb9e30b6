// Composes a polynomial spline surface with a straight line of its parameter plane. Between the crossings of knot lines the composition is a polynomial whose
// degree is the sum of both degrees, and at a crossing it is as smooth as the surface. It therefore lies in a spline space with known knots, and interpolation
// reproduces it exactly.
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

#include "geom/model/knot_basis.h"
#include "geom/model/model_builder.h"
#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"

namespace sterna {
namespace {

/// Crossings of the line nearer to each other or to its ends than this fraction of the line are merged: they differ by rounding of parameters.
constexpr double k_same_crossing = 1e-9;

/// Location on the line and the multiplicity required of the composed curve's knot there.
struct Crossing {
  double t;
  int multiplicity;
};

void add_crossings(std::vector<Crossing>& crossings, const std::vector<double>& knots, int degree, double from, double to, int total_degree) {
  if (from == to) return;
  for (std::size_t i = 0; i < knots.size();) {
    std::size_t end = i;
    while (end < knots.size() && knots[end] == knots[i]) ++end;
    const int smoothness = degree - static_cast<int>(end - i);
    if (const double t = (knots[i] - from) / (to - from); t > k_same_crossing && t < 1.0 - k_same_crossing) crossings.push_back({t, total_degree - smoothness});
    i = end;
  }
}

}  // namespace

CurvePtr line_on_surface(const NurbsSurfaceForm& form, Uv from, Uv to) {
  NurbsCurveForm<Point> line;
  line.degree = (from.u == to.u ? 0 : form.degree_u) + (from.v == to.v ? 0 : form.degree_v);
  std::vector<Crossing> crossings;
  add_crossings(crossings, form.knots_u, form.degree_u, from.u, to.u, line.degree);
  add_crossings(crossings, form.knots_v, form.degree_v, from.v, to.v, line.degree);
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
  line.knots.assign(static_cast<std::size_t>(line.degree) + 1, 0.0);
  for (std::size_t i = 0; i < crossings.size();) {
    std::size_t end = i;
    int multiplicity = 0;
    for (; end < crossings.size() && crossings[end].t - crossings[i].t <= k_same_crossing; ++end)
      multiplicity = std::max(multiplicity, crossings[end].multiplicity);
    line.knots.insert(line.knots.end(), static_cast<std::size_t>(std::min(multiplicity, line.degree)), crossings[i].t);
    i = end;
  }
  line.knots.insert(line.knots.end(), static_cast<std::size_t>(line.degree) + 1, 1.0);

  // Interpolation at the Greville abscissae: there is one for each function, and the system is regular.
  const KnotBasis basis(line.degree, line.knots, false, "following a line on a surface");
  const std::size_t n = basis.n_functions();
  const NurbsSurface surface(form);
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  Eigen::MatrixXd points(static_cast<Eigen::Index>(n), 3);
  for (std::size_t i = 0; i < n; ++i) {
    double t = 0.0;
    for (int k = 1; k <= line.degree; ++k) t += line.knots[i + static_cast<std::size_t>(k)] / line.degree;
    BasisValues values;
    basis.evaluate<false>(std::clamp(t, 0.0, 1.0), values);
    for (int k = 0; k <= line.degree; ++k) system(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(values.first) + k) = values.value[k];
    const Point p = surface.point(from + t * (to - from));
    points.row(static_cast<Eigen::Index>(i)) = Eigen::RowVector3d(p.x, p.y, p.z);
  }
  const Eigen::MatrixXd poles = system.partialPivLu().solve(points);
  for (Eigen::Index i = 0; i < poles.rows(); ++i) line.poles.push_back({poles(i, 0), poles(i, 1), poles(i, 2)});
  line.poles.front() = surface.point(from);
  line.poles.back() = surface.point(to);
  return std::make_shared<NurbsCurve>(std::move(line));
}

}  // namespace sterna
