#include "volmesh/case/growth_law.h"

#include <algorithm>
#include <cmath>

namespace sterna::volmesh {
namespace {

/// Below this r - 1 the quotient (r^n - 1)/(r - 1) loses digits; the binomial series to third order is exact to 1e-16 there for n <= 1000.
constexpr double k_near_one = 1e-9;
constexpr int k_newton_steps = 60;
constexpr double k_ratio_tolerance = 1e-14;  ///< relative change of r - 1 that ends the iteration

/// (r^n - 1)/(r - 1) from q = r - 1, without cancellation.
double geometric_sum(double q, int n) {
  if (q < k_near_one) return n * (1.0 + 0.5 * (n - 1) * q);
  return std::expm1(n * std::log1p(q)) / q;
}

}  // namespace

double layer_height(double h0, double r, int n) { return h0 * geometric_sum(r - 1.0, n); }

double growth_for_edge(double h0, double l, double r_max, int n) {
  if (n == 1 || l <= h0) return 1.0;
  return std::clamp(std::pow(l / h0, 1.0 / (n - 1)), 1.0, r_max);
}

double growth_for_height(double h0, double height, int n) {
  const double wanted = height / h0;
  if (n == 1 || wanted <= n) return 1.0;
  // The sum exceeds its last term (1+q)^(n-1), so this start lies above the root; the sum is convex in q: Newton descends monotonically.
  double q = std::expm1(std::log(wanted) / (n - 1));
  for (int step = 0; step < k_newton_steps; ++step) {
    const double s = geometric_sum(q, n);
    const double slope = q < k_near_one ? 0.5 * n * (n - 1) : (n * std::exp((n - 1) * std::log1p(q)) - s) / q;
    const double next = std::max(0.0, q - (s - wanted) / slope);
    const bool is_done = std::abs(next - q) <= k_ratio_tolerance * q;
    q = next;
    if (is_done) break;
  }
  return 1.0 + q;
}

void layer_parameters(double h0, double height, int n, double* t) {
  const double r = growth_for_height(h0, height, n);
  t[0] = 0.0;
  if (r <= 1.0) {
    for (int j = 1; j < n; ++j) t[j] = static_cast<double>(j) / n;
  } else {
    double sum = 0.0;
    double step = h0 / height;
    for (int j = 1; j < n; ++j) {
      sum += step;
      step *= r;
      t[j] = sum;
    }
  }
  t[n] = 1.0;
}

}  // namespace sterna::volmesh
