// Cross sections of bodies and wings as rows of corresponding points, through which surfaces are splined.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geom/model/aircraft.h"

namespace sterna {

/// Points of a wing section: n along the upper side up to the leading edge, the leading edge, and n back to the trailing edge. They are at equal fractions of
/// the length of each side, closer at both ends.
struct AirfoilRow {
  std::vector<Point> points;  ///< 2 n + 1: trailing edge, upper side, leading edge (index n), lower side, trailing edge
};
/// Number of points on each side of an airfoil in rows of wings. They approximate NACA sections to 1e-6 of the chord.
inline constexpr std::size_t k_wing_side_points = 48;
/// Returns the fractions of a side from the trailing to the leading edge at which rows have their points: 0 .. 1, closer at the ends (cosine).
std::vector<double> airfoil_stations(std::size_t n);
/// Returns the parameters of all points of a row: from 0 at the trailing edge over 1 at the leading edge to 2 at the trailing edge of the lower side. Surfaces
/// are splined over them.
std::vector<double> row_parameters(std::size_t n);
/// Parameters in [0, 1] of the two sides where the row's spline crosses a fraction of the chord from the leading edge (fraction 0: parameter 1, fraction 1:
/// parameter 0).
struct RowCrossing {
  double upper = 1.0;
  double lower = 1.0;
};
RowCrossing row_crossing(const std::vector<Point>& row, double fraction);

/// Returns the parameter of each side where the distance of the row's spline from a point equals `radius`, between `from` and the leading (trailing) edge;
/// empty if there is none.
std::optional<RowCrossing> row_at_distance(const std::vector<Point>& row, const RowCrossing& from, const Point& center, double radius, bool is_forward);
/// Returns the points of both sides at a crossing.
std::pair<Point, Point> points_at(const std::vector<Point>& row, const RowCrossing& crossing);

/// Returns the section in component axes. `trailing_edge`: thickness in metres (the sides are rotated about the leading edge to obtain it); empty: unchanged.
/// \throws Error(bad_argument) naming the section
std::vector<Point> section_loop(const WingSection& section, const std::optional<double>& trailing_edge);
AirfoilRow airfoil_row(const std::vector<Point>& loop, std::size_t n, const std::string& name);

/// Rows of all sections of a wing in component axes, right tip first, both halves of a symmetric wing. All trailing edges are sharp if any section has a sharp
/// one (thinner than 1e-6 chord).
/// \throws Error(bad_argument)
struct WingRows {
  std::vector<std::vector<Point>> rows;
  std::vector<bool> is_break;  ///< the wing may have a kink at the row; always at the ends
  bool is_blunt = true;
  std::vector<bool> is_sampled;  ///< the row belongs to a smooth wing (WingSection::is_row) or to a blend; splines through parts of such rows get no end
                                 ///< condition
  /// Returns true if all rows between two breaks are sampled.
  bool is_sampled_between(std::size_t first_row, std::size_t last_row) const;
};
/// Returns the rows of a wing, including the blend of a winglet (winglet_blend.h) if the wing specifies one.
WingRows wing_rows(const Wing& wing);

/// The wing's skin between the rows of two consecutive breaks. u is as in row_parameters, v runs along the span.
struct WingPanel {
  NurbsSurfaceForm form;
  std::size_t first_row = 0;
  std::vector<double> v_of_row;  ///< v of first_row and the rows that follow
  /// Returns v of a location counted in rows from tip to tip: 2.5 is half way between rows 2 and 3.
  double v(double location) const;
};
WingPanel wing_panel(const std::vector<std::vector<Point>>& rows, std::size_t first_row, std::size_t last_row, bool is_sampled);
/// Returns one panel for each part between breaks, in order.
std::vector<WingPanel> wing_panels(const WingRows& rows);

/// Returns the points of a frame in component axes. There are 2 m + 1 points, from the bottom over the right side to the top (index m) and back on the left;
/// the last point repeats the first. All points are equal if the frame is a point.
/// \throws Error(bad_argument, unsupported_format) naming the frame
std::vector<Point> frame_row(const BodyFrame& frame, std::size_t m);

}  // namespace sterna
