// Compares our spline surface evaluators with OpenCASCADE's in one run: agreement of points and derivatives, ratio of speeds; projections per second.
// usage: spline_bench
// Each derivative is a sum of poles times derivatives of basis functions that cancel: over intervals of length h the second derivatives of the functions grow
// as 1 / h^2, while the sum does not. The rounding errors of any evaluator are therefore relative to the sum of the absolute terms, and differences are
// measured against that sum. An evaluator with 113 bits (__float128) gives the error of each of the two. Exit status 1 if any value differs by more than 1e-12
// of its terms from OpenCASCADE's or from the 113-bit value, or if our evaluator is slower.
#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Standard_Version.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "geom/model/nurbs_surface.h"
#include "geom/model/nurbs_tools.h"
#include "geom/model/projection.h"
#include "geom/model/spline.h"

namespace {

using namespace sterna;
using Clock = std::chrono::steady_clock;

constexpr int k_locations = 200000;
constexpr int k_rounds = 5;
constexpr double k_agreement = 1e-12;
constexpr std::size_t k_truth_step = 20;  ///< every k_truth_step-th location is compared with the 113-bit value

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Vec3 vec(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

void multiplicities(const std::vector<double>& knots, TColStd_Array1OfReal& values, TColStd_Array1OfInteger& counts) {
  int k = 0;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (i == 0 || knots[i] != knots[i - 1]) {
      values.SetValue(++k, knots[i]);
      counts.SetValue(k, 1);
    } else {
      counts.SetValue(k, counts.Value(k) + 1);
    }
  }
}

int distinct(const std::vector<double>& knots) {
  int n = 1;
  for (std::size_t i = 1; i < knots.size(); ++i) n += knots[i] != knots[i - 1] ? 1 : 0;
  return n;
}

Handle(Geom_BSplineSurface) occt_of(const NurbsSurfaceForm& form) {
  TColgp_Array2OfPnt poles(1, static_cast<int>(form.n_u), 1, static_cast<int>(form.n_v));
  TColStd_Array2OfReal weights(1, static_cast<int>(form.n_u), 1, static_cast<int>(form.n_v));
  for (std::size_t i = 0; i < form.n_u; ++i)
    for (std::size_t j = 0; j < form.n_v; ++j) {
      const Point& p = form.poles[i * form.n_v + j];
      poles.SetValue(static_cast<int>(i) + 1, static_cast<int>(j) + 1, gp_Pnt(p.x, p.y, p.z));
      weights.SetValue(static_cast<int>(i) + 1, static_cast<int>(j) + 1, form.weights.empty() ? 1.0 : form.weights[i * form.n_v + j]);
    }
  TColStd_Array1OfReal ku(1, distinct(form.knots_u)), kv(1, distinct(form.knots_v));
  TColStd_Array1OfInteger mu(1, ku.Length()), mv(1, kv.Length());
  multiplicities(form.knots_u, ku, mu);
  multiplicities(form.knots_v, kv, mv);
  if (form.weights.empty()) return new Geom_BSplineSurface(poles, ku, kv, mu, mv, form.degree_u, form.degree_v);
  return new Geom_BSplineSurface(poles, weights, ku, kv, mu, mv, form.degree_u, form.degree_v);
}

PointGrid wing_grid() {
  PointGrid grid{65, 13, {}};
  for (int i = 0; i < 65; ++i)
    for (int j = 0; j < 13; ++j) {
      const double a = 2.0 * std::numbers::pi * i / 64.0, y = j / 12.0, chord = 3.0 - 2.0 * y, x = 0.5 * (1.0 + std::cos(a));
      const double t = 0.6 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x), z = i <= 32 ? t : -t;
      grid.points.push_back({4.0 * y + chord * x, 12.0 * y, chord * z + y * y});
    }
  return grid;
}

/// Returns the best of some rounds, in evaluations per second; `sum` prevents the compiler from removing the work.
template <class F>
double rate(const std::vector<Uv>& at, double& sum, const F& f) {
  double best = 1e300;
  for (int round = 0; round < k_rounds; ++round) {
    const Clock::time_point start = Clock::now();
    for (const Uv p : at) sum += f(p);
    best = std::min(best, seconds_since(start));
  }
  return static_cast<double>(at.size()) / best;
}

