// Formulas and constants of NASA TM-4741 as in PDAS's public-domain naca456; tables are in naca_tables.h. A section is a thickness y_t(x) added perpendicular
// to a mean line y_c(x) on both sides. Each series defines both; the designation selects them.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <regex>

#include "geom/base/error.h"
#include "geom/model/airfoil_parts.h"
#include "geom/model/naca_tables.h"

namespace sterna {
namespace {

struct Height {
  double y = 0.0;
  double slope = 0.0;
};
/// Thickness profile: stations from the leading edge, and the half thickness at each station.
struct Profile {
  std::vector<double> x, y;
};

[[noreturn]] void refuse_designation(std::string_view designation, std::string problem) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "making NACA airfoil \"" + std::string(designation) + "\"",
               .problem = std::move(problem),
               .hint = "for instance 2412, 0012-64, 23012, 23112, 16-212, 63-215, 66(3)-218, 65-618 a=0.5, 63A210"});
}

std::vector<double> cosine_stations(int n) {
  std::vector<double> x;
  for (int i = 0; i <= n; ++i) x.push_back(0.5 * (1.0 - std::cos(std::numbers::pi * i / n)));
  return x;
}

// ---------------------------------------------------------------- thickness

Profile four_digit_thickness(double t, int n) {
  Profile profile{cosine_stations(n), {}};
  for (const double x : profile.x) profile.y.push_back(5.0 * t * (0.2969 * std::sqrt(x) + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - 0.1015 * x)))));
  return profile;
}

/// Returns the modified thickness with a nose radius index (6: as in the 4-digit series) and a location of the largest thickness. TM-4741, "modified
/// four-digit".
Profile modified_thickness(double t, int nose_index, double m, int n) {
  // d1 is the slope at the trailing edge of a section 0.2 thick, by location of the largest thickness. The curve aft of that location is d0 + d1 s + d2 s^2 +
  // d3 s^3, s = 1 - x.
  const double d1 = m < 0.25 ? 0.200 : m < 0.35 ? 0.234 : m < 0.45 ? 0.315 : m < 0.55 ? 0.465 : 0.700;
  const double s = 1.0 - m, d0 = 0.002;
  const double d2 = (0.294 - 2.0 * s * d1) / (s * s), d3 = (s * d1 - 0.196) / (s * s * s);
  // The curve ahead of m is a0 sqrt x + a1 x + a2 x^2 + a3 x^3. It has the nose radius, and at m the height 0.1, slope 0 and the curvature of the aft part.
  const double a0 = 0.296904 * (nose_index <= 8 ? nose_index / 6.0 : 10.3933 / 6.0);
  const double r0 = 0.1 - a0 * std::sqrt(m), r1 = -0.5 * a0 / std::sqrt(m), r2 = 2.0 * d2 + 6.0 * d3 * s + 0.25 * a0 / (m * std::sqrt(m));
  // Solve a1 m + a2 m^2 + a3 m^3 = r0, a1 + 2 a2 m + 3 a3 m^2 = r1, 2 a2 + 6 a3 m = r2.
  const double a3 = (r0 - r1 * m + 0.5 * r2 * m * m) / (m * m * m);
  const double a2 = 0.5 * r2 - 3.0 * a3 * m;
  const double a1 = r1 - 2.0 * a2 * m - 3.0 * a3 * m * m;
  Profile profile{cosine_stations(n), {}};
  for (const double x : profile.x) {
    const double q = 1.0 - x;
    profile.y.push_back(5.0 * t * (x < m ? a0 * std::sqrt(x) + x * (a1 + x * (a2 + x * a3)) : d0 + q * (d1 + q * (d2 + q * d3))));
  }
  return profile;
}

/// Cubic Hermite interpolation in a table of 21 equal steps over [0, pi].
double at_angle(const std::array<double, 21>& value, const std::array<double, 21>& slope, double phi) {
  const double h = std::numbers::pi / 20.0;
  const auto i = std::min(static_cast<std::size_t>(phi / h), std::size_t{19});
  const double s = phi / h - static_cast<double>(i), q = 1.0 - s;
  return value[i] * q * q * (1.0 + 2.0 * s) + value[i + 1] * s * s * (3.0 - 2.0 * s) + h * s * q * (slope[i] * q - slope[i + 1] * s);
}

