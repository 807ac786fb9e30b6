#include "tests/support/face_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/model/analytic_surfaces.h"
#include "geom/model/spline.h"
#include "surfmesh/face/face_sizes.h"
#include "tests/support/test_constants.h"

namespace sterna::test {
namespace {

/// t in `to` = t.from + length * ((s + e)^power - e^power) / ((1 + e)^power - e^power), where s in [0, 1] is the relative position in `from`. e keeps
/// derivatives finite for powers below one.
class PowerSurface final : public Surface {
 public:
  PowerSurface(SurfacePtr surface, const ParameterBox& box, double power_u, double power_v)
      : surface_(std::move(surface)), inner_(surface_->domain()), box_(box), power_u_(power_u), power_v_(power_v) {}
  ParameterBox domain() const override { return box_; }
  Point point(Uv at) const override { return derivatives(at).point; }
  SurfaceDerivatives derivatives(Uv at) const override {
    const Line u = line(at.u, box_.u, inner_.u, power_u_), v = line(at.v, box_.v, inner_.v, power_v_);
    SurfaceDerivatives d = surface_->derivatives({u.at, v.at});
    d.duu = u.first * u.first * d.duu + u.second * d.du;
    d.dvv = v.first * v.first * d.dvv + v.second * d.dv;
    d.duv = u.first * v.first * d.duv;
    d.du = u.first * d.du;
    d.dv = v.first * d.dv;
    return d;
  }
  std::string kind() const override { return "reparametrised " + surface_->kind(); }

 private:
  struct Line {
    double at, first, second;
  };
  static Line line(double t, const Interval& from, const Interval& to, double power) {
    const double e = power < 1.0 ? 1e-3 : 0.0;
    const double s = std::max((t - from.from) / from.length(), 0.0) + e;
    const double start = std::pow(e, power), rate = to.length() / (std::pow(1.0 + e, power) - start);
    const double by_t = 1.0 / from.length();
    const double second = power == 1.0 || power == 2.0 ? power - 1.0 : (power - 1.0) * std::pow(std::max(s, 1e-9), power - 2.0);
    return {to.from + rate * (std::pow(s, power) - start), rate * by_t * power * std::pow(s, power - 1.0), rate * by_t * by_t * power * second};
  }
  SurfacePtr surface_;
  ParameterBox inner_, box_;
  double power_u_, power_v_;
};

SurfacePtr bump() {
  PointGrid grid{9, 9, {}};
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) {
      const double x = 0.25 * i - 1.0, y = 0.25 * j - 1.0;
      grid.points.push_back({x, y, 0.4 * std::exp(-4.0 * (x * x + y * y)) + 0.1 * std::sin(3.0 * x)});
    }
  return spline_surface(grid, {}, {});
}

/// Returns the upper and lower side of NACA 0012 from the trailing edge around the nose, tapered and twisted along the span.
SurfacePtr wing() {
  constexpr std::size_t n = 41, n_sections = 7;
  PointGrid grid{n, n_sections, {}};
  grid.points.resize(n * n_sections);
  for (std::size_t j = 0; j < n_sections; ++j) {
    const double y = 0.5 * static_cast<double>(j), chord = 1.0 - 0.15 * y, twist = -0.03 * y;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2.0 * k_pi * static_cast<double>(i) / (n - 1);
      const double x = i == 0 || i + 1 == n ? 1.0 : 0.5 * (1.0 + std::cos(angle));
      const double t = 0.6 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1015 * x * x * x * x);
      // Both sides meet exactly at the trailing edge, independent of the rounding of cos of a full turn.
      const double z = i == 0 || i + 1 == n ? 0.0 : angle < k_pi ? t : -t;
      grid.points[i * n_sections + j] = {0.3 * y + chord * (x * std::cos(twist) + z * std::sin(twist)), y, chord * (z * std::cos(twist) - x * std::sin(twist))};
    }
  }
  return spline_surface(grid, {}, {});
}

/// Returns a body's blunt nose: a full turn of bicubic spline whose first row is one point. The lengthwise parameter is slow at the nose.
SurfacePtr nose() {
  constexpr std::size_t n_x = 15, n_turn = 25;
  PointGrid grid{n_x, n_turn, {}};
  for (std::size_t i = 0; i < n_x; ++i)
    for (std::size_t j = 0; j < n_turn; ++j) {
      const double s = static_cast<double>(i) / (n_x - 1), angle = 2.0 * k_pi * static_cast<double>(j % (n_turn - 1)) / (n_turn - 1);
      const double radius = i == 0 ? 0.0 : 0.5 * std::sqrt(s * (2.0 - s));
      grid.points.push_back({2.0 * s * s, radius * std::sin(angle), 0.8 * radius * std::cos(angle)});
    }
  SplineOptions around;
  around.tangents = SplineTangents::periodic;
  return spline_surface(grid, {}, around);
}

/// Returns a plane with parameters at a small angle to each other: x = u + shear v.
SurfacePtr sheared() {
  Frame frame;
  frame.y = normalized(Vec3{10.0, 1.0, 0.0});
  return std::make_shared<PlaneSurface>(frame, ParameterBox{{0, 1}, {0, 1}});
}

struct Edge {
  Uv from, to;
};