// ---------------------------------------------------------------- the 113-bit reference

using Quad = __float128;

/// Value and two derivatives of every basis function that is not zero at t, by Cox and de Boor's definition.
struct QuadBasis {
  std::size_t first = 0;
  std::vector<Quad> of[3];
};
QuadBasis quad_basis(int degree, const std::vector<double>& knots, double t) {
  const auto p = static_cast<std::size_t>(degree);
  std::size_t span = static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), t) - knots.begin());
  span = std::clamp(span, p + 1, knots.size() - p - 1) - 1;
  while (!(knots[span] < knots[span + 1])) --span;
  QuadBasis basis;
  basis.first = span - p;
  // functions[q] holds the functions of degree q, shifted by span - p; derivatives come from degrees p - 1 and p - 2.
  std::vector<std::vector<Quad>> functions(p + 1, std::vector<Quad>(p + 2, Quad(0)));
  const auto knot = [&](std::size_t i) { return Quad(knots[basis.first + i]); };
  const auto share = [](Quad a, Quad b) { return b > 0 ? a / b : Quad(0); };
  functions[0][p] = 1;
  for (std::size_t q = 1; q <= p; ++q)
    for (std::size_t i = p - q; i <= p; ++i)
      functions[q][i] = share((Quad(t) - knot(i)) * functions[q - 1][i], knot(i + q) - knot(i)) +
                        share((knot(i + q + 1) - Quad(t)) * functions[q - 1][i + 1], knot(i + q + 1) - knot(i + 1));
  const auto derived = [&](const std::vector<Quad>& lower, std::size_t q) {
    std::vector<Quad> d(p + 2, Quad(0));
    for (std::size_t i = p - q; i <= p; ++i) d[i] = Quad(q) * (share(lower[i], knot(i + q) - knot(i)) - share(lower[i + 1], knot(i + q + 1) - knot(i + 1)));
    return d;
  };
  basis.of[0] = functions[p];
  basis.of[1] = derived(functions[p - 1], p);
  basis.of[2] = p < 2 ? std::vector<Quad>(p + 2, Quad(0)) : derived(derived(functions[p - 2], p - 1), p);
  return basis;
}