/// Maps a circle to a near circle and then to the profile, with epsilon and psi multiplied by `scale` (Report 824, p. 263; TM X-3069).
Profile mapped_profile(const airfoil_parts::MappingTable& table, double scale, int n) {
  const auto zeta = [&](double phi) {
    const double psi = scale * at_angle(table.psi, table.psi_slope, phi), epsilon = scale * at_angle(table.epsilon, table.epsilon_slope, phi);
    const std::complex<double> near_circle = std::exp(std::complex<double>(psi, phi - epsilon));
    return near_circle + 1.0 / near_circle;
  };
  const double nose = zeta(0.0).real(), chord = nose - zeta(std::numbers::pi).real();
  Profile profile;
  for (int i = 0; i <= n; ++i) {
    const std::complex<double> z = zeta(std::numbers::pi * i / n);
    profile.x.push_back((nose - z.real()) / chord);
    profile.y.push_back(z.imag() / chord);
  }
  profile.x.front() = profile.y.front() = 0.0;
  profile.x.back() = 1.0;
  return profile;
}

/// Returns the largest height, by the parabola through the highest point and its neighbours.
double largest(const Profile& profile) {
  const auto top = static_cast<std::size_t>(std::max_element(profile.y.begin(), profile.y.end()) - profile.y.begin());
  if (top == 0 || top + 1 == profile.y.size()) return profile.y[top];
  const double before = profile.y[top - 1], here = profile.y[top], after = profile.y[top + 1];
  return here + (after - before) * (after - before) / (8.0 * (2.0 * here - before - after));
}

Profile six_series_thickness(std::string_view designation, const std::string& family, double t, int n) {
  const auto table =
      std::find_if(airfoil_parts::k_mapping_tables.begin(), airfoil_parts::k_mapping_tables.end(), [&](const auto& e) { return e.family == family; });
  if (table == airfoil_parts::k_mapping_tables.end())
    refuse_designation(designation, "unknown family " + family + "; known families are 63, 64, 65, 66, 67, 63A, 64A, 65A");
  // Thickness grows with the scale, so bisection finds the scale.
  double low = 0.0, high = 4.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (2.0 * largest(mapped_profile(*table, middle, 400)) < t ? low : high) = middle;
  }
  Profile profile = mapped_profile(*table, 0.5 * (low + high), n);
  if (family.back() == 'A') {
    // A-series sides are straight from about 0.8 chords to an edge of finite thickness, which the mapping rounds off.
    constexpr double k_straight_from = 0.85, k_rounded_from = 0.95;
    const Profile fine = mapped_profile(*table, 0.5 * (low + high), 2000);
    const auto height_at = [&](double x) {
      const auto i = static_cast<std::size_t>(std::lower_bound(fine.x.begin(), fine.x.end(), x) - fine.x.begin());
      const double share = (x - fine.x[i - 1]) / (fine.x[i] - fine.x[i - 1]);
      return (1.0 - share) * fine.y[i - 1] + share * fine.y[i];
    };
    const double ya = height_at(k_straight_from), yb = height_at(k_rounded_from);
    for (std::size_t i = 0; i < profile.x.size(); ++i)
      if (profile.x[i] > k_rounded_from) profile.y[i] = yb + (yb - ya) * (profile.x[i] - k_rounded_from) / (k_rounded_from - k_straight_from);
  } else {
    profile.y.back() = 0.0;
  }
  return profile;
}

// ---------------------------------------------------------------- mean lines

Height four_digit_mean(double m, double p, double x) {
  if (m == 0.0) return {};
  if (x < p) return {m / (p * p) * (2.0 * p * x - x * x), 2.0 * m / (p * p) * (p - x)};
  const double q = 1.0 - p;
  return {m / (q * q) * (1.0 - 2.0 * p + 2.0 * p * x - x * x), 2.0 * m / (q * q) * (p - x)};
}

struct FiveDigitLine {
  double m, k1, k2_by_k1;
};
/// Parameters by location of the largest camber, P = 1 .. 5 (p = P / 20); k1 is for the lift coefficient 0.3. TM-4741; NACA Report 610.
constexpr std::array<FiveDigitLine, 5> k_five_digit = {
    {{0.0580, 361.400, 0.0}, {0.1260, 51.640, 0.0}, {0.2025, 15.957, 0.0}, {0.2900, 6.643, 0.0}, {0.3910, 3.230, 0.0}}};
