// Places along the span of a wing, and its cross sections there.
#pragma once

#include <vector>

#include "geom/model/section_rows.h"

namespace sterna {

/// Point in the middle of a row's chord, and the chord from the leading edge to the middle of the trailing edge.
Point chord_middle(const std::vector<Point>& row);
Vec3 chord_vector(const std::vector<Point>& row);

/// The wing's length along the middles of its chords, tip to tip. Places are counted in two ways: as a fraction of that length, and in rows (2.5: half way
/// in the parameter between rows 2 and 3).
class WingSpan {
 public:
  explicit WingSpan(const Wing& wing);
  const std::vector<std::vector<Point>>& rows() const { return made_.rows; }
  const WingRows& made() const { return made_; }
  double length() const { return length_; }
  /// Fractions of the rows.
  std::vector<double> fractions() const;
  double place_of(double fraction) const;
  double fraction_of(double place) const;
  /// The wing's own cross section; at whole places the row, to the bit.
  std::vector<Point> row(double place) const;
  /// Place at a part of the way from the root (0) to the tip (1), measured across the flow: along the middles of the chords, seen along x. The root is the
  /// plane of symmetry; of wings that are not symmetric the end nearer to it where they have a mirror image, else the one with the longer chord.
  double place_from_root(const Wing& wing, double part) const;

 private:
  struct Sample {
    double place;
    double fraction;
    double across;  ///< length seen along x from the first tip
  };
  WingRows made_;
  std::vector<WingPanel> panels_;
  std::vector<std::size_t> panel_of_row_;  ///< of the part behind each row
  std::vector<Sample> samples_;            ///< ascending in all members
  double length_ = 0.0;
};

}  // namespace sterna
