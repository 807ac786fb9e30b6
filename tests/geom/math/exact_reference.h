// Independent exact arithmetic for the tests: every double is an integer times a common power of two, so determinants are computed with big integers.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::test {

using BigInt = boost::multiprecision::cpp_int;
using BigRational = boost::multiprecision::cpp_rational;

/// Returns value * 2^shift.
/// \pre The product is an integer.
inline BigInt scaled_integer(double value, int shift) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  BigInt mantissa(static_cast<long long>(std::ldexp(fraction, 53)));
  const int total = exponent - 53 + shift;
  return total >= 0 ? BigInt(mantissa << static_cast<unsigned>(total)) : BigInt(mantissa / (BigInt(1) << static_cast<unsigned>(-total)));
}

/// Returns the shift that makes all values integers.
inline int common_shift(const std::vector<double>& values) {
  int shift = 0;
  for (const double v : values) {
    if (v == 0.0) continue;
    int exponent = 0;
    std::frexp(v, &exponent);
    shift = std::max(shift, 53 - exponent);
  }
  return shift;
}

using IntegerRows = std::vector<std::vector<BigInt>>;

/// Returns the rows, of equal length, as integers; each row is scaled by its own factor 2^shift.
inline IntegerRows integer_rows(const std::vector<std::vector<double>>& rows) {
  std::vector<double> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  const int shift = common_shift(all);
  IntegerRows result;
  for (const auto& row : rows) {
    result.emplace_back();
    for (const double v : row) result.back().push_back(scaled_integer(v, shift));
  }
  return result;
}

/// Returns the determinant by cofactors.
inline BigInt determinant(const IntegerRows& m) {
  if (m.size() == 1) return m[0][0];
  BigInt sum = 0;
  for (std::size_t column = 0; column < m.size(); ++column) {
    IntegerRows minor;
    for (std::size_t row = 1; row < m.size(); ++row) {
      minor.emplace_back();
      for (std::size_t c = 0; c < m.size(); ++c) {
        if (c != column) minor.back().push_back(m[row][c]);
      }
    }
    const BigInt term = m[0][column] * determinant(minor);
    if (column % 2 == 0) sum += term;
    else sum -= term;
  }
  return sum;
}

/// Sign of the determinant of differences to the first point. with_lift appends a column of squared lengths; then the first point is the query point.
inline int reference_sign(const std::vector<std::vector<double>>& points, bool with_lift) {
  const IntegerRows p = integer_rows(points);
  IntegerRows m;
  for (std::size_t i = 1; i < p.size(); ++i) {
    m.emplace_back();
    BigInt lift = 0;
    for (std::size_t c = 0; c < p[i].size(); ++c) {
      m.back().push_back(p[i][c] - p[0][c]);
      lift += m.back().back() * m.back().back();
    }
    if (with_lift) m.back().push_back(lift);
  }
  return determinant(m).sign();
}

}  // namespace sterna::test
