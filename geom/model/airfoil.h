// Wing sections: read from files, made from NACA designations, opened and closed at the trailing edge, given other points, made splines.
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
  std::vector<Uv> points;        ///< trailing edge, upper side, leading edge, lower side, trailing edge; no two neighbours coincide
  std::size_t leading_edge = 0;  ///< the point of least x
  /// Distance of the two ends, of the chord; 0: sharp.
  double trailing_edge_thickness() const;
};

/// Largest distance between upper and lower side across the chord, and where; and the largest height of the mean of both. Of the chord.
struct AirfoilMeasures {
  double thickness = 0.0, thickness_at = 0.0;
  double camber = 0.0, camber_at = 0.0;
};
AirfoilMeasures measure(const Airfoil& airfoil);

/// Selig's layout (name, then points around the section) or Lednicer's (name, counts, upper side, lower side, both from the leading edge), told apart by
/// contents; either sense of rotation; coordinates in percent or other units are scaled to the chord. Further lines of text may follow the name.
/// \throws Error(file_not_found, file_malformed with the line)
Airfoil read_airfoil(const std::filesystem::path& path);
/// The same from text; `attempted` starts messages.
Airfoil parse_airfoil(std::string_view text, const std::string& attempted);

/// NACA sections by designation, with or without "NACA": 4 digits "2412", modified "0012-64", 5 digits "23012", reflexed "23112", 16-series "16-212", 6-series
/// "63-215", "66(3)-218", "65,3-618 a=0.5", 6A-series "63A210", "64-015A". `n_side` points along each side, cosine spaced. The trailing edge is open as the
/// definition has it. Based on: Ladson, Brooks, Hill, Sproles, NASA TM-4741, 1996; Abbott, von Doenhoff, Stivers, NACA Report 824, 1945.
/// \throws Error(bad_argument) for a designation that is none
Airfoil naca_airfoil(std::string_view designation, int n_side = 80);

/// Another trailing-edge thickness (of the chord; 0 = sharp): closed by turning both sides about the leading edge, opened by adding linearly along the chord.
/// \throws Error(bad_argument) unless 0 <= thickness < 0.2
Airfoil with_trailing_edge(const Airfoil& airfoil, double thickness);

/// Leading edge (the spline's point of least x) in the origin, unit chord: the middle of the trailing edge at x = 1.
Airfoil normalized(const Airfoil& airfoil);

/// The section as curves in the plane y = 0, point (x, 0, z): cubic splines of the chord length through all points.
struct AirfoilCurves {
  CurvePtr around;            ///< t in [0, 1] from the trailing edge over the upper side
  double leading_edge = 0.5;  ///< its t: least x
  CurvePtr upper, lower;      ///< from the leading edge to the trailing edge, t in [0, 1]
};
AirfoilCurves airfoil_curves(const Airfoil& airfoil);

struct Repaneled {
  Airfoil airfoil;
  double error = 0.0;  ///< largest distance of samples of the old spline from the new one, of the chord
};
/// `n_side` points along each side, dense where the section is curved.
/// \throws Error(bad_argument) unless 5 <= n_side <= 2000
Repaneled repaneled(const Airfoil& airfoil, int n_side);
/// As few points as keep the error below `tolerance` (of the chord).
/// \throws Error(bad_argument) when 2000 points are not enough
Repaneled repaneled_within(const Airfoil& airfoil, double tolerance);

}  // namespace sterna
