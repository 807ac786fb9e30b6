#include "geom/mesh/quality.h"

#include <algorithm>
#include <numbers>

#include "geom/math/constants.h"

namespace sterna {
namespace {

/// Limits of the published skew statistics, radians (docs/method/quality.md, "Skew angle").
constexpr double k_skew_small = 6.0 * k_degree;
constexpr double k_skew_medium = 18.0 * k_degree;
constexpr double k_skew_large = 60.0 * k_degree;

template <std::size_t N>
Point center_of(const std::array<Vec3, N>& p) {
  Vec3 sum;
  for (const Vec3& x : p) sum += x;
  return sum / static_cast<double>(N);
}

}  // namespace

double skew_angle(const WedgePoints& p) {
  const std::array<Vec3, 2> normals = {normalized(cross(p[1] - p[0], p[2] - p[0])), normalized(cross(p[4] - p[3], p[5] - p[3]))};
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 growth = normalized(p[k + 3] - p[k]);
    for (const Vec3& n : normals) sum += std::acos(std::clamp(dot(n, growth), -1.0, 1.0));
  }
  return sum / 6.0;
}

void QualityScan::Extreme::lower(double v, const Point& p) {
  if (!(v < value)) return;
  value = v;
  location = p;
}

Point QualityScan::middle(const WedgePoints& p) { return center_of(p); }

void QualityScan::add_skew(double skew) {
  ++n_prisms_;
  n_below_6_ += skew < k_skew_small;
  n_below_18_ += skew < k_skew_medium;
  n_above_60_ += skew > k_skew_large;
}

void QualityScan::add_tet(const std::array<Vec3, 4>& p, const std::array<double, 2>& range) {
  const auto [smallest, largest] = range;
  if (smallest < min_dihedral_.value) min_dihedral_.lower(smallest, center_of(p));
  if (-largest < negative_max_dihedral_.value) negative_max_dihedral_.lower(-largest, center_of(p));
}

void QualityScan::merge(const QualityScan& later) {
  wedge_.lower(later.wedge_.value, later.wedge_.location);
  min_dihedral_.lower(later.min_dihedral_.value, later.min_dihedral_.location);
  negative_max_dihedral_.lower(later.negative_max_dihedral_.value, later.negative_max_dihedral_.location);
  n_prisms_ += later.n_prisms_;
  n_collapsed_ += later.n_collapsed_;
  n_below_6_ += later.n_below_6_;
  n_below_18_ += later.n_below_18_;
  n_above_60_ += later.n_above_60_;
}

Quality QualityScan::result() const {
  Quality quality;
  if (n_prisms_ > 0) {
    quality.min_wedge_quality = wedge_.value;
    quality.worst_prism = wedge_.location;
  }
  if (std::isfinite(min_dihedral_.value)) {
    quality.min_dihedral = min_dihedral_.value;
    quality.max_dihedral = -negative_max_dihedral_.value;
    quality.worst_tet = min_dihedral_.location;
    quality.most_obtuse_tet = negative_max_dihedral_.location;
  }
  if (const auto n = static_cast<double>(n_prisms_ + n_collapsed_); n > 0) {
    quality.skew_below_6 = static_cast<double>(n_below_6_) / n;
    quality.skew_below_18 = static_cast<double>(n_below_18_) / n;
    quality.skew_above_60 = static_cast<double>(n_above_60_ + n_collapsed_) / n;
  }
  return quality;
}

}  // namespace sterna