/// One of S, S_u, S_v, S_uu, S_uv, S_vv, and the sum of the absolute values of its terms.
struct Truth {
  Vec3 value[6];
  double terms[6] = {};
};
Truth truth_at(const NurbsSurfaceForm& form, Uv at) {
  const QuadBasis u = quad_basis(form.degree_u, form.knots_u, at.u), v = quad_basis(form.degree_v, form.knots_v, at.v);
  constexpr int k_orders[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
  Quad sums[6][4] = {}, terms[6] = {};
  for (std::size_t i = 0; i <= static_cast<std::size_t>(form.degree_u); ++i)
    for (std::size_t j = 0; j <= static_cast<std::size_t>(form.degree_v); ++j) {
      const std::size_t pole = (u.first + i) * form.n_v + v.first + j;
      const Point& p = form.poles[pole];
      const Quad w = form.weights.empty() ? 1.0 : form.weights[pole];
      for (int k = 0; k < 6; ++k) {
        const Quad b = u.of[k_orders[k][0]][i] * v.of[k_orders[k][1]][j] * w;
        const Quad of[4] = {b * p.x, b * p.y, b * p.z, b};
        for (int c = 0; c < 4; ++c) sums[k][c] += of[c];
        terms[k] += (b < 0 ? -b : b) * Quad(norm(p));
      }
    }
  Truth truth;
  Quad s[6][3];
  const Quad(&W)[6][4] = sums;
  for (int c = 0; c < 3; ++c) {  // quotient rule
    s[0][c] = W[0][c] / W[0][3];
    s[1][c] = (W[1][c] - W[1][3] * s[0][c]) / W[0][3];
    s[2][c] = (W[2][c] - W[2][3] * s[0][c]) / W[0][3];
    s[3][c] = (W[3][c] - 2 * W[1][3] * s[1][c] - W[3][3] * s[0][c]) / W[0][3];
    s[4][c] = (W[4][c] - W[1][3] * s[2][c] - W[2][3] * s[1][c] - W[4][3] * s[0][c]) / W[0][3];
    s[5][c] = (W[5][c] - 2 * W[2][3] * s[2][c] - W[5][3] * s[0][c]) / W[0][3];
  }
  for (int k = 0; k < 6; ++k) {
    truth.value[k] = {static_cast<double>(s[k][0]), static_cast<double>(s[k][1]), static_cast<double>(s[k][2])};
    truth.terms[k] = static_cast<double>(terms[k] / W[0][3]);
  }
  return truth;
}

/// Largest differences over all locations and the six values.
struct Agreement {
  double between = 0.0, ours = 0.0, theirs = 0.0;  ///< shares of the sum of absolute terms
  double our_share = 0.0, their_share = 0.0;       ///< error as a share of the largest value on the surface
  const char* worst = "";                          ///< name of the value with the largest error by that measure
};

Agreement agreement(const NurbsSurface& ours, const Geom_BSplineSurface& theirs, const std::vector<Uv>& locations) {
  constexpr const char* k_names[6] = {"S", "Su", "Sv", "Suu", "Suv", "Svv"};
  double largest[6] = {}, our_error[6] = {}, their_error[6] = {};
  Agreement result;
  for (std::size_t i = 0; i < locations.size(); i += k_truth_step) {
    const Uv at = locations[i];
    const Truth truth = truth_at(ours.form(), at);
    const SurfaceDerivatives d = ours.derivatives(at);
    gp_Pnt q;
    gp_Vec du, dv, duu, dvv, duv;
    theirs.D2(at.u, at.v, q, du, dv, duu, dvv, duv);
    const Vec3 a[6] = {d.point, d.du, d.dv, d.duu, d.duv, d.dvv},
               b[6] = {vec(q.XYZ()), vec(du.XYZ()), vec(dv.XYZ()), vec(duu.XYZ()), vec(duv.XYZ()), vec(dvv.XYZ())};
    for (int k = 0; k < 6; ++k) {
      largest[k] = std::max(largest[k], norm(truth.value[k]));
      our_error[k] = std::max(our_error[k], distance(a[k], truth.value[k]));
      their_error[k] = std::max(their_error[k], distance(b[k], truth.value[k]));
      if (!(truth.terms[k] > 0.0)) continue;
      result.between = std::max(result.between, distance(a[k], b[k]) / truth.terms[k]);
      result.ours = std::max(result.ours, distance(a[k], truth.value[k]) / truth.terms[k]);
      result.theirs = std::max(result.theirs, distance(b[k], truth.value[k]) / truth.terms[k]);
    }
  }
  for (int k = 0; k < 6; ++k) {
    if (!(largest[k] > 0.0)) continue;
    if (our_error[k] / largest[k] > result.our_share) result.worst = k_names[k];
    result.our_share = std::max(result.our_share, our_error[k] / largest[k]);
    result.their_share = std::max(result.their_share, their_error[k] / largest[k]);
  }
  return result;
}

bool compare(const char* name, const NurbsSurface& ours) {
  const Handle(Geom_BSplineSurface) theirs = occt_of(ours.form());
  const GeomAdaptor_Surface adaptor(theirs);
  const ParameterBox box = ours.domain();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Uv> at;
  for (int k = 0; k < k_locations; ++k) at.push_back({box.u.from + unit(random) * box.u.length(), box.v.from + unit(random) * box.v.length()});
  const Agreement agree = agreement(ours, *theirs, at);

  double sum = 0.0;
  gp_Pnt q;
  gp_Vec du, dv, duu, dvv, duv;
  const double our_point = rate(at, sum, [&](Uv p) { return ours.point(p).x; });
  const double their_point = rate(at, sum, [&](Uv p) { return adaptor.Value(p.u, p.v).X(); });
  const double our_second = rate(at, sum, [&](Uv p) { return ours.derivatives(p).duv.x; });
  const double their_second = rate(at, sum, [&](Uv p) {
    adaptor.D2(p.u, p.v, q, du, dv, duu, dvv, duv);
    return duv.X();
  });
  const double their_plain = rate(at, sum, [&](Uv p) {
    theirs->D2(p.u, p.v, q, du, dv, duu, dvv, duv);
    return duv.X();
  });
  std::printf("%-18s %8.1e %8.1e %8.1e  %8.1e %8.1e %-4s %6.2f %6.2f %6.1f  %6.2f %6.2f %6.2f %6.1f %6.1f%s\n", name, agree.between, agree.ours, agree.theirs,
              agree.our_share, agree.their_share, agree.worst, our_point / 1e6, their_point / 1e6, our_point / their_point, our_second / 1e6,
              their_second / 1e6, their_plain / 1e6, our_second / their_second, our_second / their_plain, sum == 1.2345 ? "!" : "");
  return std::max(agree.between, agree.ours) <= k_agreement && our_point > their_point && our_second > std::max(their_second, their_plain);
}

void projections(const SurfacePtr& surface) {
  const SurfaceProjector projector(surface);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Point> points;
  std::vector<Uv> seeds;
  for (int k = 0; k < k_locations; ++k) {
    const Uv at{0.02 + 0.96 * unit(random), 0.02 + 0.96 * unit(random)};
    const SurfaceDerivatives d = surface->derivatives(at);
    points.push_back(d.point + 0.01 * unit(random) * normalized(cross(d.du, d.dv)));
    seeds.push_back({at.u + 0.01 * (unit(random) - 0.5), at.v + 0.02 * (unit(random) - 0.5)});
  }
  std::vector<SurfaceProjection> nearest_points(points.size());
  const RunContext one({.threads = 1});
  Clock::time_point start = Clock::now();
  projector.project(points, seeds, nearest_points, one);
  const double seeded = static_cast<double>(points.size()) / seconds_since(start);
  start = Clock::now();
  projector.project(points, {}, nearest_points, one);
  const double global = static_cast<double>(points.size()) / seconds_since(start);
  std::printf("projections on the bicubic wing, one core: %.0f thousand seeded, %.0f thousand nearest a second\n", seeded / 1e3, global / 1e3);
}

}  // namespace

