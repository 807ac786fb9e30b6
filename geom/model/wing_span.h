// Locations along the span of a wing, and its cross sections there.
#pragma once

#include <vector>

#include "geom/model/section_rows.h"

namespace sterna {

/// Returns the midpoint of a row's chord, and the chord vector from the leading edge to the midpoint of the trailing edge.
Point chord_middle(const std::vector<Point>& row);
Vec3 chord_vector(const std::vector<Point>& row);

/// The wing's length along the midpoints of its chords, from tip to tip. Locations are given in two ways: as a fraction of that length, and in rows (2.5 is
/// half way between rows 2 and 3 in the parameter).
class WingSpan {
 public:
  explicit WingSpan(const Wing& wing);
  const std::vector<std::vector<Point>>& rows() const { return made_.rows; }
  const WingRows& made() const { return made_; }
  double length() const { return length_; }
  /// Returns the fractions of the rows.
  std::vector<double> fractions() const;
  double location_of(double fraction) const;
  double fraction_of(double location) const;
  /// Returns the wing's cross section; at integer locations exactly the row, to the bit.
  std::vector<Point> row(double location) const;
  /// Returns the location at a fraction `part` of the way from the root (0) to the tip (1). The way is measured perpendicular to the flow, along the midpoints
  /// of the chords as seen along x. The root is the plane of symmetry. For wings that are not symmetric it is the end nearer to the plane if they have a mirror
  /// image, else the end with the longer chord.
  double location_from_root(const Wing& wing, double part) const;

 private:
  struct Sample {
    double location;
    double fraction;
    double across;  ///< length seen along x from the first tip
  };
  WingRows made_;
  std::vector<WingPanel> panels_;
  std::vector<std::size_t> panel_of_row_;  ///< panel behind each row
  std::vector<Sample> samples_;            ///< ascending in all members
  double length_ = 0.0;
};

}  // namespace sterna
