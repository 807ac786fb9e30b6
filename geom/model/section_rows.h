// Cross sections of bodies and wings as rows of points that correspond to each other: what surfaces are splined through.
#pragma once

#include <string>
#include <vector>

#include "geom/model/aircraft.h"

namespace sterna {

/// Points of a wing section: n up to the leading edge, that, and n back to the trailing edge; by equal fractions of each side's length, closer at both ends.
struct AirfoilRow {
  std::vector<Point> points;  ///< 2 n + 1: trailing edge, upper side, leading edge (index n), lower side, trailing edge
};
/// Points of each side of an airfoil in rows of wings: NACA sections are met to 1e-6 chord.
inline constexpr std::size_t k_wing_side_points = 48;
/// Fractions of a side from the trailing to the leading edge at which rows have their points: 0 .. 1, closer at the ends (cosine).
std::vector<double> airfoil_stations(std::size_t n);
/// Sections in component axes. `trailing_edge`: thickness in metres (the sides are turned about the leading edge until it fits), nothing: as it is.
/// \throws Error(bad_argument) naming the section
std::vector<Point> section_loop(const WingSection& section, const std::optional<double>& trailing_edge);
AirfoilRow airfoil_row(const std::vector<Point>& loop, std::size_t n, const std::string& name);

/// Rows of all sections of a wing in component axes, right tip first, both halves of a symmetric one. Sharp trailing edges where any section has one
/// (thinner than 1e-6 chord). \throws Error(bad_argument)
struct WingRows {
  std::vector<std::vector<Point>> rows;
  bool is_blunt = true;
};
WingRows wing_rows(const Wing& wing);

/// Points of a frame in component axes: 2 m + 1, from the bottom over the right side to the top (index m) and back on the left; the last repeats the
/// first. All equal where the frame is a point. \throws Error(bad_argument, unsupported_format) naming the frame
std::vector<Point> frame_row(const BodyFrame& frame, std::size_t m);

}  // namespace sterna
