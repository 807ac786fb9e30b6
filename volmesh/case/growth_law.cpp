#include "volmesh/case/growth_law.h"

#include <algorithm>
#include <cmath>

#include "geom/math/constants.h"

namespace sterna::volmesh {
namespace {

/// For r - 1 below this value the quotient (r^n - 1)/(r - 1) loses digits. The binomial series to third order is exact to 1e-16 there, for n <= 1000.
constexpr double k_near_one = 1e-9;
constexpr int k_newton_steps = 60;
constexpr double k_ratio_tolerance = 1e-14;  ///< relative change of r - 1 that ends the iteration

/// Returns (r^n - 1)/(r - 1) for q = r - 1, without cancellation.
double geometric_sum(double q, int n) {
  if (q < k_near_one) return n * (1.0 + 0.5 * (n - 1) * q);
  return std::expm1(n * std::log1p(q)) / q;
}

constexpr int k_bend_steps = 100;            ///< largest number of Newton or bisection steps
constexpr double k_sum_tolerance = 1e-13;    ///< relative to the total height
constexpr double k_unbent = 1.0 / 3.0;       ///< fraction of the least height for the first cell: growth lines below it have the bend of full-height lines
constexpr double k_compressed = 1.0 + 1e-9;  ///< relative to n h0: lower heights are compressed
constexpr double k_largest_bend = 1e200;     ///< larger than any bend required by a height above n h0
constexpr double k_least_edge_share = 0.4;   ///< lower limit of the edge length at which the bend of a low growth line acts, as a fraction of the line's edge
constexpr double k_log_step = 1.0;           ///< step in the logarithm of the first height
constexpr double k_first_tolerance = 1e-14;  ///< tolerance in the logarithm of the first height
constexpr double k_kept_growth = 0.6;  ///< fraction of r - 1 at the top of a full-height growth line that lower lines keep before their first cells get lower

/// Sum of the cell heights of a growth line with a given bend, and the derivative of the sum with respect to the bend.
struct BentSum {
  double sum = 0.0, slope = 0.0;
  double last = 0.0, ratio = 1.0;  ///< height and ratio of the last cell
};

BentSum bent_sum(const LineGrowth& line, double bend, int n) {
  const double g = line.common;
  BentSum result{.sum = line.h0, .last = line.h0};
  double h = line.h0, dh = 0.0;
  for (int j = 1; j < n; ++j) {
    const double share = bend_share(h, line.edge), dshare = share < 1.0 ? 2.0 * share * dh / h : 0.0;
    double ratio = 1.0, dratio = 0.0;
    if (bend >= 0.0) {
      const double d = 1.0 / (1.0 + bend * share);
      if (g * d > 1.0) {
        ratio = g * d;
        dratio = -ratio * d * (share + bend * dshare);
      }
    } else {
      ratio = g * (1.0 - bend * share);
      dratio = -g * (share + bend * dshare);
    }
    dh = dratio * h + ratio * dh;
    h *= ratio;
    result.sum += h;
    result.slope += dh;
    result.ratio = ratio;
  }
  result.last = h;
  return result;
}

/// Returns the bend whose cell heights have this sum, by Newton's method between bounds. \pre n >= 2, height above n h0
double bend_for_height(const LineGrowth& line, double height, int n) {
  double low = 0.0, high = 0.0;  // bounds of the bend; the sum of heights is above the target at `low` and below it at `high`
  const double straight = bent_sum(line, 0.0, n).sum;
  if (std::abs(straight - height) <= k_sum_tolerance * height) return 0.0;
  double step = 1.0;
  if (straight > height) {
    while (bent_sum(line, step, n).sum > height && step < k_largest_bend) {
      low = step;
      step *= 4.0;
    }
    high = step;
  } else {
    while (bent_sum(line, -step, n).sum < height && step < k_largest_bend) {
      high = -step;
      step *= 4.0;
    }
    low = -step;
  }
  double bend = 0.5 * (low + high);
  for (int i = 0; i < k_bend_steps; ++i) {
    const BentSum at = bent_sum(line, bend, n);
    const double off = at.sum - height;
    if (std::abs(off) <= k_sum_tolerance * height) break;
    (off > 0.0 ? low : high) = bend;
    const double newton = at.slope < 0.0 ? bend - off / at.slope : low - 1.0;
    bend = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (high - low <= 1e-15 * std::max(1.0, std::abs(bend))) break;
  }
  return bend;
}

/// Cells of a growth line whose flat cells grow by the common ratio.
struct CommonCells {
  double first = 0.0;  ///< m, height of the first cell
  double bend = 0.0;
  double edge = 0.0;  ///< m, edge length at which the bend acts (bend_share)
};

/// Bend of a growth line that has the target height (at least 0), and the largest bend of a lower line.
struct Bends {
  double requested = 0.0, largest = 0.0;
};

Bends bends_of(const LineGrowth& line, int n) {
  const double bend = line.target > n * line.h0 * k_compressed ? bend_for_height(line, line.target, n) : line.common - 1.0;
  const double top = bend > 0.0 ? std::max(1.0, line.common / (1.0 + bend)) : line.common;
  return {std::max(0.0, bend), std::max(0.0, line.common / (1.0 + k_kept_growth * (top - 1.0)) - 1.0)};
}

/// Returns the first height in metres with which n cells of this bend have the total height `height`. Uses bisection of its logarithm, because the sum grows
/// with the first height.
/// \pre the sum with line.h0 is at least `height`
double first_for_height(LineGrowth line, double bend, double height, int n) {
  double high = std::log(line.h0), low = high;
  const auto off_at = [&](double log_first) {
    line.h0 = std::exp(log_first);
    return bent_sum(line, bend, n).sum - height;
  };
  while (off_at(low) > 0.0) {
    high = low;
    low -= k_log_step;
  }
  for (int i = 0; i < k_bend_steps && high - low > k_first_tolerance; ++i) {
    const double middle = 0.5 * (low + high);
    (off_at(middle) > 0.0 ? high : low) = middle;
  }
  return std::exp(0.5 * (low + high));
}

CommonCells common_cells(const LineGrowth& line, double height, int n) {
  if (n == 1) return {height, 0.0, line.edge};
  const Bends bends = bends_of(line, n);
  const double lowest = bent_sum(line, bends.largest, n).sum;
  if (height > lowest) return {line.h0, bend_for_height(line, height, n), line.edge};
  // The first cell is reduced in any case. The lower the growth line is, the more its last cells grow like those of a full-height line.
  const double squeeze = std::clamp((height / lowest - k_unbent) / (1.0 - k_unbent), 0.0, 1.0);
  const double bend = bends.requested + squeeze * (bends.largest - bends.requested);
  const double share = height / bent_sum(line, bend, n).sum;
  if (share >= k_least_edge_share) return {share * line.h0, bend, share * line.edge};
  LineGrowth low = line;
  low.h0 *= k_least_edge_share;
  low.edge *= k_least_edge_share;
  return {first_for_height(low, bend, height, n), bend, low.edge};
}

/// Returns the growth line with the first height and edge of its actual cells.
LineGrowth as_made(LineGrowth line, const CommonCells& cells) {
  line.h0 = cells.first;
  line.edge = cells.edge;
  return line;
}

}  // namespace

double bend_share(double height, double edge) {
  const double x = k_flat_edges * height / edge;
  return x < 1.0 ? x * x : 1.0;
}

double layer_height(double h0, double r, int n) { return h0 * geometric_sum(r - 1.0, n); }

double growth_for_edge(double h0, double l, double r_max, int n) {
  if (n == 1 || l <= h0) return 1.0;
  return std::clamp(std::pow(l / h0, 1.0 / (n - 1)), 1.0, r_max);
}

double height_by_edge(double h0, double edge, double r_max, int n, bool has_common_growth) {
  return layer_height(h0, growth_for_edge(h0, has_common_growth ? k_regular_height * edge : edge, r_max, n), n);
}

double growth_for_height(double h0, double height, int n) {
  const double goal = height / h0;
  if (n == 1 || goal <= n) return 1.0;
  // The sum exceeds its last term (1+q)^(n-1), so this start lies above the root. The sum is convex in q, so Newton's method descends monotonically.
  double q = std::expm1(std::log(goal) / (n - 1));
  for (int step = 0; step < k_newton_steps; ++step) {
    const double s = geometric_sum(q, n);
    const double slope = q < k_near_one ? 0.5 * n * (n - 1) : (n * std::exp((n - 1) * std::log1p(q)) - s) / q;
    const double next = std::max(0.0, q - (s - goal) / slope);
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

void layer_parameters(const LineGrowth& line, double height, int n, double* t) {
  if (line.common == 0.0) return layer_parameters(line.h0, height, n, t);
  const CommonCells cells = common_cells(line, height, n);
  double h = cells.first, sum = 0.0;
  t[0] = 0.0;
  for (int j = 1; j < n; ++j) {
    sum += h;
    t[j] = sum / height;
    const double share = bend_share(h, cells.edge);
    h *= cells.bend >= 0.0 ? std::max(1.0, line.common / (1.0 + cells.bend * share)) : line.common * (1.0 - cells.bend * share);
  }
  t[n] = 1.0;
}

double largest_growth(const LineGrowth& line, double height, int n) {
  if (line.common == 0.0) return growth_for_height(line.h0, height, n);
  if (n == 1) return 1.0;
  const CommonCells cells = common_cells(line, height, n);
  return std::max(line.common, bent_sum(as_made(line, cells), cells.bend, n).ratio);
}

double last_height(const LineGrowth& line, double height, int n) {
  if (line.common > 0.0) {
    const CommonCells cells = common_cells(line, height, n);
    return bent_sum(as_made(line, cells), cells.bend, n).last;
  }
  const double growth = growth_for_height(line.h0, height, n);
  return growth > 1.0 ? line.h0 * std::pow(growth, n - 1) : height / n;
}

double height_for_first_cell(const LineGrowth& line, int n) {
  return line.common > 0.0 && n > 1 ? bent_sum(line, bends_of(line, n).largest, n).sum : n * line.h0;
}

}  // namespace sterna::volmesh