/// Returns parameters in [0, 1) along the edge that split it into pieces of the target lengths; one piece if the edge has no length.
std::vector<double> cut(const Surface& surface, const surfmesh::CurvatureSizes& curvature, const Edge& edge, double size, bool& is_pole) {
  constexpr int k_samples = 4000;
  double metres = 0.0;
  std::vector<double> length{0.0};
  Point before = surface.point(edge.from);
  for (int k = 1; k <= k_samples; ++k) {
    const Uv at = edge.from + (static_cast<double>(k) / k_samples) * (edge.to - edge.from);
    const Point p = surface.point(at);
    length.push_back(length.back() + distance(before, p) / std::min(size, curvature(at)));
    metres += distance(before, p);
    before = p;
  }
  is_pole = metres < 1e-9;
  const int n = is_pole ? 1 : std::max(2, static_cast<int>(std::lround(length.back())));
  std::vector<double> at;
  for (int k = 0; k < n; ++k) {
    const double expected = length.back() * k / n;
    const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, std::lower_bound(length.begin() + 1, length.end(), expected) - length.begin()));
    const double gap = length[i] - length[i - 1];
    at.push_back((static_cast<double>(i - 1) + (gap > 0.0 ? (expected - length[i - 1]) / gap : 0.0)) / k_samples);
  }
  return at;
}

}  // namespace

SurfacePtr reparametrised(SurfacePtr surface, const ParameterBox& box, double power_u, double power_v) {
  return std::make_shared<PowerSurface>(std::move(surface), box, power_u, power_v);
}

surfmesh::FaceBorder box_border(const Surface& surface, const ParameterBox& box, double size, double curvature_angle) {
  surfmesh::CurvatureSizes curvature(surface, box);
  curvature.limit({.angle = curvature_angle});
  const Uv a{box.u.from, box.v.from}, b{box.u.to, box.v.from}, c{box.u.to, box.v.to}, d{box.u.from, box.v.to};
  const bool is_closed_u = distance(surface.point(a), surface.point(b)) + distance(surface.point(0.5 * (a + d)), surface.point(0.5 * (b + c))) < 1e-12;
  const bool is_closed_v = distance(surface.point(a), surface.point(d)) + distance(surface.point(0.5 * (a + b)), surface.point(0.5 * (c + d))) < 1e-12;
  // Both sides of a seam use the points of the first side.
  const auto point = [&](Uv at) {
    return surface.point({is_closed_u && at.u == box.u.to ? box.u.from : at.u, is_closed_v && at.v == box.v.to ? box.v.from : at.v});
  };
  // Opposite edges are split in the same direction, so that the sides of a seam match.
  struct Side {
    Edge edge;
    bool is_reversed;
  };
  surfmesh::FaceBorder border;
  border.loops.emplace_back();
  std::vector<surfmesh::BorderPoint>& loop = border.loops.front();
  bool was_pole = false;
  for (const Side& side : {Side{{a, b}, false}, Side{{b, c}, false}, Side{{d, c}, true}, Side{{a, d}, true}}) {
    bool is_pole = false;
    std::vector<double> at = cut(surface, curvature, side.edge, size, is_pole);
    if (side.is_reversed) {
      at.push_back(1.0);
      at.erase(at.begin());
      std::reverse(at.begin(), at.end());
    }
    for (std::size_t k = 0; k < at.size(); ++k) {
      const Uv uv = at[k] == 0.0 ? side.edge.from : at[k] == 1.0 ? side.edge.to : side.edge.from + at[k] * (side.edge.to - side.edge.from);
      // The corner after a pole is identical to the pole.
      loop.push_back({uv, k == 0 && was_pole ? loop.back().point : point(uv)});
    }
    was_pole = is_pole;
  }
  if (was_pole) loop.front().point = loop.back().point;
  return border;
}

std::vector<FaceShape> face_shapes() {
  std::vector<FaceShape> shapes;
  const auto add = [&](std::string name, SurfacePtr surface, double size, double area = 0.0, int n_narrow = 0) {
    const ParameterBox box = surface->domain();
    shapes.push_back({std::move(name), std::move(surface), box, size, area, n_narrow});
  };
  const Frame frame;
  add("plane", std::make_shared<PlaneSurface>(frame, ParameterBox{{0, 2}, {0, 1}}), 0.05, 2.0);
  add("sphere", std::make_shared<SphereSurface>(frame, 1.0), 0.1, 4.0 * k_pi);
  add("pole_patch", std::make_shared<SphereSurface>(frame, 1.0, ParameterBox{{0.3, 2.0}, {0.2, 0.5 * k_pi}}), 0.05, 1.7 * (1.0 - std::sin(0.2)));
  add("cylinder", std::make_shared<CylinderSurface>(frame, 0.5, ParameterBox{k_full_turn, {0, 3}}), 0.1, 3.0 * k_pi);
  add("torus", std::make_shared<TorusSurface>(frame, 1.0, 0.3), 0.06, 4.0 * k_pi * k_pi * 0.3);
  add("bump", bump(), 0.05);
  add("wing", wing(), 0.04);
  add("badly_scaled", reparametrised(bump(), {{0, 1e6}, {0, 1e-3}}, 1.0, 1.0), 0.05);
  add("stretched", reparametrised(std::make_shared<PlaneSurface>(frame, ParameterBox{{0, 2}, {0, 1}}), {{0, 1}, {0, 1}}, 3.0, 1.0), 0.05, 2.0);
  add("nose", nose(), 0.05);
  add("sheared", sheared(), 0.02, 0.0, 20);
  add("cone", std::make_shared<ConeSurface>(frame, 0.0, 0.3, ParameterBox{k_full_turn, {0, 2}}), 0.06, 0.0, 8);
  add("slow_pole", reparametrised(std::make_shared<SphereSurface>(frame, 1.0), {{0, 1}, {0, 1}}, 1.0, 3.0), 0.1, 4.0 * k_pi);
  add("fast_pole", reparametrised(std::make_shared<SphereSurface>(frame, 1.0), {{0, 1}, {0, 1}}, 1.0, 0.4), 0.1, 4.0 * k_pi);
  return shapes;
}

}  // namespace sterna::test
