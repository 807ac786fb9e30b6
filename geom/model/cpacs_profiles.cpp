// Reads profiles of CPACS: lists of points, cst2D, and standard profiles.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <pugixml.hpp>

#include "geom/model/cpacs_parts.h"

namespace sterna::cpacs {
namespace {

using Node = pugi::xml_node;

/// Points of a unit profile nearer than this are one repeated point: files have 6 digits and more.
constexpr double k_same_profile_point = 1e-9;
/// Number of points on each side of an airfoil given by a formula, and on each quarter of a fuselage profile. The chord error is below 1e-4 of the size.
constexpr int k_profile_side_points = 60;
constexpr int k_quarter_points = 16;

bool is_same(Uv a, Uv b) { return std::hypot(a.u - b.u, a.v - b.v) <= k_same_profile_point; }

std::vector<Uv> point_list(const Document& document, const Node& list, const char* first, const char* second) {
  const XmlFile& file = document.file;
  const auto column = [&](const char* name) {
    const Node node = list.child(name);
    if (!node) file.fail(list, std::string("the list '") + name + "' is missing");
    return file.numbers(node, XmlFile::content(node));
  };
  const std::vector<double> a = column(first), b = column(second);
  if (a.size() != b.size())
    file.fail(list,
              std::string("the lists '") + first + "' and '" + second + "' have " + std::to_string(a.size()) + " and " + std::to_string(b.size()) + " numbers");
  std::vector<Uv> points;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (points.empty() || !is_same(points.back(), {a[i], b[i]})) points.push_back({a[i], b[i]});
  return points;
}

double signed_area(const std::vector<Uv>& points) {
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Uv a = points[i], b = points[(i + 1) % points.size()];
    area += 0.5 * (a.u * b.v - a.v * b.u);
  }
  return area;
}

double bernstein_sum(const std::vector<double>& b, double x) {
  const std::size_t n = b.size() - 1;
  double sum = 0.0, binomial = 1.0;
  for (std::size_t i = 0; i <= n; ++i) {
    sum += b[i] * binomial * std::pow(x, static_cast<double>(i)) * std::pow(1.0 - x, static_cast<double>(n - i));
    binomial *= static_cast<double>(n - i) / static_cast<double>(i + 1);
  }
  return sum;
}

/// Class-shape transformation after Kulfan: z = x^N1 (1 - x)^N2 * sum of Bernstein polynomials + x * half the thickness of the trailing edge.
std::vector<Uv> cst_airfoil(const Document& document, const Node& node) {
  const XmlFile& file = document.file;
  const auto side = [&](const char* n1, const char* n2, const char* b, double sign) {
    const double first = file.required_child_number(node, n1), second = file.required_child_number(node, n2);
    const std::vector<double> coefficients = file.numbers(node.child(b), XmlFile::content(node.child(b)));
    if (coefficients.empty()) file.fail(node, std::string("the list '") + b + "' is missing or empty");
    const double thickness = file.child_number(node, "trailingEdgeThickness", 0.0);
    std::vector<Uv> points;
    for (int i = 0; i <= k_profile_side_points; ++i) {
      const double x = 0.5 * (1.0 + std::cos(std::numbers::pi * i / k_profile_side_points));
      points.push_back({x, std::pow(x, first) * std::pow(1.0 - x, second) * bernstein_sum(coefficients, x) + sign * 0.5 * thickness * x});
    }
    return points;
  };
  std::vector<Uv> points = side("upperN1", "upperN2", "upperB", 1.0), lower = side("lowerN1", "lowerN2", "lowerB", -1.0);
  points.insert(points.end(), lower.rbegin() + 1, lower.rend());
  return points;
}

/// Adds a quarter from the positive u axis to the positive v axis of |u / a|^m + |v / b|^n = 1, without its end.
void add_quarter(std::vector<Uv>& points, double a, double b, double m, double n, double sign_u, double sign_v, double center, bool is_backward) {
  for (int i = 0; i < k_quarter_points; ++i) {
    const int k = is_backward ? k_quarter_points - i : i;
    const double angle = 0.5 * std::numbers::pi * k / k_quarter_points;
    const double c = k == k_quarter_points ? 0.0 : std::cos(angle), s = k == 0 ? 0.0 : std::sin(angle);
    points.push_back({sign_u * a * std::pow(c, 2.0 / m), center + sign_v * b * std::pow(s, 2.0 / n)});
  }
}

std::vector<Uv> standard_profile(const Document& document, const Node& node) {
  const XmlFile& file = document.file;
  std::vector<Uv> points;
  if (const Node ellipse = node.child("superEllipse")) {
    const double lower = file.child_number(ellipse, "lowerHeightFraction", 0.5);
    const double m_lower = file.child_number(ellipse, "mLower", 2.0), n_lower = file.child_number(ellipse, "nLower", 2.0);
    const double m_upper = file.child_number(ellipse, "mUpper", 2.0), n_upper = file.child_number(ellipse, "nUpper", 2.0);
    if (!(lower > 0.0 && lower < 1.0)) file.fail(ellipse, "lowerHeightFraction is " + exact_text(lower) + "; it must be between 0 and 1");
    for (const double exponent : {m_lower, n_lower, m_upper, n_upper})
      if (!(exponent > 0.0)) file.fail(ellipse, "an exponent is " + exact_text(exponent) + "; all must be positive");
    const double center = lower - 0.5;  // the profile has unit height, from -0.5 to 0.5
    add_quarter(points, 0.5, lower, m_lower, n_lower, 1.0, -1.0, center, true);
    add_quarter(points, 0.5, 1.0 - lower, m_upper, n_upper, 1.0, 1.0, center, false);
    add_quarter(points, 0.5, 1.0 - lower, m_upper, n_upper, -1.0, 1.0, center, true);
    add_quarter(points, 0.5, lower, m_lower, n_lower, -1.0, -1.0, center, false);
  } else if (const Node rectangle = node.child("rectangle")) {
    const double height = file.child_number(rectangle, "heightToWidthRatio", 1.0);
    const double radius = file.child_number(rectangle, "cornerRadius", 0.0);
    if (!(height > 0.0) || radius < 0.0 || radius > 0.5 * std::min(1.0, height))
      file.fail(rectangle, "a rectangle 1 wide and " + exact_text(height) + " high with corners of radius " + exact_text(radius) + " is not possible");
    points.push_back({0.0, -0.5 * height});
    constexpr std::array<std::array<double, 2>, 4> k_corners{{{1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}}};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Uv center{k_corners[corner][0] * (0.5 - radius), k_corners[corner][1] * (0.5 * height - radius)};
      const double start = 0.5 * std::numbers::pi * (static_cast<double>(corner) - 1.0);
      for (int i = 0; i <= (radius > 0.0 ? k_quarter_points : 0); ++i) {
        const double angle = start + 0.5 * std::numbers::pi * i / k_quarter_points;
        points.push_back({center.u + radius * std::cos(angle), center.v + radius * std::sin(angle)});
      }
      if (corner == 1) points.push_back({0.0, 0.5 * height});
    }
  } else {
    file.fail(node, "the standard profile must be a rectangle or a superEllipse");
  }
  return points;
}

}  // namespace

