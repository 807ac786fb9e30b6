// Airfoil sections. They are read from files or generated from NACA designations, their trailing edge is opened or closed, and they are repaneled or converted
// to splines.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geom/model/curve.h"
#include "geom/model/nurbs_form.h"

namespace sterna {

/// Section in its plane, u = x / chord (aft), v = z / chord (up).
struct Airfoil {
  std::string name;
  std::vector<Uv> points;        ///< trailing edge, upper side, leading edge, lower side, trailing edge; neighbouring points are distinct
  std::size_t leading_edge = 0;  ///< index of the point with the smallest x
  /// Returns the distance between both ends, relative to the chord; 0: sharp.
  double trailing_edge_thickness() const;
};

/// Maximum thickness and its position, and maximum camber height. Relative to the chord.
struct AirfoilMeasures {
  double thickness = 0.0, thickness_at = 0.0;
  double camber = 0.0, camber_at = 0.0;
};
AirfoilMeasures measure(const Airfoil& airfoil);

/// Reads Selig's layout (name, then points around the section) or Lednicer's (name, counts, upper side, lower side, both from the leading edge); the layout is
/// detected from the contents. Accepts either sense of rotation. Coordinates in percent or other units are scaled to the chord. Further lines of text may
/// follow the name.
/// \throws Error(file_not_found, file_malformed with the line)
Airfoil read_airfoil(const std::filesystem::path& path);
/// Parses an airfoil from text, as read_airfoil; `attempted` starts messages.
Airfoil parse_airfoil(std::string_view text, const std::string& attempted);

/// Generates NACA sections from a designation, with or without "NACA": 4 digits "2412", modified "0012-64", 5 digits "23012", reflexed "23112", 16-series
/// "16-212", 6-series "63-215", "66(3)-218", "65,3-618 a=0.5", 6A-series "63A210", "64-015A". `n_side` points along each side, cosine spaced. The trailing edge
/// is open as in the definition. Based on: Ladson, Brooks, Hill, Sproles, NASA TM-4741, 1996; Abbott, von Doenhoff, Stivers, NACA Report 824, 1945.
/// \throws Error(bad_argument) for an invalid designation
Airfoil naca_airfoil(std::string_view designation, int n_side = 80);

/// Changes the trailing-edge thickness (relative to the chord; 0 = sharp). The edge is closed by rotating both sides about the leading edge, and opened by
/// adding thickness linearly along the chord.
/// \throws Error(bad_argument) unless 0 <= thickness < 0.2
Airfoil with_trailing_edge(const Airfoil& airfoil, double thickness);

/// Returns the airfoil with its leading edge (the spline's point of least x) at the origin and unit chord: the midpoint of the trailing edge is at x = 1.
Airfoil normalized(const Airfoil& airfoil);

/// The section as curves in the plane y = 0. They are cubic splines over chord length through all points (x, 0, z).
struct AirfoilCurves {
  CurvePtr around;            ///< t in [0, 1] from the trailing edge over the upper side
  double leading_edge = 0.5;  ///< parameter of the leading edge (least x)
  CurvePtr upper, lower;      ///< from the leading edge to the trailing edge, t in [0, 1]
};
AirfoilCurves airfoil_curves(const Airfoil& airfoil);

struct Repaneled {
  Airfoil airfoil;
  double error = 0.0;  ///< largest distance of samples of the old spline from the new one, relative to the chord
};
/// Returns the airfoil with `n_side` points along each side, clustered where the curvature is high.
/// \throws Error(bad_argument) unless 5 <= n_side <= 2000
Repaneled repaneled(const Airfoil& airfoil, int n_side);
/// Returns the airfoil with the fewest points that keep the error below `tolerance` (relative to the chord).
/// \throws Error(bad_argument) if 2000 points are not enough
Repaneled repaneled_within(const Airfoil& airfoil, double tolerance);

}  // namespace sterna
