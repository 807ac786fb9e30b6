#include "surfmesh/face/face_sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sterna::surfmesh {
namespace {

constexpr double k_no_limit = std::numeric_limits<double>::infinity();
/// Smallest number of samples between two breaks: few are needed, because a bicubic piece has few bumps.
constexpr std::size_t k_samples_per_piece = 4;
/// Limits for the total number of samples in one direction. The lower limit resolves analytic surfaces that are one piece; the upper one limits the cost for
/// faces of many pieces.
constexpr std::size_t k_min_samples = 33;
constexpr std::size_t k_max_samples = 257;
/// Squared sine of the angle between du and dv, below which the surface has no normal.
constexpr double k_min_sine2 = 1e-20;
/// Rounds of four sweeps that carry sizes over the grid; each sweep carries sizes any distance in its direction, so few are needed.
constexpr int k_growth_rounds = 3;

std::vector<double> sample_line(const std::vector<double>& breaks, const Interval& range) {
  std::vector<double> ends{range.from};
  for (const double b : breaks)
    if (b > range.from && b < range.to) ends.push_back(b);
  ends.push_back(range.to);
  const std::size_t n_pieces = ends.size() - 1;
  const std::size_t target = std::clamp(n_pieces * k_samples_per_piece, k_min_samples - 1, k_max_samples - 1);
  const std::size_t each = std::max<std::size_t>(1, (target + n_pieces - 1) / n_pieces);
  std::vector<double> line;
  for (std::size_t p = 0; p < n_pieces; ++p)
    for (std::size_t k = 0; k < each; ++k) line.push_back(ends[p] + (ends[p + 1] - ends[p]) * static_cast<double>(k) / static_cast<double>(each));
  line.push_back(range.to);
  return line;
}

/// Returns index i and fraction s in [0, 1] with line[i] (1 - s) + line[i + 1] s = t, clamped to the line.
std::pair<std::size_t, double> find_on_line(const std::vector<double>& line, double t) {
  const auto above = std::upper_bound(line.begin() + 1, line.end() - 1, t);
  const auto i = static_cast<std::size_t>(above - line.begin()) - 1;
  const double length = line[i + 1] - line[i];
  return {i, length > 0.0 ? std::clamp((t - line[i]) / length, 0.0, 1.0) : 0.0};
}

/// Samples on the border of the box must count as inside of polygons that run along it. For the test they are moved towards the middle of the box, by this
/// fraction of its size.
constexpr double k_inwards = 1e-6;
double inwards(double t, const Interval& range) { return t + k_inwards * (0.5 * (range.from + range.to) - t); }

/// Returns the area inside polygons; holes run against the first polygon.
double area_of(std::span<const std::vector<Uv>> loops) {
  double sum = 0.0;
  for (const std::vector<Uv>& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Uv &a = loop[i], &b = loop[(i + 1) % loop.size()];
      sum += 0.5 * (a.u * b.v - a.v * b.u);
    }
  return std::abs(sum);
}

/// Finds the crossings of polygons with the line of this u, ascending in v.
void find_crossings_of_row(std::span<const std::vector<Uv>> loops, double u, std::vector<double>& crossings) {
  crossings.clear();
  for (const std::vector<Uv>& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Uv &a = loop[i], &b = loop[(i + 1) % loop.size()];
      if ((a.u <= u) != (b.u <= u)) crossings.push_back(a.v + (u - a.u) / (b.u - a.u) * (b.v - a.v));
    }
  std::sort(crossings.begin(), crossings.end());
}

/// Edges match the sizes on average only: they are up to about 1.3 times as long, and the error grows with the square of their length.
constexpr double k_error_share = 0.6;

}  // namespace

double largest_curvature(const SurfaceDerivatives& d) {
  const double e = norm2(d.du), f = dot(d.du, d.dv), g = norm2(d.dv);
  const double area2 = e * g - f * f;
  if (!(area2 > k_min_sine2 * e * g)) return 0.0;
  const Vec3 normal = cross(d.du, d.dv) / std::sqrt(area2);
  const double l = dot(d.duu, normal), m = dot(d.duv, normal), n = dot(d.dvv, normal);
  const double mean = 0.5 * (e * n - 2.0 * f * m + g * l) / area2;
  const double gauss = (l * n - m * m) / area2;
  return std::abs(mean) + std::sqrt(std::max(0.0, mean * mean - gauss));
}

void CurvatureLimits::take_less(const CurvatureLimits& other) {
  for (double CurvatureLimits::*member : {&CurvatureLimits::angle, &CurvatureLimits::chord_error, &CurvatureLimits::min_edge, &CurvatureLimits::most_turn,
                                          &CurvatureLimits::least_edge, &CurvatureLimits::error_edge})
    this->*member = std::min(this->*member, other.*member);
}

