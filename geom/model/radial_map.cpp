// Steps: merge repeated points; scale coordinates to unit size; solve the interpolation system (with the linear part as side conditions, in the directions that
// the points span); verify that the points get their displacements.
#include "geom/model/radial_map.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "geom/base/error.h"
#include "geom/base/number_text.h"

namespace sterna {
namespace {

constexpr std::string_view k_radial_map_attempt = "spreading displacements over space";
/// Largest number of points. The system is dense: 6000 points take 0.3 GB and about one minute.
constexpr std::size_t k_max_points = 6000;
/// Points closer than this fraction of the points' extent are one point.
constexpr double k_same_location = 1e-9;
/// Tolerance between displacements of repeated points, and of the solution at its points, as a fraction of the largest displacement.
constexpr double k_same_shift = 1e-6;
/// The points do not span a direction in which they extend by less than this fraction of their largest extent.
constexpr double k_flat = 1e-6;
/// Scaled distance below which the logarithm of the second derivative of a thin plate is cut off.
constexpr double k_core = 1e-9;

[[noreturn]] void refuse_map(std::string problem, std::vector<ErrorLocation> locations = {}, std::string hint = {}) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = std::string(k_radial_map_attempt),
               .problem = std::move(problem),
               .locations = std::move(locations),
               .hint = std::move(hint)});
}

/// phi, phi' / r, and (phi'' - phi' / r) / r^2 as functions of the scaled distance.
struct Kernel {
  double value, slope, bend;
};
Kernel thin_plate(double r2) {
  if (r2 == 0.0) return {0.0, 2.0 * std::log(k_core) + 1.0, 0.0};
  const double log_r = 0.5 * std::log(std::max(r2, k_core * k_core));
  return {r2 * log_r, 2.0 * log_r + 1.0, 2.0 / std::max(r2, k_core * k_core)};
}
Kernel wendland(double r2, double radius) {
  const double r = std::sqrt(r2), q = r / radius;
  if (q >= 1.0) return {0.0, 0.0, 0.0};
  const double a = 1.0 - q, a2 = a * a;
  return {a2 * a2 * (4.0 * q + 1.0), -20.0 / (radius * radius) * a2 * a, r > 0.0 ? 60.0 * a2 / (radius * radius * radius * r) : 0.0};
}

/// Removes repeated points; first occurrences keep their order.
ScatteredDisplacements merged(const ScatteredDisplacements& data, double tolerance, double shift_tolerance) {
  std::vector<std::size_t> order(data.at.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return std::tie(data.at[a].x, a) < std::tie(data.at[b].x, b); });
  std::vector<char> is_repeated(data.at.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size() && data.at[order[j]].x - data.at[order[i]].x <= tolerance; ++j) {
      const std::size_t a = std::min(order[i], order[j]), b = std::max(order[i], order[j]);
      if (distance(data.at[a], data.at[b]) > tolerance) continue;
      if (distance(data.shift[a], data.shift[b]) > shift_tolerance)
        refuse_map("points " + std::to_string(a + 1) + " and " + std::to_string(b + 1) + " have the same location but different displacements, " +
                       format_point(data.shift[a]) + " and " + format_point(data.shift[b]),
                   {{data.at[a], "both points"}});
      is_repeated[b] = 1;
    }
  }
  ScatteredDisplacements result;
  for (std::size_t i = 0; i < data.at.size(); ++i) {
    if (is_repeated[i]) continue;
    result.at.push_back(data.at[i]);
    result.shift.push_back(data.shift[i]);
  }
  return result;
}

/// Returns orthonormal directions (columns) in which the points extend.
Eigen::MatrixXd spanned_directions(const std::vector<Vec3>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Vec3& p : points) mean += Eigen::Vector3d(p.x, p.y, p.z);
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) {
    const Eigen::Vector3d d = Eigen::Vector3d(p.x, p.y, p.z) - mean;
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const double largest = solver.eigenvalues()[2];
  Eigen::MatrixXd directions(3, 0);
  for (int k = 2; k >= 0; --k) {
    if (!(solver.eigenvalues()[k] > k_flat * k_flat * largest) || !(largest > 0.0)) break;
    directions.conservativeResize(3, directions.cols() + 1);
    directions.col(directions.cols() - 1) = solver.eigenvectors().col(k);
  }
  return directions;
}

}  // namespace

