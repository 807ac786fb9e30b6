// Quality figures of a HybridMesh, gathered cell by cell so that they share the single pass of `check`.
#pragma once

#include <cstdint>
#include <limits>

#include "geom/math/measures.h"
#include "geom/mesh/check.h"

namespace sterna {

/// Returns the skew angle, eq. (13) of docs/method/quality.md, "Skew angle", in radians: the mean angle between the three growth edges and the normals of base
/// and top. An edge or normal of zero length counts as pi/2.
double skew_angle(const WedgePoints& p);

/// Running minima and counts. Scans of consecutive chunks are merged in order; ties keep the first location.
class QualityScan {
 public:
  /// Adds a prism by its wedge_quality and skew_angle; `points()` returns its corners.
  template <class Points>
  void add_prism(double quality, double skew, const Points& points) {
    if (quality < wedge_.value) wedge_.lower(quality, middle(points()));
    add_skew(skew);
  }
  /// Adds a pyramid or tet of a column over collapsed lines. It is no prism and counts as skewed by more than 60 degrees.
  void add_collapsed() { ++n_collapsed_; }
  /// Adds a tetrahedron. `range` = tet_dihedral_range(p).
  void add_tet(const std::array<Vec3, 4>& p, const std::array<double, 2>& range);
  void merge(const QualityScan& later);
  Quality result() const;

 private:
  static Point middle(const WedgePoints& p);
  void add_skew(double skew);
  struct Extreme {
    double value = std::numeric_limits<double>::infinity();
    Point location;
    void lower(double v, const Point& p);
  };
  Extreme wedge_, min_dihedral_, negative_max_dihedral_;
  std::int64_t n_prisms_ = 0, n_collapsed_ = 0;
  std::int64_t n_below_6_ = 0, n_below_18_ = 0, n_above_60_ = 0;
};

}  // namespace sterna
