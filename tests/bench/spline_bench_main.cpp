// Our evaluators of spline surfaces against OpenCASCADE's, in one run: agreement of points and derivatives, ratio of speeds; projections per second.
// usage: spline_bench
// Exit status 1 when any value differs by more than 1e-12 of its scale.
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

constexpr int k_places = 200000;
constexpr int k_rounds = 5;
constexpr double k_agreement = 1e-12;

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

/// Best of some rounds, evaluations per second; `sum` keeps the work alive.
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

bool compare(const char* name, const NurbsSurface& ours) {
  const Handle(Geom_BSplineSurface) theirs = occt_of(ours.form());
  const GeomAdaptor_Surface adaptor(theirs);
  const ParameterBox box = ours.domain();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Uv> at;
  for (int k = 0; k < k_places; ++k) at.push_back({box.u.from + unit(random) * box.u.length(), box.v.from + unit(random) * box.v.length()});

  double largest[6] = {}, difference[6] = {};
  for (const Uv p : at) {
    const SurfaceDerivatives d = ours.derivatives(p);
    gp_Pnt q;
    gp_Vec du, dv, duu, dvv, duv;
    theirs->D2(p.u, p.v, q, du, dv, duu, dvv, duv);
    const Vec3 a[6] = {d.point, d.du, d.dv, d.duu, d.duv, d.dvv}, b[6] = {vec(q.XYZ()), vec(du.XYZ()), vec(dv.XYZ()), vec(duu.XYZ()), vec(duv.XYZ()), vec(dvv.XYZ())};
    for (int k = 0; k < 6; ++k) {
      largest[k] = std::max(largest[k], norm(b[k]));
      difference[k] = std::max(difference[k], distance(a[k], b[k]));
    }
  }
  double worst = 0.0;
  for (int k = 0; k < 6; ++k)
    if (largest[k] > 0.0) worst = std::max(worst, difference[k] / largest[k]);

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
  std::printf("%-24s %9.1e  %7.2f %7.2f %6.1f   %7.2f %7.2f %7.2f %6.1f %6.1f%s\n", name, worst, our_point / 1e6, their_point / 1e6, our_point / their_point, our_second / 1e6, their_second / 1e6, their_plain / 1e6,
              our_second / their_second, our_second / their_plain, sum == 1.2345 ? "!" : "");
  return worst <= k_agreement;
}

void projections(const SurfacePtr& surface) {
  const SurfaceProjector projector(surface);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Point> points;
  std::vector<Uv> seeds;
  for (int k = 0; k < k_places; ++k) {
    const Uv at{0.02 + 0.96 * unit(random), 0.02 + 0.96 * unit(random)};
    const SurfaceDerivatives d = surface->derivatives(at);
    points.push_back(d.point + 0.01 * unit(random) * normalized(cross(d.du, d.dv)));
    seeds.push_back({at.u + 0.01 * (unit(random) - 0.5), at.v + 0.02 * (unit(random) - 0.5)});
  }
  std::vector<SurfaceFoot> feet(points.size());
  const RunContext one({.threads = 1});
  Clock::time_point start = Clock::now();
  projector.project(points, seeds, feet, one);
  const double seeded = static_cast<double>(points.size()) / seconds_since(start);
  start = Clock::now();
  projector.project(points, {}, feet, one);
  const double global = static_cast<double>(points.size()) / seconds_since(start);
  std::printf("projections on the bicubic wing, one core: %.0f thousand seeded, %.0f thousand nearest a second\n", seeded / 1e3, global / 1e3);
}

}  // namespace

int main() {
  std::printf("OpenCASCADE %s; best of %d rounds of %d random places; millions of evaluations a second\n", OCC_VERSION_COMPLETE, k_rounds, k_places);
  std::printf("%-24s %9s  %7s %7s %6s   %7s %7s %7s %6s %6s\n", "", "relative", "point", "OCCT", "ratio", "second", "adaptor", "plain", "ratio", "ratio");
  std::printf("%-24s %9s  %7s %7s %6s   %7s %7s %7s %6s %6s\n", "surface", "difference", "ours", "adaptor", "", "ours", "OCCT", "OCCT", "", "");
  const SplineOptions cubic{}, akima{.tangents = SplineTangents::akima}, linear{.tangents = SplineTangents::linear};
  const PointGrid grid = wing_grid();
  bool is_good = compare("bicubic, C2", NurbsSurface(spline_surface_form(grid, cubic, cubic)));
  is_good = compare("bicubic, Akima", NurbsSurface(spline_surface_form(grid, akima, akima))) && is_good;
  is_good = compare("cubic x linear", NurbsSurface(spline_surface_form(grid, cubic, linear))) && is_good;
  NurbsSurfaceForm rational = spline_surface_form(grid, cubic, cubic);
  for (std::size_t i = 0; i < rational.poles.size(); ++i) rational.weights.push_back(1.0 + 0.3 * std::sin(static_cast<double>(i)));
  is_good = compare("bicubic, rational", NurbsSurface(rational)) && is_good;
  const NurbsSurfaceForm plain = spline_surface_form(grid, cubic, cubic);
  is_good = compare("degree 5 x 5", NurbsSurface(on_knots_v(on_knots_u(plain, 5, elevated_knots(plain.knots_u, 2)), 5, elevated_knots(plain.knots_v, 2)))) && is_good;
  projections(std::make_shared<NurbsSurface>(plain));
  std::printf(is_good ? "all agree to %.0e\n" : "NOT all agree to %.0e\n", k_agreement);
  return is_good ? 0 : 1;
}