RadialMap::RadialMap(const ScatteredDisplacements& data, const RadialMapOptions& options)
    : is_thin_plate_(options.kernel == "thin_plate"), radius_(options.radius), scale_(1.0) {
  if (options.kernel != "thin_plate" && options.kernel != "wendland_c2") refuse_map("kernel is \"" + options.kernel + "\", must be thin_plate or wendland_c2");
  if (data.at.empty()) refuse_map("no points were given");
  if (data.at.size() != data.shift.size()) refuse_map(std::to_string(data.at.size()) + " points, but " + std::to_string(data.shift.size()) + " displacements");
  Point low = data.at.front(), high = data.at.front();
  double largest = 0.0;
  for (std::size_t i = 0; i < data.at.size(); ++i) {
    if (!is_finite(data.at[i]) || !is_finite(data.shift[i])) refuse_map("point " + std::to_string(i + 1) + " or its displacement is not finite");
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], data.at[i][a]);
      high[a] = std::max(high[a], data.at[i][a]);
    }
    largest = std::max(largest, norm(data.shift[i]));
  }
  origin_ = 0.5 * (low + high);
  const double diagonal = distance(low, high);
  scale_ = diagonal > 0.0 ? diagonal : 1.0;
  const ScatteredDisplacements unique = merged(data, k_same_location * scale_, k_same_shift * largest);
  const std::size_t n = unique.at.size();
  if (n > k_max_points)
    refuse_map(std::to_string(n) + " points, at most " + std::to_string(k_max_points) + " can be solved", {},
               "reduce the number of points: displacements are smooth, and a few hundred points are sufficient");
  if (!is_thin_plate_ && !is_automatic(radius_) && !(radius_ > 0.0)) refuse_map("radius is " + number_text(radius_) + " m, must be positive");
  radius_ = (is_automatic(radius_) ? scale_ : radius_) / scale_;
  for (const Point& p : unique.at) centres_.push_back((p - origin_) / scale_);

  const bool has_linear_part = is_thin_plate_ || options.linear_part;
  const Eigen::MatrixXd directions = has_linear_part ? spanned_directions(centres_) : Eigen::MatrixXd(3, 0);
  const auto m = static_cast<Eigen::Index>(n);
  const Eigen::Index n_linear = has_linear_part ? 1 + directions.cols() : 0;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(m + n_linear, m + n_linear);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(m + n_linear, 3);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Vec3& a = centres_[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double r2 = norm2(a - centres_[static_cast<std::size_t>(j)]);
      system(i, j) = system(j, i) = is_thin_plate_ ? thin_plate(r2).value : wendland(r2, radius_).value;
    }
    if (has_linear_part) {
      system(i, m) = system(m, i) = 1.0;
      const Eigen::VectorXd along = directions.transpose() * Eigen::Vector3d(a.x, a.y, a.z);
      for (Eigen::Index k = 0; k < along.size(); ++k) system(i, m + 1 + k) = system(m + 1 + k, i) = along[k];
    }
    const Vec3& shift = unique.shift[static_cast<std::size_t>(i)];
    right.row(i) << shift.x, shift.y, shift.z;
  }
  const Eigen::MatrixXd solution = Eigen::PartialPivLU<Eigen::MatrixXd>(system).solve(right);
  const auto row = [&](Eigen::Index i) { return Vec3{solution(i, 0), solution(i, 1), solution(i, 2)}; };
  for (Eigen::Index i = 0; i < m; ++i) weights_.push_back(row(i));
  if (has_linear_part) {
    constant_ = row(m);
    for (Eigen::Index k = 0; k < directions.cols(); ++k)
      for (int a = 0; a < 3; ++a) linear_[a] += directions(a, k) * row(m + 1 + k);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double miss = distance(point(unique.at[i]), unique.at[i] + unique.shift[i]);
    if (!(miss <= k_same_shift * largest + 1e-14 * scale_))
      refuse_map("the system cannot be solved accurately: the displacement of a point is off by " + number_text(miss) + " m", {{unique.at[i], "this point"}},
                 "remove points that nearly coincide, or use a smaller radius");
  }
}

Point RadialMap::point(const Point& p) const {
  const Vec3 x = (p - origin_) / scale_;
  Vec3 shift = constant_ + x.x * linear_[0] + x.y * linear_[1] + x.z * linear_[2];
  for (std::size_t k = 0; k < centres_.size(); ++k) {
    const double r2 = norm2(x - centres_[k]);
    shift += (is_thin_plate_ ? thin_plate(r2).value : wendland(r2, radius_).value) * weights_[k];
  }
  return p + shift;
}

SpaceMapDerivatives RadialMap::derivatives(const Point& p) const {
  const Vec3 x = (p - origin_) / scale_;
  Vec3 shift = constant_ + x.x * linear_[0] + x.y * linear_[1] + x.z * linear_[2];
  SpaceMapDerivatives d;
  d.dx = linear_[0];
  d.dy = linear_[1];
  d.dz = linear_[2];
  for (std::size_t k = 0; k < centres_.size(); ++k) {
    const Vec3 e = x - centres_[k];
    const Kernel kernel = is_thin_plate_ ? thin_plate(norm2(e)) : wendland(norm2(e), radius_);
    const Vec3& w = weights_[k];
    shift += kernel.value * w;
    const Vec3 slope = kernel.slope * w, bend = kernel.bend * w;
    d.dx += e.x * slope;
    d.dy += e.y * slope;
    d.dz += e.z * slope;
    d.dxx += slope + e.x * e.x * bend;
    d.dyy += slope + e.y * e.y * bend;
    d.dzz += slope + e.z * e.z * bend;
    d.dxy += e.x * e.y * bend;
    d.dxz += e.x * e.z * bend;
    d.dyz += e.y * e.z * bend;
  }
  d.point = p + shift;
  const double r = 1.0 / scale_;
  d.dx = r * d.dx + Vec3{1.0, 0.0, 0.0};
  d.dy = r * d.dy + Vec3{0.0, 1.0, 0.0};
  d.dz = r * d.dz + Vec3{0.0, 0.0, 1.0};
  for (Vec3* second : {&d.dxx, &d.dxy, &d.dxz, &d.dyy, &d.dyz, &d.dzz}) *second *= r * r;
  return d;
}

}  // namespace sterna
