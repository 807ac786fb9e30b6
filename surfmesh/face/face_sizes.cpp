#include "surfmesh/face/face_sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sterna::surfmesh {
namespace {

constexpr double k_no_limit = std::numeric_limits<double>::infinity();
/// Samples between two breaks at least: a bicubic piece has few bumps.
constexpr std::size_t k_samples_per_piece = 4;
/// Samples of a direction as a whole: at least, so that analytic surfaces of one piece are seen; at most, so that a face of many pieces is still cheap.
constexpr std::size_t k_min_samples = 33;
constexpr std::size_t k_max_samples = 257;
/// Sine squared between du and dv below which there is no normal.
constexpr double k_min_sine2 = 1e-20;
/// Rounds of four sweeps that carry sizes over the grid; each reaches as far as it likes along the sweep, so few are needed.
constexpr int k_growth_rounds = 3;

std::vector<double> sample_line(const std::vector<double>& breaks, const Interval& range) {
  std::vector<double> ends{range.from};
  for (const double b : breaks)
    if (b > range.from && b < range.to) ends.push_back(b);
  ends.push_back(range.to);
  const std::size_t n_pieces = ends.size() - 1;
  const std::size_t wanted = std::clamp(n_pieces * k_samples_per_piece, k_min_samples - 1, k_max_samples - 1);
  const std::size_t each = std::max<std::size_t>(1, (wanted + n_pieces - 1) / n_pieces);
  std::vector<double> line;
  for (std::size_t p = 0; p < n_pieces; ++p)
    for (std::size_t k = 0; k < each; ++k) line.push_back(ends[p] + (ends[p + 1] - ends[p]) * static_cast<double>(k) / static_cast<double>(each));
  line.push_back(range.to);
  return line;
}

/// Index i and share s in [0, 1] with line[i] (1 - s) + line[i + 1] s = t, held within the line.
std::pair<std::size_t, double> find_on_line(const std::vector<double>& line, double t) {
  const auto above = std::upper_bound(line.begin() + 1, line.end() - 1, t);
  const auto i = static_cast<std::size_t>(above - line.begin()) - 1;
  const double length = line[i + 1] - line[i];
  return {i, length > 0.0 ? std::clamp((t - line[i]) / length, 0.0, 1.0) : 0.0};
}

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

CurvatureSizes::CurvatureSizes(const Surface& surface, const ParameterBox& box, double angle, double min_edge, double growth)
    : u_(sample_line(surface.breaks_u(), box.u)), v_(sample_line(surface.breaks_v(), box.v)), size_(u_.size() * v_.size(), k_no_limit) {
  const std::size_t n_u = u_.size(), n_v = v_.size();
  std::vector<Point> points(n_u * n_v);
  for (std::size_t i = 0; i < n_u; ++i) {
    for (std::size_t j = 0; j < n_v; ++j) {
      const SurfaceDerivatives d = surface.derivatives({u_[i], v_[j]});
      points[i * n_v + j] = d.point;
      // Some parametrisations have no finite speed on their border (a square root at a nose): such samples say nothing.
      if (is_finite(d.du)) mean_speed_u_ += norm(d.du) / static_cast<double>(n_u * n_v);
      if (is_finite(d.dv)) mean_speed_v_ += norm(d.dv) / static_cast<double>(n_u * n_v);
      // The chord of an arc of radius 1 / curvature.
      const double curvature = largest_curvature(d);
      if (curvature > 0.0) size_[i * n_v + j] = std::max(min_edge, 2.0 * std::sin(0.5 * angle) / curvature);
    }
  }
  const auto carry = [&](std::size_t from, std::size_t to) { size_[to] = std::min(size_[to], size_[from] + growth * distance(points[from], points[to])); };
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
  // Where some corner has no limit, the sum would not be a number.
  if (std::max({a, b, c, d}) == k_no_limit) return std::min({a, b, c, d});
  return (1.0 - s) * ((1.0 - t) * a + t * b) + s * ((1.0 - t) * c + t * d);
}

}  // namespace sterna::surfmesh