double CurvatureLimits::size_of(double curvature) const {
  if (!(curvature > 0.0)) return k_no_limit;
  const double radius = 1.0 / curvature;
  const auto chord = [&](double by) { return std::isfinite(by) ? 2.0 * std::sin(0.5 * by) * radius : k_no_limit; };
  const double size = std::max({chord(angle), std::min(min_edge, chord(most_turn)), least_edge});
  if (!std::isfinite(chord_error)) return size;
  // The arc over the middle of an equilateral triangle with the edge length l rises by e: l^2 = 3 (2 R e - e^2). Curvatures above 1/e lead to the size that
  // spans a feature as high as the error, and never to less, because finer edges would not bring the surface nearer.
  const double e = k_error_share * chord_error, r = std::max(radius, e);
  return std::min(size, std::max(error_edge, std::sqrt(3.0 * (2.0 * r * e - e * e))));
}

CurvatureSizes::CurvatureSizes(const Surface& surface, const ParameterBox& box, std::span<const std::vector<Uv>> loops) {
  const bool is_plane = surface.kind() == "plane";
  if (is_plane) {
    u_ = {box.u.from, box.u.to};
    v_ = {box.v.from, box.v.to};
  } else {
    u_ = sample_line(surface.breaks_u(), box.u);
    v_ = sample_line(surface.breaks_v(), box.v);
  }
  const std::size_t n_u = u_.size(), n_v = v_.size();
  size_.assign(n_u * n_v, k_no_limit);
  curvature_.assign(n_u * n_v, 0.0);
  points_.resize(n_u * n_v);
  cell_.assign(n_u * n_v, 0.0);
  is_inside_.assign(n_u * n_v, 0);
  std::size_t n_fast_u = 0, n_fast_v = 0;
  std::vector<double> crossings;
  for (std::size_t i = 0; i < n_u; ++i) {
    find_crossings_of_row(loops, inwards(u_[i], box.u), crossings);
    for (std::size_t j = 0; j < n_v; ++j) {
      const std::size_t k = i * n_v + j;
      const SurfaceDerivatives d = surface.derivatives({u_[i], v_[j]});
      points_[k] = d.point;
      const bool is_inside = loops.empty() || (std::upper_bound(crossings.begin(), crossings.end(), inwards(v_[j], box.v)) - crossings.begin()) % 2 == 1;
      // Some parametrisations have no finite speed on their border (a square root at a nose). Samples there are ignored.
      if (is_finite(d.du)) {
        mean_speed_u_ += norm(d.du);
        ++n_fast_u;
      }
      if (is_finite(d.dv)) {
        mean_speed_v_ += norm(d.dv);
        ++n_fast_v;
      }
      if (!is_inside) continue;
      is_inside_[k] = 1;
      if (const double curvature = largest_curvature(d); std::isfinite(curvature)) curvature_[k] = curvature;
      const double du = 0.5 * (u_[std::min(i + 1, n_u - 1)] - u_[i == 0 ? 0 : i - 1]), dv = 0.5 * (v_[std::min(j + 1, n_v - 1)] - v_[j == 0 ? 0 : j - 1]);
      if (const double cell = norm(cross(d.du, d.dv)) * du * dv; std::isfinite(cell)) area_ += cell_[k] = cell;
    }
  }
  if (n_fast_u > 0) mean_speed_u_ /= static_cast<double>(n_fast_u);
  if (n_fast_v > 0) mean_speed_v_ /= static_cast<double>(n_fast_v);
  if (is_plane && !loops.empty()) area_ = area_of(loops) * mean_speed_u_ * mean_speed_v_;
}

void CurvatureSizes::limit(const CurvatureLimits& limits) {
  const std::size_t n_u = u_.size(), n_v = v_.size();
  for (std::size_t k = 0; k < size_.size(); ++k) size_[k] = limits.size_of(curvature_[k]);
  if (!std::isfinite(limits.growth)) return;
  const auto carry = [&](std::size_t from, std::size_t to) {
    size_[to] = std::min(size_[to], size_[from] + limits.growth * distance(points_[from], points_[to]));
  };
  for (int round = 0; round < k_growth_rounds; ++round) {
    for (std::size_t i = 0; i < n_u; ++i)
      for (std::size_t j = 0; j < n_v; ++j) {
        if (i > 0) carry((i - 1) * n_v + j, i * n_v + j);
        if (j > 0) carry(i * n_v + j - 1, i * n_v + j);
      }
    for (std::size_t i = n_u; i-- > 0;)
      for (std::size_t j = n_v; j-- > 0;) {
        if (i + 1 < n_u) carry((i + 1) * n_v + j, i * n_v + j);
        if (j + 1 < n_v) carry(i * n_v + j + 1, i * n_v + j);
      }
  }
}

double CurvatureSizes::operator()(Uv at) const {
  const auto [i, s] = find_on_line(u_, at.u);
  const auto [j, t] = find_on_line(v_, at.v);
  const std::size_t n_v = v_.size();
  const double a = size_[i * n_v + j], b = size_[i * n_v + j + 1], c = size_[(i + 1) * n_v + j], d = size_[(i + 1) * n_v + j + 1];
  // If a corner has no limit (infinity), the weighted sum could be NaN.
  if (std::max({a, b, c, d}) == k_no_limit) return std::min({a, b, c, d});
  return (1.0 - s) * ((1.0 - t) * a + t * b) + s * ((1.0 - t) * c + t * d);
}

}  // namespace sterna::surfmesh