constexpr std::array<FiveDigitLine, 5> k_five_digit_reflexed = {
    {{0.0, 0.0, 0.0}, {0.1300, 51.990, 0.000764}, {0.2170, 15.793, 0.00677}, {0.3180, 6.520, 0.0303}, {0.4410, 3.191, 0.1355}}};

Height five_digit_mean(const FiveDigitLine& line, bool is_reflexed, double lift, double x) {
  const double k = line.k1 * lift / 0.3 / 6.0, m = line.m, d = x - m;
  if (!is_reflexed) {
    if (x < m) return {k * x * (x * x - 3.0 * m * x + m * m * (3.0 - m)), k * (3.0 * x * x - 6.0 * m * x + m * m * (3.0 - m))};
    return {k * m * m * m * (1.0 - x), -k * m * m * m};
  }
  const double lift_off = line.k2_by_k1 * std::pow(1.0 - m, 3), factor = x < m ? 1.0 : line.k2_by_k1;
  return {k * (factor * d * d * d - lift_off * x - m * m * m * x + m * m * m), k * (3.0 * factor * d * d - lift_off - m * m * m)};
}

/// Returns the height at x of the mean line whose load is uniform from the leading edge to x = a and then decreases to zero (Report 824, eq. 4.26). Its slope
/// at the nose is infinite and is therefore evaluated at x = 0.005.
Height uniform_load_mean(double a, double lift, double x) {
  constexpr double k_nose = 0.005;
  const auto log_or_zero = [](double t) { return t > 0.0 ? std::log(t) : 0.0; };
  const double xs = std::max(x, k_nose);
  if (a >= 1.0) {
    const double c = lift / (4.0 * std::numbers::pi), q = 1.0 - x;
    return {-c * (q * log_or_zero(q) + x * log_or_zero(x)), c * (log_or_zero(std::max(1.0 - xs, k_nose)) - log_or_zero(xs))};
  }
  const double c = lift / (2.0 * std::numbers::pi * (a + 1.0)), b = 1.0 - a;
  const double g = -(a * a * (0.5 * log_or_zero(a) - 0.25) + 0.25) / b;
  const double h = (0.5 * b * b * std::log(b) - 0.25 * b * b) / b + g;
  const auto height = [&](double t) {
    const double d = a - t, q = 1.0 - t;
    return c * ((0.5 * d * d * log_or_zero(std::abs(d)) - 0.5 * q * q * log_or_zero(q) + 0.25 * q * q - 0.25 * d * d) / b - t * log_or_zero(t) + g - h * t);
  };
  const double d = a - xs, q = 1.0 - xs;
  const double slope = c * ((q * log_or_zero(q) - d * log_or_zero(std::abs(d))) / b - log_or_zero(xs) - 1.0 - h);
  return {height(x), slope};
}

/// The mean line of the A-series: a = 0.8 with a straight part to the trailing edge (TM-4741, p. 8).
Height a_series_mean(double lift, double x) {
  constexpr double k_straight_from = 0.87437, k_factor = 0.97948;
  const double end = k_factor * uniform_load_mean(0.8, lift, k_straight_from).y;
  if (x >= k_straight_from) return {end * (1.0 - x) / (1.0 - k_straight_from), -end / (1.0 - k_straight_from)};
  const Height base = uniform_load_mean(0.8, lift, x);
  return {k_factor * base.y, k_factor * base.slope};
}

template <class MeanLine>
Airfoil combined(const std::string& name, const Profile& profile, const MeanLine& mean) {
  std::vector<Uv> upper, points;
  std::vector<Uv> lower;
  for (std::size_t i = 0; i < profile.x.size(); ++i) {
    const Height c = mean(profile.x[i]);
    const double along = 1.0 / std::sqrt(1.0 + c.slope * c.slope);
    const Uv across{-c.slope * along * profile.y[i], along * profile.y[i]}, centre{profile.x[i], c.y};
    upper.push_back(centre + across);
    lower.push_back(centre - across);
  }
  points.assign(upper.rbegin(), upper.rend());
  points.insert(points.end(), lower.begin() + 1, lower.end());
  return airfoil_parts::make(name, points);
}