int main() {
  std::printf("OpenCASCADE %s; best of %d rounds of %d random places; millions of evaluations a second\n", OCC_VERSION_COMPLETE, k_rounds, k_locations);
  std::printf("%-18s %-26s  %-22s %-20s  %s\n", "", "differences / terms", "/ largest, from truth", "points", "second derivatives");
  std::printf("%-18s %8s %8s %8s  %8s %8s %-4s %6s %6s %6s  %6s %6s %6s %6s %6s\n", "surface", "between", "ours", "OCCT", "ours", "OCCT", "of", "ours", "OCCT",
              "ratio", "ours", "adapt.", "plain", "ratio", "ratio");
  const SplineOptions cubic{}, akima{.tangents = SplineTangents::akima}, linear{.tangents = SplineTangents::linear};
  const PointGrid grid = wing_grid();
  bool is_good = compare("bicubic, C2", NurbsSurface(spline_surface_form(grid, cubic, cubic)));
  is_good = compare("bicubic, Akima", NurbsSurface(spline_surface_form(grid, akima, akima))) && is_good;
  is_good = compare("cubic x linear", NurbsSurface(spline_surface_form(grid, cubic, linear))) && is_good;
  NurbsSurfaceForm rational = spline_surface_form(grid, cubic, cubic);
  for (std::size_t i = 0; i < rational.poles.size(); ++i) rational.weights.push_back(1.0 + 0.3 * std::sin(static_cast<double>(i)));
  is_good = compare("bicubic, rational", NurbsSurface(rational)) && is_good;
  const NurbsSurfaceForm plain = spline_surface_form(grid, cubic, cubic);
  is_good =
      compare("degree 5 x 5", NurbsSurface(on_knots_v(on_knots_u(plain, 5, elevated_knots(plain.knots_u, 2)), 5, elevated_knots(plain.knots_v, 2)))) && is_good;
  projections(std::make_shared<NurbsSurface>(plain));
  std::printf(is_good ? "all agree to %.0e, and ours are faster\n" : "NOT all agree to %.0e and are faster\n", k_agreement);
  return is_good ? 0 : 1;
}