void orient(std::vector<Uv>& points, double sign) {
  if (signed_area(points) * sign < 0.0) std::reverse(points.begin(), points.end());
}

std::vector<Uv> read_airfoil(const Document& document, const Node& from, const std::string& uid) {
  const Node node = document.resolve(from, uid);
  const Node list = node.child("pointList"), cst = node.child("cst2D");
  if (!list && !cst) document.file.fail(node, "the profile has neither a pointList nor cst2D");
  std::vector<Uv> points = list ? point_list(document, list, "x", "z") : cst_airfoil(document, cst);
  if (points.size() < 5) document.file.fail(node, "an airfoil needs 5 points; it has " + std::to_string(points.size()));
  orient(points, 1.0);
  return points;
}

std::vector<Uv> read_fuselage_profile(Document& document, const Node& from, const std::string& uid) {
  const Node node = document.resolve(from, uid);
  const Node list = node.child("pointList"), standard = node.child("standardProfile");
  if (!list && !standard) document.file.fail(node, "the profile has neither a pointList nor a standardProfile");
  std::vector<Uv> points = list ? point_list(document, list, "y", "z") : standard_profile(document, standard);
  const std::string symmetry = document.file.text(node, "symmetry");
  const bool is_open = points.size() > 2 && !is_same(points.front(), points.back()) && std::abs(points.front().u) <= k_same_profile_point &&
                       std::abs(points.back().u) <= k_same_profile_point;
  const bool is_half = is_open && (std::all_of(points.begin(), points.end(), [](Uv p) { return p.u >= -k_same_profile_point; }) ||
                                   std::all_of(points.begin(), points.end(), [](Uv p) { return p.u <= k_same_profile_point; }));
  if (is_half && symmetry.empty()) document.file.report(node, "the profile is an open half; the other half was added by mirroring");
  if (symmetry == "x-z-plane" || is_half) {  // one half is given: add the other one
    std::vector<Uv> other = points;
    for (Uv& p : other) p.u = -p.u;
    points.insert(points.end(), other.rbegin(), other.rend());
    points.erase(std::unique(points.begin(), points.end(), is_same), points.end());
  } else if (!symmetry.empty()) {
    document.file.fail(node, "the symmetry of a profile must be x-z-plane or empty; given: '" + symmetry + "'");
  }
  while (points.size() > 1 && is_same(points.front(), points.back())) points.pop_back();
  if (points.size() < 4) document.file.fail(node, "a fuselage profile needs 4 points; it has " + std::to_string(points.size()));
  orient(points, 1.0);
  const auto lowest = std::min_element(points.begin(), points.end(),
                                       [](Uv a, Uv b) { return std::abs(a.v - b.v) > k_same_profile_point ? a.v < b.v : std::abs(a.u) < std::abs(b.u); });
  std::rotate(points.begin(), lowest, points.end());
  return points;
}

std::vector<Uv> read_curve_profile(const Document& document, const Node& from, const std::string& uid) {
  const Node node = document.resolve(from, uid);
  const Node list = node.child("pointList");
  if (!list) document.file.fail(node, "the profile has no pointList");
  std::vector<Uv> points = point_list(document, list, "x", "y");
  if (points.size() < 2) document.file.fail(node, "a profile needs 2 points; it has " + std::to_string(points.size()));
  return points;
}

}  // namespace sterna::cpacs