/// A designation in lower case, without "naca", blanks and the subscripts in brackets or after a comma. The mean line's "a=" is separate.
struct Designation {
  std::string digits;
  double a = 1.0;
};
Designation cleaned(std::string_view text) {
  Designation d;
  std::string lower;
  for (const char c : text) lower += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  std::smatch match;
  static const std::regex k_load(R"(a\s*=\s*(1(\.0*)?|0?\.\d+)\s*$)");
  if (std::regex_search(lower, match, k_load)) {
    d.a = std::stod(match[1]);
    lower = match.prefix();
  }
  lower = std::regex_replace(lower, std::regex(R"(^\s*naca|\s|_|\([^)]*\)|,\d)"), "");
  d.digits = lower;
  return d;
}

int digit(const std::string& text, std::size_t at) { return text[at] - '0'; }
double percent(const std::string& text) { return std::stoi(text) / 100.0; }

}  // namespace

Airfoil naca_airfoil(std::string_view designation, int n_side) {
  constexpr int k_fewest = 10, k_most = 2000;
  if (n_side < k_fewest || n_side > k_most) refuse_designation(designation, std::to_string(n_side) + " points along a side, must be 10 .. 2000");
  const Designation d = cleaned(designation);
  const std::string name = "NACA " + std::string(designation.substr(designation.rfind("NACA ", 0) == 0 ? 5 : 0));
  const std::string& s = d.digits;
  std::smatch match;
  const auto is = [&](const char* pattern) { return std::regex_match(s, match, std::regex(pattern)); };
  const auto checked_thickness = [&](double t) {
    constexpr double k_thickest = 0.40;
    if (!(t > 0.0) || t > k_thickest) refuse_designation(designation, "a thickness of " + std::to_string(t) + " chords, must be above 0 and at most 0.40");
    return t;
  };

  if (is("16-?(\\d)(\\d\\d)")) {
    const double lift = digit(match[1], 0) / 10.0;
    return combined(name, modified_thickness(checked_thickness(percent(match[2])), 4, 0.5, n_side), [&](double x) { return uniform_load_mean(1.0, lift, x); });
  }
  // Subscripts ("642-015", "64(2)-015", "64,2-015") give the width of the low-drag range and do not affect the shape.
  if (is("(6[3-7])(a?)\\d?(a?)-(\\d)(\\d\\d)(a?)") || is("(6[3-7])(a?)\\d?(a?)(\\d)(\\d\\d)(a?)")) {
    const bool is_a = match[2].length() + match[3].length() + match[6].length() > 0;
    const double lift = digit(match[4], 0) / 10.0;
    const Profile profile = six_series_thickness(designation, match[1].str() + (is_a ? "A" : ""), checked_thickness(percent(match[5])), n_side);
    if (is_a) return combined(name, profile, [&](double x) { return a_series_mean(lift, x); });
    return combined(name, profile, [&](double x) { return uniform_load_mean(d.a, lift, x); });
  }
  if (is("(\\d)(\\d)(\\d\\d)(-(\\d)(\\d))?")) {
    const double m = digit(match[1], 0) / 100.0, p = digit(match[2], 0) / 10.0, t = checked_thickness(percent(match[3]));
    if (m > 0.0 && p == 0.0) refuse_designation(designation, "the position of the camber is missing: the second digit is 0");
    Profile profile;
    if (match[4].matched) {
      const int nose = digit(match[5], 0), at = digit(match[6], 0);
      if (at < 2 || at > 6) refuse_designation(designation, "the largest thickness at 0." + std::to_string(at) + " chords, must be at 0.2 .. 0.6");
      profile = modified_thickness(t, nose, at / 10.0, n_side);
    } else {
      profile = four_digit_thickness(t, n_side);
    }
    return combined(name, profile, [&](double x) { return four_digit_mean(m, p, x); });
  }
  if (is("(\\d)([1-5])([01])(\\d\\d)")) {
    const double lift = 0.15 * digit(match[1], 0);
    const bool is_reflexed = match[3] == "1";
    const std::size_t location = static_cast<std::size_t>(digit(match[2], 0)) - 1;
    if (is_reflexed && location == 0) refuse_designation(designation, "there is no reflexed mean line with the camber at 0.05 chords");
    const FiveDigitLine& line = is_reflexed ? k_five_digit_reflexed[location] : k_five_digit[location];
    return combined(name, four_digit_thickness(checked_thickness(percent(match[4])), n_side),
                    [&](double x) { return five_digit_mean(line, is_reflexed, lift, x); });
  }
  refuse_designation(designation, "not a designation of the 4-digit, modified 4-digit, 5-digit, 16-, 6- or 6A-series");
}

}  // namespace sterna
